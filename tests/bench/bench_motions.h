// Hand motions over shapes, replayed at games of 30 to 144 frames a second: what is felt, against what a proxy feels that sees
// the scene without a game in between.
#pragma once

#include <vector>

#include "bench/bench_report.h"

namespace spidar::bench {

int bench_motions(std::vector<BenchRow> &rows);

} // namespace spidar::bench
