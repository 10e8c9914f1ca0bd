// Gauss-Newton on R3 x S2 x S2 for the grip as the paper strings it, two strings to each pole end: the work of
// gauss_newton.h with both poles computed side by side. Slot 2e+k holds the k-th string of pole end e (0: +, 1: -).
//
// A string at end s of a pole, with direction e, has the slopes (e, s e) in (P0, r). So all that the normal
// equations need are the outer products e e' summed over the strings of an end: their sum over both ends serves
// P0 and r alone, their difference couples the two. Unknowns and the meaning of the pivots are those of gauss_newton.h.
#pragma once

#include <array>
#include <cstdint>

#include "core/frame_geometry.h"
#include "core/grip_geometry.h"
#include "core/pole_lanes.h"

namespace spidar {

inline constexpr std::size_t kSlotCount = 4;

// Which string sits in which slot, and from where it comes.
struct CrossedLayout {
    std::array<LaneVec, kSlotCount> motors_m;
    std::array<std::array<std::uint8_t, 2>, kSlotCount> strings{}; // [slot][pole]
    double pole_half_length_m = 0.0;
};

// False, layout untouched, when some pole end does not carry exactly two strings.
[[nodiscard]] bool make_layout(const FrameGeometry &frame, const GripGeometry &grip,
                               CrossedLayout &layout) noexcept;

struct CrossedPose {
    LaneVec position_m; // P0 in both lanes
    LaneVec poles_m;    // r1, r2
};

[[nodiscard]] inline CrossedPose lanes_of(const GripPose &pose) noexcept {
    return {lanes_of(pose.position_m, pose.position_m), lanes_of(pose.r1_m, pose.r2_m)};
}

[[nodiscard]] inline GripPose pose_of(const CrossedPose &pose) noexcept {
    return {lane(pose.position_m, 0), lane(pose.poles_m, 0), lane(pose.poles_m, 1)};
}

// Measured minus computed lengths, and the directions in which the lengths grow.
struct CrossedErrors {
    std::array<LaneVec, kSlotCount> direction;
    std::array<Lanes, kSlotCount> residual_m;
    double sum_of_squares_m2 = 0.0;
};

// Normal equations of one pose, eliminated poles first; the 3 x 3 position block as L D L'.
struct CrossedFactor {
    LaneVec u; // tangents of the poles
    LaneVec v;
    LaneVec couple_u; // of the position to u, and to v once u is eliminated
    LaneVec couple_v;
    Lanes inverse_u{};
    Lanes inverse_v{};
    Lanes ratio{};
    double l10 = 0.0, l20 = 0.0, l21 = 0.0;
    double inverse_0 = 0.0, inverse_1 = 0.0, inverse_2 = 0.0;
    double min_pivot = 0.0; // as in GaussNewtonStep
    bool solvable = false;
};

struct CrossedStep {
    LaneVec position_m;
    LaneVec poles_m;
    double size_m2 = 0.0;     // squared norm of the seven displacements
    double decrease_m2 = 0.0; // of the sum of squares, as the linear model has it
};

[[nodiscard]] CrossedErrors errors_at(const CrossedLayout &layout, const StringArray &lengths_m,
                                      const CrossedPose &pose) noexcept;

[[nodiscard]] CrossedFactor factorise(const CrossedErrors &errors, const CrossedPose &pose,
                                      double pole_half_length_m) noexcept;

// The step that `errors` ask for, by the factorisation made there.
[[nodiscard]] CrossedStep solve(const CrossedFactor &factor, const CrossedErrors &errors) noexcept;

// The same by a factorisation made close by; `pose` is where the errors are. Ends at the same pose.
[[nodiscard]] CrossedStep solve_nearby(const CrossedFactor &factor, const CrossedErrors &errors,
                                       const CrossedPose &pose) noexcept;

// Moved, and the poles back on their spheres to rounding.
[[nodiscard]] CrossedPose moved(const CrossedPose &pose, const CrossedStep &step,
                                double pole_half_length_m) noexcept;

} // namespace spidar
