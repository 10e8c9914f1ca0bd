// String lengths -> grip pose. Warm: Gauss-Newton on R3 x S2 x S2 from the pose that the last ones foresee; the second
// step is taken only when the first one leaves an error, and reuses its factorisation. Cold, or on a bad
// residual: the closed form (cubic in y1 / x2, from eq. (4)-(15) as corrected in docs/why/paper_notes.md). Rigid grips, exit
// pulleys and other frames take the same way with general steps: gauss_newton.h, and seven starts without closed form.
#pragma once

#include <cstdint>

#include "core/base/sound_state.h"
#include "core/base/status.h"
#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "core/kinematics/motion_prior.h"
#include "core/kinematics/pose_blend.h"
#include "core/kinematics/steps/crossed_step.h"

namespace spidar {

struct SearchTools; // core/kinematics/search/pose_search.h

// Lengths no pose explains. The paper's strings err by up to 3 mm; seven times that is a fault.
inline constexpr double kImpossibleResidual_m = 0.020;
// Smallest scaled pivot of the normal equations, about sigma7 squared. Below this the lengths leave a direction open to
// 1 %: the pose is flagged.
inline constexpr double kNearSingularPivot = 1e-4;
// Warm ticks from one look for other answers to the next: 8 ms at 1 kHz, in which a hand moves a few millimetres.
inline constexpr int kRivalPeriod = 8;
// Without a closed form a look costs more: it is taken this often, and only while the lengths fit worse than calibrated
// strings do.
inline constexpr int kSlowRivalPeriod = 14;
inline constexpr int kSlowRivalLooks = 5;
// Looks in a row that must find a better answer before the pose goes there: 56 ms at 1 kHz.
inline constexpr int kRivalLooks = 7;
// A movement within a tick of less than this, a hundredth of an encoder count in a second, is none.
inline constexpr double kStill_m = 2.5e-10;
// A warm tick is done when the error it leaves is below this part of what the lengths themselves err by: their residual.
// Errors add by squares, so that the pose is then worse by 0.2 %.
inline constexpr double kTrackingShare = 0.05;

struct KinematicsResult {
    GripPose pose;
    double residual_rms_m =
        0.0; // sqrt(mean (l - l(pose))^2) of the lengths given; noise or a fault shows here
    double conditioning =
        0.0; // smallest pivot of the scaled normal equations, 0..1; small = near singular. Lengths with errors:
    // looked at every kRivalPeriod ticks
    int steps = 0;              // Gauss-Newton steps taken
    bool cold_start = false;    // the closed form was used
    Status status = Status::ok; // >= 0: pose is new; < 0: pose is the last good one
};

class ForwardKinematics {
public:
    // Keeps copies. On a negative status the old configuration stands. Resets to the rest pose, cold.
    Status configure(const FrameGeometry &frame, const GripGeometry &grip) noexcept;

    // One servo tick: one to three steps. Lengths with errors are weighed against where the motion leads
    // (motion_prior.h). A search follows when a step is larger than hand and errors explain; another answer that stays better
    // for kRivalLooks looks is gone to without a jump (pose_blend.h). Holds the last good pose (status < 0) on garbage. Never NaN, no allocation.
    // ambiguous_pose, where there is a closed form: looked for every kRivalPeriod ticks, stands in between.
    KinematicsResult update(const StringArray &lengths_m) noexcept;

    // As update(), from no memory: closed form, upright pair first, then Gauss-Newton to convergence.
    KinematicsResult solve_cold(const StringArray &lengths_m) noexcept;

    // Warm start from here at the next update().
    void set_last_pose(const GripPose &pose) noexcept;
    [[nodiscard]] const GripPose &last_pose() const noexcept {
        return blend_.active() ? blend_.shown() : last_pose_;
    }
    // The same lengths again give the same pose. With errors the pose comes to it over some ticks.
    [[nodiscard]] bool settled() const noexcept {
        return !blend_.active() && better_looks_ == 0 && (prior_.weight() == 0.0 || still_);
    }
    // Forget the last pose: the next update() is cold.
    void reset() noexcept {
        warm_ = false;
        ambiguous_ = false;
        ticks_to_rivals_ = 0;
        better_looks_ = 0;
        fresh_ = true;
        still_ = false;
        blend_.stop();
        prior_.restart();
        forget_motion();
    }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(crossed_, is_box_, closed_form_, warm_, foreseeing_, still_, fresh_,
                         ambiguous_) &&
               is_tally(ticks_to_rivals_) && is_tally(better_looks_) && prior_.is_sound() &&
               blend_.is_sound() && spidar::is_sound(grip_) && spidar::is_sound(layout_);
    }

private:
    KinematicsResult track_crossed(const StringArray &lengths_m) noexcept;
    KinematicsResult track_any(const StringArray &lengths_m) noexcept;
    KinematicsResult search(const StringArray &lengths_m, const GripPose *remembered,
                            double content_m) noexcept;
    [[nodiscard]] SearchTools search_tools() const noexcept;
    void look_for_rivals(const StringArray &lengths_m, KinematicsResult &found) noexcept;
    void finish_look(bool look, const StringArray &lengths_m, KinematicsResult &result) noexcept;
    [[nodiscard]] GripPose expected_pose() const noexcept;
    [[nodiscard]] bool residual_alarms(double residual_rms_m) const noexcept;
    void foresee(const CrossedPose &change) noexcept;
    void forget_motion() noexcept {
        last_change_ = CrossedPose();
        last_turn_ = CrossedPose();
        foreseeing_ = false;
        prior_.forget_motion();
    }
    // Changes `result` in place and returns it: the tick makes no copy that it can spare.
    KinematicsResult accept(KinematicsResult &result) noexcept;
    [[nodiscard]] KinematicsResult hold(const KinematicsResult &from, Status status) const noexcept;
    [[nodiscard]] KinematicsResult refuse(const StringArray &lengths_m,
                                          const KinematicsResult &result) const noexcept;

    FrameGeometry frame_{};
    GripGeometry grip_{};
    CrossedLayout layout_;
    bool crossed_ =
        false; // layout_ is valid and the strings leave from eyelets: the fast steps serve
    Vec3 half_extents_m_{0.0}; // valid when is_box_
    bool is_box_ = false;
    bool closed_form_ = false;
    bool warm_ = false;
    GripPose last_pose_{};
    CrossedPose last_change_{}; // of the last warm tick
    CrossedPose last_turn_{};   // change of that change
    CrossedPose foreseen_change_{};
    bool foreseeing_ = false;
    MotionPrior prior_;
    PoseBlend blend_;
    bool still_ = false;        // the last tick moved the pose by less than kStill_m
    bool fresh_ = true;         // no tick since the pose was set or found
    double conditioning_ = 0.0; // by the strings alone, at the last look
    int better_looks_ = 0;      // in a row, at which another answer was better
    bool ambiguous_ = false;    // at the last look
    int ticks_to_rivals_ = 0;   // warm ticks until the next one
};

} // namespace spidar
