// The fast path for vectors that hold one value of every string; included by the sources that compile it, each for its
// own target. kRows: the first so many DOF count.
//
//   min ||R x - W q||^2 + w |x - t|^2,  lower <= x <= upper,   R = W A (kRows x 8), H = R'R + w I
//
// 1. H is inverted on the strings taken as free (WideTable). Held strings have a unit row and column.
// 2. Principal pivots on that table bound and release strings until every tension is within its bounds and every
//    slope at a bound has the right sign: one rank-1 update each.
// 3. Newton corrections with the gradient taken from A itself. They are the certificate too: the tensions still
//    free, the slopes of all held strings (those outside the table as well) and the rounding of the gradient are
//    checked; a string held wrongly goes back to 1, anything in doubt is left to the exact search.
#pragma once

#include "core/fast_tension_limits.h"

namespace spidar {

namespace { // each source compiles its own, for its own target

// -H^-1 on the free strings by four block pivots without a division in their chain: all is scaled by the product of
// the determinants so far, and divided once, at the end. Then the table of principal pivots on it (sweep operator).
template <class Eight>
class WideTable {
public:
    // t: H on the strings of the table, scaled by `scale`, unit rows elsewhere. False when a pivot has cancelled.
    bool invert(Eight (&t)[kFastStrings], double scale, double mean_diagonal) noexcept {
        Eight sigma = Eight::all(1.0);
        const double least = kCancelled * mean_diagonal * mean_diagonal;
        double before = 1.0;
        const double d0 = sweep_pair<0>(t, sigma);
        bool sound = d0 > least;
        before = sigma.first();
        const double d1 = sweep_pair<2>(t, sigma);
        sound = sound & (d1 > least * before * before);
        before = sigma.first();
        const double d2 = sweep_pair<4>(t, sigma);
        sound = sound & (d2 > least * before * before);
        before = sigma.first();
        const double d3 = sweep_pair<6>(t, sigma);
        sound = sound & (d3 > least * before * before) & (d3 > kTiny) & (before > kTiny);
        sigma_ = sigma.first();
        sound = sound & (sigma_ > kTiny) & (sigma_ < 1.0 / kTiny);
        factor_ = scale / sigma_;
        return sound;
    }

    [[nodiscard]] double factor() const noexcept { return factor_; }

    static Eight times(const Eight (&t)[kFastStrings], Eight g) noexcept {
        Eight even = t[0] * g.template lane<0>();
        Eight odd = t[1] * g.template lane<1>();
        even = Eight::mul_add(t[2], g.template lane<2>(), even);
        odd = Eight::mul_add(t[3], g.template lane<3>(), odd);
        even = Eight::mul_add(t[4], g.template lane<4>(), even);
        odd = Eight::mul_add(t[5], g.template lane<5>(), odd);
        even = Eight::mul_add(t[6], g.template lane<6>(), even);
        odd = Eight::mul_add(t[7], g.template lane<7>(), odd);
        return even + odd;
    }

private:
    // Scaled determinants and their products beyond this have lost digits to underflow, or will to overflow.
    static constexpr double kTiny = 1e-280;

    template <int kPair>
    static double sweep_pair(Eight (&t)[kFastStrings], Eight &sigma) noexcept {
        constexpr unsigned kOwn = 3U << kPair;
        const Eight p = t[kPair];
        const Eight q = t[kPair + 1];
        const Eight a = p.template lane<kPair>();
        const Eight b = p.template lane<kPair + 1>();
        const Eight c = q.template lane<kPair + 1>();
        const Eight determinant = Eight::sub_mul(b, b, a * c);
        const Eight zero = Eight::all(0.0);
        // sigma (-c, b) and sigma (b, -a) on the pair's own lanes.
        const Eight sb = sigma * b;
        const Eight u_own = Eight::select(1U << kPair, zero - sigma * c, sb);
        const Eight v_own = Eight::select(1U << kPair, sb, zero - sigma * a);
        const Eight u = Eight::select(kOwn, u_own, Eight::sub_mul(b, q, c * p));
        const Eight v = Eight::select(kOwn, v_own, Eight::sub_mul(b, p, a * q));
        update<kPair, 0>(t, determinant, u, v);
        update<kPair, 1>(t, determinant, u, v);
        update<kPair, 2>(t, determinant, u, v);
        update<kPair, 3>(t, determinant, u, v);
        update<kPair, 4>(t, determinant, u, v);
        update<kPair, 5>(t, determinant, u, v);
        update<kPair, 6>(t, determinant, u, v);
        update<kPair, 7>(t, determinant, u, v);
        t[kPair] = sigma * u;
        t[kPair + 1] = sigma * v;
        sigma = sigma * determinant;
        return determinant.first();
    }

