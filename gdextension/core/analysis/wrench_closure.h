// How well the strings close around the grip at a pose, and how much of a request they can give. Looked at when asked, not
// in the servo step.
#pragma once

#include "core/base/types.h"
#include "core/geometry/wrench_matrix.h"
#include "core/tension/tension_solver.h"

namespace spidar {

struct WrenchClosure {
    // Smallest over largest element of the null vector of A: 1 when all strings share alike, 0 when some wrench cannot be
    // given by strings that only pull, or A has lost rank, or a string is broken.
    double margin = 0.0;
    // Tensions that give no wrench, largest 1; zero when A has lost rank. Signs differ when closure is lost.
    StringArray null_tensions{};
};

// Weights of `settings` only scale the rows against each other (for the rank); broken strings count as absent. Under a
// DOF mask: for the DOF that count, the best of many null vectors, to 1e-7 by some 45 solves.
[[nodiscard]] WrenchClosure wrench_closure(const WrenchMatrix &matrix,
                                           const TensionSettings &settings) noexcept;

// Factors s for which some tensions within the limits of `settings` give exactly s q.
struct FeasibleScale {
    bool any =
        false; // false: no multiple of q can be given (or A has lost rank, or input is not finite)
    double least = 0.0;
    double largest = 0.0; // infinity for a zero q that can be given
};

[[nodiscard]] FeasibleScale feasible_scale(const WrenchMatrix &matrix, const PaperWrench &wrench,
                                           const TensionSettings &settings) noexcept;

} // namespace spidar
