// Solvers of others in shared libraries under build/peers/ (tests/bench/peers/fetch_peers.py makes them), opened at run
// time. Each has three functions: peer_create(h, f, upper, lower), which keeps the arrays and reads them at each solve;
// peer_solve(handle, warm, quick, x), above zero when solved; peer_free(handle).
#pragma once

#include <memory>
#include <vector>

#include "bench/tension_peers.h"

namespace spidar::bench {

// DAQP in each build that this processor runs, plainly and with its quick look at the unbounded optimum first. Empty,
// with a sentence on stderr, when it is not there.
[[nodiscard]] std::vector<std::unique_ptr<TensionMethod>> daqp_methods();

// quadprog, eiquadprog, qpOASES: those that are there; a sentence on stderr for each that is not.
[[nodiscard]] std::vector<std::unique_ptr<TensionMethod>> other_library_methods();

[[nodiscard]] bool is_daqp(const std::string &name);

} // namespace spidar::bench
