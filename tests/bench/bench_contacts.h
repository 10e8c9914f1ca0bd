// Closest points of a tool and a shape on pairs whose answer is known, beside the distance queries of others.
#pragma once

#include <vector>

#include "bench/bench_report.h"

namespace spidar::bench {

[[nodiscard]] int bench_contacts(std::vector<BenchRow> &rows);

} // namespace spidar::bench
