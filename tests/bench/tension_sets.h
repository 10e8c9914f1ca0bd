// The problem sets that the figures refer to: S1 random feasible, S2 a smooth 1 kHz trajectory of contacts, S3
// saturated or infeasible, S4a-e the hard ones, and S2 at the shipped settings.
#pragma once

#include <string>
#include <vector>

#include "core/tension/tension_solver.h"

namespace spidar::bench {

struct TensionSet {
    std::string name;
    bool smooth = false; // each problem follows from the one before: solved warm too
    std::vector<TensionProblem> problems;
};

// Seeded: the same problems in each run.
[[nodiscard]] std::vector<TensionSet> tension_sets();
// The first problems of "S2 shipped" and of "S1".
[[nodiscard]] TensionSet shipped_trajectory_set(std::size_t problems);
[[nodiscard]] TensionSet feasible_set(std::size_t problems);

} // namespace spidar::bench
