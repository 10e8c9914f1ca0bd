#include "paper/closure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace spidar::paper {

namespace {

// Rounding of the elimination is 1e-15; the margin grows by 1e-3 a degree beside its zero, so this places
// a border to a millionth of a degree.
constexpr double kZero = 1e-9;

using Vector8 = StringArray;

double dot(const Vector8 &a, const Vector8 &b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

void remove_part(Vector8 &vector, const Vector8 &unit) {
    const double part = dot(vector, unit);
    for (std::size_t i = 0; i < vector.size(); ++i) {
        vector[i] -= part * unit[i];
    }
}

} // namespace

Closure closure_of(const WrenchMatrix &matrix, double pole_half_length_m) {
    // Gram-Schmidt on the rows, largest remainder first and each made orthogonal twice: seven unit
    // vectors, whose complement in R8 is the null vector.
    std::array<Vector8, kDofCount> rows{};
    for (std::size_t k = 0; k < rows.size(); ++k) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            rows[k][i] = matrix.columns[i][k] / (k < 3 ? 1.0 : pole_half_length_m);
        }
    }
    Closure result;
    result.determinant = 1.0;
    for (std::size_t done = 0; done < rows.size(); ++done) {
        const auto largest = std::max_element(
            rows.begin() + static_cast<std::ptrdiff_t>(done), rows.end(),
            [](const Vector8 &a, const Vector8 &b) { return dot(a, a) < dot(b, b); });
        std::swap(rows[done], *largest);
        const double pivot = std::sqrt(dot(rows[done], rows[done]));
        result.determinant *= pivot * pivot;
        result.smallest_pivot = pivot;
        if (!(pivot > kZero)) {
            return result; // rank below 7: no closure, and no single null vector
        }
        for (double &value : rows[done]) {
            value /= pivot;
        }
        for (std::size_t k = done + 1; k < rows.size(); ++k) {
            remove_part(rows[k], rows[done]);
            remove_part(rows[k], rows[done]);
        }
    }
    // The unit vector that keeps most of itself outside the row space.
    double best = -1.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        Vector8 candidate{};
        candidate[i] = 1.0;
        for (int pass = 0; pass < 2; ++pass) {
            for (const Vector8 &row : rows) {
                remove_part(candidate, row);
            }
        }
        const double size = dot(candidate, candidate);
        if (size > best) {
            best = size;
            result.null_vector = candidate;
        }
    }
    // Of the two signs, the one whose smallest element is larger.
    const auto [low, high] =
        std::minmax_element(result.null_vector.begin(), result.null_vector.end());
    const double least = *low;
    const double most = *high;
    const double scale = (most + least >= 0.0 ? 1.0 : -1.0) / std::max(most, -least);
    for (double &value : result.null_vector) {
        value *= scale;
    }
    result.margin = *std::min_element(result.null_vector.begin(), result.null_vector.end());
    result.closed = result.margin > kZero;
    return result;
}

} // namespace spidar::paper
