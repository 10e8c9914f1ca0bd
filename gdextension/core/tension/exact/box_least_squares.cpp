#include "core/tension/exact/box_least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/tension/exact/double_double.h"

namespace spidar {

namespace {

// Share of its diagonal below which a Cholesky pivot has lost half of its digits and QR is used.
// Above it one refinement step gains at least seven digits.
constexpr double kCancelledPivot = 1e-8;

} // namespace

BoxLeastSquares::BoxLeastSquares(const TensionProblem &problem) noexcept : problem_(problem) {
    for (std::size_t k = 0; k < kDofCount; ++k) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            rows_[k][i] = problem.weights[k] * problem.matrix.columns[i][k];
        }
    }
    for (std::size_t k = 0; k < kDofCount; ++k) {
        const Row &row = rows_[k];
        for (std::size_t i = 0; i < kStringCount; ++i) {
            for (std::size_t j = 0; j < kStringCount; ++j) {
                hessian_[i][j] += row[i] * row[j];
            }
        }
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        hessian_[i][i] += problem.proximal_weight;
    }
}

void BoxLeastSquares::factor(StringMask free) noexcept {
    free_ = free;
    if (!factor_cholesky()) {
        factor_householder();
    }
}

bool BoxLeastSquares::factor_cholesky() noexcept {
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double keep_row = has_string(free_, i) ? 1.0 : 0.0;
        for (std::size_t j = 0; j < kStringCount; ++j) {
            unit_upper_[i][j] = has_string(free_, j) ? keep_row * hessian_[i][j] : 0.0;
        }
        if (!has_string(free_, i)) {
            unit_upper_[i][i] = 1.0;
        }
    }
    smallest_pivot_ = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < kStringCount; ++j) {
        const double pivot = unit_upper_[j][j];
        if (has_string(free_, j)) {
            if (!(pivot > kCancelledPivot * hessian_[j][j])) {
                return false;
            }
            smallest_pivot_ = std::min(smallest_pivot_, pivot);
        }
        inverse_pivot_[j] = 1.0 / pivot;
        for (std::size_t i = j + 1; i < kStringCount; ++i) {
            const double factor = unit_upper_[j][i] * inverse_pivot_[j];
            for (std::size_t c = i; c < kStringCount; ++c) {
                unit_upper_[i][c] -= factor * unit_upper_[j][c];
            }
        }
        for (std::size_t i = j + 1; i < kStringCount; ++i) {
            unit_upper_[j][i] *= inverse_pivot_[j];
        }
    }
    return true;
}

void BoxLeastSquares::factor_householder() noexcept {
    constexpr std::size_t kRows = kDofCount + kStringCount;
    std::array<Row, kRows> m{};
    const double root = std::sqrt(problem_.proximal_weight);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const bool is_free = has_string(free_, i);
        for (std::size_t k = 0; k < kDofCount; ++k) {
            m[k][i] = is_free ? rows_[k][i] : 0.0;
        }
        m[kDofCount + i][i] = is_free ? root : 1.0;
    }
    smallest_pivot_ = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < kStringCount; ++j) {
        double square = 0.0;
        for (std::size_t r = j; r < kRows; ++r) {
            square += m[r][j] * m[r][j];
        }
        // Never zero: row kDofCount + j holds sqrt(w) or 1 in this column.
        const double norm = m[j][j] > 0.0 ? -std::sqrt(square) : std::sqrt(square);
        std::array<double, kRows> v{};
        for (std::size_t r = j; r < kRows; ++r) {
            v[r] = m[r][j];
        }
        v[j] -= norm;
        const double scale = -1.0 / (norm * v[j]); // 2 / |v|^2
        Row projection{};
        for (std::size_t r = j; r < kRows; ++r) {
            for (std::size_t c = 0; c < kStringCount; ++c) {
                projection[c] += v[r] * m[r][c];
            }
        }
        for (std::size_t r = j; r < kRows; ++r) {
            for (std::size_t c = j; c < kStringCount; ++c) {
                m[r][c] -= scale * v[r] * projection[c];
            }
        }
        const double pivot = norm * norm;
        inverse_pivot_[j] = 1.0 / pivot;
        if (has_string(free_, j)) {
            smallest_pivot_ = std::min(smallest_pivot_, pivot);
        }
        for (std::size_t c = 0; c < kStringCount; ++c) {
            unit_upper_[j][c] = c > j ? m[j][c] / norm : 0.0;
        }
    }
}

