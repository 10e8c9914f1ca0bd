// The fast path itself, for one vector type; included by the sources that compile it, each for its own target.
//
//   min ||R x - W q||^2 + w |x - t|^2,  lower <= x <= upper,   R = W A (7 x 8), H = R'R + w I
//
// 1. H is inverted on the strings taken as free by four symmetric 2 x 2 block pivots (the sweep operator), the
//    division of each off the critical path. Held strings have a unit row and column.
// 2. Principal pivots on that table bound and release strings until every tension is within its bounds and every
//    slope at a bound has the right sign: one rank-1 update each.
// 3. Newton corrections with the gradient taken from A itself. They are the certificate too: the tensions still
//    free, the slopes of all held strings (those outside the table as well) and the rounding of the gradient are
//    checked; a string held wrongly goes back to 1, anything in doubt is left to the exact search.
#pragma once

namespace spidar {
namespace {

// A correction shorter than this ends them. Longer ones do when the contraction seen, correction over first step,
// leaves less than kLeft_n for the next.
constexpr double kStep_n = 1e-13;
constexpr double kLeft_n = 1e-14;
constexpr double kShort_n = 1e-8; // not longer than this, whatever the contraction
constexpr int kCorrections = 4;
// Rounding of the gradient as a share of the largest force that cancels in it, and how far it may move a string.
constexpr double kNoise = 2e-15;
constexpr double kNoiseMove_n = 4e-12;
// What the table (about 1e-9 N at w = 1e-6) cannot tell from zero.
constexpr double kTableTolerance = 1e-9;
// Pivots of the table that are a smaller share of the mean diagonal of H (its square for pairs) have lost more digits
// than the corrections can make good: they would contract too slowly to tell convergence from standstill.
constexpr double kCancelled = 1e-10;
// Passes over all violated strings; then one at a time, the last first (Murty), which cannot cycle.
constexpr int kBlockPasses = 4;
constexpr int kPasses = 24;
constexpr int kTables = 4; // inversions; a warm start seldom needs a second
constexpr double kLargest = 1e12;
constexpr double kOpen = 1e300;

constexpr std::size_t kStrings = 8;
constexpr std::size_t kDofs = 7;
constexpr std::uint64_t kOn = ~std::uint64_t{0};
alignas(32) constexpr std::uint64_t kLanes[16][4] = {
    {0, 0, 0, 0},     {kOn, 0, 0, 0},     {0, kOn, 0, 0},     {kOn, kOn, 0, 0},
    {0, 0, kOn, 0},   {kOn, 0, kOn, 0},   {0, kOn, kOn, 0},   {kOn, kOn, kOn, 0},
    {0, 0, 0, kOn},   {kOn, 0, 0, kOn},   {0, kOn, 0, kOn},   {kOn, kOn, 0, kOn},
    {0, 0, kOn, kOn}, {kOn, 0, kOn, kOn}, {0, kOn, kOn, kOn}, {kOn, kOn, kOn, kOn}};

template <class Four>
class FastTension {
public:
    explicit FastTension(const TensionProblem &problem) noexcept : p_(problem) {}

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
            invert(table);
            const double mean = stiffness_ * 0.125;
            if (!(smallest_pivot_ > kCancelled * mean * mean)) {
                return false;
            }
            step(table);
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
                step(free_);
                const double d = largest_step_;
                if (getenv("DBG"))
                    printf("table %x free %x inv %d corr %d before %g d %g soft %g g %g %g\n",
                           table, free_, inversions, correction, before, d, -table_[0][0],
                           gradient_.a.largest(), gradient_.b.largest());
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
    struct Row { // one value a string
        Four a, b;
        static Row load(const double *p) noexcept { return {Four::load(p), Four::load(p + 4)}; }
        void store(double *p) const noexcept {
            a.store(p);
            b.store(p + 4);
        }
    };
    enum class Verdict { optimal, correct_again, release, in_doubt };

