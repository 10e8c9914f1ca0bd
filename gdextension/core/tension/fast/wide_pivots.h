// The second step of fast_tension_wide.h: which strings are at a bound.
#pragma once

#include "core/tension/fast/fast_tension_limits.h"

namespace spidar {

namespace { // each source compiles its own, for its own target

// Principal pivots on the table that bound and release its strings.
template <class Eight>
struct Pivoting {
    Eight table[kFastStrings];
    Eight lower;
    Eight upper;
    Eight x;
    double stiffness = 0.0; // trace of H
    unsigned free = 0;
    unsigned low = 0; // held at the lower bound
    unsigned high = 0;
    int passes = 0;

    // False at the iteration bound or where a pivot has cancelled.
    bool run() noexcept {
        const Eight tolerance = Eight::all(kTableTolerance);
        Eight least = Eight::select(free, lower, Eight::all(-kOpen));
        Eight most = Eight::select(free, upper, Eight::all(kOpen));
        Eight y = x; // tensions of free, slopes of held strings
        unsigned held_in_table = 0;
        for (int pass = 0; pass < kPasses; ++pass) {
            unsigned out = Eight::less(tolerance, Eight::max(least - y, y - most));
            if (out == 0) {
                x = Eight::select(held_in_table, x, y);
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
                const Eight row = table[c];
                const double corner = pick(row, c);
                const bool was_free = ((free >> c) & 1U) != 0U;
                if (!was_free && !(corner > kCancelled * stiffness)) {
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
                y = Eight::mul_add(row, Eight::select(free, Eight::all(share), Eight::all(-share)),
                                   y);
                if (was_free) {
                    x = Eight::select(own, Eight::all(bound), x);
                    y = Eight::select(own, Eight::all(-share), y);
                    least = Eight::select(own, Eight::all(to_low ? 0.0 : -kOpen), least);
                    most = Eight::select(own, Eight::all(to_low ? kOpen : 0.0), most);
                    (to_low ? low : high) |= own;
                } else {
                    y = Eight::select(own, x - Eight::all(share), y);
                    least = Eight::select(own, lower, least);
                    most = Eight::select(own, upper, most);
                    low &= ~own;
                    high &= ~own;
                }
                free ^= own;
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
        // Column c becomes sign T_cr / T_cc, as row c does: from nothing, since the difference of T_rc and
        // T_cr (1 - sign / T_cc) would be rounding alone where T_cc is large.
        const Eight w = Eight::select(own, Eight::all(-sign * inverse), row * Eight::all(inverse));
        alignas(64) double entries[kFastStrings];
        row.store(entries);
#pragma GCC unroll 8
        for (std::size_t r = 0; r < kFastStrings; ++r) {
            table[r] = Eight::sub_mul(Eight::all(entries[r]), w, table[r].keep(0xFFU & ~own));
        }
        table[c] = Eight::select(own, Eight::all(-inverse), row * Eight::all(sign * inverse));
    }

    static double pick(Eight v, std::size_t lane) noexcept {
        alignas(64) double all[kFastStrings];
        v.store(all);
        return all[lane];
    }
};

} // namespace

} // namespace spidar
