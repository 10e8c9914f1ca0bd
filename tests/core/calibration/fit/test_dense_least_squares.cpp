#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/calibration/fit/dense_least_squares.h"
#include "support/motion_samples.h"

using namespace spidar;
using namespace spidar::test;

TEST_CASE("dense least squares: a line through three points, by hand") {
    DenseMatrix a(2);
    a.append({1.0, 0.0});
    a.append({1.0, 1.0});
    a.append({1.0, 2.0});
    // y = 1, 3, 4: slope 1.5, intercept 7/6, residuals -1/6, 1/3, -1/6.
    const LeastSquaresSolution s = solve_least_squares(a, {1.0, 3.0, 4.0}, 0.0);
    REQUIRE(s.status == Status::ok);
    CHECK(s.x[0] == doctest::Approx(7.0 / 6.0).epsilon(1e-14));
    CHECK(s.x[1] == doctest::Approx(1.5).epsilon(1e-14));
    CHECK(s.residual_norm == doctest::Approx(std::sqrt(1.0 / 6.0)).epsilon(1e-14));
    // Singular values of [1 0; 1 1; 1 2]: squares are (8 +- sqrt 40) / 2.
    CHECK(s.singular[0] == doctest::Approx(std::sqrt(4.0 + std::sqrt(10.0))).epsilon(1e-14));
    CHECK(s.singular[1] == doctest::Approx(std::sqrt(4.0 - std::sqrt(10.0))).epsilon(1e-13));
    // (A^T A)^-1 = [5 -3; -3 3] / 6.
    const DenseMatrix inverse = inverse_normal(s);
    CHECK(inverse(0, 0) == doctest::Approx(5.0 / 6.0).epsilon(1e-13));
    CHECK(inverse(0, 1) == doctest::Approx(-0.5).epsilon(1e-13));
    CHECK(inverse(1, 1) == doctest::Approx(0.5).epsilon(1e-13));
}

TEST_CASE("dense least squares: the residual is orthogonal to every column") {
    Draw draw(7);
    for (std::size_t n = 1; n <= kMaxUnknowns; n += 3) {
        DenseMatrix a(n);
        std::vector<double> b;
        for (std::size_t i = 0; i < 3 * n; ++i) {
            std::vector<double> row(n);
            for (double &x : row) {
                x = draw.normal();
            }
            a.append(row);
            b.push_back(draw.normal());
        }
        const LeastSquaresSolution s = solve_least_squares(a, b, 0.0);
        REQUIRE(s.status == Status::ok);
        for (std::size_t j = 0; j < n; ++j) {
            double along = 0.0;
            for (std::size_t i = 0; i < b.size(); ++i) {
                double error = b[i];
                for (std::size_t k = 0; k < n; ++k) {
                    error -= a(i, k) * s.x[k];
                }
                along += a(i, j) * error;
            }
            CHECK(std::fabs(along) < 1e-12);
        }
    }
}

TEST_CASE("dense least squares: a rank-deficient problem gives the shortest answer") {
    DenseMatrix a(2);
    a.append({1.0, 1.0});
    a.append({2.0, 2.0});
    const LeastSquaresSolution s = solve_least_squares(a, {2.0, 4.0}, 1e-12);
    CHECK(s.status == Status::near_singular);
    CHECK(s.rank == 1);
    CHECK(s.x[0] == doctest::Approx(1.0).epsilon(1e-14));
    CHECK(s.x[1] == doctest::Approx(1.0).epsilon(1e-14));
    // The open combination is x0 - x1.
    CHECK(std::fabs(s.right(0, 1) + s.right(1, 1)) < 1e-14);
}

TEST_CASE("dense least squares: refuses what is no problem") {
    CHECK(solve_least_squares(DenseMatrix(0), {}, 0.0).status == Status::invalid_settings);
    CHECK(solve_least_squares(DenseMatrix(1, 2), {1.0}, 0.0).status == Status::invalid_settings);
    CHECK(solve_least_squares(DenseMatrix(2, 1), {1.0}, 0.0).status == Status::invalid_settings);
    DenseMatrix bad(1);
    bad.append({std::numeric_limits<double>::quiet_NaN()});
    CHECK(solve_least_squares(bad, {1.0}, 0.0).status == Status::not_finite);
}