    static Four lanes(unsigned four) noexcept {
        return Four::load(reinterpret_cast<const double *>(kLanes[four & 15U]));
    }
    static Row strings(unsigned mask) noexcept { return {lanes(mask), lanes(mask >> 4U)}; }
    static unsigned bits(Four a, Four b) noexcept { return a.bits() | (b.bits() << 4U); }
    static bool has(unsigned mask, std::size_t string) noexcept {
        return ((mask >> string) & 1U) != 0U;
    }

    // Bounds, target, start and R. False for bounds in disorder or nothing finite.
    bool read(const ActiveSet *warm) noexcept {
        const Row lower = Row::load(p_.lower_n.data());
        const Row upper = Row::load(p_.upper_n.data());
        const Row target = Row::load(p_.proximal_target_n.data());
        const Four most = Four::all(kLargest);
        const Four size_a = lower.a.absolute() + upper.a.absolute() + target.a.absolute();
        const Four size_b = lower.b.absolute() + upper.b.absolute() + target.b.absolute();
        const Four fine_a = (lower.a <= upper.a) & (size_a <= most);
        const Four fine_b = (lower.b <= upper.b) & (size_b <= most);
        if (bits(fine_a, fine_b) != 0xFFU || !(p_.proximal_weight > 0.0)) {
            return false;
        }
        movable_ = bits(lower.a < upper.a, lower.b < upper.b);
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
        const Row at_low = strings(low_);
        const Row at_high = strings(high_);
        const Four start_a = Four::min(Four::max(target.a, lower.a), upper.a);
        const Four start_b = Four::min(Four::max(target.b, lower.b), upper.b);
        Row{Four::select(at_low.a, lower.a, Four::select(at_high.a, upper.a, start_a)),
            Four::select(at_low.b, lower.b, Four::select(at_high.b, upper.b, start_b))}
            .store(x_);
        read_half(0);
        read_half(4);
        stiffness_ = trace();
        return true;
    }

    void read_half(std::size_t first) noexcept {
        Four c0 = Four::load(&p_.matrix.columns[first][0]);
        Four c1 = Four::load(&p_.matrix.columns[first + 1][0]);
        Four c2 = Four::load(&p_.matrix.columns[first + 2][0]);
        Four c3 = Four::load(&p_.matrix.columns[first + 3][0]);
        Four d0 = Four::load(&p_.matrix.columns[first][3]);
        Four d1 = Four::load(&p_.matrix.columns[first + 1][3]);
        Four d2 = Four::load(&p_.matrix.columns[first + 2][3]);
        Four d3 = Four::load(&p_.matrix.columns[first + 3][3]);
        Four::transpose(c0, c1, c2, c3);
        Four::transpose(d0, d1, d2, d3);
        const DofArray &w = p_.weights;
        (c0 * Four::all(w[0])).store(&rows_[0][first]);
        (c1 * Four::all(w[1])).store(&rows_[1][first]);
        (c2 * Four::all(w[2])).store(&rows_[2][first]);
        (c3 * Four::all(w[3])).store(&rows_[3][first]);
        (d1 * Four::all(w[4])).store(&rows_[4][first]);
        (d2 * Four::all(w[5])).store(&rows_[5][first]);
        (d3 * Four::all(w[6])).store(&rows_[6][first]);
    }

    // Two strings' share of A x.
    template <int kFirst, int kLane>
    void add_columns(Four x, Four &f0, Four &f1, Four &b0, Four &b1) const noexcept {
        const Four x0 = x.template lane<kLane>();
        const Four x1 = x.template lane<kLane + 1>();
        f0 = Four::mul_add(Four::load(&p_.matrix.columns[kFirst][0]), x0, f0);
        f1 = Four::mul_add(Four::load(&p_.matrix.columns[kFirst + 1][0]), x1, f1);
        b0 = Four::mul_add(Four::load(&p_.matrix.columns[kFirst][3]), x0, b0);
        b1 = Four::mul_add(Four::load(&p_.matrix.columns[kFirst + 1][3]), x1, b1);
    }

