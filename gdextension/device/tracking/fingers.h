// The fingers of a rigid grip. No string measures how far they are closed: a button, the game or a sensor tells. They follow
// like fingers, without a jump of angle or speed. Nothing can push them open, so no grasp torque is felt.
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

    // A report that is believed, and the command of each cycle.
    void take(const DeviceReading &reading) noexcept;
    void take(const HapticCommand &command) noexcept;
    void advance(double dt_s) noexcept;

    [[nodiscard]] const FingerMotion &motion() const noexcept { return motion_; }

    [[nodiscard]] bool at_rest() const noexcept {
        return motion_.rate_rad_s == 0.0 && motion_.angle_rad == target_rad();
    }
    // Neither would move them.
    [[nodiscard]] bool has_seen(const DeviceReading &reading,
                                const HapticCommand &command) const noexcept;
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(motion_.given) && spidar::is_sound(settings_);
    }

private:
    [[nodiscard]] double share_of(const DeviceReading &reading) const noexcept;
    [[nodiscard]] double share_of(const HapticCommand &command) const noexcept;
    [[nodiscard]] double target_rad() const noexcept;

    FingerSettings settings_;
    double device_share_ = 0.0; // told by buttons and sensor, 0 open to 1 closed
    double game_share_ = 0.0;
    FingerMotion motion_; // given: not for a crossed grip, whose strings measure it
};

} // namespace spidar
