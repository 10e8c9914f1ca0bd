#pragma once

#include <vector>

#include "bench/bench_report.h"

namespace spidar::bench {

// Tension solvers on the sets of tension_sets.h, interleaved in this process; 0 when no solver of ours failed and DAQP
// was there to compare with.
int bench_tension(std::vector<BenchRow> &rows);

} // namespace spidar::bench
