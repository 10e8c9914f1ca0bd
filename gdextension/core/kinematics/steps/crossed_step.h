// Gauss-Newton on R3 x S2 x S2 for two strings at each pole end, with both poles computed side by
// side. Unknowns and pivots are those of gauss_newton.h. Slot 2e+k holds the k-th string of pole
// end e (0: +, 1: -).
//
// A string at end s (+1 or -1) of a pole, with direction e, has the slopes (e, s e) in (P0, r). The
// normal equations therefore need only the outer products e e' summed over the strings of an end.
// Their sum over both ends serves P0 and r; their difference couples the two.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/sound_state.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "core/geometry/pole_lanes.h"

namespace spidar {

inline constexpr std::size_t kSlotCount = 4;

// Error that a step of size s leaves behind: about this times s^2 (unit: 1/m), divided by the root
// of the pivot where that is small. The poles are the most curved part: 1 / d = 25 for the paper's
// grip.
inline constexpr double kLengthCurvature = 25.0;

// The string in each slot and the motor it comes from.
struct CrossedLayout {
    std::array<LaneVec, kSlotCount> motors_m;
    std::array<std::array<std::uint8_t, 2>, kSlotCount> strings{}; // [slot][pole]
    double pole_half_length_m = 0.0;
};

// Checks restored memory: see core/base/sound_state.h.
[[nodiscard]] constexpr bool is_sound(const CrossedLayout &layout) noexcept {
    bool sound = true;
    for (const auto &slot : layout.strings) {
        for (const std::uint8_t string : slot) {
            sound = sound && string < kStringCount;
        }
    }
    return sound;
}

// Returns false and leaves `layout` unchanged when the grip is rigid or some pole end does not
// carry exactly two strings.
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

// Errors of the eight lengths at a pose.
struct CrossedErrors {
    // Unit vectors along which the lengths grow.
    std::array<LaneVec, kSlotCount> direction;
    // Measured minus computed lengths.
    std::array<Lanes, kSlotCount> residual_m{};
    std::array<Lanes, kSlotCount> per_length{}; // 1 / computed length (unit: 1/m)
    double sum_of_squares_m2 = 0.0;
};

// Factorized normal equations of one pose: the poles' blocks and the remaining block of the
// position, both inverted by cofactors. Each takes one division, whose latency dominates the cost
// of a step.
struct CrossedFactor {
    LaneVec u; // first tangent of each pole
    // Second tangent of each pole.
    LaneVec v;
    // Coupling of the position to u, times the inverse of the pole's block.
    LaneVec carry_u;
    // Coupling of the position to v, times the inverse of the pole's block.
    LaneVec carry_v;
    Lanes inverse_uu{};
    Lanes inverse_uv{};
    Lanes inverse_vv{};
    std::array<double, 6> inverse_position{}; // xx xy xz yy yz zz
    double min_pivot = 0.0;                   // as in GaussNewtonStep
    bool solvable = false;
};

struct CrossedStep {
    LaneVec position_m;
    LaneVec poles_m;
    double size_m2 = 0.0;     // squared norm of the seven displacements
    double decrease_m2 = 0.0; // expected, of the sum of squares
};

namespace crossed_detail {

// Sum of e e' over strings, in the order xx xy xz yy yz zz; one pole per lane.
using LaneMatrix = std::array<Lanes, 6>;

[[gnu::always_inline]] inline LaneMatrix outer_sum(const LaneVec &a, const LaneVec &b) noexcept {
    return {a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.x * a.z + b.x * b.z,
            a.y * a.y + b.y * b.y, a.y * a.z + b.y * b.z, a.z * a.z + b.z * b.z};
}

// Returns wa a a' + wb b b'.
[[gnu::always_inline]] inline LaneMatrix outer_sum(const LaneVec &a, const LaneVec &b, Lanes wa,
                                                   Lanes wb) noexcept {
    const LaneVec p = wa * a;
    const LaneVec q = wb * b;
    return {p.x * a.x + q.x * b.x, p.x * a.y + q.x * b.y, p.x * a.z + q.x * b.z,
            p.y * a.y + q.y * b.y, p.y * a.z + q.y * b.z, p.z * a.z + q.z * b.z};
}

[[gnu::always_inline]] inline LaneVec product(const LaneMatrix &m, const LaneVec &v) noexcept {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
            m[2] * v.x + m[4] * v.y + m[5] * v.z};
}

// Residuals times directions, summed over the strings of each pole end: the sum over both ends of a
// pole (for P0), and the + end minus the - end (for r).
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

// Computes two unit tangents of each pole without a square root (Duff et al. 2017, "Building an
// orthonormal basis, revisited").
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
    return b < a ? b : a; // returns a when b is NaN; the pivots are checked separately
}

