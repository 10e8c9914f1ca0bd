// The symmetric table of principal pivots: H swept on the free strings F, for one vector type,
//   T_FF = -H_FF^-1,  T_FB = H_FF^-1 H_FB,  T_BB = H_BB - H_BF H_FF^-1 H_FB.
// See fast_tension_kernel.h.
#pragma once

#include "core/tension/fast/fast_tension_limits.h"

namespace spidar {

inline constexpr std::uint64_t kOn = ~std::uint64_t{0};
alignas(32) inline constexpr std::uint64_t kLanes[16][4] = {
    {0, 0, 0, 0},     {kOn, 0, 0, 0},     {0, kOn, 0, 0},     {kOn, kOn, 0, 0},
    {0, 0, kOn, 0},   {kOn, 0, kOn, 0},   {0, kOn, kOn, 0},   {kOn, kOn, kOn, 0},
    {0, 0, 0, kOn},   {kOn, 0, 0, kOn},   {0, kOn, 0, kOn},   {kOn, kOn, 0, kOn},
    {0, 0, kOn, kOn}, {kOn, 0, kOn, kOn}, {0, kOn, kOn, kOn}, {kOn, kOn, kOn, kOn}};

namespace { // one copy per source, for its own target

// One value per string.
template <class Four>
struct StringRow {
    Four a{}; // strings 0-3
    Four b{}; // strings 4-7
    static StringRow load(const double *p) noexcept { return {Four::load(p), Four::load(p + 4)}; }
    void store(double *p) const noexcept {
        a.store(p);
        b.store(p + 4);
    }
    // Returns the lane mask of the lowest four bits.
    static Four lanes(unsigned four) noexcept {
        return Four::load(reinterpret_cast<const double *>(kLanes[four & 15U]));
    }
    // Returns the lane masks of eight bits.
    static StringRow strings(unsigned mask) noexcept { return {lanes(mask), lanes(mask >> 4U)}; }
    // Returns the eight bits of two lane masks.
    static unsigned bits(Four a, Four b) noexcept { return a.bits() | (b.bits() << 4U); }
};

// Bounds and target of a problem, read from the problem itself.
template <class Four>
struct BoundRows {
    using Row = StringRow<Four>;
    Row lower;
    Row upper;
    Row target;

    explicit BoundRows(const TensionProblem &problem) noexcept
        : lower(Row::load(problem.lower_n.data())), upper(Row::load(problem.upper_n.data())),
          target(Row::load(problem.proximal_target_n.data())) {}

    // False when a lower bound exceeds its upper bound or a value is not finite or above kLargest.
    [[nodiscard]] bool sound() const noexcept {
        const Four most = Four::all(kLargest);
        const Four size_a = lower.a.absolute() + upper.a.absolute() + target.a.absolute();
        const Four size_b = lower.b.absolute() + upper.b.absolute() + target.b.absolute();
        return Row::bits((lower.a <= upper.a) & (size_a <= most),
                         (lower.b <= upper.b) & (size_b <= most)) == 0xFFU;
    }
    // Returns the strings whose bounds differ.
    [[nodiscard]] unsigned movable() const noexcept {
        return Row::bits(lower.a < upper.a, lower.b < upper.b);
    }
};

template <class Four>
class SweepTable {
public:
    using Row = StringRow<Four>;

    // Row of R for one DOF, read by invert(). It must be zero for strings outside the table.
    [[nodiscard]] double *rows(std::size_t dof) noexcept { return rows_[dof]; }
    // Sets R for the strings of `table`.
    void set_rows(const double (&rows)[kFastDofs][kFastStrings], unsigned table) noexcept {
        const Row mask = Row::strings(table);
        for (std::size_t k = 0; k < kFastDofs; ++k) {
            const Row r = Row::load(rows[k]);
            Row{r.a & mask.a, r.b & mask.b}.store(rows_[k]);
        }
    }