PaperWrench BoxLeastSquares::weighted_apply(const StringArray &v) const noexcept {
    PaperWrench result{};
    for (std::size_t k = 0; k < kDofCount; ++k) {
        double even = 0.0;
        double odd = 0.0;
        for (std::size_t i = 0; i < kStringCount; i += 2) {
            even += rows_[k][i] * v[i];
            odd += rows_[k][i + 1] * v[i + 1];
        }
        result[k] = even + odd;
    }
    return result;
}

void BoxLeastSquares::add_transposed(const PaperWrench &force, StringArray &sum) const noexcept {
    for (std::size_t k = 0; k < kDofCount; ++k) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            sum[i] += rows_[k][i] * force[k];
        }
    }
}

BoxLeastSquares::Gradient BoxLeastSquares::gradient(const StringArray &x,
                                                    bool precise) const noexcept {
    if (precise) {
        return gradient_precise(x);
    }
    PaperWrench force = weighted_apply(x);
    Gradient result;
    for (std::size_t k = 0; k < kDofCount; ++k) {
        force[k] -= problem_.weights[k] * problem_.wrench[k];
        result.largest_force_n = std::max(result.largest_force_n, std::abs(force[k]));
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        result.values[i] = problem_.proximal_weight * (x[i] - problem_.proximal_target_n[i]);
    }
    add_transposed(force, result.values);
    return result;
}

BoxLeastSquares::Gradient BoxLeastSquares::gradient_precise(const StringArray &x) const noexcept {
    Gradient result;
    std::array<DoubleDouble, kDofCount> force{}; // W'W (A x - q)
    for (std::size_t k = 0; k < kDofCount; ++k) {
        DoubleDouble sum{-problem_.wrench[k], 0.0};
        for (std::size_t i = 0; i < kStringCount; ++i) {
            sum = sum + two_product(problem_.matrix.columns[i][k], x[i]);
        }
        const double weight = problem_.weights[k];
        result.largest_force_n = std::max(result.largest_force_n, std::abs(weight * sum.high));
        force[k] = (sum * weight) * weight;
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        DoubleDouble sum = two_sum(x[i], -problem_.proximal_target_n[i]) * problem_.proximal_weight;
        for (std::size_t k = 0; k < kDofCount; ++k) {
            sum = sum + force[k] * problem_.matrix.columns[i][k];
        }
        result.values[i] = sum.rounded();
    }
    return result;
}

StringArray BoxLeastSquares::solve(const StringArray &right_side) const noexcept {
    StringArray x{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        x[i] = has_string(free_, i) ? right_side[i] : 0.0;
    }
    for (std::size_t j = 0; j < kStringCount; ++j) {
        for (std::size_t i = j + 1; i < kStringCount; ++i) {
            x[i] -= unit_upper_[j][i] * x[j];
        }
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        x[i] *= inverse_pivot_[i];
    }
    for (std::size_t j = kStringCount; j-- > 0;) {
        for (std::size_t i = j + 1; i < kStringCount; ++i) {
            x[j] -= unit_upper_[j][i] * x[i];
        }
    }
    return x;
}

StringArray BoxLeastSquares::curvature(const StringArray &v) const noexcept {
    const PaperWrench force = weighted_apply(v);
    StringArray result{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        result[i] = problem_.proximal_weight * v[i];
    }
    add_transposed(force, result);
    return result;
}

BoxLeastSquares::Release BoxLeastSquares::release(std::size_t string) const noexcept {
    Release result;
    result.direction = solve(hessian_[string]);
    for (double &value : result.direction) {
        value = -value;
    }
    result.direction[string] = 1.0;
    for (double force : weighted_apply(result.direction)) {
        result.stiffness += force * force;
    }
    for (double value : result.direction) {
        result.stiffness += problem_.proximal_weight * value * value;
    }
    return result;
}

double BoxLeastSquares::objective(const StringArray &x) const noexcept {
    PaperWrench force = weighted_apply(x);
    double sum = 0.0;
    for (std::size_t k = 0; k < kDofCount; ++k) {
        force[k] -= problem_.weights[k] * problem_.wrench[k];
        sum += force[k] * force[k];
    }
    double distance = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double away = x[i] - problem_.proximal_target_n[i];
        distance += away * away;
    }
    return sum + problem_.proximal_weight * distance;
}

} // namespace spidar
