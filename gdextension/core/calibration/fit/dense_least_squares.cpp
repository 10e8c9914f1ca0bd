#include "core/calibration/fit/dense_least_squares.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/finite.h"

namespace spidar {

namespace {

// One-sided Jacobi converges quadratically; 32 columns need about ten sweeps.
constexpr int kMaxSweeps = 60;
// Columns count as orthogonal at this cosine: a few roundings.
constexpr double kOrthogonal = 1e-15;

// Householder: A becomes R in its upper triangle, b becomes Q^T b.
void triangularise(DenseMatrix &a, std::vector<double> &b) {
    const std::size_t rows = a.rows();
    std::vector<double> v(rows);
    for (std::size_t k = 0; k < a.columns(); ++k) {
        double norm = 0.0;
        for (std::size_t i = k; i < rows; ++i) {
            norm = std::hypot(norm, a(i, k));
        }
        if (norm == 0.0) {
            continue;
        }
        const double alpha = std::copysign(norm, -a(k, k));
        double square = 0.0;
        for (std::size_t i = k; i < rows; ++i) {
            v[i] =
                (a(i, k) - (i == k ? alpha : 0.0)) / norm; // over norm: no overflow in the square
            square += v[i] * v[i];
        }
        const auto reflect = [&](auto &&element) {
            double sum = 0.0;
            for (std::size_t i = k; i < rows; ++i) {
                sum += v[i] * element(i);
            }
            const double factor = 2.0 * sum / square;
            for (std::size_t i = k; i < rows; ++i) {
                element(i) -= factor * v[i];
            }
        };
        for (std::size_t j = k + 1; j < a.columns(); ++j) {
            reflect([&](std::size_t i) -> double & { return a(i, j); });
        }
        reflect([&](std::size_t i) -> double & { return b[i]; });
        a(k, k) = alpha;
        for (std::size_t i = k + 1; i < rows; ++i) {
            a(i, k) = 0.0;
        }
    }
}

// Rotates columns of `u` (and of `v` alike) until all are orthogonal: u = U S, with R = U S V^T.
void orthogonalise(DenseMatrix &u, DenseMatrix &v) {
    const std::size_t n = u.columns();
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
        bool rotated = false;
        for (std::size_t p = 0; p + 1 < n; ++p) {
            for (std::size_t q = p + 1; q < n; ++q) {
                double pp = 0.0;
                double qq = 0.0;
                double pq = 0.0;
                for (std::size_t i = 0; i < n; ++i) {
                    pp += u(i, p) * u(i, p);
                    qq += u(i, q) * u(i, q);
                    pq += u(i, p) * u(i, q);
                }
                if (!(std::fabs(pq) > kOrthogonal * std::sqrt(pp) * std::sqrt(qq))) {
                    continue;
                }
                rotated = true;
                const double zeta = (qq - pp) / (2.0 * pq);
                const double t =
                    std::copysign(1.0, zeta) / (std::fabs(zeta) + std::hypot(1.0, zeta));
                const double c = 1.0 / std::hypot(1.0, t);
                const double s = c * t;
                for (DenseMatrix *m : {&u, &v}) {
                    for (std::size_t i = 0; i < n; ++i) {
                        const double x = (*m)(i, p);
                        const double y = (*m)(i, q);
                        (*m)(i, p) = c * x - s * y;
                        (*m)(i, q) = s * x + c * y;
                    }
                }
            }
        }
        if (!rotated) {
            return;
        }
    }
}

} // namespace

void DenseMatrix::append(const std::vector<double> &row) {
    values_.insert(values_.end(), row.begin(), row.end());
    ++rows_;
}

LeastSquaresSolution solve_least_squares(DenseMatrix a, std::vector<double> b,
                                         double relative_cutoff) {
    LeastSquaresSolution solution;
    const std::size_t n = a.columns();
    if (n == 0 || n > kMaxUnknowns || a.rows() < n || b.size() != a.rows() ||
        !(relative_cutoff >= 0.0)) {
        return solution;
    }
    if (!all_finite(a.values(), b)) {
        solution.status = Status::not_finite;
        return solution;
    }
    triangularise(a, b);
    DenseMatrix u(n, n);
    DenseMatrix v(n, n);
    for (std::size_t i = 0; i < n; ++i) {
        v(i, i) = 1.0;
        for (std::size_t j = i; j < n; ++j) {
            u(i, j) = a(i, j);
        }
    }
    orthogonalise(u, v);

    std::vector<double> size(n, 0.0);
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = 0; i < n; ++i) {
            size[j] = std::hypot(size[j], u(i, j));
        }
    }
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return size[x] > size[y]; });

    double square = 0.0;
    for (std::size_t i = n; i < b.size(); ++i) {
        square += b[i] * b[i];
    }
    solution.x.assign(n, 0.0);
    solution.singular.resize(n);
    solution.right = DenseMatrix(n, n);
    const double cutoff = relative_cutoff * size[order[0]];
    for (std::size_t j = 0; j < n; ++j) {
        const std::size_t from = order[j];
        solution.singular[j] = size[from];
        double along = 0.0; // (U_j . b), times the singular value
        for (std::size_t i = 0; i < n; ++i) {
            solution.right(i, j) = v(i, from);
            along += u(i, from) * b[i];
        }
        const bool kept = size[from] > cutoff;
        if (kept) {
            const double step = along / size[from] / size[from];
            for (std::size_t i = 0; i < n; ++i) {
                solution.x[i] += step * v(i, from);
            }
            ++solution.rank;
        } else if (size[from] > 0.0) {
            square += (along / size[from]) * (along / size[from]);
        }
    }
    solution.residual_norm = std::sqrt(square);
    solution.status = solution.rank == n ? Status::ok : Status::near_singular;
    return solution;
}

DenseMatrix inverse_normal(const LeastSquaresSolution &solution) {
    const std::size_t n = solution.x.size();
    DenseMatrix inverse(n, n);
    for (std::size_t j = 0; j < solution.rank; ++j) {
        const double weight = 1.0 / (solution.singular[j] * solution.singular[j]);
        for (std::size_t r = 0; r < n; ++r) {
            for (std::size_t c = 0; c < n; ++c) {
                inverse(r, c) += weight * solution.right(r, j) * solution.right(c, j);
            }
        }
    }
    return inverse;
}

} // namespace spidar
