// H and f of 1/2 x'Hx + f'x, for the peers that want them.
#pragma once

#include "core/tension/tension_solver.h"

namespace spidar::bench {

struct Quadratic {
    alignas(32) double h[kStringCount][kStringCount];
    alignas(32) double f[kStringCount];
};

// Built with AVX2 where the compiler can, for all peers: none pays for our own vectors.
void build_quadratic(const TensionProblem &problem, Quadratic &quadratic);

} // namespace spidar::bench
