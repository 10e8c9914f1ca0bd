// Gauss-Newton on R3 x S2 x S2 for the grip as the paper strings it, two strings to each pole end: the work of
// gauss_newton.h with both poles computed side by side. Slot 2e+k holds the k-th string of pole end e (0: +, 1: -).
//
// A string at end s of a pole, with direction e, has the slopes (e, s e) in (P0, r). So all that the normal
// equations need are the outer products e e' summed over the strings of an end: their sum over both ends serves
// P0 and r alone, their difference couples the two. Unknowns and the meaning of the pivots are those of gauss_newton.h.
#pragma once

#include <array>
#include <cmath>
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
    std::array<Lanes, kSlotCount> residual_m{};
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

namespace crossed_detail {

// Sum of e e' over strings: xx xy xz yy yz zz, a pole a lane.
using LaneMatrix = std::array<Lanes, 6>;

[[gnu::always_inline]] inline LaneMatrix outer_sum(const LaneVec &a, const LaneVec &b) noexcept {
    return {a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.x * a.z + b.x * b.z,
            a.y * a.y + b.y * b.y, a.y * a.z + b.y * b.z, a.z * a.z + b.z * b.z};
}

[[gnu::always_inline]] inline LaneVec product(const LaneMatrix &m, const LaneVec &v) noexcept {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
            m[2] * v.x + m[4] * v.y + m[5] * v.z};
}

// Residuals times directions, summed over each end: their sum and their difference over the two ends.
struct Gradients {
    LaneVec sum;
    LaneVec difference;
};

[[gnu::always_inline]] inline Gradients gradients(const CrossedErrors &errors) noexcept {
    const LaneVec plus =
        errors.residual_m[0] * errors.direction[0] + errors.residual_m[1] * errors.direction[1];
    const LaneVec minus =
        errors.residual_m[2] * errors.direction[2] + errors.residual_m[3] * errors.direction[3];
    return {plus + minus, plus - minus};
}

// Two unit tangents of each pole without a square root (Duff et al. 2017, "Building an orthonormal basis, revisited").
[[gnu::always_inline]] inline void tangents(const LaneVec &poles_m, double d, LaneVec &u,
                                            LaneVec &v) noexcept {
    const LaneVec n = both(1.0 / d) * poles_m;
    const Lanes sign{std::copysign(1.0, n.z[0]), std::copysign(1.0, n.z[1])};
    const Lanes a = both(-1.0) / (sign + n.z);
    const Lanes b = n.x * n.y * a;
    u = {both(1.0) + sign * n.x * n.x * a, sign * b, -sign * n.x};
    v = {b, sign + n.y * n.y * a, -n.y};
}

[[gnu::always_inline]] inline double smaller(double a, double b) noexcept {
    return b < a ? b : a; // a when b is NaN: the pivots themselves decide then
}

[[gnu::always_inline]] inline CrossedStep step_of(const CrossedFactor &f,
                                                  const Gradients &g) noexcept {
    const Lanes gradient_u = dot(f.u, g.difference);
    const Lanes full_v = dot(f.v, g.difference);
    const Lanes gradient_v = full_v - f.ratio * gradient_u;
    const Lanes wu = gradient_u * f.inverse_u;
    const Lanes wv = gradient_v * f.inverse_v;
    const LaneVec rest = g.sum - wu * f.couple_u - wv * f.couple_v;
    const double y0 = sum_of(rest.x);
    const double y1 = sum_of(rest.y) - f.l10 * y0;
    const double y2 = sum_of(rest.z) - f.l20 * y0 - f.l21 * y1;
    const double z = y2 * f.inverse_2;
    const double y = y1 * f.inverse_1 - f.l21 * z;
    const double x = y0 * f.inverse_0 - f.l10 * y - f.l20 * z;

    CrossedStep step;
    step.position_m = {both(x), both(y), both(z)};
    const Lanes v = wv - f.inverse_v * dot(f.couple_v, step.position_m);
    const Lanes u = wu - f.inverse_u * dot(f.couple_u, step.position_m) - f.ratio * v;
    step.poles_m = u * f.u + v * f.v;
    step.size_m2 = x * x + y * y + z * z + sum_of(u * u + v * v);
    step.decrease_m2 = x * sum_of(g.sum.x) + y * sum_of(g.sum.y) + z * sum_of(g.sum.z) +
                       sum_of(u * gradient_u + v * full_v);
    return step;
}

} // namespace crossed_detail

[[nodiscard, gnu::always_inline]] inline CrossedErrors errors_at(const CrossedLayout &layout,
                                                                 const StringArray &lengths_m,
                                                                 const CrossedPose &pose) noexcept {
    CrossedErrors errors;
    const std::array<LaneVec, 2> ends{pose.position_m + pose.poles_m,
                                      pose.position_m - pose.poles_m};
    Lanes squares{};
    for (std::size_t slot = 0; slot < kSlotCount; ++slot) {
        const LaneVec string = ends[slot / 2] - layout.motors_m[slot];
        const Lanes length = square_root(dot(string, string));
        const Lanes measured{lengths_m[layout.strings[slot][0]],
                             lengths_m[layout.strings[slot][1]]};
        errors.direction[slot] = (both(1.0) / length) * string;
        errors.residual_m[slot] = measured - length;
        squares += errors.residual_m[slot] * errors.residual_m[slot];
    }
    errors.sum_of_squares_m2 = sum_of(squares);
    return errors;
}

