// Forward kinematics: string lengths to grip pose. A warm tick takes Gauss-Newton steps on R3 x S2
// x S2 from the pose that the last poses predict. A second step is taken only if the first leaves
// an error that matters, and uses the factorization of the first if that suffices. A cold start, or
// a residual that is too large, leads to a search from the closed form (cubic in y1 / x2, eq.
// (4)-(15) as corrected in docs/why/paper_notes.md). Rigid grips, exit pulleys and grips without
// exactly two strings at each pole end use the general steps of gauss_newton.h. Without a closed
// form the search has seven starts.
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

// Residual (rms) above which no pose explains the lengths. The paper's strings err by up to 3 mm;
// seven times that is a fault.
inline constexpr double kImpossibleResidual_m = 0.020;
// Smallest scaled pivot of the normal equations (about sigma7 squared) that is not flagged
// near_singular. Below it sigma7 is below about 0.01: a motion of 1 mm in some direction changes
// the lengths by 0.01 mm or less.
inline constexpr double kNearSingularPivot = 1e-4;
// Warm ticks between two searches for a rival, which is another pose that may fit the same lengths
// better: 8 ms at 1 kHz, a few mm of hand motion.
inline constexpr int kRivalPeriod = 8;
// kRivalPeriod for grips without a closed form or with the general steps, where a search costs
// more. It then runs only while the residual exceeds kWarmResidualGate_m.
inline constexpr int kSlowRivalPeriod = 14;
// Number of searches in a row, from the closed form, that must prefer a rival before it is taken:
// 56 ms at 1 kHz.
inline constexpr int kRivalLooks = 7;
// Like kRivalLooks, for grips without a closed form or with the general steps: 70 ms at 1 kHz.
inline constexpr int kSlowRivalLooks = 5;
// Largest change of pose per tick that counts as standing still: 0.01 encoder counts per second.
inline constexpr double kStill_m = 2.5e-10;
// A warm tick ends when the error that it leaves is below this share of the residual. Errors add by
// squares, so that this error makes the total about 0.1 % larger.
inline constexpr double kTrackingShare = 0.05;

struct KinematicsResult {
    GripPose pose;
    // sqrt(mean (l - l(pose))^2) over the eight lengths; shows noise and faults.
    double residual_rms_m = 0.0;
    // Smallest pivot of the scaled normal equations, 0..1; small: near singular. For lengths with
    // errors it is computed anew only at searches for rivals.
    double conditioning = 0.0;
    int steps = 0;              // Gauss-Newton or Newton steps taken
    bool cold_start = false;    // a search ran, from the closed form or other starts
    Status status = Status::ok; // >= 0: pose is new; < 0: pose is the last good one
};

class ForwardKinematics {
public:
    // Keeps copies; starts cold at the rest pose. invalid_geometry keeps the old configuration.
    Status configure(const FrameGeometry &frame, const GripGeometry &grip) noexcept;

    // Takes one servo tick of measured lengths (unit: m). A warm tick takes one to three steps.
    // Lengths with errors are weighed against the predicted motion (motion_prior.h). A search runs
    // when a step or a residual is larger than hand motion and the usual errors explain. The
    // returned pose changes without a jump (pose_blend.h) to a rival that kRivalLooks or
    // kSlowRivalLooks searches in a row prefer. On bad lengths the result holds the last good pose,
    // which is never NaN, and status < 0. Warm ticks report ambiguous_pose only with a closed form
    // and eyelets, as the last search found it. No allocation.
    KinematicsResult update(const StringArray &lengths_m) noexcept;

    // Finds the pose without the last pose: by a search from the closed form, the upright root pair
    // first, or from seven starts. A good result becomes the last pose.
    KinematicsResult solve_cold(const StringArray &lengths_m) noexcept;

    // Sets the pose from which the next update() starts warm.
    void set_last_pose(const GripPose &pose) noexcept;
    // The pose last returned by update().
    [[nodiscard]] const GripPose &last_pose() const noexcept {
        return blend_.active() ? blend_.shown() : last_pose_;
    }
    // True when another update() with the last lengths would return the last pose.
    [[nodiscard]] bool settled() const noexcept {
        return !blend_.active() && better_looks_ == 0 && (prior_.weight() == 0.0 || still_);
    }
    // The next update() searches for the pose instead of starting at the last one.
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
    // Checks restored memory: see core/base/sound_state.h.
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
    // Changes `result` in place and returns it, which saves a copy per tick.
    KinematicsResult accept(KinematicsResult &result) noexcept;
    [[nodiscard]] KinematicsResult hold(const KinematicsResult &from, Status status) const noexcept;
    [[nodiscard]] KinematicsResult refuse(const StringArray &lengths_m,
                                          const KinematicsResult &result) const noexcept;

    FrameGeometry frame_{};
    GripGeometry grip_{};
    CrossedLayout layout_;
    // layout_ is valid and the strings leave from eyelets: the fast steps of crossed_step.h apply.
    bool crossed_ = false;
    Vec3 half_extents_m_{0.0}; // valid when is_box_
    bool is_box_ = false;
    bool closed_form_ = false;
    bool warm_ = false;
    GripPose last_pose_{};
    CrossedPose last_change_{}; // change of pose in the last warm tick
    CrossedPose last_turn_{};   // change of last_change_
    CrossedPose foreseen_change_{};
    bool foreseeing_ = false;
    MotionPrior prior_;
    PoseBlend blend_;
    bool still_ = false; // the last tick moved the pose by less than kStill_m
    // True until the first tick after the pose was set or the memory was reset.
    bool fresh_ = true;
    // Conditioning by the lengths alone: of the last tick or, for lengths with errors, of the last
    // tick that searched for rivals.
    double conditioning_ = 0.0;
    // Searches in a row that preferred a rival.
    int better_looks_ = 0;
    // True if the last search found that another pose fits as well.
    bool ambiguous_ = false;
    // Warm ticks until the next search for rivals.
    int ticks_to_rivals_ = 0;
};

} // namespace spidar
