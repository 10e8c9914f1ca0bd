// The fast solver for one vector type. Sources include it and compile it for their own target.
//
//   min ||R x - W q||^2 + w |x - t|^2,  lower <= x <= upper,   R = W A (7 x 8), H = R'R + w I
//
// 1. H is inverted on the strings assumed free by four symmetric 2 x 2 block pivots (sweep
// operator). Held strings have a unit row and column.
// 2. Principal pivots on the resulting table hold and release strings, one rank-1 update each,
// until every tension is within its bounds and every slope at a bound has the right sign.
// 3. Newton corrections with the gradient from A itself follow. The last correction also checks the
// answer: tensions of free strings, slopes of held strings and the rounding of the gradient. If a
// held string should be free, step 1 runs again with it free. What cannot be decided is left to the
// exact solver.
#pragma once

#include "core/tension/fast/fast_tension_limits.h"
#include "core/tension/fast/sweep_table.h"

namespace spidar {

namespace { // one copy per source, for its own target

template <class Four>
class FastTension {
public:
    explicit FastTension(const FastInput &input) noexcept
        : p_(input.problem), matrix_(input.matrix), wrench_(input.wrench) {}

    bool run(const ActiveSet *warm, TensionSolution &solution) noexcept {
        if (!read(warm)) {
            return false;
        }
        unsigned table = movable_ & ~(low_ | high_);
        int inversions = 0;
        int passes = 0;
        while (inversions < kTables) {
            if (inversions++ > 0) { // read() has set the rows of the first table
                table_.set_rows(rows_, table);
            }
            gradient();
            table_.invert(p_.proximal_weight, table);
            const double mean = stiffness_ * 0.125;
            if (!(table_.smallest_pivot() > kCancelled * mean * mean)) {
                return false;
            }
            step(table);
            double before = largest_step_;
            free_ = table;
            contraction_ = 0.0;
            if (!settle(passes)) {
                return false;
            }
            if (contraction_ >
                0.0) { // pivots changed the table: the first step says nothing about it
                if (!(contraction_ <= kWorstContraction)) {
                    table = free_;
                    continue;
                }
                const double trusted_n = kLeft_n / (contraction_ * contraction_);
                before = before < trusted_n ? before : trusted_n;
            }
            for (int correction = 0;; ++correction) {
                if (correction == kCorrections) {
                    return false;
                }
                gradient();
                step(free_);
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
    using Row = StringRow<Four>;
    enum class Verdict { optimal, correct_again, release, in_doubt };

    static bool has(unsigned mask, std::size_t string) noexcept {
        return ((mask >> string) & 1U) != 0U;
    }

    // Reads bounds, target, start and R. Returns false when a lower bound exceeds its upper bound
    // or a value is not finite.
    bool read(const ActiveSet *warm) noexcept {
        const BoundRows<Four> bounds(p_);
        const auto &[lower, upper, target] = bounds;
        if (!bounds.sound() || !(p_.proximal_weight > 0.0)) {
            return false;
        }
        movable_ = bounds.movable();
        low_ = ~movable_ & 0xFFU;
        high_ = 0;
        if (warm != nullptr) {
            low_ |= strings_at(*warm, StringBound::at_lower);
            high_ = strings_at(*warm, StringBound::at_upper) & ~low_;
        }
        const Row at_low = Row::strings(low_);
        const Row at_high = Row::strings(high_);
        const Four start_a = Four::min(Four::max(target.a, lower.a), upper.a);
        const Four start_b = Four::min(Four::max(target.b, lower.b), upper.b);
        Row{Four::select(at_low.a, lower.a, Four::select(at_high.a, upper.a, start_a)),
            Four::select(at_low.b, lower.b, Four::select(at_high.b, upper.b, start_b))}
            .store(x_);
        const Row in_table = Row::strings(movable_ & ~(low_ | high_));
        const Four even = read_half(0, in_table.a);
        const Four odd = read_half(4, in_table.b);
        stiffness_ = (even + odd).sum() + 8.0 * p_.proximal_weight;
        return stiffness_ <= kWorstCondition * p_.proximal_weight;
    }

    // Reads R of four strings, and for the table only those in it. Returns the squares of the
    // elements summed over DOF.
    [[gnu::always_inline]] Four read_half(std::size_t first, Four in_table) noexcept {
        const double *const columns[] = {&matrix_.columns[first][0], &matrix_.columns[first + 1][0],
                                         &matrix_.columns[first + 2][0],
                                         &matrix_.columns[first + 3][0]};
        Four c0, c1, c2, c3; // DOF 0-3
        Four d0, d1, d2, d3; // DOF 3-6
        Four::load_transposed(columns[0], columns[1], columns[2], columns[3], c0, c1, c2, c3);
        Four::load_transposed(columns[0] + 3, columns[1] + 3, columns[2] + 3, columns[3] + 3, d0,
                              d1, d2, d3);
        const PaperWeights &w = p_.weights;
        const Four rows[kFastDofs] = {
            c0 * Four::all(w[0]), c1 * Four::all(w[1]), c2 * Four::all(w[2]), c3 * Four::all(w[3]),
            d1 * Four::all(w[4]), d2 * Four::all(w[5]), d3 * Four::all(w[6])};
        Four squares = Four::all(0.0);
#pragma GCC unroll 7
        for (std::size_t k = 0; k < kFastDofs; ++k) {
            rows[k].store(&rows_[k][first]);
            (rows[k] & in_table).store(table_.rows(k) + first);
            squares = Four::mul_add(rows[k], rows[k], squares);
        }
        return squares;
    }

    // Adds the share of two strings in A x.
    template <int kFirst, int kLane>
    void add_columns(Four x, Four &f0, Four &f1, Four &b0, Four &b1) const noexcept {
        const Four x0 = x.template lane<kLane>();
        const Four x1 = x.template lane<kLane + 1>();
        f0 = Four::mul_add(Four::load(&matrix_.columns[kFirst][0]), x0, f0);
        f1 = Four::mul_add(Four::load(&matrix_.columns[kFirst + 1][0]), x1, f1);
        b0 = Four::mul_add(Four::load(&matrix_.columns[kFirst][3]), x0, b0);
        b1 = Four::mul_add(Four::load(&matrix_.columns[kFirst + 1][3]), x1, b1);
    }

    // Adds the share of two DOF in R'f.
    template <int kFirst, int kLane>
    void add_rows(Four force, Row &g, Row &h) const noexcept {
        const Four even = force.template lane<kLane>();
        const Four odd = force.template lane<kLane + 1>();
        g.a = Four::mul_add(Four::load(&rows_[kFirst][0]), even, g.a);
        g.b = Four::mul_add(Four::load(&rows_[kFirst][4]), even, g.b);
        h.a = Four::mul_add(Four::load(&rows_[kFirst + 1][0]), odd, h.a);
        h.b = Four::mul_add(Four::load(&rows_[kFirst + 1][4]), odd, h.b);
    }

    // Computes half the gradient at x_ for every string, from A itself.
    [[gnu::always_inline]] void
    gradient() noexcept { // inlined: otherwise x_ and the results go through memory
        const Row x = Row::load(x_);
        Four f0 = Four::all(0.0) - Four::load(&wrench_[0]);
        Four f1 = Four::all(0.0);
        Four b0 = Four::all(0.0) - Four::load(&wrench_[3]);
        Four b1 = Four::all(0.0);
        add_columns<0, 0>(x.a, f0, f1, b0, b1);
        add_columns<2, 2>(x.a, f0, f1, b0, b1);
        add_columns<4, 0>(x.b, f0, f1, b0, b1);
        add_columns<6, 2>(x.b, f0, f1, b0, b1);
        front_ = Four::load(&p_.weights[0]) * (f0 + f1); // DOF 0-3
        back_ = Four::load(&p_.weights[3]) * (b0 + b1);  // DOF 3-6
        const Four w = Four::all(p_.proximal_weight);
        const Row t = Row::load(p_.proximal_target_n.data());
        Row g{w * (x.a - t.a), w * (x.b - t.b)};
        Row h{Four::all(0.0), Four::all(0.0)};
        add_rows<0, 0>(front_, g, h);
        add_rows<2, 2>(front_, g, h);
        add_rows<5, 2>(back_, g, h);
        const Four last = back_.template lane<1>();
        g.a = Four::mul_add(Four::load(&rows_[4][0]), last, g.a);
        g.b = Four::mul_add(Four::load(&rows_[4][4]), last, g.b);
        gradient_ = {g.a + h.a, g.b + h.b};
    }

    // Adds the Newton step of the `free` strings for gradient_ to x_.
    void step(unsigned free) noexcept {
        const Row mask = Row::strings(free);
        const Row g{gradient_.a & mask.a, gradient_.b & mask.b};
        const Row product = table_.times(g);
        const Row d{product.a & mask.a, product.b & mask.b};
        const Row x = Row::load(x_);
        Row{x.a + d.a, x.b + d.b}.store(x_);
        largest_step_ = Four::max(d.a.absolute(), d.b.absolute()).largest();
    }

    // Pivots until every string of the table is within its range: the tension of a free string, the
    // slope of a held one. Returns false when a pivot cancels or the passes run out.
    bool settle(int &passes) noexcept {
        const Row lower = Row::load(p_.lower_n.data());
        const Row upper = Row::load(p_.upper_n.data());
        const Four tolerance = Four::all(kTableTolerance);
        {
            const Row x = Row::load(x_);
            const Row mask = Row::strings(free_);
            const Four out_a = Four::max(lower.a - x.a, x.a - upper.a);
            const Four out_b = Four::max(lower.b - x.b, x.b - upper.b);
            if (Row::bits((tolerance < out_a) & mask.a, (tolerance < out_b) & mask.b) == 0) {
                return true; // usual end of a warm tick
            }
            const double condition = stiffness_ * table_.softest(mask);
            contraction_ = kTableRounding * condition * condition;
            const Four open = Four::all(kOpen);
            const Four shut = Four::all(-kOpen);
            Row{Four::select(mask.a, lower.a, shut), Four::select(mask.b, lower.b, shut)}.store(
                least_);
            Row{Four::select(mask.a, upper.a, open), Four::select(mask.b, upper.b, open)}.store(
                most_);
            x.store(y_);
        }
        held_in_table_ = 0;
        for (int pass = 0; pass < kPasses; ++pass) {
            const Row y = Row::load(y_);
            const Row least = Row::load(least_);
            const Row most = Row::load(most_);
            unsigned out = Row::bits(tolerance < Four::max(least.a - y.a, y.a - most.a),
                                     tolerance < Four::max(least.b - y.b, y.b - most.b));
            if (out == 0) {
                const Row mask = Row::strings(held_in_table_);
                const Row x = Row::load(x_);
                Row{Four::select(mask.a, x.a, y.a), Four::select(mask.b, x.b, y.b)}.store(x_);
                return true;
            }
            ++passes;
            if (pass >= kBlockPasses) {
                unsigned last = out;
                for (; (last & (last - 1U)) != 0; last &= last - 1U) {
                }
                out = last;
            }
            for (; out != 0; out &= out - 1U) {
                const auto c = static_cast<std::size_t>(__builtin_ctz(out));
                if (!(y_[c] < least_[c] || y_[c] > most_[c])) {
                    continue;
                }
                if (!has(free_, c) && !(table_.at(c) > kCancelled * stiffness_)) {
                    return false;
                }
                pivot(c);
            }
        }
        return false;
    }

    // Holds string c at the bound it passed, or releases it. y_ holds the tensions of free strings
    // and the slopes of held ones.
    void pivot(std::size_t c) noexcept {
        const bool was_free = has(free_, c);
        const bool to_low = y_[c] < least_[c];
        const double inverse = 1.0 / table_.at(c);
        const double change = (to_low ? least_[c] : most_[c]) - y_[c];
        const double share = was_free ? change * inverse : -change * inverse;
        const double sign = was_free ? -1.0 : 1.0; // of T_rc' / T_rc
        const Row row = table_.row(c);
        const Row mask = Row::strings(free_);
        const Four plus = Four::all(share);
        const Four minus = Four::all(-share);
        const Row y = Row::load(y_);
        Row{Four::mul_add(row.a, Four::select(mask.a, plus, minus), y.a),
            Four::mul_add(row.b, Four::select(mask.b, plus, minus), y.b)}
            .store(y_);
        if (was_free) {
            x_[c] = to_low ? p_.lower_n[c] : p_.upper_n[c];
            y_[c] = -share;
            least_[c] = to_low ? 0.0 : -kOpen;
            most_[c] = to_low ? kOpen : 0.0;
            (to_low ? low_ : high_) |= 1U << c;
        } else {
            y_[c] = x_[c] - share;
            least_[c] = p_.lower_n[c];
            most_[c] = p_.upper_n[c];
            low_ &= ~(1U << c);
            high_ &= ~(1U << c);
        }
        free_ ^= 1U << c;
        held_in_table_ ^= 1U << c;
        table_.pivot(c, inverse, sign);
    }

    // Judges x_ after a correction whose largest element is d, from where gradient_ was computed.
    Verdict judge(double d) noexcept {
        const Row mask = Row::strings(free_);
        const double noise = kNoise * Four::max(front_.absolute(), back_.absolute()).largest();
        // A string moves by at most the gradient's noise times the largest diagonal of H^-1.
        if (!(noise * table_.softest(mask) <= kNoiseMove_n)) {
            return Verdict::in_doubt;
        }
        const Row x = Row::load(x_);
        const Row lower = Row::load(p_.lower_n.data());
        const Row upper = Row::load(p_.upper_n.data());
        const Four inside_a = (lower.a <= x.a) & (x.a <= upper.a);
        const Four inside_b = (lower.b <= x.b) & (x.b <= upper.b);
        if (Row::bits(inside_a, inside_b) != 0xFFU) {
            return Verdict::in_doubt;
        }
        // rise: slope of each held string, positive when its bound is right. |H d| <= trace(H) d.
        const double slack = noise + stiffness_ * d;
        const Row at_high = Row::strings(high_);
        const Four zero = Four::all(0.0);
        const Four rise_a = Four::select(at_high.a, zero - gradient_.a, gradient_.a);
        const Four rise_b = Four::select(at_high.b, zero - gradient_.b, gradient_.b);
        const unsigned held = movable_ & ~free_;
        const Four slack_all = Four::all(slack);
        const unsigned right = Row::bits(slack_all < rise_a, slack_all < rise_b);
        if ((held & ~right) == 0) {
            return Verdict::optimal;
        }
        const Four minus = Four::all(-slack);
        wrong_ = held & Row::bits(rise_a < minus, rise_b < minus);
        if (wrong_ != 0) {
            return Verdict::release;
        }
        return d > kStep_n ? Verdict::correct_again : Verdict::in_doubt;
    }

    // Writes the solution. Returns false where squares would overflow.
    bool report(int iterations, TensionSolution &solution) const noexcept {
        Row::load(x_).store(solution.tensions_n.data());
        solution.active = active_set(low_, high_);
        solution.largest_error_n = Four::max(front_.absolute(), back_.absolute()).largest();
        solution.iterations = iterations;
        solution.status = Status::ok;
        return solution.largest_error_n < kLargestForce_n;
    }

    const TensionProblem &p_;
    const WrenchMatrix &matrix_;
    const PaperWrench &wrench_;
    alignas(32) double rows_[kFastDofs][kFastStrings]; // R, by DOF
    alignas(32) double x_[kFastStrings];
    alignas(32) double y_[kFastStrings];
    alignas(32) double least_[kFastStrings];
    alignas(32) double most_[kFastStrings];
    SweepTable<Four> table_;
    Row gradient_{};
    Four front_{}; // W (A x - q) where gradient_ was taken
    Four back_{};
    double largest_step_ = 0.0;
    double stiffness_ = 0.0;   // trace of H
    double contraction_ = 0.0; // worst contraction of the corrections; 0 when no pivot was made
    unsigned movable_ = 0;     // strings with lower < upper
    unsigned low_ = 0;         // held at the lower bound
    // Held at the upper bound.
    unsigned high_ = 0;
    unsigned free_ = 0;
    unsigned held_in_table_ = 0;
    unsigned wrong_ = 0; // held with a slope of the wrong sign
};

} // namespace

} // namespace spidar
