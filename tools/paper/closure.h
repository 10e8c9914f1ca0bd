// Vector closure (section II): the two theories of the paper, from the null vector of A.
#pragma once

#include "core/geometry/wrench_matrix.h"

namespace spidar::paper {

struct Closure {
    StringArray null_vector{};   // A null = 0, largest element 1 in size
    double margin = 0.0;         // smallest element: > 0 when tension can be added in every string
    double smallest_pivot = 0.0; // of the scaled A: 0 where the rank is below 7
    double determinant = 0.0;    // det(A A^T), moments and g scaled by 1/pole_half_length
    bool closed = false;         // theory 2: rank 7 and a strictly positive null vector
};

// Moments and g are divided by pole_half_length_m, so that all rows are newtons.
[[nodiscard]] Closure closure_of(const WrenchMatrix &matrix, double pole_half_length_m);

} // namespace spidar::paper
