// Closed-form kinematics of the paper's grip in a box frame, eq. (4)-(15) with the paper's misprints put
// right (docs/why/paper_notes.md). x, y, x1, y2 follow directly; y1 and x2 are each a root of a cubic,
//   (2b y1 - k1)(y1^2 - (d^2 - x1^2)) + (E1 - y y1)^2 = 0   (and likewise for x2),
// two of whose roots can lie on the pole's circle: pole upright or flipped. Four pairs in all.
#pragma once

#include <array>

#include "core/base/types.h"
#include "core/geometry/grip_geometry.h"
#include "core/kinematics/steps/crossed_step.h"

namespace spidar {

// Pair p: bit 0 set takes the flipped root of pole 1, bit 1 that of pole 2. Pair 0 is the upright one.
inline constexpr int kRootPairCount = 4;

// True when the strings are tied to this grip as in Kim, Koike and Sato's paper, which the closed form assumes.
[[nodiscard]] bool has_paper_attachments(const GripGeometry &grip) noexcept;

// What the four root pairs of one set of string lengths have in common, computed once. Both poles are computed side by side; in the
// paper's letters for pole 1 (for pole 2 x and y, a and b change places and z - c becomes z + c):
struct ClosedForm {
    Lanes along{};    // b (a): half size of the frame along the pole's rest direction
    Lanes position{}; // y (x)
    Lanes side{};     // x1 (y2), known directly
    Lanes k{};        // k1 (k2)
    Lanes e{};        // E1 (E2)
    Lanes face{};     // +c (-c): z of the face on which the pole's strings hang
    Lanes upright{};  // the cubic's roots: y1 (x2)
    Lanes flipped{};
    double pole_half_length_m = 0.0;
};

[[nodiscard]] ClosedForm solve_closed_form(const Vec3 &half_extents_m, double pole_half_length_m,
                                           const StringArray &lengths_m) noexcept;

// Where each root of each pole puts P0, and how sharply: [0] upright, [1] flipped.
struct RootHeights {
    std::array<Lanes, 2> from_face_m{}; // |z of P0 - face|
    std::array<Lanes, 2> slope_m{};     // |d(|r|^2)/dz|
    double faces_apart_m = 0.0;         // 2 c
};

[[nodiscard]] RootHeights root_heights(const ClosedForm &form) noexcept;

// What RootPairPose::misfit_m will be, to first order in how far the poles disagree about z: all pairs for little more
// than the price of one. And how much of an error of the lengths a misfit may be, up to a constant factor: it grows
// towards the z faces.
struct MisfitForecast {
    double misfit_m = 0.0;
    double gain = 1.0;
};
[[nodiscard]] MisfitForecast forecast_misfit(const RootHeights &heights, double pole_half_length_m,
                                             int pair) noexcept;

struct RootPairPose {
    CrossedPose pose;
    // How far from a true solution the pair is: the length by which the poles miss their spheres at the
    // z that suits both best. About the residual it would end with, up to a factor of the geometry.
    double misfit_m = 0.0;
};

// The pose of root pair `pair`. Exact for exact lengths; with errors, a start for Gauss-Newton (roots that turned
// complex are replaced by the nearest real ones). Always finite for finite lengths, poles on their spheres.
[[nodiscard]] RootPairPose root_pair_pose(const ClosedForm &form, int pair) noexcept;

// Its pose alone, for a pair that is tried whatever its misfit: z without the last refinement.
[[nodiscard]] CrossedPose root_pair_start(const ClosedForm &form, int pair) noexcept;

// True when both poles are on the upright side of their folds, where the two roots of the cubic meet.
[[nodiscard]] bool is_upright(const Vec3 &half_extents_m, const GripPose &pose) noexcept;

} // namespace spidar
