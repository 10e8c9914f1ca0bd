// How well the strings close around the grip at a pose, and how much of a request they can give.
// Diagnosis on request: not for the servo step.
#pragma once

#include "core/base/types.h"
#include "core/geometry/wrench_matrix.h"
#include "core/tension/tension_solver.h"

namespace spidar {

struct WrenchClosure {
    // Smallest over largest element of the null vector of A: 1 when all strings share equally. 0
    // when strings that only pull cannot give some wrench, when A has lost rank or, with all DOF,
    // when a string is broken.
    double margin = 0.0;
    // Tensions that give no wrench, scaled to a largest element of 1. Elements of both signs: the
    // strings do not close. Zero when A has lost rank.
    StringArray null_tensions{};
};

// `settings` supplies the DOF mask, the broken strings and the weights; the weights only scale the
// rows for the rank decision. With a DOF mask there are many null vectors: the one with the largest
// margin is found by 45 bisection steps, and a margin below 1e-7 counts as 0.
[[nodiscard]] WrenchClosure wrench_closure(const WrenchMatrix &matrix,
                                           const TensionSettings &settings) noexcept;

// The interval of factors s >= 0 for which some tensions within the limits give exactly s q.
struct FeasibleScale {
    // False when no such factor exists, when A has lost rank, or when q is not finite.
    bool any = false;
    double least = 0.0;
    double largest = 0.0; // infinity for q = 0 when zero wrench can be given
};

[[nodiscard]] FeasibleScale feasible_scale(const WrenchMatrix &matrix, const PaperWrench &wrench,
                                           const TensionSettings &settings) noexcept;

} // namespace spidar
