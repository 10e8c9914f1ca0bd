// Tensions for forces alone (the first three DOF): three unknowns in place of eight tensions.
//
//   min ||R x - b||^2 + w |x - t|^2,  lower <= x <= upper,   R = W A (3 x 8), b = W q
//
// The solution is x = clamp(t + R'z), where z is the one root of b - R x(z) - w z = 0. That
// function is monotone and piecewise linear, so that Newton's method (Jacobian R_F R_F' + w I, F:
// strings not clamped) ends in a few steps, and with a good guess mostly in one. Sources include
// this file and compile it for their own target.
#pragma once

#include "core/tension/fast/fast_tension_limits.h"
#include "core/tension/fast/sweep_table.h"

namespace spidar {

// Newton steps after which the general solver takes over, since strings could swap endlessly.
inline constexpr int kTranslationSteps = 16;

namespace { // one copy per source, for its own target

// NOLINTNEXTLINE(misc-definitions-in-headers): `inline` would let the linker mix the targets
[[nodiscard]] bool is_translation_only(const TensionProblem &problem) noexcept {
    const PaperWeights &w = problem.weights;
    return w[3] == 0.0 && w[4] == 0.0 && w[5] == 0.0 && w[6] == 0.0;
}

template <class Four>
class TranslationTension {
public:
    explicit TranslationTension(const FastInput &input) noexcept
        : p_(input.problem), matrix_(input.matrix), wrench_(input.wrench) {}

    // As solve_fast(): returns false when `solution` is undefined.
    bool run(const ActiveSet *warm, TensionSolution &solution) noexcept {
        const BoundRows<Four> bounds(p_);
        const auto &[lower, upper, target] = bounds;
        const double w = p_.proximal_weight;
        if (!bounds.sound() || !(w > 0.0)) {
            return false;
        }
        const unsigned movable = bounds.movable();
        read_half(0);
        read_half(4);
        const double b0 = p_.weights[0] * wrench_[0];
        const double b1 = p_.weights[1] * wrench_[1];
        const double b2 = p_.weights[2] * wrench_[2];
        unsigned low = ~movable & 0xFFU;
        unsigned high = 0;
        if (warm != nullptr) {
            low |= strings_at(*warm, StringBound::at_lower);
            high = strings_at(*warm, StringBound::at_upper) & ~low;
        }
        const Row at_low = Row::strings(low);
        const Row at_high = Row::strings(high);
        // The first step trusts the guess: strings assumed free count as free wherever they start.
        Row x{Four::select(at_low.a, lower.a, Four::select(at_high.a, upper.a, target.a)),
              Four::select(at_low.b, lower.b, Four::select(at_high.b, upper.b, target.b))};
        unsigned free = movable & ~(low | high);
        double z0 = 0.0;
        double z1 = 0.0;
        double z2 = 0.0;
        bool same = false;
        bool settled = false; // x is t + R'z, clamped at the assumed bounds
        for (int step = 0; step < kTranslationSteps; ++step) {
            if (!same && !factor(free)) {
                return false;
            }
            const double r0 = b0 - dot(row_[0], x) - w * z0;
            const double r1 = b1 - dot(row_[1], x) - w * z1;
            const double r2 = b2 - dot(row_[2], x) - w * z2;
            // Computes the step times the determinant: only the update of x waits for the division.
            const double e0 = adjugate_[0] * r0 + adjugate_[1] * r1 + adjugate_[2] * r2;
            const double e1 = adjugate_[1] * r0 + adjugate_[3] * r1 + adjugate_[4] * r2;
            const double e2 = adjugate_[2] * r0 + adjugate_[4] * r1 + adjugate_[5] * r2;
            // No string of R_F would move further than this: |R_F'd|^2 <= trace(R_F R_F') |d|^2.
            if (settled && (e0 * e0 + e1 * e1 + e2 * e2) * trace_ <= least_ * least_) {
                return report(x, low, high, step, largest_of(w * z0, w * z1, w * z2),
                              largest_of(b0, b1, b2), solution);
            }
            // Computed from z: summing up u would keep the rounding of a distant start.
            const Row away = combine(z0, z1, z2);
            const Row move = combine(e0, e1, e2);
            const Four over = Four::all(over_);
            const Row u{Four::mul_add(move.a, over, target.a + away.a),
                        Four::mul_add(move.b, over, target.b + away.b)};
            z0 += e0 * over_;
            z1 += e1 * over_;
            z2 += e2 * over_;
            x = {Four::min(Four::max(u.a, lower.a), upper.a),
                 Four::min(Four::max(u.b, lower.b), upper.b)};
            const unsigned at_least =
                (~movable & 0xFFU) | Row::bits(u.a <= lower.a, u.b <= lower.b);
            const unsigned at_most = Row::bits(upper.a <= u.a, upper.b <= u.b) & ~at_least;
            settled = at_least == low && at_most == high;
            low = at_least;
            high = at_most;
            const unsigned now = movable & ~(low | high);
            same = now == free;
            free = now;
        }
        return false;
    }

private:
    using Row = StringRow<Four>;