// Factorizes the normal equations whose outer sums at the two ends are `plus` and `minus`. `fall`
// is added to the poles' diagonals, `hold` to those of the position.
[[nodiscard, gnu::always_inline]] inline CrossedFactor
eliminate(const LaneMatrix &plus, const LaneMatrix &minus, Lanes fall, double hold,
          const CrossedPose &pose, double pole_half_length_m) noexcept {
    CrossedFactor f;
    LaneMatrix sum;
    LaneMatrix difference;
#pragma GCC unroll 6
    for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] = plus[i] + minus[i];
        difference[i] = plus[i] - minus[i];
    }
    tangents(pose.poles_m, pole_half_length_m, f.u, f.v);
    const LaneVec sum_u = product(sum, f.u);
    const Lanes uu = dot(f.u, sum_u) + fall;
    const Lanes uv = dot(f.v, sum_u);
    const Lanes vv = dot(f.v, product(sum, f.v)) + fall;
    const Lanes area = uu * vv - uv * uv;
    const Lanes per_area = both(1.0) / area;
    f.inverse_uu = per_area * vv;
    f.inverse_uv = -(per_area * uv);
    f.inverse_vv = per_area * uu;
    const LaneVec couple_u = product(difference, f.u);
    const LaneVec couple_v = product(difference, f.v);
    f.carry_u = f.inverse_uu * couple_u + f.inverse_uv * couple_v;
    f.carry_v = f.inverse_uv * couple_u + f.inverse_vv * couple_v;

    const LaneVec &a = f.carry_u;
    const LaneVec &b = f.carry_v;
    const double s0 = sum_of(sum[0] - a.x * couple_u.x - b.x * couple_v.x) + hold;
    const double s1 = sum_of(sum[1] - a.x * couple_u.y - b.x * couple_v.y);
    const double s2 = sum_of(sum[2] - a.x * couple_u.z - b.x * couple_v.z);
    const double s3 = sum_of(sum[3] - a.y * couple_u.y - b.y * couple_v.y) + hold;
    const double s4 = sum_of(sum[4] - a.y * couple_u.z - b.y * couple_v.z);
    const double s5 = sum_of(sum[5] - a.z * couple_u.z - b.z * couple_v.z) + hold;
    const double minor_yz = s3 * s5 - s4 * s4;
    const double minor_xy = s0 * s3 - s1 * s1;
    const double cofactor_xy = s2 * s4 - s1 * s5;
    const double cofactor_xz = s1 * s4 - s2 * s3;
    const double volume = s0 * minor_yz + s1 * cofactor_xy + s2 * cofactor_xz;
    const double per_volume = 1.0 / volume;
    f.inverse_position = {minor_yz * per_volume,
                          cofactor_xy * per_volume,
                          cofactor_xz * per_volume,
                          (s0 * s5 - s2 * s2) * per_volume,
                          (s1 * s2 - s0 * s4) * per_volume,
                          minor_xy * per_volume};

    // A pole's pivot: determinant over squared mean diagonal, the same in every basis.
    const Lanes mean = both(0.5) * (uu + vv);
    const Lanes pole = area / (mean * mean);
    const double pivot_x = s0 / sum_of(sum[0]);
    const double pivot_y = minor_xy / (s0 * sum_of(sum[3]));
    const double pivot_z = volume / (minor_xy * sum_of(sum[5]));
    f.min_pivot = smaller(smaller(smaller(pole[0], pole[1]), pivot_x), smaller(pivot_y, pivot_z));
    f.solvable = uu[0] > 0.0 && uu[1] > 0.0 && area[0] > 0.0 && area[1] > 0.0 && s0 > 0.0 &&
                 minor_xy > 0.0 && volume > 0.0;
    return f;
}

[[gnu::always_inline]] inline CrossedStep step_of(const CrossedFactor &f,
                                                  const Gradients &g) noexcept {
    const Lanes gradient_u = dot(f.u, g.difference);
    const Lanes gradient_v = dot(f.v, g.difference);
    const LaneVec rest = g.sum - gradient_u * f.carry_u - gradient_v * f.carry_v;
    const double rx = sum_of(rest.x);
    const double ry = sum_of(rest.y);
    const double rz = sum_of(rest.z);
    const std::array<double, 6> &p = f.inverse_position;
    const double x = p[0] * rx + p[1] * ry + p[2] * rz;
    const double y = p[1] * rx + p[3] * ry + p[4] * rz;
    const double z = p[2] * rx + p[4] * ry + p[5] * rz;

    CrossedStep step;
    step.position_m = {both(x), both(y), both(z)};
    // Pole displacements at a fixed position, less the share of the position's displacement.
    const Lanes u =
        f.inverse_uu * gradient_u + f.inverse_uv * gradient_v - dot(f.carry_u, step.position_m);
    const Lanes v =
        f.inverse_uv * gradient_u + f.inverse_vv * gradient_v - dot(f.carry_v, step.position_m);
    step.poles_m = u * f.u + v * f.v;
    step.size_m2 = x * x + y * y + z * z + sum_of(u * u + v * v);
    step.decrease_m2 = x * sum_of(g.sum.x) + y * sum_of(g.sum.y) + z * sum_of(g.sum.z) +
                       sum_of(u * gradient_u + v * gradient_v);
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
#pragma GCC unroll 4 // at -O2 the compiler keeps the loop, which costs a fifth of the time
    for (std::size_t slot = 0; slot < kSlotCount; ++slot) {
        const LaneVec string = ends[slot / 2] - layout.motors_m[slot];
        const Lanes length = square_root(dot(string, string));
        const Lanes measured{lengths_m[layout.strings[slot][0]],
                             lengths_m[layout.strings[slot][1]]};
        errors.per_length[slot] = both(1.0) / length;
        errors.direction[slot] = errors.per_length[slot] * string;
        errors.residual_m[slot] = measured - length;
        squares += errors.residual_m[slot] * errors.residual_m[slot];
    }
    errors.sum_of_squares_m2 = sum_of(squares);
    return errors;
}

