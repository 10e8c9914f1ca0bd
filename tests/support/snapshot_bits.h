// All bits of a snapshot as one number: two runs of equal numbers told the game exactly the same.
#pragma once

#include <cstdint>

#include "device/recording/field_words.h"
#include "device/servo_snapshot.h"

namespace spidar::test {

class BitMixer {
public:
    template <typename T>
    void mix(T value) {
        hash_ = (hash_ ^ to_word(value)) * 0x9E3779B97F4A7C15U;
        hash_ ^= hash_ >> 29U;
    }
    void mix(const Vec3 &v) {
        mix(v.x);
        mix(v.y);
        mix(v.z);
    }
    void mix(const Wrench &wrench) {
        mix(wrench.force_n);
        mix(wrench.moment_nm);
        mix(wrench.grasp_torque_nm);
    }
    template <typename T, std::size_t N>
    void mix(const std::array<T, N> &values) {
        for (const T &value : values) {
            mix(value);
        }
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 1;
};

inline std::uint64_t bits_of(const ServoSnapshot &now) {
    static_assert(count_members<ServoSnapshot>() == 25, "ServoSnapshot changed: mix it in here");
    static_assert(count_members<ServoCounters>() == 17, "ServoCounters changed: mix it in here");
    BitMixer mixer;
    mixer.mix(now.time_s);
    mixer.mix(now.state);
    mixer.mix(now.fault);
    mixer.mix(now.fault_string);
    mixer.mix(now.grip.pose.position_m);
    mixer.mix(now.grip.pose.r1_m);
    mixer.mix(now.grip.pose.r2_m);
    for (int axis = 0; axis < 3; ++axis) {
        mixer.mix(now.grip.frame.rotation[axis]);
    }
    mixer.mix(now.grip.frame.crossing_angle_rad);
    mixer.mix(now.grip.frame.grasp_angle_rad);
    mixer.mix(now.grip.frame.rotation_held);
    mixer.mix(now.grip.twist.linear_m_s);
    mixer.mix(now.grip.twist.angular_rad_s);
    mixer.mix(now.grip.twist.grasp_rate_rad_s);
    mixer.mix(now.grip.residual_rms_m);
    mixer.mix(now.grip.conditioning);
    mixer.mix(now.grip.status);
    mixer.mix(now.grasp);
    mixer.mix(now.counts);
    mixer.mix(now.lengths_m);
    mixer.mix(now.tensions_n);
    mixer.mix(now.requested);
    mixer.mix(now.achieved);
    mixer.mix(now.at_min_mask);
    mixer.mix(now.at_max_mask);
    mixer.mix(now.tension_status);
    mixer.mix(now.force_scale);
    mixer.mix(now.safety_scale);
    mixer.mix(now.thermal_share);
    mixer.mix(now.parity_error_m);
    mixer.mix(now.zero_known);
    mixer.mix(now.contact_count);
    for (const ContactReport &contact : now.contacts) {
        mixer.mix(contact.id);
        mixer.mix(contact.impulse_ns);
        mixer.mix(contact.grasp_impulse_nms);
        mixer.mix(contact.touching);
    }
    mixer.mix(now.injected_j);
    mixer.mix(now.clamp.gain);
    mixer.mix(now.clamp.request);
    mixer.mix(now.clamp.from_latency);
    mixer.mix(now.clamp.index);
    mixer.mix(now.clamp.asked);
    mixer.mix(now.clamp.given);
    const ServoCounters &count = now.counters;
    mixer.mix(count.ticks);
    mixer.mix(count.kinematics_skipped);
    mixer.mix(count.tension_skipped);
    mixer.mix(count.cold_starts);
    mixer.mix(count.bad_samples);
    mixer.mix(count.read_timeouts);
    mixer.mix(count.rejected_requests);
    mixer.mix(count.clamped_requests);
    mixer.mix(count.expired_requests);
    mixer.mix(count.saturated_ticks);
    mixer.mix(count.slewed_ticks);
    mixer.mix(count.write_failures);
    mixer.mix(count.reports_missed);
    mixer.mix(count.old_reports);
    mixer.mix(count.faded_ticks);
    mixer.mix(count.bad_time_steps);
    mixer.mix(count.gate_clamps);
    mixer.mix(now.buttons);
    return mixer.value();
}

} // namespace spidar::test
