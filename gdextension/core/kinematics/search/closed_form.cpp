#include "core/kinematics/search/closed_form.h"

#include <cmath>

namespace spidar {

namespace {

// Keeps divisions defined at the z faces, where the closed form has 0/0: a thousandth of a
// nanometer.
constexpr double kSmallestDistance_m = 1e-12;
// Largest excess of a z step over the poles' disagreement that still counts as a refinement (unit:
// m).
constexpr double kFuseSlack_m = 1e-6;
// cos(t/2) = s for cos(3t/2) = w and t in [0, pi/3] solves 4 s^3 - 3 s = w. A cubic Hermite through
// both ends of s(w) errs by less than 2e-4; each Newton step squares that.
// sqrt(3)/2, where s' = 1/6. At w = 1: s = 1, s' = 1/9.
constexpr double kStart0 = 0.86602540378443865;
constexpr double kStart1 = 1.0 / 6.0;
constexpr double kStart3 = 2.0 * kStart0 + kStart1 + 1.0 / 9.0 - 2.0;
constexpr double kStart2 = 1.0 - kStart0 - kStart1 - kStart3;
constexpr int kRootSteps = 2;
constexpr double kHalfSqrt3 = 0.86602540378443865;

// Returns a, or `low` where a is smaller or NaN.
Lanes at_least(Lanes a, double low) noexcept {
    const Lanes bound = both(low);
    return a >= bound ? a : bound;
}

Lanes at_most(Lanes a, Lanes high) noexcept {
    return a <= high ? a : high;
}

Lanes away_from_zero(Lanes h) noexcept {
    const Lanes small = both(kSmallestDistance_m);
    const Lanes least = h < both(0.0) ? -small : small;
    const Lanes size = h < both(0.0) ? -h : h;
    return size < small ? least : h;
}

// The two roots of the cubic that can lie on the pole's circle, upright and flipped.
void solve_cubics(ClosedForm &form, Lanes circle2) noexcept {
    // Monic: t^3 + q2 t^2 + q1 t + q0, by the angle of its three real roots.
    const Lanes scale = both(0.5) / form.along;
    const Lanes q2 = (form.position * form.position - form.k) * scale;
    const Lanes q1 = -circle2 - both(2.0) * form.e * form.position * scale;
    const Lanes q0 = (form.k * circle2 + form.e * form.e) * scale;
    const Lanes shift = q2 * both(1.0 / 3.0);
    const Lanes m2 = at_least(shift * shift - q1 * both(1.0 / 3.0), 0.0);
    const Lanes m = square_root(m2);
    const Lanes half = both(0.5) * (shift * q1 - q0) - shift * shift * shift;
    const Lanes cosine = at_most(at_least(half / (m2 * m), -1.0), both(1.0)); // cos(3 t)
    const Lanes w = square_root(both(0.5) * (both(1.0) + cosine));            // cos(3 t / 2)
    Lanes s = both(kStart0) + w * (both(kStart1) + w * (both(kStart2) + w * both(kStart3)));
#pragma GCC unroll 2
    for (int i = 0; i < kRootSteps; ++i) {
        const Lanes s2 = s * s;
        s = (both(8.0) * s2 * s + w) / (both(12.0) * s2 - both(3.0));
    }
    const Lanes cos_t = both(2.0) * s * s - both(1.0);
    const Lanes sin_t = both(2.0) * s * square_root(at_least(both(1.0) - s * s, 0.0));
    const Lanes limit = square_root(circle2);
    const auto on_circle = [&limit](Lanes root) {
        const Lanes low = root >= -limit ? root : -limit;
        return at_most(low, limit);
    };
    form.upright = on_circle(both(2.0) * m * cos_t - shift);
    form.flipped = on_circle(m * (both(2.0 * kHalfSqrt3) * sin_t - cos_t) - shift);
}

// |r|^2 - d^2 of each pole for one z per pole, and its derivative.
struct Misfit {
    Lanes value{};
    Lanes slope{};
};

Misfit misfit(const ClosedForm &form, Lanes z) noexcept {
    const Lanes h = away_from_zero(z - form.face);
    const Lanes per_along = both(1.0) / form.along;
    const Lanes per_h = both(1.0) / h;
    const Lanes root = both(0.5) * (form.k + h * h) * per_along;
    const Lanes root_slope = h * per_along;
    const Lanes vertical = (form.e - form.position * root) * per_h;
    const Lanes vertical_slope = -(form.position * root_slope + vertical) * per_h;
    const double d2 = form.pole_half_length_m * form.pole_half_length_m;
    return {root * root + vertical * vertical + form.side * form.side - both(d2),
            both(2.0) * (root * root_slope + vertical * vertical_slope)};
}

// Returns z of P0 as each pole implies it, with the signs that agree best.
Lanes heights(const ClosedForm &form, Lanes roots) noexcept {
    const Lanes h = square_root(at_least(both(2.0) * form.along * roots - form.k, 0.0));
    // Inside the frame z lies below face 1 and above face 2. Other signs lie outside and occur only
    // for such lengths.
    Lanes z = form.face + Lanes{-1.0, 1.0} * h;
    double best = std::fabs(z[0] - z[1]);
#pragma GCC unroll 2
    for (const double sign : {1.0, -1.0}) {
        const Lanes other = form.face + both(sign) * h;
        if (std::fabs(other[0] - other[1]) < best) {
            best = std::fabs(other[0] - other[1]);
            z = other;
        }
    }
    return z;
}

Lanes roots_of(const ClosedForm &form, int pair) noexcept {
    return Lanes{(pair & 1) != 0 ? form.flipped[0] : form.upright[0],
                 (pair & 2) != 0 ? form.flipped[1] : form.upright[1]};
}

// Returns the mean of both z, weighted by each pole's sensitivity to z.
double fused_height(const ClosedForm &form, Lanes z_each) noexcept {
    const Misfit each = misfit(form, z_each);
    const Lanes weight = each.slope * each.slope;
    const double weights = sum_of(weight);
    const bool weighted = weights > 0.0 && std::isfinite(weights);
    return weighted ? sum_of(weight * z_each) / weights : 0.5 * sum_of(z_each);
}

CrossedPose pose_at_height(const ClosedForm &form, Lanes roots, double z) noexcept {
    const double d = form.pole_half_length_m;
    z = std::isfinite(z) ? z : 0.0;

    // Third components follow from z: sign and size by the equation, or what the circle leaves.
    const Lanes h = away_from_zero(both(z) - form.face);
    const Lanes size2 = both(d * d) - form.side * form.side - roots * roots;
    const Lanes room = both(2.0) * square_root(at_least(size2, 0.0));
    const Lanes wanted = (form.e - form.position * roots) / h;
    const Lanes vertical = at_most(wanted >= -room ? wanted : -room, room);

    const Lanes length2 = form.side * form.side + roots * roots + vertical * vertical;
    const Lanes scale = both(d) / square_root(length2);
    CrossedPose pose;
    pose.position_m = {both(form.position[1]), both(form.position[0]), both(z)};
    pose.poles_m = {scale * Lanes{form.side[0], roots[1]}, scale * Lanes{roots[0], form.side[1]},
                    scale * vertical};
#pragma GCC unroll 2
    for (int pole = 0; pole < 2; ++pole) {
        // A pole of almost no or far too much length is replaced by its rest direction.
        if (!(length2[pole] > 0.0) || !std::isfinite(length2[pole])) {
            pose.poles_m.x[pole] = pole == 0 ? 0.0 : d;
            pose.poles_m.y[pole] = pole == 0 ? d : 0.0;
            pose.poles_m.z[pole] = 0.0;
        }
    }
    return pose;
}

} // namespace

bool has_paper_attachments(const GripGeometry &grip) noexcept {
    const GripGeometry paper;
    if (grip.kind != GripKind::crossed) {
        return false;
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (grip.attachments[i].pole != paper.attachments[i].pole ||
            grip.attachments[i].sign != paper.attachments[i].sign) {
            return false;
        }
    }
    return true;
}

ClosedForm solve_closed_form(const Vec3 &half_extents_m, double pole_half_length_m,
                             const StringArray &lengths_m) noexcept {
    const double a = half_extents_m.x;
    const double b = half_extents_m.y;
    const double d = pole_half_length_m;
    // Differences of squares as products: squaring first would cost digits.
    const auto difference = [&lengths_m](std::size_t i, std::size_t j) {
        return (lengths_m[i] - lengths_m[j]) * (lengths_m[i] + lengths_m[j]);
    };
    const auto quarter_sum = [&lengths_m](std::size_t first) {
        double sum = 0.0;
        for (std::size_t i = first; i < first + 4; ++i) {
            sum += 0.25 * lengths_m[i] * lengths_m[i];
        }
        return sum;
    };
    const Lanes eighth = both(0.125) / Lanes{a, b};
    // Lane 0: along x, from pole 1's strings. Lane 1: along y, from pole 2's strings.
    const Lanes first{difference(0, 1), difference(4, 6)};
    const Lanes second{difference(2, 3), difference(5, 7)};
    const Lanes sum = -(first + second) * eighth;
    const double x = sum[0];
    const double y = sum[1];

    ClosedForm form;
    form.pole_half_length_m = d;
    form.along = Lanes{b, a};
    form.position = Lanes{y, x};
    form.side = (second - first) * eighth;
    form.face = Lanes{half_extents_m.z, -half_extents_m.z};
    form.k = both(x * x + y * y + d * d + a * a + b * b) - Lanes{quarter_sum(0), quarter_sum(4)};
    const Lanes across{difference(0, 2) + difference(1, 3), difference(4, 5) + difference(6, 7)};
    form.e = both(0.125) * across - Lanes{x, y} * form.side + Lanes{b * y, a * x};
    solve_cubics(form, at_least(both(d * d) - form.side * form.side, 0.0));
    return form;
}

RootHeights root_heights(const ClosedForm &form) noexcept {
    RootHeights heights;
    heights.faces_apart_m = form.face[0] - form.face[1];
    const Lanes per_along = both(1.0) / form.along;
    for (std::size_t flipped = 0; flipped < 2; ++flipped) {
        const Lanes root = flipped == 0 ? form.upright : form.flipped;
        const Lanes square = both(2.0) * form.along * root - form.k;
        const Lanes h = at_least(square_root(at_least(square, 0.0)), kSmallestDistance_m);
        const Lanes per_h = both(1.0) / h;
        const Lanes vertical = (form.e - form.position * root) * per_h;
        const Lanes slope = both(2.0) * ((root - vertical * form.position) * h * per_along -
                                         vertical * vertical * per_h);
        heights.from_face_m[flipped] = h;
        heights.slope_m[flipped] = slope < both(0.0) ? -slope : slope;
    }
    return heights;
}

MisfitForecast forecast_misfit(const RootHeights &heights, double pole_half_length_m,
                               int pair) noexcept {
    const std::size_t one = (pair & 1) != 0 ? 1 : 0;
    const std::size_t two = (pair & 2) != 0 ? 1 : 0;
    const double h0 = heights.from_face_m[one][0];
    const double h1 = heights.from_face_m[two][1];
    const double s0 = heights.slope_m[one][0];
    const double s1 = heights.slope_m[two][1];
    // P0 lies between the faces, or beyond either.
    const double between = std::fabs(heights.faces_apart_m - h0 - h1);
    const double beyond = heights.faces_apart_m - std::fabs(h0 - h1);
    const double apart = between < std::fabs(beyond) ? between : std::fabs(beyond);
    const double both_slopes2 = s0 * s0 + s1 * s1;
    MisfitForecast forecast;
    forecast.misfit_m = both_slopes2 > 0.0
                            ? apart * s0 * s1 / (2.0 * pole_half_length_m * std::sqrt(both_slopes2))
                            : 0.0;
    forecast.gain = 1.0 + 0.5 * heights.faces_apart_m / (h0 < h1 ? h0 : h1);
    return forecast;
}

CrossedPose root_pair_start(const ClosedForm &form, int pair) noexcept {
    const Lanes roots = roots_of(form, pair);
    return pose_at_height(form, roots, fused_height(form, heights(form, roots)));
}

RootPairPose root_pair_pose(const ClosedForm &form, int pair) noexcept {
    const Lanes roots = roots_of(form, pair);
    const Lanes z_each = heights(form, roots);
    const double apart = std::fabs(z_each[0] - z_each[1]);
    double z = fused_height(form, z_each);
    // One Newton step on the sum of squared misfits.
    const Misfit fused = misfit(form, both(z));
    double misfit2 = sum_of(fused.value * fused.value);
    const double gradient = sum_of(fused.value * fused.slope);
    const double step = gradient / sum_of(fused.slope * fused.slope);
    if (std::fabs(step) <= apart + kFuseSlack_m) {
        z -= step;
        misfit2 -= step * gradient;
    }
    RootPairPose result;
    result.misfit_m = std::sqrt(misfit2 > 0.0 ? misfit2 : 0.0) / (2.0 * form.pole_half_length_m);
    result.pose = pose_at_height(form, roots, z);
    return result;
}

bool is_upright(const Vec3 &half_extents_m, const GripPose &pose) noexcept {
    // A pole folds where the slope of its |r|^2 over z vanishes: y1 = b t^2 + t y with t = z1 / (z - c).
    const Vec3 &p = pose.position_m;
    const double t1 = pose.r1_m.z / (p.z - half_extents_m.z);
    const double t2 = pose.r2_m.z / (p.z + half_extents_m.z);
    return pose.r1_m.y > t1 * (half_extents_m.y * t1 + p.y) &&
           pose.r2_m.x > t2 * (half_extents_m.x * t2 + p.x);
}

} // namespace spidar