[[nodiscard, gnu::always_inline]] inline CrossedFactor
factorise(const CrossedErrors &errors, const CrossedPose &pose,
          double pole_half_length_m) noexcept {
    CrossedFactor f;
    const crossed_detail::LaneMatrix plus =
        crossed_detail::outer_sum(errors.direction[0], errors.direction[1]);
    const crossed_detail::LaneMatrix minus =
        crossed_detail::outer_sum(errors.direction[2], errors.direction[3]);
    crossed_detail::LaneMatrix sum;
    crossed_detail::LaneMatrix difference;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] = plus[i] + minus[i];
        difference[i] = plus[i] - minus[i];
    }
    crossed_detail::tangents(pose.poles_m, pole_half_length_m, f.u, f.v);
    const LaneVec sum_u = crossed_detail::product(sum, f.u);
    const Lanes uu = dot(f.u, sum_u);
    const Lanes uv = dot(f.v, sum_u);
    const Lanes vv = dot(f.v, crossed_detail::product(sum, f.v));
    f.inverse_u = both(1.0) / uu;
    f.ratio = uv * f.inverse_u;
    const Lanes pivot_v = vv - f.ratio * uv;
    f.inverse_v = both(1.0) / pivot_v;
    f.couple_u = crossed_detail::product(difference, f.u);
    f.couple_v = crossed_detail::product(difference, f.v) - f.ratio * f.couple_u;

    const LaneVec a = f.inverse_u * f.couple_u;
    const LaneVec b = f.inverse_v * f.couple_v;
    const double xx = sum_of(sum[0]);
    const double yy = sum_of(sum[3]);
    const double zz = sum_of(sum[5]);
    const double s0 = sum_of(sum[0] - a.x * f.couple_u.x - b.x * f.couple_v.x);
    const double s1 = sum_of(sum[1] - a.x * f.couple_u.y - b.x * f.couple_v.y);
    const double s2 = sum_of(sum[2] - a.x * f.couple_u.z - b.x * f.couple_v.z);
    const double s3 = sum_of(sum[3] - a.y * f.couple_u.y - b.y * f.couple_v.y);
    const double s4 = sum_of(sum[4] - a.y * f.couple_u.z - b.y * f.couple_v.z);
    const double s5 = sum_of(sum[5] - a.z * f.couple_u.z - b.z * f.couple_v.z);
    f.inverse_0 = 1.0 / s0;
    f.l10 = s1 * f.inverse_0;
    f.l20 = s2 * f.inverse_0;
    const double d1 = s3 - f.l10 * s1;
    const double t21 = s4 - f.l10 * s2;
    f.inverse_1 = 1.0 / d1;
    f.l21 = t21 * f.inverse_1;
    const double d2 = s5 - f.l20 * s2 - f.l21 * t21;
    f.inverse_2 = 1.0 / d2;

    // Of the poles the determinant over the squared mean of the diagonal: the same in every basis.
    const Lanes mean = both(0.5) * (uu + vv);
    const Lanes pole = uu * pivot_v / (mean * mean);
    f.min_pivot = crossed_detail::smaller(
        crossed_detail::smaller(crossed_detail::smaller(pole[0], pole[1]), s0 / xx),
        crossed_detail::smaller(d1 / yy, d2 / zz));
    f.solvable = uu[0] > 0.0 && uu[1] > 0.0 && pivot_v[0] > 0.0 && pivot_v[1] > 0.0 && s0 > 0.0 &&
                 d1 > 0.0 && d2 > 0.0;
    return f;
}

// The step that `errors` ask for, by the factorisation made there.
[[nodiscard, gnu::always_inline]] inline CrossedStep solve(const CrossedFactor &factor,
                                                           const CrossedErrors &errors) noexcept {
    return crossed_detail::step_of(factor, crossed_detail::gradients(errors));
}

// The same by a factorisation made close by; `pose` is where the errors are. Ends at the same pose.
[[nodiscard, gnu::always_inline]] inline CrossedStep
solve_nearby(const CrossedFactor &factor, const CrossedErrors &errors,
             const CrossedPose &pose) noexcept {
    crossed_detail::Gradients g = crossed_detail::gradients(errors);
    // The factor's tangents are not quite those of this pose: what pulls along a pole must not turn it.
    const Lanes along = dot(pose.poles_m, g.difference) / dot(pose.poles_m, pose.poles_m);
    g.difference = g.difference - along * pose.poles_m;
    return crossed_detail::step_of(factor, g);
}

// Moved, and the poles back on their spheres to rounding.
[[nodiscard, gnu::always_inline]] inline CrossedPose
moved(const CrossedPose &pose, const CrossedStep &step, double pole_half_length_m) noexcept {
    const LaneVec poles = pose.poles_m + step.poles_m;
    return {pose.position_m + step.position_m,
            (both(pole_half_length_m) / square_root(dot(poles, poles))) * poles};
}

} // namespace spidar
