// What a recording costs the servo loop.
#pragma once

#include <vector>

#include "bench/bench_report.h"

namespace spidar::bench {

// Rows of a step with and without a recording, in turn on the same inputs. 0 when the ratio of the medians is within
// the limit and no cycle was lost.
[[nodiscard]] int bench_recording(std::vector<BenchRow> &rows);

} // namespace spidar::bench