    template <int kPair, int kRow>
    static void update(Eight (&t)[kFastStrings], Eight determinant, Eight u, Eight v) noexcept {
        if constexpr (kRow != kPair && kRow != kPair + 1) {
            constexpr unsigned kOthers = 0xFFU & ~(3U << kPair);
            const Eight x = t[kRow].template lane<kPair>();
            const Eight y = t[kRow].template lane<kPair + 1>();
            const Eight scaled = (determinant * t[kRow]).keep(kOthers);
            t[kRow] = Eight::sub_mul(y, v, Eight::sub_mul(x, u, scaled));
        }
    }

    double sigma_ = 1.0;
    double factor_ = 1.0;
};

template <class Eight, int kRows>
class WideTension {
public:
    explicit WideTension(const TensionProblem &problem) noexcept : p_(problem) {}

    bool run(const ActiveSet *warm, TensionSolution &solution) noexcept {
        if (!read(warm)) {
            return false;
        }
        unsigned table = movable_ & ~(low_ | high_);
        int inversions = 0;
        int passes = 0;
        while (inversions < kTables) {
            ++inversions;
            gradient();
            if (!invert_and_step(table)) {
                return false;
            }
            double before = largest_step_;
            free_ = table;
            if (!settle(passes)) {
                return false;
            }
            for (int correction = 0;; ++correction) {
                if (correction == kCorrections) {
                    return false;
                }
                gradient();
                take(WideTable<Eight>::times(table_, gradient_.keep(free_)).keep(free_));
                const double d = largest_step_;
                const bool settled = d <= kStep_n || (d <= kShort_n && d * d <= kLeft_n * before);
                before = d;
                if (!settled) {
                    continue;
                }
                const Verdict verdict = judge(d);
                if (verdict == Verdict::optimal) {
                    return report(inversions + passes, solution);
                }
                if (verdict == Verdict::in_doubt) {
                    return false;
                }
                if (verdict == Verdict::release) {
                    break;
                }
            }
            table = free_ | wrong_;
            low_ &= ~wrong_;
            high_ &= ~wrong_;
        }
        return false;
    }

private:
    enum class Verdict { optimal, correct_again, release, in_doubt };

    static bool has(unsigned mask, std::size_t string) noexcept {
        return ((mask >> string) & 1U) != 0U;
    }

