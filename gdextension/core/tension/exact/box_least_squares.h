// Linear algebra of solve_exactly(): the objective
//   ||W (A x - q)||^2 + w |x - t|^2
// restricted to a set of free strings. All arrays are 8 wide; a string that is not free has a unit
// row and column. The work therefore does not depend on how many strings are free.
#pragma once

#include <array>

#include "core/base/types.h"
#include "core/tension/exact/tension_problem.h"

namespace spidar {

class BoxLeastSquares {
public:
    // Copies weighted matrix and proximal weight. `problem` must outlive this object and be finite.
    explicit BoxLeastSquares(const TensionProblem &problem) noexcept;

    // Factorizes H = A'W'WA + w I on the free strings as U' D U. Uses Cholesky or, where a pivot
    // cancels, Householder QR of [WA; sqrt(w) I]: the error of QR grows with the condition number
    // and not with its square.
    void factor(StringMask free) noexcept;
    // Smallest element of D over the free strings of the last factor(); +infinity if none was free.
    [[nodiscard]] double smallest_pivot() const noexcept { return smallest_pivot_; }

    struct Gradient {
        // Half the gradient, for every string: A'W'W(A x - q) + w (x - t).
        StringArray values{};
        // max |W (A x - q)|: the size of the terms that cancel in the gradient.
        double largest_force_n = 0.0;
    };
    // Computes the gradient from A itself, not from H. precise: in double-double arithmetic.
    [[nodiscard]] Gradient gradient(const StringArray &x, bool precise) const noexcept;

    // Returns H^-1 right_side on the free strings of the last factor(), and 0 for the others.
    [[nodiscard]] StringArray solve(const StringArray &right_side) const noexcept;

    // Returns (H v)_i for every string, computed as W A v first.
    [[nodiscard]] StringArray curvature(const StringArray &v) const noexcept;

    [[nodiscard]] double diagonal(std::size_t string) const noexcept {
        return hessian_[string][string];
    }

    // Effect of releasing a bound string: while x_string moves by 1, the free strings follow by
    // `direction` (1 at the string itself) against the stiffness direction' H direction.
    struct Release {
        StringArray direction{};
        double stiffness = 0.0;
    };
    [[nodiscard]] Release release(std::size_t string) const noexcept;

    [[nodiscard]] double objective(const StringArray &x) const noexcept;

private:
    using Row = std::array<double, kStringCount>;

    bool factor_cholesky() noexcept;
    void factor_householder() noexcept;
    [[nodiscard]] Gradient gradient_precise(const StringArray &x) const noexcept;
    // Returns W A v.
    [[nodiscard]] PaperWrench weighted_apply(const StringArray &v) const noexcept;
    // Adds (W A)' force to `sum`.
    void add_transposed(const PaperWrench &force, StringArray &sum) const noexcept;

    const TensionProblem &problem_;
    std::array<Row, kDofCount> rows_{}; // W A, by DOF, 8 strings wide
    std::array<Row, kStringCount> hessian_{};
    std::array<Row, kStringCount> unit_upper_{}; // U
    Row inverse_pivot_{};                        // 1 / D
    double smallest_pivot_ = 0.0;
    StringMask free_ = 0;
};

} // namespace spidar
