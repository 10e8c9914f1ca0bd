#pragma once

namespace spidar::bench {

// Prints one row a case: median, p99, p99.9, maximum (ns). 0 when every case ran as it says.
int bench_step();

} // namespace spidar::bench