    static double size(double v) noexcept { return v < 0.0 ? -v : v; }
    static double largest_of(double a, double b, double c) noexcept {
        const double ab = size(a) > size(b) ? size(a) : size(b);
        return ab > size(c) ? ab : size(c);
    }

    void read_half(std::size_t first) noexcept {
        Four c0, c1, c2, c3; // c3 is not needed
        Four::load_transposed(&matrix_.columns[first][0], &matrix_.columns[first + 1][0],
                              &matrix_.columns[first + 2][0], &matrix_.columns[first + 3][0], c0,
                              c1, c2, c3);
        (first == 0 ? row_[0].a : row_[0].b) = c0 * Four::all(p_.weights[0]);
        (first == 0 ? row_[1].a : row_[1].b) = c1 * Four::all(p_.weights[1]);
        (first == 0 ? row_[2].a : row_[2].b) = c2 * Four::all(p_.weights[2]);
    }

    static double dot(const Row &p, const Row &q) noexcept {
        return Four::mul_add(p.a, q.a, p.b * q.b).sum();
    }

    // Returns R'd.
    [[nodiscard]] Row combine(double d0, double d1, double d2) const noexcept {
        const Four f0 = Four::all(d0);
        const Four f1 = Four::all(d1);
        const Four f2 = Four::all(d2);
        return {Four::mul_add(row_[2].a, f2, Four::mul_add(row_[1].a, f1, row_[0].a * f0)),
                Four::mul_add(row_[2].b, f2, Four::mul_add(row_[1].b, f1, row_[0].b * f0))};
    }

    // Inverts R_F R_F' + w I as adjugate over determinant. Returns false where the latter cancels.
    bool factor(unsigned free) noexcept {
        const Row mask = Row::strings(free);
        const Row m0{row_[0].a & mask.a, row_[0].b & mask.b};
        const Row m1{row_[1].a & mask.a, row_[1].b & mask.b};
        const Row m2{row_[2].a & mask.a, row_[2].b & mask.b};
        const double w = p_.proximal_weight;
        const double xx = dot(m0, m0) + w;
        const double xy = dot(m0, m1);
        const double xz = dot(m0, m2);
        const double yy = dot(m1, m1) + w;
        const double yz = dot(m1, m2);
        const double zz = dot(m2, m2) + w;
        adjugate_[0] = yy * zz - yz * yz;
        adjugate_[1] = xz * yz - xy * zz;
        adjugate_[2] = xy * yz - xz * yy;
        adjugate_[3] = xx * zz - xz * xz;
        adjugate_[4] = xy * xz - xx * yz;
        adjugate_[5] = xx * yy - xy * xy;
        const double determinant = xx * adjugate_[0] + xy * adjugate_[1] + xz * adjugate_[2];
        trace_ = xx + yy + zz;
        over_ = 1.0 / determinant;
        least_ = kStep_n * determinant;
        return determinant > kCancelled * trace_ * trace_ * trace_ && determinant < kLargest;
    }

    bool report(const Row &x, unsigned low, unsigned high, int steps, double error_n,
                double request_n, TensionSolution &solution) const noexcept {
        // Rounding of the residual moves a string by at most this: s / (s^2 + w) peaks at s^2 = w.
        const double noise = kNoise * (error_n + request_n);
        if (!(noise * noise <= 4.0 * p_.proximal_weight * kNoiseMove_n * kNoiseMove_n)) {
            return false;
        }
        x.store(solution.tensions_n.data());
        solution.active = active_set(low, high);
        solution.largest_error_n = error_n;
        solution.iterations = steps;
        solution.status = Status::ok;
        return true;
    }

    const TensionProblem &p_;
    const WrenchMatrix &matrix_;
    const PaperWrench &wrench_;
    Row row_[3];         // R
    double adjugate_[6]; // xx xy xz yy yz zz
    double over_ = 0.0;  // 1 / determinant
    double trace_ = 0.0; // of R_F R_F' + w I
    double least_ = 0.0; // a step below this, times the determinant, ends the iteration
};

} // namespace

} // namespace spidar
