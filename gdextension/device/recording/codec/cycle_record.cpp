#include "device/recording/codec/cycle_record.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// Fills a row of doubles from the front.
struct Filler {
    double *next;
    void put(double value) noexcept { *next++ = value; }
    void put(const Vec3 &v) noexcept {
        put(v.x);
        put(v.y);
        put(v.z);
    }
    void put(std::span<const double> values) noexcept {
        next = std::copy(values.begin(), values.end(), next);
    }
};

} // namespace

void fill_output(const ServoSnapshot &snapshot, const DriveCommand &drive,
                 CycleOutput &output) noexcept {
    static_assert(kOutputTensions == kStringCount);
    const GripState &grip = snapshot.grip;
    Filler filler{output.values.data()};
    filler.put(drive.currents_a);
    filler.put(snapshot.tensions_n);
    filler.put(grip.pose.position_m);
    filler.put(grip.pose.r1_m);
    filler.put(grip.pose.r2_m);
    filler.put(lanes(grip.twist));
    filler.put(lanes(snapshot.requested));
    filler.put(grip.frame.grasp_angle_rad);
    filler.put(snapshot.force_scale);
    filler.put(snapshot.time_s);
    output.state = snapshot.state;
    output.grasp = snapshot.grasp;
    output.fault_string = snapshot.fault_string;
    output.motors_on = drive.motors_on;
    output.fault = snapshot.fault;
    output.pose_status = grip.status;
    output.tension_status = snapshot.tension_status;
}

std::uint32_t digest_of(const CycleOutput &output) noexcept {
    std::uint64_t hash = 0;
    const auto mix = [&hash](std::uint64_t word) {
        constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15U; // 2^64 / golden ratio
        constexpr unsigned kHalf = 32;
        hash = (hash ^ word) * kOdd;
        hash ^= hash >> kHalf; // the high bits of the product mix best
    };
    for (const double value : output.values) {
        mix(std::bit_cast<std::uint64_t>(value));
    }
    const auto word = [](auto value) { return static_cast<std::uint64_t>(value); };
    mix(word(output.state));
    mix(word(output.grasp));
    mix(word(output.fault_string));
    mix(word(output.motors_on));
    mix(word(output.fault));
    mix(word(output.pose_status));
    mix(word(output.tension_status));
    return static_cast<std::uint32_t>(hash);
}

MillinewtonArray millinewtons_of(const CycleOutput &output) noexcept {
    constexpr double kPerNewton = 1000.0;
    constexpr double kMost = 1e9; // makes the conversion defined for any value
    MillinewtonArray tensions{};
    for (std::size_t i = 0; i < tensions.size(); ++i) {
        const double value = kPerNewton * output.values[kOutputTensions + i];
        tensions[i] =
            value >= -kMost && value <= kMost ? static_cast<std::int32_t>(std::lround(value)) : 0;
    }
    return tensions;
}

} // namespace spidar
