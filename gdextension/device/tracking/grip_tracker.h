// Counts of each cycle -> GripState: pose by forward kinematics, twist by the difference of poses, filtered.
#pragma once

#include "core/base/one_pole.h"
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
    // A plausible sample. `unchanged`: the same counts as the last good one. tensions_n: commanded in the last cycle.
    Update update(const CountArray &counts, bool unchanged, const StringArray &tensions_n,
                  double dt_s) noexcept;
    // No usable sample in this cycle: pose held. The twist is held too, until stale: then it falls to zero.
    void hold(Status why, double dt_s, bool stale) noexcept;

    [[nodiscard]] const GripState &grip() const noexcept { return grip_; }
    // In the last cycle, unfiltered; nothing when the pose was held or found anew.
    [[nodiscard]] const Displacement &moved() const noexcept { return moved_; }
    [[nodiscard]] const StringArray &lengths_m() const noexcept { return lengths_m_; }
    // The twist is exactly zero.
    [[nodiscard]] bool at_rest() const noexcept;
    [[nodiscard]] bool has_pose() const noexcept { return has_pose_; }
    // Speed of the fastest of P0 and the four pole ends (unit: m/s).
    [[nodiscard]] double fastest_point_m_s() const noexcept;

private:
    void filter_twist(const Twist &raw, double dt_s) noexcept;
    void come_to_rest(double dt_s) noexcept;

    ForwardKinematics kinematics_;
    LengthCorrection lengths_of_;
    OnePole twist_filter_;
    GripState grip_{};
    Displacement moved_{};
    StringArray lengths_m_{};
    Status solved_status_ = Status::ok; // of the pose held
    bool has_pose_ = false;
    bool solved_ = false;       // the last sample gave a pose
    double since_pose_s_ = 0.0; // since the pose the next difference is taken from
};

} // namespace spidar
