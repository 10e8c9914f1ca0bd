#include "bench/methods/paper_polynomials.h"

#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "core/kinematics/search/closed_form.h"

namespace spidar::bench {

namespace {

constexpr std::size_t kDegree = 6;
using Polynomial = std::array<double, kDegree + 1>; // constant term first

Polynomial product(const Polynomial &a, const Polynomial &b) {
    Polynomial result{};
    for (std::size_t i = 0; i <= kDegree; ++i) {
        for (std::size_t j = 0; i + j <= kDegree; ++j) {
            result[i + j] += a[i] * b[j];
        }
    }
    return result;
}

// (|r|^2 - d^2) h^2 of one pole as a polynomial in z, h = z - face, made monic.
Polynomial pole_polynomial(const ClosedForm &form, int pole) {
    const double scale = 0.5 / form.along[pole];
    const Polynomial h{-form.face[pole], 1.0};
    const Polynomial h2 = product(h, h);
    Polynomial root{form.k[pole] * scale};
    Polynomial left{form.e[pole]}; // E - y root, which is h times the vertical component
    for (std::size_t i = 0; i <= kDegree; ++i) {
        root[i] += scale * h2[i];
        left[i] -= form.position[pole] * root[i];
    }
    Polynomial sum = product(root, root);
    sum[0] += form.side[pole] * form.side[pole] - form.pole_half_length_m * form.pole_half_length_m;
    sum = product(sum, h2);
    const Polynomial square = product(left, left);
    const double leading = sum[kDegree] + square[kDegree];
    for (std::size_t i = 0; i <= kDegree; ++i) {
        sum[i] = (sum[i] + square[i]) / leading;
    }
    return sum;
}

// Common root of two monic polynomials of degree six, by remainders.
double common_root(Polynomial a, Polynomial b) {
    std::size_t degree = kDegree;
    for (std::size_t i = 0; i < degree; ++i) {
        a[i] -= b[i]; // both monic: one degree less
    }
    a[degree] = 0.0;
    std::swap(a, b);
    // a has degree `degree`, b one less; each round takes both down by one.
    while (degree > 2) {
        const double lead = b[degree - 1];
        for (std::size_t i = 0; i < degree; ++i) {
            b[i] /= lead;
        }
        for (std::size_t shift = 2; shift-- > 0;) {
            const double factor = a[degree - 1 + shift];
            for (std::size_t i = 0; i < degree; ++i) {
                a[i + shift] -= factor * b[i];
            }
        }
        std::swap(a, b);
        --degree;
    }
    return -b[0] / b[1];
}

// The pose that a height implies.
GripPose pose_at(const ClosedForm &form, double z) {
    const Lanes h = both(z) - form.face;
    const Lanes root = (form.k + h * h) / (both(2.0) * form.along);
    const Lanes vertical = (form.e - form.position * root) / h;
    return {Vec3(form.position[1], form.position[0], z), Vec3(form.side[0], root[0], vertical[0]),
            Vec3(root[1], form.side[1], vertical[1])};
}

double misfit_of_pole_2(const ClosedForm &form, double z) {
    const GripPose pose = pose_at(form, z);
    const double d = form.pole_half_length_m;
    const Vec3 &r = pose.r2_m;
    return std::fabs(r.x * r.x + r.y * r.y + r.z * r.z - d * d);
}

} // namespace

GripPose paper_division(const Vec3 &half_extents_m, double pole_half_length_m,
                        const StringArray &lengths_m) {
    const ClosedForm form = solve_closed_form(half_extents_m, pole_half_length_m, lengths_m);
    return pose_at(form, common_root(pole_polynomial(form, 0), pole_polynomial(form, 1)));
}

GripPose paper_cubic(const Vec3 &half_extents_m, double pole_half_length_m,
                     const StringArray &lengths_m) {
    const ClosedForm form = solve_closed_form(half_extents_m, pole_half_length_m, lengths_m);
    const double b = form.along[0];
    const double k = form.k[0];
    const double y = form.position[0];
    const double side2 = form.side[0] * form.side[0];
    const double g = form.e[0] - y * k / (2.0 * b);
    const double d2 = pole_half_length_m * pole_half_length_m;
    // u^3 + c2 u^2 + c1 u + c0 = 0, u = (z - c)^2, by Cardano.
    const double c2 = 2.0 * k + y * y;
    const double c1 = 4.0 * b * b * (side2 - d2) + k * k - 4.0 * b * y * g;
    const double c0 = 4.0 * b * b * g * g;
    const double p = c1 - c2 * c2 / 3.0;
    const double q = 2.0 * c2 * c2 * c2 / 27.0 - c2 * c1 / 3.0 + c0;
    const std::complex<double> root =
        std::sqrt(std::complex<double>(0.25 * q * q + p * p * p / 27.0));
    const std::complex<double> one = std::pow(-0.5 * q + root, 1.0 / 3.0);
    const std::complex<double> turn(-0.5, 0.86602540378443865);
    double best = std::numeric_limits<double>::infinity();
    double z = std::numeric_limits<double>::quiet_NaN();
    std::complex<double> w = one;
    for (int i = 0; i < 3; ++i, w *= turn) {
        const double u = (w - p / (3.0 * w)).real() - c2 / 3.0;
        if (!(u >= 0.0)) {
            continue;
        }
        const double height = form.face[0] - std::sqrt(u);
        const double miss = misfit_of_pole_2(form, height);
        if (miss < best) {
            best = miss;
            z = height;
        }
    }
    return pose_at(form, z);
}

} // namespace spidar::bench