    // Two DOF's share of R'f.
    template <int kFirst, int kLane>
    void add_rows(Four force, Row &g, Row &h) const noexcept {
        const Four even = force.template lane<kLane>();
        const Four odd = force.template lane<kLane + 1>();
        g.a = Four::mul_add(Four::load(&rows_[kFirst][0]), even, g.a);
        g.b = Four::mul_add(Four::load(&rows_[kFirst][4]), even, g.b);
        h.a = Four::mul_add(Four::load(&rows_[kFirst + 1][0]), odd, h.a);
        h.b = Four::mul_add(Four::load(&rows_[kFirst + 1][4]), odd, h.b);
    }

    // Half the gradient at x_, every string, from A itself.
    void gradient() noexcept {
        const Row x = Row::load(x_);
        Four f0 = Four::all(0.0) - Four::load(&p_.wrench[0]);
        Four f1 = Four::all(0.0);
        Four b0 = Four::all(0.0) - Four::load(&p_.wrench[3]);
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

    // The table of H swept on `table`: -H^-1 there, unit rows elsewhere.
    void invert(unsigned table) noexcept {
        const Row mask = strings(table);
        alignas(32) double m[kDofs][kStrings];
        for (std::size_t k = 0; k < kDofs; ++k) {
            const Row r = Row::load(rows_[k]);
            Row{r.a & mask.a, r.b & mask.b}.store(m[k]);
        }
        const Four w = Four::all(p_.proximal_weight);
        const Four one = Four::all(1.0);
        const Row diagonal{Four::select(mask.a, w, one), Four::select(mask.b, w, one)};
        Row t[kStrings];
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kStrings; ++i) {
            const Four own = lanes(1U << (i & 3U));
            t[i].a = i < 4 ? diagonal.a & own : Four::all(0.0);
            t[i].b = i < 4 ? Four::all(0.0) : diagonal.b & own;
        }
        // The lower left quarter is the upper right one turned over: it is left out until a pivot row needs it.
#pragma GCC unroll 2
        for (std::size_t i = 0; i < 4; i += 2) {
#pragma GCC unroll 7
            for (std::size_t k = 0; k < kDofs; ++k) {
                const Row r = Row::load(m[k]);
                const Four u = Four::all(m[k][i]);
                const Four v = Four::all(m[k][i + 1]);
                t[i].a = Four::mul_add(r.a, u, t[i].a);
                t[i].b = Four::mul_add(r.b, u, t[i].b);
                t[i + 1].a = Four::mul_add(r.a, v, t[i + 1].a);
                t[i + 1].b = Four::mul_add(r.b, v, t[i + 1].b);
            }
        }
#pragma GCC unroll 7
        for (std::size_t k = 0; k < kDofs; ++k) {
            const Four r = Four::load(&m[k][4]);
            t[4].b = Four::mul_add(r, Four::all(m[k][4]), t[4].b);
            t[5].b = Four::mul_add(r, Four::all(m[k][5]), t[5].b);
            t[6].b = Four::mul_add(r, Four::all(m[k][6]), t[6].b);
            t[7].b = Four::mul_add(r, Four::all(m[k][7]), t[7].b);
        }
        Four smallest = Four::all(kLargest);
        sweep_pair<0>(t, smallest);
        sweep_pair<2>(t, smallest);
        t[4].a = t[0].b;
        t[5].a = t[1].b;
        t[6].a = t[2].b;
        t[7].a = t[3].b;
        Four::transpose(t[4].a, t[5].a, t[6].a, t[7].a);
        sweep_pair<4>(t, smallest);
        sweep_pair<6>(t, smallest);
        smallest_pivot_ = smallest.first();
        for (std::size_t i = 0; i < kStrings; ++i) {
            t[i].store(table_[i]);
        }
    }

    template <int kPair>
    static Four &half(Row &r) noexcept {
        return kPair < 4 ? r.a : r.b;
    }

