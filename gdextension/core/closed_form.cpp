#include "core/closed_form.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

constexpr double kTwoThirdsPi = 2.0943951023931953;
// Newton steps on the sum of the two poles' misfits in z.
constexpr int kFuseSteps = 2;
// Keeps divisions defined at the z faces, where the closed form has 0/0; a thousandth of a nanometre.
constexpr double kSmallestDistance_m = 1e-12;

// What the lengths say about one pole, in the paper's letters for pole 1. For pole 2 x and y, a and b
// change places and z - c becomes z + c.
struct PoleEquations {
    double along = 0.0;    // b (a): half size of the frame along the pole's rest direction
    double position = 0.0; // y (x)
    double side = 0.0;     // x1 (y2), known directly
    double k = 0.0;        // k1 (k2)
    double e = 0.0;        // E1 (E2)
    double d2 = 0.0;       // d^2
    double face = 0.0;     // +c (-c): z of the face on which the pole's strings hang
};

// Root of the cubic: the pole's component along its rest direction, y1 (x2).
double pole_root(const PoleEquations &p, bool flipped) noexcept {
    const double circle2 = std::fmax(p.d2 - p.side * p.side, 0.0);
    // Monic: t^3 + q2 t^2 + q1 t + q0.
    const double scale = 1.0 / (2.0 * p.along);
    const double q2 = (p.position * p.position - p.k) * scale;
    const double q1 = -circle2 - 2.0 * p.e * p.position * scale;
    const double q0 = (p.k * circle2 + p.e * p.e) * scale;
    const double shift = q2 / 3.0;
    const double m2 = std::fmax(shift * shift - q1 / 3.0, 0.0);
    const double m = std::sqrt(m2);
    const double half = 0.5 * (shift * q1 - q0) - shift * shift * shift;
    const double cosine = m > 0.0 ? std::clamp(half / (m2 * m), -1.0, 1.0) : 1.0;
    const double angle = std::acos(cosine) / 3.0;
    const double root = 2.0 * m * std::cos(flipped ? angle - kTwoThirdsPi : angle) - shift;
    const double limit = std::sqrt(circle2);
    return std::clamp(root, -limit, limit);
}

// Distance of P0 from the pole's face, |z - face|, for a root.
double face_distance(const PoleEquations &p, double root) noexcept {
    return std::sqrt(std::fmax(2.0 * p.along * root - p.k, 0.0));
}

// |r|^2 - d^2 of the pole that z implies, and its derivative.
struct Misfit {
    double value = 0.0;
    double slope = 0.0;
};

double away_from_zero(double h) noexcept {
    return std::fabs(h) < kSmallestDistance_m ? std::copysign(kSmallestDistance_m, h) : h;
}

Misfit misfit(const PoleEquations &p, double z) noexcept {
    const double h = away_from_zero(z - p.face);
    const double root = (p.k + h * h) / (2.0 * p.along);
    const double root_slope = h / p.along;
    const double vertical = (p.e - p.position * root) / h;
    const double vertical_slope = -(p.position * root_slope + vertical) / h;
    return {root * root + vertical * vertical + p.side * p.side - p.d2,
            2.0 * (root * root_slope + vertical * vertical_slope)};
}

