// How much of a wrench the strings can give: the paper's "capacity" (section VI.2), from the real solver.
#pragma once

#include "core/tension/tension_solver.h"

namespace spidar::paper {

enum class Weighting { plain, pole_ends }; // W = 1 as printed, or moments and g divided by d

struct Capacity {
    double ratio = 0.0; // (A tau) . q / |q|^2: 1 when all of it is given
    PaperWrench achieved{};
    PaperWrench unwanted{}; // A tau - ratio q
    StringArray tensions_n{};
};

// The paper's problem (section V): min |W (A tau - q)|^2, 0 <= tau <= max_tension_n.
[[nodiscard]] Capacity capacity_of(const WrenchMatrix &matrix, const PaperWrench &wrench,
                                   Weighting weighting, double pole_half_length_m,
                                   double max_tension_n);

// Largest multiple of `wrench` that is given exactly (to a millionth), between 0 and `end`.
[[nodiscard]] double largest_exact(const WrenchMatrix &matrix, const PaperWrench &wrench,
                                   double pole_half_length_m, double max_tension_n, double end);

} // namespace spidar::paper
