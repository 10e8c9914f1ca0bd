#pragma once

#include <vector>

#include "bench/bench_report.h"

namespace spidar::bench {

// Kinematics along trajectory T1, clean, quantised and with noise. 0 when our own rows have no failure on the clean
// and quantised lengths.
int bench_fk(std::vector<BenchRow> &rows);

} // namespace spidar::bench