    // Computes the table of H swept on `table`: -H^-1 there, unit rows elsewhere.
    void invert(double weight, unsigned table) noexcept {
        const Row mask = Row::strings(table);
        const auto &m = rows_;
        const Four w = Four::all(weight);
        const Four one = Four::all(1.0);
        const Row diagonal{Four::select(mask.a, w, one), Four::select(mask.b, w, one)};
        Row t[kFastStrings];
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            const Four own = Row::lanes(1U << (i & 3U));
            t[i].a = i < 4 ? diagonal.a & own : Four::all(0.0);
            t[i].b = i < 4 ? Four::all(0.0) : diagonal.b & own;
        }
        // The lower left quarter is the transpose of the upper right one, filled in when needed.
#pragma GCC unroll 2
        for (std::size_t i = 0; i < 4; i += 2) {
#pragma GCC unroll 7
            for (std::size_t k = 0; k < kFastDofs; ++k) {
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
        for (std::size_t k = 0; k < kFastDofs; ++k) {
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
#pragma GCC unroll 8 // otherwise the rows go through memory twice
        for (std::size_t i = 0; i < kFastStrings; ++i) {
            t[i].store(table_[i]);
        }
    }

    // Sweeps string c. sign: -1 when c was swept before (free), +1 when not. inverse: 1 / at(c).
    void pivot(std::size_t c, double inverse, double sign) noexcept {
        const Row row = Row::load(table_[c]);
        const Row own = Row::strings(1U << c);
        const Row others = Row::strings(0xFFU & ~(1U << c));
        const Four inv = Four::all(inverse);
        // Column c becomes sign T_cr / T_cc, like row c. It is computed afresh, since the
        // difference of T_rc and T_cr (1 - sign / T_cc) would be rounding alone where T_cc is
        // large.
        const Four corner = Four::all(-sign * inverse);
        const Row w{Four::select(own.a, corner, row.a * inv),
                    Four::select(own.b, corner, row.b * inv)};
        alignas(32) double entries[kFastStrings];
        row.store(entries);
        for (std::size_t r = 0; r < kFastStrings; ++r) {
            const Four e = Four::all(entries[r]);
            const Row t = Row::load(table_[r]);
            Row{Four::sub_mul(e, w.a, t.a & others.a), Four::sub_mul(e, w.b, t.b & others.b)}.store(
                table_[r]);
        }
        const Four signed_inverse = Four::all(sign * inverse);
        const Four pivot_entry = Four::all(-inverse);
        Row{Four::select(own.a, pivot_entry, row.a * signed_inverse),
            Four::select(own.b, pivot_entry, row.b * signed_inverse)}
            .store(table_[c]);
    }

    [[nodiscard]] double at(std::size_t c) const noexcept {
        return table_[c][c];
    }
    [[nodiscard]] Row row(std::size_t c) const noexcept {
        return Row::load(table_[c]);
    }
    // Smallest determinant of the pairs that invert() swept.
    [[nodiscard]] double smallest_pivot() const noexcept {
        return smallest_pivot_;
    }

    // Largest absolute diagonal element within the mask.
    [[nodiscard]] double softest(const Row &mask) const noexcept {
        Four a = Four::load(table_[0]);
        a = a.template with_lane<1>(Four::load(table_[1]));
        a = a.template with_lane<2>(Four::load(table_[2]));
        a = a.template with_lane<3>(Four::load(table_[3]));
        Four b = Four::load(table_[4] + 4);
        b = b.template with_lane<1>(Four::load(table_[5] + 4));
        b = b.template with_lane<2>(Four::load(table_[6] + 4));
        b = b.template with_lane<3>(Four::load(table_[7] + 4));
        return Four::max(a.absolute() & mask.a, b.absolute() & mask.b).largest();
    }

    // Returns T g.
    [[nodiscard]] Row times(const Row &g) const noexcept {
        Row even{Four::all(0.0), Four::all(0.0)};
        Row odd = even;
        add_table<0, 0>(g.a, even, odd);
        add_table<2, 2>(g.a, even, odd);
        add_table<4, 0>(g.b, even, odd);
        add_table<6, 2>(g.b, even, odd);
        return {even.a + odd.a, even.b + odd.b};
    }

private:
    template <int kPair>
    static Four &half(Row &r) noexcept {
        return kPair < 4 ? r.a : r.b;
    }

    // Rows kPair and kPair + 1 before the sweep (p, q), and adj(T_PP) T_PR (u, v), which the other
    // rows lose.
    struct Sweep {
        Row p;
        Row q;
        Row u;
        Row v;
        Four inverse; // 1 / determinant of the pair
    };

    // Sweeps rows kPair and kPair + 1 together: T_RR - T_RP adj(T_PP) T_PR / det. The products do
    // not wait for 1 / det.
    template <int kPair>
    static void sweep_pair(Row (&t)[kFastStrings], Four &smallest) noexcept {
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
        sweep_rows<kPair>(t, {p, q, u, v, inverse}, std::make_integer_sequence<int, 6>());
        t[kPair] = {inverse * u.a, inverse * u.b};
        t[kPair + 1] = {inverse * v.a, inverse * v.b};
    }

    // Sweeps the other six rows. The rows of the next pair come first, so that the next division
    // need not wait for the rest.
    template <int kPair, int... kStep>
    static void sweep_rows(Row (&t)[kFastStrings], const Sweep &sweep,
                           std::integer_sequence<int, kStep...>) noexcept {
        (sweep_row<kPair, (kPair + 2 + kStep) & 7>(t[(kPair + 2 + kStep) & 7], sweep), ...);
    }

    template <int kPair, int kRow>
    static void sweep_row(Row &row, const Sweep &sweep) noexcept {
        constexpr int kLane = kPair & 3;
        const auto &[p, q, u, v, inverse] = sweep;
        if constexpr (kPair < 4 &&
                      kRow >= 4) { // the lower left quarter is not filled yet: T_rP = T_Pr
            const Four x = p.b.template lane<kRow & 3>();
            const Four y = q.b.template lane<kRow & 3>();
            row.b = Four::sub_mul(inverse, Four::mul_add(x, u.b, y * v.b), row.b);
        } else {
            const Four x = half<kPair>(row).template lane<kLane>();
            const Four y = half<kPair>(row).template lane<kLane + 1>();
            half<kPair>(row) = half<kPair>(row).template without_pair<kLane>();
            row.a = Four::sub_mul(inverse, Four::mul_add(x, u.a, y * v.a), row.a);
            row.b = Four::sub_mul(inverse, Four::mul_add(x, u.b, y * v.b), row.b);
        }
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

    alignas(32) double rows_[kFastDofs][kFastStrings];
    alignas(32) double table_[kFastStrings][kFastStrings];
    double smallest_pivot_ = 0.0;
};

} // namespace

} // namespace spidar
