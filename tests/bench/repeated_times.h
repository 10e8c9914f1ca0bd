// Times of a list of problems, each tried several times: the least counts, for it was not interrupted. How every bench
// interleaves its methods: they take turns at blocks of problems, so that the machine's moods meet all alike and
// each runs with warm caches; and the whole list is gone through kRuns times.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "bench/bench_report.h"
#include "bench/tick_counter.h"

namespace spidar::bench {

inline constexpr int kRuns = 4;
inline constexpr std::size_t kBlock = 200;

class RepeatedTimes {
public:
    explicit RepeatedTimes(std::size_t problems) : ticks_(problems, ~std::uint64_t{0}) {}

    template <typename Call>
    void time(std::size_t problem, Call &&call) {
        const std::uint64_t nothing = empty_call_ticks();
        const std::uint64_t from = ticks();
        call();
        const std::uint64_t spent = ticks() - from;
        ticks_[problem] = std::min(ticks_[problem], spent > nothing ? spent - nothing : 0);
    }

    // Median, p99, p99.9 and maximum into a row.
    void fill(BenchRow &row) const {
        std::vector<std::uint64_t> sorted = ticks_;
        std::sort(sorted.begin(), sorted.end());
        row.median_ns = quantile_ns(sorted, 0.5);
        row.p99_ns = quantile_ns(sorted, 0.99);
        row.p999_ns = quantile_ns(sorted, 0.999);
        row.max_ns = quantile_ns(sorted, 1.0);
    }

private:
    static double quantile_ns(const std::vector<std::uint64_t> &sorted, double share) {
        if (sorted.empty()) {
            return kNoFigure;
        }
        const auto last = static_cast<double>(sorted.size() - 1);
        return ns_per_tick() *
               static_cast<double>(sorted[static_cast<std::size_t>(share * last + 0.5)]);
    }

    std::vector<std::uint64_t> ticks_;
};

// Goes through `problems` problems kRuns times in blocks: work(run, method, problem), methods in turns. The blocks of each
// run begin elsewhere: no problem finds the caches cold in all of them.
template <typename Work>
void in_turns(std::size_t problems, std::size_t methods, Work &&work) {
    for (int run = 0; run < kRuns; ++run) {
        const auto first_block = kBlock * static_cast<std::size_t>(run + 1) / kRuns;
        for (std::size_t from = 0, to = 0; from < problems; from = to) {
            to = std::min(from == 0 ? first_block : from + kBlock, problems);
            for (std::size_t method = 0; method < methods; ++method) {
                for (std::size_t problem = from; problem < to; ++problem) {
                    work(run, method, problem);
                }
            }
        }
    }
}

} // namespace spidar::bench
