// Closed-form kinematics of the paper's grip in a box frame, eq. (4)-(15) with misprints corrected
// (docs/why/paper_notes.md). x, y, x1 and y2 follow directly. y1 and x2 are each a root of a cubic,
//   (2b y1 - k1)(y1^2 - (d^2 - x1^2)) + (E1 - y y1)^2 = 0   (and likewise for x2).
// Two roots of each cubic can lie on the pole's circle, upright and flipped: four root pairs.
#pragma once

#include <array>

#include "core/base/types.h"
#include "core/geometry/grip_geometry.h"
#include "core/kinematics/steps/crossed_step.h"

namespace spidar {

// Number of root pairs. Bit 0 of an index flips the root of pole 1, bit 1 that of pole 2.
inline constexpr int kRootPairCount = 4;

// True when the strings are tied as in the paper, which the closed form assumes.
[[nodiscard]] bool has_paper_attachments(const GripGeometry &grip) noexcept;

// Values that the four root pairs of one set of lengths share: of pole 1 in lane 0, of pole 2 in
// lane 1. Each comment gives the paper's letter for pole 1, and in brackets that for pole 2.
struct ClosedForm {
    Lanes along{};    // b (a): half size of the frame along the pole's rest direction
    Lanes position{}; // y (x)
    Lanes side{};     // x1 (y2)
    Lanes k{};        // k1 (k2)
    Lanes e{};        // E1 (E2)
    Lanes face{};     // +c (-c): z of the face that carries the pole's strings
    Lanes upright{};  // the cubic's upright root: y1 (x2)
    // The cubic's other root on the pole's circle.
    Lanes flipped{};
    double pole_half_length_m = 0.0;
};

[[nodiscard]] ClosedForm solve_closed_form(const Vec3 &half_extents_m, double pole_half_length_m,
                                           const StringArray &lengths_m) noexcept;

// Height of P0 that each root of each pole implies. Index 0: upright root, 1: flipped root.
struct RootHeights {
    std::array<Lanes, 2> from_face_m{}; // |z of P0 - face|
    std::array<Lanes, 2> slope_m{};     // |d(|r|^2)/dz|
    double faces_apart_m = 0.0;         // 2 c
};

[[nodiscard]] RootHeights root_heights(const ClosedForm &form) noexcept;

// First-order forecast of RootPairPose::misfit_m from the difference between the two poles'
// heights. Forecasts for all four pairs cost little more than one of them.
struct MisfitForecast {
    // Expected misfit (unit: m).
    double misfit_m = 0.0;
    // Misfit per error of the lengths, up to a constant factor; grows toward the z faces.
    double gain = 1.0;
};
[[nodiscard]] MisfitForecast forecast_misfit(const RootHeights &heights, double pole_half_length_m,
                                             int pair) noexcept;

struct RootPairPose {
    CrossedPose pose;
    // Distance (unit: m) by which the pole ends miss their spheres at the best common z. It is
    // about the residual of the final pose times a factor of the geometry.
    double misfit_m = 0.0;
};

// Returns the pose of root pair `pair`. It is exact for exact lengths, otherwise a start for
// Gauss-Newton: complex roots are replaced by the nearest real ones. Always finite for finite
// lengths, with the poles on their spheres.
[[nodiscard]] RootPairPose root_pair_pose(const ClosedForm &form, int pair) noexcept;

// Returns the pose of root_pair_pose() without its last refinement of z and without the misfit, for
// a pair that is tried in any case.
[[nodiscard]] CrossedPose root_pair_start(const ClosedForm &form, int pair) noexcept;

// True when both poles are on the upright side of the fold where the cubic's two roots meet.
[[nodiscard]] bool is_upright(const Vec3 &half_extents_m, const GripPose &pose) noexcept;

} // namespace spidar
