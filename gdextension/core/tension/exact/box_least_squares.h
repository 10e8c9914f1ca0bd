// The linear algebra under solve_exactly(): the objective
//   ||W (A x - q)||^2 + w |x - t|^2
// restricted to a set of free strings. Everything is fixed-size, 8 wide and masked (a string that is not
// free has a unit row and column), so that no path depends on how many strings are free.
#pragma once

#include <array>

#include "core/base/types.h"
#include "core/tension/exact/tension_problem.h"

namespace spidar {

class BoxLeastSquares {
public:
    // Takes the matrix, wrench, weights and proximal term; `problem` must outlive this and be finite.
    explicit BoxLeastSquares(const TensionProblem &problem) noexcept;

    // H = A'W'WA + w I on the free strings = U' D U. Cholesky; where a pivot cancels, Householder QR of
    // [WA; sqrt(w) I], whose error grows with the condition number and not with its square.
    void factor(StringMask free) noexcept;
    // Smallest element of D over the free strings; +infinity when none is free.
    [[nodiscard]] double smallest_pivot() const noexcept { return smallest_pivot_; }

    struct Gradient {
        StringArray values{};         // half the gradient: A'W'W(A x - q) + w (x - t), every string
        double largest_force_n = 0.0; // max |W (A x - q)|: the size of what cancels in it
    };
    // From A itself, not from H. `precise`: in double-double arithmetic.
    [[nodiscard]] Gradient gradient(const StringArray &x, bool precise) const noexcept;

    // H^-1 g on the free strings (0 elsewhere), with the last factor().
    [[nodiscard]] StringArray solve(const StringArray &right_side) const noexcept;

    // (H v)_i for every string, by way of W A v.
    [[nodiscard]] StringArray curvature(const StringArray &v) const noexcept;

    [[nodiscard]] double diagonal(std::size_t string) const noexcept {
        return hessian_[string][string];
    }

    // What releasing a bound string does: with x_string moving by 1 the free strings follow by `direction`
    // (1 at the string itself), against the stiffness direction' H direction.
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
    // W A v
    [[nodiscard]] PaperWrench weighted_apply(const StringArray &v) const noexcept;
    // sum += (W A)' force
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