// z from both poles: the signs that agree best, weighted by how well each pole sees z, then refined.
double fuse_z(const PoleEquations &one, double root_one, const PoleEquations &two,
              double root_two) noexcept {
    const double h1 = face_distance(one, root_one);
    const double h2 = face_distance(two, root_two);
    // Inside the frame z lies below face 1 and above face 2; other signs are outside, met only when the
    // lengths say so.
    double z1 = one.face - h1;
    double z2 = two.face + h2;
    double best = std::fabs(z1 - z2);
    for (const double sign : {1.0, -1.0}) {
        const double other_one = one.face + sign * h1;
        const double other_two = two.face + sign * h2;
        if (std::fabs(other_one - other_two) < best) {
            best = std::fabs(other_one - other_two);
            z1 = other_one;
            z2 = other_two;
        }
    }
    const Misfit at1 = misfit(one, z1);
    const Misfit at2 = misfit(two, z2);
    const double w1 = at1.slope * at1.slope;
    const double w2 = at2.slope * at2.slope;
    double z =
        w1 + w2 > 0.0 && std::isfinite(w1 + w2) ? (w1 * z1 + w2 * z2) / (w1 + w2) : 0.5 * (z1 + z2);
    for (int i = 0; i < kFuseSteps; ++i) {
        const Misfit f1 = misfit(one, z);
        const Misfit f2 = misfit(two, z);
        const double slope2 = f1.slope * f1.slope + f2.slope * f2.slope;
        const double step = (f1.value * f1.slope + f2.value * f2.slope) / slope2;
        // A step longer than the poles' own disagreement is no refinement.
        if (!(std::fabs(step) <= best + 1e-6)) {
            break;
        }
        z -= step;
    }
    return z;
}

// Third component of the pole from z; sign and size from the equation, or what the circle leaves.
double vertical_component(const PoleEquations &p, double z, double root) noexcept {
    const double h = away_from_zero(z - p.face);
    const double size = std::sqrt(std::fmax(p.d2 - p.side * p.side - root * root, 0.0));
    const double vertical = (p.e - p.position * root) / h;
    return std::isfinite(vertical) ? std::clamp(vertical, -2.0 * size, 2.0 * size) : 0.0;
}

Vec3 onto_sphere(const Vec3 &r, double d, const Vec3 &otherwise) noexcept {
    const double length = glm::length(r);
    return length > 0.0 && std::isfinite(length) ? r * (d / length) : otherwise;
}

} // namespace

bool has_paper_attachments(const GripGeometry &grip) noexcept {
    const GripGeometry paper;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (grip.attachments[i].pole != paper.attachments[i].pole ||
            grip.attachments[i].sign != paper.attachments[i].sign) {
            return false;
        }
    }
    return true;
}

GripPose closed_form_pose(const Vec3 &half_extents_m, double pole_half_length_m,
                          const StringArray &lengths_m, int pair) noexcept {
    const double a = half_extents_m.x;
    const double b = half_extents_m.y;
    const double c = half_extents_m.z;
    const double d = pole_half_length_m;
    // Differences of squares as products: the squares would cost digits.
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
    const double x = -(difference(0, 1) + difference(2, 3)) / (8.0 * a);
    const double x1 = -(difference(0, 1) - difference(2, 3)) / (8.0 * a);
    const double y = -(difference(4, 6) + difference(5, 7)) / (8.0 * b);
    const double y2 = -(difference(4, 6) - difference(5, 7)) / (8.0 * b);
    const double common = x * x + y * y + d * d + a * a + b * b;

    PoleEquations one;
    one.along = b;
    one.position = y;
    one.side = x1;
    one.k = common - quarter_sum(0);
    one.e = (difference(0, 2) + difference(1, 3)) / 8.0 - x * x1 + b * y;
    one.d2 = d * d;
    one.face = c;
    PoleEquations two;
    two.along = a;
    two.position = x;
    two.side = y2;
    two.k = common - quarter_sum(4);
    two.e = (difference(4, 5) + difference(6, 7)) / 8.0 + a * x - y * y2;
    two.d2 = d * d;
    two.face = -c;

    const double y1 = pole_root(one, (pair & 1) != 0);
    const double x2 = pole_root(two, (pair & 2) != 0);
    const double z = fuse_z(one, y1, two, x2);
    const Vec3 r1(x1, y1, vertical_component(one, z, y1));
    const Vec3 r2(x2, y2, vertical_component(two, z, x2));
    return {Vec3(x, y, z), onto_sphere(r1, d, Vec3(0.0, d, 0.0)),
            onto_sphere(r2, d, Vec3(d, 0.0, 0.0))};
}

} // namespace spidar
