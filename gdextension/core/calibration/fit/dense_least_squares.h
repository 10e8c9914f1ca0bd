// Small dense least squares for calibration: Householder QR, then the singular values of R by
// one-sided Jacobi rotations. QR does not square the condition number. The rotations give small
// singular values to full relative accuracy, which shows the combinations of unknowns that the
// measurements do not determine. Allocates: not for the servo loop.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/status.h"

namespace spidar {

// Largest number of unknowns: 8 offsets, 8 gains, 8 winding terms and 4 sizes, with some room.
inline constexpr std::size_t kMaxUnknowns = 32;

// Matrix to which rows can be appended, one per measurement.
class DenseMatrix {
public:
    explicit DenseMatrix(std::size_t columns) : columns_(columns) {}
    DenseMatrix(std::size_t rows, std::size_t columns)
        : rows_(rows), columns_(columns), values_(rows * columns, 0.0) {}

    void append(const std::vector<double> &row); // requires exactly columns() values
    [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
    [[nodiscard]] std::size_t columns() const noexcept { return columns_; }
    double &operator()(std::size_t row, std::size_t column) noexcept {
        return values_[row * columns_ + column];
    }
    double operator()(std::size_t row, std::size_t column) const noexcept {
        return values_[row * columns_ + column];
    }
    [[nodiscard]] const std::vector<double> &values() const noexcept {
        return values_;
    } // row by row

private:
    std::size_t rows_ = 0;
    std::size_t columns_ = 0;
    std::vector<double> values_;
};

struct LeastSquaresSolution {
    // ok; near_singular when directions below the cutoff were left at zero; invalid_settings for 0
    // or more than kMaxUnknowns unknowns, for fewer rows than unknowns, for sizes that do not match
    // and for a negative cutoff; not_finite.
    Status status = Status::invalid_settings;
    std::vector<double> x;        // minimizes |A x - b| over the directions above the cutoff
    double residual_norm = 0.0;   // |A x - b|
    std::size_t rank = 0;         // singular values above the cutoff
    std::vector<double> singular; // descending
    DenseMatrix right{0};         // column j: unit vector of unknowns that belongs to singular[j]
};

// Directions whose singular value is at most relative_cutoff times the largest are left out of x.
[[nodiscard]] LeastSquaresSolution solve_least_squares(DenseMatrix a, std::vector<double> b,
                                                       double relative_cutoff);

// Returns (A^T A)^-1 over the directions above the cutoff. Multiplied by the variance of b it is
// the covariance of x.
[[nodiscard]] DenseMatrix inverse_normal(const LeastSquaresSolution &solution);

} // namespace spidar
