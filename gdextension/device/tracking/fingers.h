// The fingers of a rigid grip, which no string measures. A button, the game or a sensor closes
// them. The angle follows smoothly, without jumps of angle or speed. The device cannot push the
// fingers, so that no grasp torque is felt.
#pragma once

#include "core/base/sound_state.h"
#include "core/geometry/grip_geometry.h"
#include "device/contract/haptic_command.h"
#include "device/contract/motion.h"
#include "device/contract/transport.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class Fingers {
public:
    void configure(const FingerSettings &settings, GripKind kind) noexcept;

    // Takes an accepted report.
    void take(const DeviceReading &reading) noexcept;
    // Takes the command of a cycle.
    void take(const HapticCommand &command) noexcept;
    void advance(double dt_s) noexcept;

    [[nodiscard]] const FingerMotion &motion() const noexcept { return motion_; }

    [[nodiscard]] bool at_rest() const noexcept {
        return motion_.rate_rad_s == 0.0 && motion_.angle_rad == target_rad();
    }
    // True when both take() functions with these arguments would change nothing.
    [[nodiscard]] bool has_seen(const DeviceReading &reading,
                                const HapticCommand &command) const noexcept;
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(motion_.given) && spidar::is_sound(settings_);
    }

private:
    [[nodiscard]] double share_of(const DeviceReading &reading) const noexcept;
    [[nodiscard]] double share_of(const HapticCommand &command) const noexcept;
    [[nodiscard]] double target_rad() const noexcept;

    FingerSettings settings_;
    double device_share_ = 0.0; // by buttons and sensor: 0 open to 1 closed
    double game_share_ = 0.0;
    // `given` is false for a crossed grip, whose strings measure the angle.
    FingerMotion motion_;
};

} // namespace spidar