    // Sweeps rows kPair and kPair + 1 together. T_RR - T_RP adj(T_PP) T_PR / det: the products do not wait for 1 / det.
    template <int kPair>
    static void sweep_pair(Row (&t)[kStrings], Four &smallest) noexcept {
        constexpr int kLane = kPair & 3;
        const Row p = t[kPair];
        const Row q = t[kPair + 1];
        const Four a = half<kPair>(t[kPair]).template lane<kLane>();
        const Four b = half<kPair>(t[kPair]).template lane<kLane + 1>();
        const Four c = half<kPair>(t[kPair + 1]).template lane<kLane + 1>();
        const Four determinant = Four::sub_mul(b, b, a * c);
        const Four inverse = Four::all(1.0) / determinant;
        smallest = Four::min(smallest, determinant);
        const Four zero = Four::all(0.0);
        Row u{Four::sub_mul(b, q.a, c * p.a), Four::sub_mul(b, q.b, c * p.b)};
        Row v{Four::sub_mul(b, p.a, a * q.a), Four::sub_mul(b, p.b, a * q.b)};
        half<kPair>(u) = half<kPair>(u).template with_pair<kLane>(zero - c, b);
        half<kPair>(v) = half<kPair>(v).template with_pair<kLane>(b, zero - a);
#pragma GCC unroll 8
        for (int r = 0; r < 8; ++r) {
            if (r == kPair || r == kPair + 1 || (kPair < 4 && r >= 4)) {
                continue;
            }
            const Four x = half<kPair>(t[r]).template lane<kLane>();
            const Four y = half<kPair>(t[r]).template lane<kLane + 1>();
            half<kPair>(t[r]) = half<kPair>(t[r]).template with_pair<kLane>(zero, zero);
            t[r].a = Four::sub_mul(inverse, Four::mul_add(x, u.a, y * v.a), t[r].a);
            t[r].b = Four::sub_mul(inverse, Four::mul_add(x, u.b, y * v.b), t[r].b);
        }
        if (kPair < 4) { // T_rP = T_Pr
            sweep_lower<0>(t[4].b, p.b, q.b, u.b, v.b, inverse);
            sweep_lower<1>(t[5].b, p.b, q.b, u.b, v.b, inverse);
            sweep_lower<2>(t[6].b, p.b, q.b, u.b, v.b, inverse);
            sweep_lower<3>(t[7].b, p.b, q.b, u.b, v.b, inverse);
        }
        t[kPair] = {inverse * u.a, inverse * u.b};
        t[kPair + 1] = {inverse * v.a, inverse * v.b};
    }

    template <int kLane>
    static void sweep_lower(Four &row, Four p, Four q, Four u, Four v, Four inverse) noexcept {
        const Four x = p.template lane<kLane>();
        const Four y = q.template lane<kLane>();
        row = Four::sub_mul(inverse, Four::mul_add(x, u, y * v), row);
    }

    template <int kFirst, int kLane>
    void add_table(Four g, Row &even, Row &odd) const noexcept {
        const Four u = g.template lane<kLane>();
        const Four v = g.template lane<kLane + 1>();
        even.a = Four::mul_add(Four::load(&table_[kFirst][0]), u, even.a);
        even.b = Four::mul_add(Four::load(&table_[kFirst][4]), u, even.b);
        odd.a = Four::mul_add(Four::load(&table_[kFirst + 1][0]), v, odd.a);
        odd.b = Four::mul_add(Four::load(&table_[kFirst + 1][4]), v, odd.b);
    }

    // x_ += Newton step of the `free` strings from gradient_.
    void step(unsigned free) noexcept {
        const Row mask = strings(free);
        const Row g{gradient_.a & mask.a, gradient_.b & mask.b};
        Row even{Four::all(0.0), Four::all(0.0)};
        Row odd = even;
        add_table<0, 0>(g.a, even, odd);
        add_table<2, 2>(g.a, even, odd);
        add_table<4, 0>(g.b, even, odd);
        add_table<6, 2>(g.b, even, odd);
        const Row d{(even.a + odd.a) & mask.a, (even.b + odd.b) & mask.b};
        gain_ =
            Four::mul_add(g.a, d.a, g.b * d.b); // g'd is what the objective changes by: H d = -g
        const Row x = Row::load(x_);
        where_ = x;
        Row{x.a + d.a, x.b + d.b}.store(x_);
        largest_step_ = Four::max(d.a.absolute(), d.b.absolute()).largest();
    }