    // Bounds, target, start and R. False for bounds in disorder or nothing finite.
    bool read(const ActiveSet *warm) noexcept {
        lower_ = Eight::load(p_.lower_n.data());
        upper_ = Eight::load(p_.upper_n.data());
        target_ = Eight::load(p_.proximal_target_n.data());
        const Eight size = lower_.absolute() + upper_.absolute() + target_.absolute();
        const unsigned fine =
            Eight::less_equal(lower_, upper_) & Eight::less_equal(size, Eight::all(kLargest));
        if (fine != 0xFFU || !(p_.proximal_weight > 0.0)) {
            return false;
        }
        movable_ = Eight::less(lower_, upper_);
        low_ = ~movable_ & 0xFFU;
        high_ = 0;
        if (warm != nullptr) {
            // One byte a string, 1 or 2: the product gathers the lowest bits of all eight in its top byte.
            const auto guess = std::bit_cast<std::uint64_t>(*warm);
            constexpr std::uint64_t kLowBits = 0x0101010101010101ULL;
            constexpr std::uint64_t kGather = 0x0102040810204080ULL;
            low_ |= static_cast<unsigned>(((guess & kLowBits) * kGather) >> 56U);
            high_ |= static_cast<unsigned>((((guess >> 1U) & kLowBits) * kGather) >> 56U);
            high_ &= ~low_;
        }
        const Eight start = Eight::min(Eight::max(target_, lower_), upper_);
        x_ = Eight::select(low_, lower_, Eight::select(high_, upper_, start));
        weights_ = Eight::template load_front<kRows>(p_.weights.data());
        Eight columns[kFastStrings];
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            columns[i] = weights_ * Eight::template load_front<kRows>(p_.matrix.columns[i].data());
        }
        // One string of each pole tells the scale.
        const Eight squares = Eight::mul_add(columns[0], columns[0], columns[4] * columns[4]);
        const double size_of_h = squares.sum() + p_.proximal_weight;
        if (!(size_of_h > 1.0 / kLargest && size_of_h < kLargest)) {
            return false;
        }
        constexpr std::uint64_t kExponent = 0x7FF0000000000000ULL;
        constexpr std::uint64_t kTwiceBias = 0x7FE0000000000000ULL;
        scale_ = std::bit_cast<double>(kTwiceBias -
                                       (std::bit_cast<std::uint64_t>(size_of_h) & kExponent));
        Eight::transpose(columns);
        Eight trace = columns[0] * columns[0];
#pragma GCC unroll 7
        for (int k = 1; k < kRows; ++k) {
            trace = Eight::mul_add(columns[k], columns[k], trace);
        }
#pragma GCC unroll 7
        for (int k = 0; k < kRows; ++k) {
            rows_[k] = columns[k];
        }
        stiffness_ = trace.sum() + 8.0 * p_.proximal_weight;
        return true;
    }

