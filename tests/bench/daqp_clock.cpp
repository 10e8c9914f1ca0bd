#include "bench/daqp_clock.h"

#include <utility>

#include "bench/library_peers.h"

namespace spidar::bench {

DaqpClock::DaqpClock(std::size_t problems)
    : warm_set_(shipped_trajectory_set(problems)), cold_set_(feasible_set(problems)) {
    for (const bool warm : {true, false}) {
        for (std::unique_ptr<TensionMethod> &method : daqp_methods()) {
            entries_.push_back({std::move(method), RepeatedTimes(problems), warm});
        }
    }
}

void DaqpClock::time(std::size_t method, std::size_t problem) {
    Entry &entry = entries_[method];
    const TensionProblem &p =
        entry.warm ? warm_set_.problems[problem] : cold_set_.problems[problem];
    StringArray tensions_n{};
    entry.times.time(problem,
                     [&] { entry.method->solve(p, entry.warm && problem > 0, tensions_n); });
}

void DaqpClock::time_block(std::size_t from, std::size_t to) {
    for (std::size_t method = 0; method < entries_.size(); ++method) {
        for (std::size_t problem = from; problem < to; ++problem) {
            time(method, problem);
        }
    }
}

BenchRow DaqpClock::fastest(bool warm) const {
    BenchRow best;
    for (const Entry &entry : entries_) {
        BenchRow row;
        entry.times.fill(row);
        if (entry.warm == warm && (best.median_ns == kNoFigure || row.median_ns < best.median_ns)) {
            best = row;
        }
    }
    best.method = "DAQP 0.11.0, fastest";
    best.set = warm ? warm_set_.name : cold_set_.name;
    best.mode = warm ? "warm" : "cold";
    best.ratio_to_daqp = 1.0;
    return best;
}

} // namespace spidar::bench