    // Pivots until all strings of the table are within their ranges: tensions of the free ones, slopes of the held.
    bool settle(int &passes) noexcept {
        const Row lower = Row::load(p_.lower_n.data());
        const Row upper = Row::load(p_.upper_n.data());
        const Four tolerance = Four::all(kTableTolerance);
        {
            const Row x = Row::load(x_);
            const Row mask = strings(free_);
            const Four out_a = Four::max(lower.a - x.a, x.a - upper.a);
            const Four out_b = Four::max(lower.b - x.b, x.b - upper.b);
            if (bits((tolerance < out_a) & mask.a, (tolerance < out_b) & mask.b) == 0) {
                return true; // the usual case of a warm tick
            }
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
            unsigned out = bits(tolerance < Four::max(least.a - y.a, y.a - most.a),
                                tolerance < Four::max(least.b - y.b, y.b - most.b));
            if (out == 0) {
                const Row mask = strings(held_in_table_);
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
                if (!has(free_, c) && !(table_[c][c] > kCancelled * stiffness_)) {
                    return false;
                }
                pivot(c);
            }
        }
        return false;
    }

    // Holds string c at the bound it passed, or releases it; y_ holds tensions of free, slopes of held strings.
    void pivot(std::size_t c) noexcept {
        const bool was_free = has(free_, c);
        const bool to_low = y_[c] < least_[c];
        const double inverse = 1.0 / table_[c][c];
        const double change = (to_low ? least_[c] : most_[c]) - y_[c];
        const double share = was_free ? change * inverse : -change * inverse;
        const double sign = was_free ? -1.0 : 1.0; // of T_rc' / T_rc
        const Row row = Row::load(table_[c]);
        const Row mask = strings(free_);
        const Row own = strings(1U << c);
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
        const Four inv = Four::all(inverse);
        // Its own element is set so that the update leaves sign T_rc / T_cc in column c.
        const Four corner = Four::all(1.0 - sign * inverse);
        const Row w{Four::select(own.a, corner, row.a * inv),
                    Four::select(own.b, corner, row.b * inv)};
        alignas(32) double entries[kStrings];
        row.store(entries);
        for (std::size_t r = 0; r < kStrings; ++r) {
            const Four e = Four::all(entries[r]);
            const Row t = Row::load(table_[r]);
            Row{Four::sub_mul(e, w.a, t.a), Four::sub_mul(e, w.b, t.b)}.store(table_[r]);
        }
        const Four signed_inverse = Four::all(sign * inverse);
        const Four pivot_entry = Four::all(-inverse);
        Row{Four::select(own.a, pivot_entry, row.a * signed_inverse),
            Four::select(own.b, pivot_entry, row.b * signed_inverse)}
            .store(table_[c]);
    }

