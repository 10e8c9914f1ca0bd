// String lengths -> grip pose. Warm: Gauss-Newton on R3 x S2 x S2 from the last pose. Cold, or on a bad
// residual: the trigonometric closed form (cubic in y1 / x2, from eq. (4)-(15) as corrected in docs/paper_notes.md).
#pragma once

#include <cstdint>

#include "core/frame_geometry.h"
#include "core/grip_geometry.h"
#include "core/status.h"
#include "core/types.h"

namespace spidar {

struct KinematicsResult {
    GripPose pose;
    double residual_rms_m =
        0.0; // sqrt(mean (l - l(pose))^2) of the lengths given; noise or a fault shows here
    double conditioning =
        0.0;       // smallest pivot of the scaled normal equations, 0..1; small = near singular
    int steps = 0; // Gauss-Newton steps taken
    bool cold_start = false;    // the closed form was used
    Status status = Status::ok; // >= 0: pose is new; < 0: pose is the last good one
};

class ForwardKinematics {
public:
    // Keeps copies. On a negative status the old configuration stands. Resets to the rest pose, cold.
    Status configure(const FrameGeometry &frame, const GripGeometry &grip) noexcept;

    // One servo tick: two steps from the last pose; falls back to cold() when the residual or the step size
    // says so; holds the last good pose (status < 0) on garbage. Never NaN, no allocation.
    KinematicsResult update(const StringArray &lengths_m) noexcept;

    // As update(), from no memory: closed form, upright pair first, then Gauss-Newton to convergence.
    KinematicsResult solve_cold(const StringArray &lengths_m) noexcept;

    // Warm start from here at the next update().
    void set_last_pose(const GripPose &pose) noexcept;
    [[nodiscard]] const GripPose &last_pose() const noexcept { return last_pose_; }
    // Forget the last pose: the next update() is cold.
    void reset() noexcept { warm_ = false; }

private:
    KinematicsResult search(const StringArray &lengths_m, const GripPose *remembered) noexcept;
    KinematicsResult accept(KinematicsResult result) noexcept;
    [[nodiscard]] KinematicsResult hold(KinematicsResult result, Status status) const noexcept;

    FrameGeometry frame_{};
    GripGeometry grip_{};
    Vec3 half_extents_m_{0.0}; // valid when is_box_
    bool is_box_ = false;
    bool warm_ = false;
    GripPose last_pose_{};
};

} // namespace spidar
