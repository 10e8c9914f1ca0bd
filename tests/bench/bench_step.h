#pragma once

#include <vector>

#include "bench/bench_report.h"

namespace spidar::bench {

// Prints and adds one row a case. 0 when every case ran as it says.
int bench_step(std::vector<BenchRow> &rows);

} // namespace spidar::bench
