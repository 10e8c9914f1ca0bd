// Computes GripState from the counts of each cycle: the pose by forward kinematics, the twist by
// filtered differences of poses. Since a report is some time old, or missing, the present pose is
// the measured pose extrapolated by a twist.
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
    // On a negative status the old configuration stays.
    Status configure(const ServoSettings &settings) noexcept;
    // The next sample is solved without the last pose, and the twist restarts from zero.
    void restart() noexcept;

    // Sets the zero counts to `counts`, which the grip has at home, then acts like restart().
    void set_zero(const CountArray &counts) noexcept;

    struct Update {
        Status status = Status::ok; // < 0: the pose is the last good one
        bool skipped = false;       // counts were unchanged: nothing was solved
        bool cold_start = false;
        bool moved = false; // the pose changed
    };
    // When a sample was taken.
    struct Made {
        // Time since the last sample that gave a pose.
        double after_s = 0.0;
        // Age of the sample; 0: just taken.
        double age_s = 0.0;
    };
    // Takes a plausible sample. unchanged: the counts equal those of the last good sample.
    // tensions_n: commanded in the last cycle.
    Update update(const CountArray &counts, bool unchanged, const StringArray &tensions_n,
                  const Made &made) noexcept;
    // Takes a cycle without a usable sample and extrapolates the pose by the twist. The twist is
    // held or, when stale, falls to zero. Returns true when the pose changed.
    bool hold(Status why, double dt_s, bool stale) noexcept;

    [[nodiscard]] const GripState &grip() const noexcept { return grip_; }
    // Unfiltered displacement of the last cycle; zero when the pose was found by a search.
    [[nodiscard]] const Displacement &moved() const noexcept { return moved_; }
    [[nodiscard]] const StringArray &lengths_m() const noexcept { return lengths_m_; }
    // True when the twist is exactly zero and the same counts again would give the same pose.
    [[nodiscard]] bool at_rest() const noexcept;
    [[nodiscard]] bool has_pose() const noexcept { return has_pose_; }
    // Speed of the fastest point among P0 and the four pole ends (unit: m/s).
    [[nodiscard]] double fastest_point_m_s() const noexcept;
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(carried_, has_pose_, solved_, grip_.frame.rotation_held,
                         measured_frame_.rotation_held) &&
               spidar::is_sound(geometry_) && kinematics_.is_sound() && lengths_of_.is_sound();
    }

private:
    void filter_twist(const Twist &raw, double dt_s) noexcept;
    void come_to_rest(double dt_s) noexcept;
    // Sets grip_.pose and frame to the measured ones extrapolated by the twist.
    void place(double age_s) noexcept;
    void carry_on(double time_s) noexcept;

    GripGeometry geometry_;
    ForwardKinematics kinematics_;
    LengthCorrection lengths_of_;
    OnePole twist_filter_;
    OnePole carrier_filter_;
    // The twist that extrapolates the pose, with less filtering than grip_.twist: lag would be felt
    // when the hand turns back.
    Twist carrier_;
    GripState grip_{};
    GripPose measured_;
    GripFrame measured_frame_;
    bool carried_ = false; // grip_.pose is extrapolated
    Displacement moved_{};
    StringArray lengths_m_{};
    Status solved_status_ = Status::ok; // status of the measured pose
    bool has_pose_ = false;
    bool solved_ = false; // the last sample gave a pose
};

} // namespace spidar
