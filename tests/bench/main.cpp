// spidar_bench step: the cost of one servo step, of its two computations, and the memory of a device.
// Times come from a shared machine: read the ratios between rows of one run.
#include <cstdio>
#include <cstring>

#include "bench/bench_step.h"

int main(int argc, char **argv) {
    if (argc == 1 || (argc == 2 && std::strcmp(argv[1], "step") == 0)) {
        return spidar::bench::bench_step();
    }
    std::fprintf(stderr, "usage: spidar_bench [step]\n");
    return 2;
}