    bool invert_and_step(unsigned table) noexcept {
        const Eight diagonal =
            Eight::select(table, Eight::all(p_.proximal_weight), Eight::all(1.0 / scale_));
        Eight t[kFastStrings];
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            t[i] = diagonal.keep(1U << i);
        }
#pragma GCC unroll 7
        for (std::size_t k = 0; k < kRows; ++k) {
            const Eight row = (rows_[k] * Eight::all(p_.weights[k])).keep(table);
#pragma GCC unroll 8
            for (std::size_t i = 0; i < kFastStrings; ++i) {
                t[i] = Eight::mul_add(row, Eight::all(p_.matrix.columns[i][k]), t[i]);
            }
        }
        const Eight scale = Eight::all(scale_);
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            t[i] = (t[i] * scale).keep(has(table, i) ? table : 1U << i);
        }
        WideTable<Eight> inverse;
        const bool sound = inverse.invert(t, scale_, scale_ * stiffness_ * 0.125);
        const Eight factor = Eight::all(inverse.factor());
        take((WideTable<Eight>::times(t, gradient_.keep(table)) * factor).keep(table));
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            table_[i] = (t[i] * factor).keep(table);
        }
        return sound;
    }

    // Half the gradient at x_, every string, from A itself.
    void gradient() noexcept {
        Eight even = Eight::all(0.0) - Eight::template load_front<kRows>(p_.wrench.data());
        Eight odd = column(1) * x_.template lane<1>();
        even = Eight::mul_add(column(0), x_.template lane<0>(), even);
        even = Eight::mul_add(column(2), x_.template lane<2>(), even);
        odd = Eight::mul_add(column(3), x_.template lane<3>(), odd);
        even = Eight::mul_add(column(4), x_.template lane<4>(), even);
        odd = Eight::mul_add(column(5), x_.template lane<5>(), odd);
        even = Eight::mul_add(column(6), x_.template lane<6>(), even);
        odd = Eight::mul_add(column(7), x_.template lane<7>(), odd);
        force_ = weights_ * (even + odd);
        Eight g = Eight::all(p_.proximal_weight) * (x_ - target_);
        Eight h = rows_[0] * force_.template lane<0>();
        g = add_row<1>(g);
        h = add_row<2>(h);
        g = add_row<3>(g);
        h = add_row<4>(h);
        g = add_row<5>(g);
        h = add_row<6>(h);
        gradient_ = g + h;
    }

    template <int kRow>
    [[nodiscard]] Eight add_row(Eight sum) const noexcept {
        if constexpr (kRow < kRows) {
            return Eight::mul_add(rows_[kRow], force_.template lane<kRow>(), sum);
        } else {
            return sum;
        }
    }

    [[nodiscard]] Eight column(std::size_t string) const noexcept {
        return Eight::template load_front<kRows>(p_.matrix.columns[string].data());
    }

    // x_ += the Newton step d of the free strings (0 elsewhere) from gradient_.
    void take(Eight d) noexcept {
        gain_ = gradient_ * d; // what the objective changes by: H d = -g
        where_ = x_;
        x_ = x_ + d;
        largest_step_ = d.absolute().largest();
    }

    // Pivots until all strings of the table are within their ranges: tensions of the free ones, slopes of the held.
    bool settle(int &passes) noexcept {
        const Eight tolerance = Eight::all(kTableTolerance);
        const unsigned out_now = Eight::less(tolerance, Eight::max(lower_ - x_, x_ - upper_));
        if ((out_now & free_) == 0) {
            return true; // the usual case of a warm tick
        }
        return pivot_until_settled(passes);
    }

    [[gnu::noinline]] bool pivot_until_settled(int &passes) noexcept {
        const Eight tolerance = Eight::all(kTableTolerance);
        Eight least = Eight::select(free_, lower_, Eight::all(-kOpen));
        Eight most = Eight::select(free_, upper_, Eight::all(kOpen));
        Eight y = x_; // tensions of free, slopes of held strings
        unsigned held_in_table = 0;
        for (int pass = 0; pass < kPasses; ++pass) {
            unsigned out = Eight::less(tolerance, Eight::max(least - y, y - most));
            if (out == 0) {
                x_ = Eight::select(held_in_table, x_, y);
                return true;
            }
            ++passes;
            if (pass >= kBlockPasses) {
                unsigned last = out;
                for (; (last & (last - 1U)) != 0; last &= last - 1U) {
                }
                out = last;
            }
            while (out != 0) {
                const auto c = static_cast<std::size_t>(__builtin_ctz(out));
                const unsigned own = 1U << c;
                const Eight row = table_[c];
                const double corner = pick(row, c);
                const bool was_free = has(free_, c);
                if (!was_free && !(corner > kCancelled * stiffness_)) {
                    return false;
                }
                // Holds string c at the bound it passed, or releases it.
                const double y_c = pick(y, c);
                const double least_c = pick(least, c);
                const bool to_low = y_c < least_c;
                const double bound = to_low ? least_c : pick(most, c);
                const double inverse = 1.0 / corner;
                const double change = bound - y_c;
                const double share = was_free ? change * inverse : -change * inverse;
                const double sign = was_free ? -1.0 : 1.0; // of T_rc' / T_rc
                y = Eight::mul_add(row, Eight::select(free_, Eight::all(share), Eight::all(-share)),
                                   y);
                if (was_free) {
                    x_ = Eight::select(own, Eight::all(bound), x_);
                    y = Eight::select(own, Eight::all(-share), y);
                    least = Eight::select(own, Eight::all(to_low ? 0.0 : -kOpen), least);
                    most = Eight::select(own, Eight::all(to_low ? kOpen : 0.0), most);
                    (to_low ? low_ : high_) |= own;
                } else {
                    y = Eight::select(own, x_ - Eight::all(share), y);
                    least = Eight::select(own, lower_, least);
                    most = Eight::select(own, upper_, most);
                    low_ &= ~own;
                    high_ &= ~own;
                }
                free_ ^= own;
                held_in_table ^= own;
                pivot(c, row, inverse, sign);
                // Of this pass, those that are still outside.
                out &= ~own & Eight::less(Eight::all(0.0), Eight::max(least - y, y - most));
            }
        }
        return false;
    }

    // The sweep of string c: sign is -1 when it was swept before (free), +1 when not.
    void pivot(std::size_t c, Eight row, double inverse, double sign) noexcept {
        const unsigned own = 1U << c;
        // Its own element is set so that the update leaves sign T_rc / T_cc in column c.
        const Eight w =
            Eight::select(own, Eight::all(1.0 - sign * inverse), row * Eight::all(inverse));
        alignas(64) double entries[kFastStrings];
        row.store(entries);
#pragma GCC unroll 8
        for (std::size_t r = 0; r < kFastStrings; ++r) {
            table_[r] = Eight::sub_mul(Eight::all(entries[r]), w, table_[r]);
        }
        table_[c] = Eight::select(own, Eight::all(-inverse), row * Eight::all(sign * inverse));
    }

    static double pick(Eight v, std::size_t lane) noexcept {
        alignas(64) double all[kFastStrings];
        v.store(all);
        return all[lane];
    }

    // Largest diagonal element of the table within the free strings.
    [[nodiscard]] double softest() const noexcept {
        Eight diagonal = table_[0];
#pragma GCC unroll 8
        for (std::size_t i = 1; i < kFastStrings; ++i) {
            diagonal = Eight::select(1U << i, table_[i], diagonal);
        }
        return diagonal.absolute().keep(free_).largest();
    }

    // After a correction by d (largest) from where gradient_ was taken.
    Verdict judge(double d) noexcept {
        const double noise = kNoise * force_.absolute().largest();
        // The noise of the gradient times the softest element of H^-1 moves a string.
        if (!(noise * softest() <= kNoiseMove_n)) {
            return Verdict::in_doubt;
        }
        const unsigned inside = Eight::less_equal(lower_, x_) & Eight::less_equal(x_, upper_);
        if (inside != 0xFFU) {
            return Verdict::in_doubt;
        }
        // Slopes of held strings, positive when the bound is right; |H d| is at most its trace times d.
        const double slack = noise + stiffness_ * d;
        const Eight rise = Eight::select(high_, Eight::all(0.0) - gradient_, gradient_);
        const unsigned held = movable_ & ~free_;
        const unsigned right = Eight::less(Eight::all(slack), rise);
        if ((held & ~right) == 0) {
            return Verdict::optimal;
        }
        wrong_ = held & Eight::less(rise, Eight::all(-slack));
        if (wrong_ != 0) {
            return Verdict::release;
        }
        return d > kStep_n ? Verdict::correct_again : Verdict::in_doubt;
    }

    // Bit i to the lowest bit of byte i.
    static std::uint64_t spread(unsigned mask) noexcept {
        const std::uint64_t copies = (mask & 0xFFU) * std::uint64_t{0x0101010101010101};
        const std::uint64_t picked = copies & 0x8040201008040201ULL;
        return ((picked + 0x7F7F7F7F7F7F7F7FULL) >> 7U) & 0x0101010101010101ULL;
    }

    // False when the objective overflows.
    bool report(int iterations, TensionSolution &solution) const noexcept {
        x_.store(solution.tensions_n.data());
        solution.active = std::bit_cast<ActiveSet>(spread(low_) | (spread(high_) << 1U));
        const Eight away = where_ - target_;
        const Eight terms = Eight::mul_add(away * away, Eight::all(p_.proximal_weight),
                                           Eight::mul_add(force_, force_, gain_));
        solution.objective = terms.sum();
        solution.largest_error_n = force_.absolute().largest();
        solution.iterations = iterations;
        solution.status = Status::ok;
        return solution.objective < kOpen;
    }

    const TensionProblem &p_;
    Eight lower_{};
    Eight upper_{};
    Eight target_{};
    Eight weights_{};
    Eight rows_[kRows]; // R, by DOF
    Eight table_[kFastStrings];
    Eight x_{};
    Eight gradient_{};
    Eight where_{}; // x_ before the last step
    Eight force_{}; // W (A x - q) where gradient_ was taken
    Eight gain_{};  // g'd of the last step
    double largest_step_ = 0.0;
    double stiffness_ = 0.0; // trace of H
    double scale_ = 1.0;     // a power of two, about 1 / H
    unsigned movable_ = 0;   // lower < upper
    unsigned low_ = 0;       // held at the lower bound
    unsigned high_ = 0;
    unsigned free_ = 0;
    unsigned wrong_ = 0; // held with a slope of the wrong sign
};

} // namespace

} // namespace spidar
