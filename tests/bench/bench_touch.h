// One servo cycle of what is felt of real shapes: time, and the error of the force where the answer is known.
#pragma once

#include <vector>

#include "bench/bench_report.h"

namespace spidar::bench {

int bench_touch(std::vector<BenchRow> &rows);

} // namespace spidar::bench