// prior: weight of the expected pose, added to all diagonals, so that the pivots include it. 0:
// none.
[[nodiscard, gnu::always_inline]] inline CrossedFactor factorise(const CrossedErrors &errors,
                                                                 const CrossedPose &pose,
                                                                 double pole_half_length_m,
                                                                 double prior = 0.0) noexcept {
    return crossed_detail::eliminate(
        crossed_detail::outer_sum(errors.direction[0], errors.direction[1]),
        crossed_detail::outer_sum(errors.direction[2], errors.direction[3]), both(prior), prior,
        pose, pole_half_length_m);
}

// factorise() with the curvature of the lengths (Newton's matrix): the steps converge quadratically
// for lengths with errors too. If the residuals are small relative to the poles, the pivots are
// about those of the normal equations.
[[nodiscard, gnu::always_inline]] inline CrossedFactor
factorise_curved(const CrossedErrors &errors, const CrossedPose &pose,
                 double pole_half_length_m) noexcept {
    // The curvature of a length l with residual f adds -(f / l) (I - e e').
    const auto end = [&errors](std::size_t slot) {
        const Lanes w0 = errors.residual_m[slot] * errors.per_length[slot];
        const Lanes w1 = errors.residual_m[slot + 1] * errors.per_length[slot + 1];
        crossed_detail::LaneMatrix sum = crossed_detail::outer_sum(
            errors.direction[slot], errors.direction[slot + 1], both(1.0) + w0, both(1.0) + w1);
        for (const std::size_t diagonal : {0U, 3U, 5U}) {
            sum[diagonal] -= w0 + w1;
        }
        return sum;
    };
    // A displaced pole end returns to its sphere: r loses |displacement|^2 / (2 d^2) of its length.
    const Lanes fall = dot(crossed_detail::gradients(errors).difference, pose.poles_m) *
                       both(1.0 / (pole_half_length_m * pole_half_length_m));
    return crossed_detail::eliminate(end(0), end(2), fall, 0.0, pose, pole_half_length_m);
}

// Returns the step for `errors` with the factorization of the same pose.
[[nodiscard, gnu::always_inline]] inline CrossedStep solve(const CrossedFactor &factor,
                                                           const CrossedErrors &errors) noexcept {
    return crossed_detail::step_of(factor, crossed_detail::gradients(errors));
}

// Returns the step for `errors` at `pose` with the factorization of a nearby pose. Repeated steps
// converge to the same pose as with the own factorization of each pose. prior: as in factorise().
// expected: the pose that the prior pulls toward.
[[nodiscard, gnu::always_inline]] inline CrossedStep
solve_nearby(const CrossedFactor &factor, const CrossedErrors &errors, const CrossedPose &pose,
             double prior = 0.0, const CrossedPose &expected = CrossedPose()) noexcept {
    crossed_detail::Gradients g = crossed_detail::gradients(errors);
    if (prior > 0.0) { // the position counts once in each of the two lanes
        g.sum = g.sum + both(0.5 * prior) * (expected.position_m - pose.position_m);
        g.difference = g.difference + both(prior) * (expected.poles_m - pose.poles_m);
    }
    // The factor's tangents differ a little from this pose's: a pull along a pole must not turn it.
    const Lanes along = dot(pose.poles_m, g.difference) / dot(pose.poles_m, pose.poles_m);
    g.difference = g.difference - along * pose.poles_m;
    return crossed_detail::step_of(factor, g);
}

// Returns the pose after a step, with the poles scaled back to their spheres.
[[nodiscard, gnu::always_inline]] inline CrossedPose
moved(const CrossedPose &pose, const CrossedStep &step, double pole_half_length_m) noexcept {
    const LaneVec poles = pose.poles_m + step.poles_m;
    return {pose.position_m + step.position_m,
            (both(pole_half_length_m) / square_root(dot(poles, poles))) * poles};
}

} // namespace spidar
