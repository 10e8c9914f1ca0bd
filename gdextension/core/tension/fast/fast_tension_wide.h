// The fast path for vectors that hold one value of every string, as fast_tension_kernel.h is for vectors of four.
// Included by the source that compiles it for its target. kRows: the first so many DOF count.
//
//   min ||R x - W q||^2 + w |x - t|^2,  lower <= x <= upper,   R = W A (kRows x 8), H = R'R + w I
//
// 1. H is inverted on the strings taken as free (wide_table.h).
// 2. Principal pivots on that table bound and release strings until every tension is within its bounds and every
//    slope at a bound has the right sign: one rank-1 update each.
// 3. Newton corrections with the gradient taken from A itself. They are the certificate too: the tensions still
//    free, the slopes of all held strings (those outside the table as well) and the rounding of the gradient are
//    checked; a string held wrongly goes back to 1, anything in doubt is left to the exact search.
#pragma once

#include "core/tension/fast/wide_pivots.h"
#include "core/tension/fast/wide_table.h"

namespace spidar {

namespace { // each source compiles its own, for its own target

template <class Eight, int kRows>
class WideTension {
public:
    explicit WideTension(const FastInput &input) noexcept
        : p_(input.problem), matrix_(input.matrix), wrench_(input.wrench) {}

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
            free_ = table;
            contraction_ = 0.0;
            if (!settle(passes)) {
                return false;
            }
            double before = step_.largest();
            if (contraction_ > 0.0) { // pivots were made: that step says nothing of their table
                if (!(contraction_ <= kWorstContraction)) {
                    table = free_;
                    continue;
                }
                const double trusted_n = kLeft_n / (contraction_ * contraction_);
                before = before < trusted_n ? before : trusted_n;
            }
            if (const Verdict verdict = correct(before); verdict == Verdict::optimal) {
                return report(inversions + passes, solution);
            } else if (verdict == Verdict::in_doubt) {
                return false;
            }
            table = free_ | wrong_;
            low_ &= ~wrong_;
            high_ &= ~wrong_;
        }
        return false;
    }

private:
    enum class Verdict { optimal, release, in_doubt };

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
            columns[i] = weights_ * Eight::template load_front<kRows>(matrix_.columns[i].data());
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
        return stiffness_ <= kWorstCondition * p_.proximal_weight;
    }

    bool invert_and_step(unsigned strings) noexcept {
        Eight t[kFastStrings];
        const Inversion inverse =
            WideTable<Eight>::invert(rows_, p_, matrix_, strings, scale_, stiffness_, t);
        const Eight factor = Eight::all(inverse.factor);
        take((times(t, gradient_.keep(strings)) * factor).keep(strings));
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            table_[i] = (t[i] * factor).keep(strings);
        }
        return inverse.sound;
    }

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

    // Half the gradient at x_, every string, from A itself.
    void gradient() noexcept {
        Eight even = Eight::all(0.0) - Eight::template load_front<kRows>(wrench_.data());
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
        return Eight::template load_front<kRows>(matrix_.columns[string].data());
    }

    // x_ += the Newton step d of the free strings (0 elsewhere) from gradient_.
    void take(Eight d) noexcept {
        step_ = d.absolute();
        x_ = x_ + d;
    }

    // Pivots until all strings of the table are within their ranges: tensions of the free ones, slopes of the held.
    bool settle(int &passes) noexcept {
        const Eight tolerance = Eight::all(kTableTolerance);
        const unsigned out = Eight::less(tolerance, Eight::max(lower_ - x_, x_ - upper_));
        if ((out & free_) == 0) {
            return true; // the usual case of a warm tick
        }
        const double condition = stiffness_ * softest();
        contraction_ = kTableRounding * condition * condition;
        // Copied there and back: this object stays in registers, which only the seldom case must leave.
        Pivoting<Eight> pivoting;
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            pivoting.table[i] = table_[i];
        }
        pivoting.lower = lower_;
        pivoting.upper = upper_;
        pivoting.x = x_;
        pivoting.stiffness = stiffness_;
        pivoting.free = free_;
        pivoting.low = low_;
        pivoting.high = high_;
        const bool settled = pivoting.run();
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            table_[i] = pivoting.table[i];
        }
        x_ = pivoting.x;
        free_ = pivoting.free;
        low_ = pivoting.low;
        high_ = pivoting.high;
        passes += pivoting.passes;
        return settled;
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

    // The longest correction that may end them, when the step before was `before`.
    static double enough_after(double before) noexcept {
        const double contracting_n = __builtin_sqrt(kLeft_n * before);
        return contracting_n < kStep_n    ? kStep_n
               : contracting_n < kShort_n ? contracting_n
                                          : kShort_n;
    }

    // Newton steps until what is left is rounding, and the certificate. `before`: the step before the first.
    Verdict correct(double before) noexcept {
        for (int correction = 0; correction < kCorrections; ++correction) {
            gradient();
            const double noise = kNoise * force_.absolute().largest();
            // The noise of the gradient times the softest element of H^-1 moves a string.
            const bool quiet = noise * softest() <= kNoiseMove_n;
            // A step up to this ends it: known before the step, so that what is to be checked need not wait.
            const double enough = enough_after(before);
            const Eight rise = Eight::select(high_, Eight::all(0.0) - gradient_, gradient_);
            const unsigned held = movable_ & ~free_;
            const unsigned right = Eight::less(Eight::all(noise + stiffness_ * enough), rise);
            take(times(table_, gradient_.keep(free_)).keep(free_));
            const unsigned small = Eight::less_equal(step_, Eight::all(enough));
            const unsigned inside = Eight::less_equal(lower_, x_) & Eight::less_equal(x_, upper_);
            if (quiet & ((small & inside & (right | ~held)) == 0xFFU)) {
                return Verdict::optimal;
            }
            before = step_.largest();
            if (small != 0xFFU) {
                continue;
            }
            if (!quiet || inside != 0xFFU) {
                return Verdict::in_doubt;
            }
            // Slopes of held strings, positive when the bound is right; |H d| is at most its trace times d.
            const double slack = noise + stiffness_ * before;
            if ((held & ~Eight::less(Eight::all(slack), rise)) == 0) {
                return Verdict::optimal;
            }
            wrong_ = held & Eight::less(rise, Eight::all(-slack));
            if (wrong_ != 0) {
                return Verdict::release;
            }
            if (!(before > kStep_n)) {
                return Verdict::in_doubt;
            }
        }
        return Verdict::in_doubt;
    }

    // Bit i to the lowest bit of byte i.
    static std::uint64_t spread(unsigned mask) noexcept {
        const std::uint64_t copies = (mask & 0xFFU) * std::uint64_t{0x0101010101010101};
        const std::uint64_t picked = copies & 0x8040201008040201ULL;
        return ((picked + 0x7F7F7F7F7F7F7F7FULL) >> 7U) & 0x0101010101010101ULL;
    }

    // False where squares overflow.
    bool report(int iterations, TensionSolution &solution) const noexcept {
        x_.store(solution.tensions_n.data());
        solution.active = std::bit_cast<ActiveSet>(spread(low_) | (spread(high_) << 1U));
        solution.largest_error_n = force_.absolute().largest();
        solution.iterations = iterations;
        solution.status = Status::ok;
        return solution.largest_error_n < kLargestForce_n;
    }

    const TensionProblem &p_;
    const WrenchMatrix &matrix_;
    const DofArray &wrench_;
    Eight lower_{};
    Eight upper_{};
    Eight target_{};
    Eight weights_{};
    Eight rows_[kRows]; // R, by DOF
    Eight table_[kFastStrings];
    Eight x_{};
    Eight gradient_{};
    Eight step_{};             // size of the last step
    Eight force_{};            // W (A x - q) where gradient_ was taken
    double stiffness_ = 0.0;   // trace of H
    double contraction_ = 0.0; // of the corrections, at worst; 0 when no pivot was made
    double scale_ = 1.0;       // a power of two, about 1 / H
    unsigned movable_ = 0;     // lower < upper
    unsigned low_ = 0;         // held at the lower bound
    unsigned high_ = 0;
    unsigned free_ = 0;
    unsigned wrong_ = 0; // held with a slope of the wrong sign
};

} // namespace

} // namespace spidar
