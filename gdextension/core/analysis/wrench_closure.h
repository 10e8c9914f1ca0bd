// How well the strings hold the grip at a pose, and how much of a requested wrench they can give.
// Diagnosis on request: not for the servo step.
#pragma once

#include "core/base/types.h"
#include "core/geometry/wrench_matrix.h"
#include "core/tension/tension_solver.h"

namespace spidar {

struct WrenchClosure {
    // Smallest over largest element of the null vector of A: 1 when all strings share equally. 0
    // when strings that only pull cannot give some wrench, when A has lost rank or, if the DOF mask
    // has all DOF, when a string is broken.
    double margin = 0.0;
    // Tensions that give no wrench, scaled to a largest element of 1. If the DOF mask has all DOF,
    // elements of both signs mean that the strings cannot hold the grip, and all elements are 0
    // when A has lost rank. With fewer DOF all elements are 0 when margin is 0.
    StringArray null_tensions{};
};

// `settings` supplies the DOF mask, the broken strings and the weights; the weights only scale the
// rows for the rank decision. If the DOF mask leaves out a DOF, there are many null vectors: the
// one with the largest margin is found by 45 bisection steps, and a margin below 1e-7 counts as 0.
[[nodiscard]] WrenchClosure wrench_closure(const WrenchMatrix &matrix,
                                           const TensionSettings &settings) noexcept;

// The interval of factors s >= 0 for which some tensions within the limits give exactly s q.
struct FeasibleScale {
    // False when no such factor exists or when q is not finite; with all DOF and no broken string
    // also when A has lost rank.
    bool any = false;
    double least = 0.0;
    double largest = 0.0; // infinity for q = 0 when zero wrench can be given
};

[[nodiscard]] FeasibleScale feasible_scale(const WrenchMatrix &matrix, const PaperWrench &wrench,
                                           const TensionSettings &settings) noexcept;

} // namespace spidar
