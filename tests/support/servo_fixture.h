// A servo step or loop on the paper's device, ideal unless a test says otherwise.
#pragma once

#include <cmath>
#include <memory>

#include "device/loop/servo_loop.h"
#include "device/simulation/simulated_transport.h"
#include "device/step/servo_step.h"
#include "support/tick_checks.h"

namespace spidar::test {

inline constexpr double kTick_s = 0.001;

inline ServoSettings ideal_settings() {
    ServoSettings settings;
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          CountArray{}, kPaperMetresPerCount);
    settings.safety.hand_presence_s = 0.0; // most tests hold the grip stiller than any hand
    return settings;
}

inline CountArray counts_of(const ServoSettings &settings, const GripPose &pose) {
    const StringArray lengths_m = string_lengths(settings.frame, settings.grip, pose);
    CountArray counts{};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double turns =
            (lengths_m[i] - settings.strings.offset_m[i]) / settings.strings.scale_m_per_count[i];
        counts[i] =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(settings.strings.zero_count[i]) +
                                      static_cast<std::uint32_t>(std::llround(turns)));
    }
    return counts;
}

inline GripPose moved_by(const ServoSettings &settings, const Vec3 &position_m,
                         double grasp_angle_rad = 0.0) {
    return make_pose(settings.grip, position_m, Mat3(1.0), grasp_angle_rad);
}

// A step that is fed by hand: what a device would say, tick by tick.
struct Bench {
    ServoSettings settings = ideal_settings();
    ServoStep step;
    HapticCommand command;
    DeviceReading reading;
    Status read_status = Status::ok;
    bool simulated = true;
    DriveCommand drive;
    TickChecks checks;
    std::shared_ptr<ProxyMemory> memory = std::make_shared<ProxyMemory>();

    Bench() {
        step.use(memory.get());
        start();
    }
    void start() { started = step.configure(settings); }
    Status started = Status::ok;

    void put(const GripPose &pose) { reading.counts = counts_of(settings, pose); }
    void tick(int times = 1, double dt_s = kTick_s) {
        for (int i = 0; i < times; ++i) {
            drive = step.step(read_status, reading, command, dt_s, simulated);
            checks.check(settings, read_status, reading, drive, now(), dt_s);
        }
    }
    // Forces on and the ramp over.
    void activate() {
        command.forces_enabled = true;
        tick(1 + static_cast<int>(std::lround(settings.safety.arming_time_s / kTick_s)));
    }
    void ask(const Wrench &wrench, double duration_s) {
        ++command.wrench_sequence;
        command.wrench = wrench;
        command.wrench_duration_s = duration_s;
    }
    const ServoSnapshot &now() const { return step.snapshot(); }
    bool motors_off() const {
        bool off = !drive.motors_on;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            off = off && drive.tensions_n[i] == 0.0 && drive.currents_a[i] == 0.0 &&
                  now().tensions_n[i] == 0.0;
        }
        return off;
    }
};

} // namespace spidar::test
