// DAQP's times inside the bench of another problem, so that its ratios come from one process and one mood of the
// machine: warm on S2 at the shipped settings (the primary row of the tension bench), cold on S1.
#pragma once

#include <memory>
#include <vector>

#include "bench/bench_report.h"
#include "bench/repeated_times.h"
#include "bench/tension_peers.h"
#include "bench/tension_sets.h"

namespace spidar::bench {

class DaqpClock {
public:
    explicit DaqpClock(std::size_t problems);

    // False, with a sentence on stderr, when DAQP is not there: ratios then do not exist.
    [[nodiscard]] bool ready() const { return !entries_.empty(); }
    // How many more methods in_turns() has to call, and the call for each of them.
    [[nodiscard]] std::size_t methods() const { return entries_.size(); }
    void time(std::size_t method, std::size_t problem);
    // All methods over these problems, for a bench that makes its own turns.
    void time_block(std::size_t from, std::size_t to);

    // Rows of the fastest build: "DAQP 0.11.0, fastest", sets "S2 shipped" and "S1".
    [[nodiscard]] BenchRow warm_row() const { return fastest(true); }
    [[nodiscard]] BenchRow cold_row() const { return fastest(false); }

private:
    struct Entry {
        std::unique_ptr<TensionMethod> method;
        RepeatedTimes times;
        bool warm;
    };

    [[nodiscard]] BenchRow fastest(bool warm) const;

    std::vector<Entry> entries_;
    TensionSet warm_set_;
    TensionSet cold_set_;
};

} // namespace spidar::bench