    // After a correction by d (largest) from where gradient_ was taken.
    Verdict judge(double d) noexcept {
        const Row mask = strings(free_);
        // The largest element of H^-1 on the free strings: the noise of the gradient times it moves a string.
        Four diagonal_a = Four::load(table_[0]);
        diagonal_a = Four::select(lanes(2), Four::load(table_[1]), diagonal_a);
        diagonal_a = Four::select(lanes(4), Four::load(table_[2]), diagonal_a);
        diagonal_a = Four::select(lanes(8), Four::load(table_[3]), diagonal_a);
        Four diagonal_b = Four::load(table_[4] + 4);
        diagonal_b = Four::select(lanes(2), Four::load(table_[5] + 4), diagonal_b);
        diagonal_b = Four::select(lanes(4), Four::load(table_[6] + 4), diagonal_b);
        diagonal_b = Four::select(lanes(8), Four::load(table_[7] + 4), diagonal_b);
        const double softest =
            Four::max(diagonal_a.absolute() & mask.a, diagonal_b.absolute() & mask.b).largest();
        const double noise = kNoise * Four::max(front_.absolute(), back_.absolute()).largest();
        if (!(noise * softest <= kNoiseMove_n)) {
            return Verdict::in_doubt;
        }
        const Row x = Row::load(x_);
        const Row lower = Row::load(p_.lower_n.data());
        const Row upper = Row::load(p_.upper_n.data());
        const Four inside_a = (lower.a <= x.a) & (x.a <= upper.a);
        const Four inside_b = (lower.b <= x.b) & (x.b <= upper.b);
        if (bits(inside_a, inside_b) != 0xFFU) {
            return Verdict::in_doubt;
        }
        // Slopes of held strings, positive when the bound is right; |H d| is at most its trace times d.
        const double slack = noise + stiffness_ * d;
        const Row at_high = strings(high_);
        const Four zero = Four::all(0.0);
        const Four rise_a = Four::select(at_high.a, zero - gradient_.a, gradient_.a);
        const Four rise_b = Four::select(at_high.b, zero - gradient_.b, gradient_.b);
        const unsigned held = movable_ & ~free_;
        const Four slack_all = Four::all(slack);
        const unsigned right = bits(slack_all < rise_a, slack_all < rise_b);
        if ((held & ~right) == 0) {
            return Verdict::optimal;
        }
        const Four minus = Four::all(-slack);
        wrong_ = held & bits(rise_a < minus, rise_b < minus);
        if (wrong_ != 0) {
            return Verdict::release;
        }
        return d > kStep_n ? Verdict::correct_again : Verdict::in_doubt;
    }

    // Trace of H: a bound on its largest element and eigenvalue.
    [[nodiscard]] double trace() const noexcept {
        Four even = Four::all(0.0);
        Four odd = even;
        for (const auto &row : rows_) {
            const Row r = Row::load(row);
            even = Four::mul_add(r.a, r.a, even);
            odd = Four::mul_add(r.b, r.b, odd);
        }
        return (even + odd).sum() + 8.0 * p_.proximal_weight;
    }

    // Bit i to the lowest bit of byte i.
    static std::uint64_t spread(unsigned mask) noexcept {
        const std::uint64_t copies = (mask & 0xFFU) * std::uint64_t{0x0101010101010101};
        const std::uint64_t picked = copies & 0x8040201008040201ULL;
        return ((picked + 0x7F7F7F7F7F7F7F7FULL) >> 7U) & 0x0101010101010101ULL;
    }

    // False when the objective overflows.
    bool report(int iterations, TensionSolution &solution) const noexcept {
        Row::load(x_).store(solution.tensions_n.data());
        solution.active = std::bit_cast<ActiveSet>(spread(low_) | (spread(high_) << 1U));
        const Four back = back_ & lanes(14); // DOF 3 is in both
        const Row x = where_;
        const Row t = Row::load(p_.proximal_target_n.data());
        const Four da = x.a - t.a;
        const Four db = x.b - t.b;
        const Four squares = Four::mul_add(front_, front_, back * back);
        const Four away = Four::mul_add(da, da, db * db);
        solution.objective =
            (Four::mul_add(away, Four::all(p_.proximal_weight), squares) + gain_).sum();
        solution.iterations = iterations;
        solution.status = Status::ok;
        return solution.objective < kOpen;
    }

    const TensionProblem &p_;
    alignas(32) double rows_[kDofs][kStrings]; // R, by DOF
    alignas(32) double table_[kStrings][kStrings];
    alignas(32) double x_[kStrings];
    alignas(32) double y_[kStrings];
    alignas(32) double least_[kStrings];
    alignas(32) double most_[kStrings];
    Row gradient_{};
    Row where_{};  // x_ before the last step
    Four front_{}; // W (A x - q) where gradient_ was taken
    Four back_{};
    Four gain_{}; // g'd of the last step
    double largest_step_ = 0.0;
    double stiffness_ = 0.0; // trace of H
    double smallest_pivot_ = 0.0;
    unsigned movable_ = 0; // lower < upper
    unsigned low_ = 0;     // held at the lower bound
    unsigned high_ = 0;
    unsigned free_ = 0;
    unsigned held_in_table_ = 0;
    unsigned wrong_ = 0; // held with a slope of the wrong sign
};

} // namespace
} // namespace spidar
