// Counts of each cycle -> GripState: pose by forward kinematics, twist by the difference of poses, filtered. Reports are some
// time old, or do not come: the pose of now is the measured one carried on by the twist.
#pragma once

#include "core/base/one_pole.h"
#include "core/base/sound_state.h"
#include "core/kinematics/forward_kinematics.h"
#include "device/contract/motion.h"
#include "device/settings/servo_settings.h"
#include "device/tracking/length_correction.h"

namespace spidar {

class GripTracker {
public:
    // On a negative status the old configuration stands.
    Status configure(const ServoSettings &settings) noexcept;
    // The next sample is solved from no memory; the twist starts again from zero.
    void restart() noexcept;

    // These counts are those of the home pose: lengths start from them. Then as restart().
    void set_zero(const CountArray &counts) noexcept;

    struct Update {
        Status status = Status::ok; // < 0: the pose is the last good one
        bool skipped = false;       // counts unchanged: nothing to solve
        bool cold_start = false;
        bool moved = false; // the pose changed
    };
    // When a sample was made: so long after the last one that gave a pose, and so long ago. Zero age: it is of now.
    struct Made {
        double after_s = 0.0;
        double age_s = 0.0;
    };
    // A plausible sample. `unchanged`: the same counts as the last good one. tensions_n: commanded in the last cycle.
    Update update(const CountArray &counts, bool unchanged, const StringArray &tensions_n,
                  const Made &made) noexcept;
    // No usable sample in this cycle, of this length: the pose is carried on by the twist. That is held, until stale: then
    // it falls to zero. True: the pose changed.
    bool hold(Status why, double dt_s, bool stale) noexcept;

    [[nodiscard]] const GripState &grip() const noexcept { return grip_; }
    // In the last cycle, unfiltered; nothing when the pose was found anew.
    [[nodiscard]] const Displacement &moved() const noexcept { return moved_; }
    [[nodiscard]] const StringArray &lengths_m() const noexcept { return lengths_m_; }
    // The twist is exactly zero, and the same counts would give the same pose.
    [[nodiscard]] bool at_rest() const noexcept;
    [[nodiscard]] bool has_pose() const noexcept { return has_pose_; }
    // Speed of the fastest of P0 and the four pole ends (unit: m/s).
    [[nodiscard]] double fastest_point_m_s() const noexcept;
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(carried_, has_pose_, solved_, grip_.frame.rotation_held,
                         measured_frame_.rotation_held) &&
               spidar::is_sound(geometry_) && kinematics_.is_sound() && lengths_of_.is_sound();
    }

private:
    void filter_twist(const Twist &raw, double dt_s) noexcept;
    void come_to_rest(double dt_s) noexcept;
    // grip_.pose and frame: the measured ones carried on by the twist for this long.
    void place(double age_s) noexcept;
    void carry_on(double time_s) noexcept;

    GripGeometry geometry_;
    ForwardKinematics kinematics_;
    LengthCorrection lengths_of_;
    OnePole twist_filter_;
    OnePole carrier_filter_;
    Twist
        carrier_; // what carries the pose on: filtered less, as lag would be felt when the hand turns back
    GripState grip_{};
    GripPose measured_;
    GripFrame measured_frame_;
    bool carried_ = false; // grip_.pose is not the measured one
    Displacement moved_{};
    StringArray lengths_m_{};
    Status solved_status_ = Status::ok; // of the pose held
    bool has_pose_ = false;
    bool solved_ = false; // the last sample gave a pose
};

} // namespace spidar
