// -H^-1 on the free strings, H = R'R + w I, by four symmetric 2 x 2 block pivots without a division in their chain:
// everything is scaled by the product of the determinants so far and divided once, at the end. Held strings have a
// unit row and column meanwhile.
#pragma once

#include "core/tension/fast/fast_tension_limits.h"

namespace spidar {

namespace { // each source compiles its own, for its own target

// Where the four determinants came from: enough to tell whether one of them has cancelled.
class PivotCheck {
public:
    explicit PivotCheck(double mean_diagonal) noexcept
        : least_(kCancelled * mean_diagonal * mean_diagonal) {}

    // scaled by the square of `before`, the product of all scales until then.
    void include(double determinant, double before) noexcept {
        sound_ = sound_ & (determinant > least_ * before * before) & (determinant > kTiny);
    }
    [[nodiscard]] bool sound(double sigma) const noexcept {
        return sound_ & (sigma > kTiny) & (sigma < 1.0 / kTiny);
    }

private:
    // Scaled determinants and their products beyond this have lost digits to underflow, or will to overflow.
    static constexpr double kTiny = 1e-280;
    double least_;
    bool sound_ = true;
};

struct Inversion {
    double factor = 1.0; // what the table is still to be multiplied by
    bool sound = false;  // false: a pivot has cancelled
};

template <class Eight>
class WideTable {
public:
    // rows: R; weights: w_k that R = W A was made with; scale: a power of two, about 1 / H; trace: of H.
    template <int kRows>
    static Inversion invert(const Eight (&rows)[kRows], const TensionProblem &problem,
                            const WrenchMatrix &matrix, unsigned strings, double scale,
                            double trace, Eight (&t)[kFastStrings]) noexcept {
        const Eight diagonal =
            Eight::select(strings, Eight::all(problem.proximal_weight), Eight::all(1.0 / scale));
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            t[i] = diagonal.keep(1U << i);
        }
#pragma GCC unroll 7
        for (std::size_t k = 0; k < kRows; ++k) {
            const Eight row = (rows[k] * Eight::all(problem.weights[k])).keep(strings);
#pragma GCC unroll 8
            for (std::size_t i = 0; i < kFastStrings; ++i) {
                t[i] = Eight::mul_add(row, Eight::all(matrix.columns[i][k]), t[i]);
            }
        }
        const Eight scales = Eight::all(scale);
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            t[i] = (t[i] * scales).keep(((strings >> i) & 1U) != 0U ? strings : 1U << i);
        }
        PivotCheck check(scale * trace * 0.125);
        Eight sigma = Eight::all(1.0);
        sweep_pair<0>(t, sigma, check);
        sweep_pair<2>(t, sigma, check);
        sweep_pair<4>(t, sigma, check);
        sweep_pair<6>(t, sigma, check);
        return {scale / sigma.first(), check.sound(sigma.first())};
    }

private:
    template <int kPair>
    static void sweep_pair(Eight (&t)[kFastStrings], Eight &sigma, PivotCheck &check) noexcept {
        constexpr unsigned kOwn = 3U << kPair;
        const Eight p = t[kPair];
        const Eight q = t[kPair + 1];
        // The pivot rows are the pivot columns too: read back one by one as the factors of the other rows.
        alignas(64) double x[kFastStrings];
        alignas(64) double y[kFastStrings];
        p.store(x);
        q.store(y);
        const Eight a = p.template lane<kPair>();
        const Eight b = p.template lane<kPair + 1>();
        const Eight c = q.template lane<kPair + 1>();
        const Eight determinant = Eight::sub_mul(b, b, a * c);
        check.include(determinant.first(), sigma.first());
        const Eight zero = Eight::all(0.0);
        // sigma (-c, b) and sigma (b, -a) on the pair's own lanes.
        const Eight sb = sigma * b;
        const Eight u_own = Eight::select(1U << kPair, zero - sigma * c, sb);
        const Eight v_own = Eight::select(1U << kPair, sb, zero - sigma * a);
        const Eight u = Eight::select(kOwn, u_own, Eight::sub_mul(b, q, c * p));
        const Eight v = Eight::select(kOwn, v_own, Eight::sub_mul(b, p, a * q));
#pragma GCC unroll 8
        for (int r = 0; r < 8; ++r) {
            if (r != kPair && r != kPair + 1) {
                const Eight scaled = (determinant * t[r]).keep(0xFFU & ~kOwn);
                t[r] = Eight::sub_mul(Eight::all(y[r]), v,
                                      Eight::sub_mul(Eight::all(x[r]), u, scaled));
            }
        }
        t[kPair] = sigma * u;
        t[kPair + 1] = sigma * v;
        sigma = sigma * determinant;
    }
};

} // namespace

} // namespace spidar
