#include "bench/tension_peers.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "bench/library_peers.h"
#include "bench/quadratic.h"
#include "core/base/simd_level.h"

namespace spidar::bench {

namespace {

constexpr std::size_t kStrings = kStringCount;
constexpr std::size_t kDofs = kDofCount;

class Ours : public TensionMethod {
public:
    Ours(const char *name, SimdLevel level, bool safe_only)
        : TensionMethod(name), level_(level), safe_only_(safe_only) {}

    bool solve(const TensionProblem &problem, bool warm, StringArray &tensions_n) override {
        const ActiveSet *from = warm ? &last_ : nullptr;
        const TensionSolution solution = safe_only_ ? solve_exactly(problem, from)
                                                    : solve_tension_problem(problem, from, level_);
        last_ = solution.active;
        tensions_n = solution.tensions_n;
        return solution.status == Status::ok;
    }

private:
    SimdLevel level_;
    bool safe_only_;
    ActiveSet last_{};
};

// x of H x = -f by Cholesky (LDL').
void solve_unbounded(const Quadratic &q, StringArray &x) {
    double m[kStrings][kStrings];
    std::copy(&q.h[0][0], &q.h[0][0] + kStrings * kStrings, &m[0][0]);
    for (std::size_t i = 0; i < kStrings; ++i) {
        x[i] = -q.f[i];
    }
    for (std::size_t j = 0; j < kStrings; ++j) {
        for (std::size_t i = j + 1; i < kStrings; ++i) {
            const double factor = m[i][j] / m[j][j];
            for (std::size_t c = j; c < kStrings; ++c) {
                m[i][c] -= factor * m[j][c];
            }
            x[i] -= factor * x[j];
        }
    }
    for (std::size_t j = kStrings; j-- > 0;) {
        for (std::size_t c = j + 1; c < kStrings; ++c) {
            x[j] -= m[j][c] * x[c];
        }
        x[j] /= m[j][j];
    }
}

// What many drivers do: solve without bounds, then cut off.
class Clamp : public TensionMethod {
public:
    Clamp() : TensionMethod("clamp") {}
    bool solve(const TensionProblem &p, bool /*warm*/, StringArray &tensions_n) override {
        Quadratic q;
        build_quadratic(p, q);
        solve_unbounded(q, tensions_n);
        for (std::size_t i = 0; i < kStrings; ++i) {
            tensions_n[i] = std::clamp(tensions_n[i], p.lower_n[i], p.upper_n[i]);
        }
        return true;
    }
};

class ProjectedGaussSeidel : public TensionMethod {
public:
    ProjectedGaussSeidel() : TensionMethod("projected Gauss-Seidel, 30") {}
    bool solve(const TensionProblem &p, bool warm, StringArray &tensions_n) override {
        constexpr int kSweeps = 30;
        Quadratic q;
        build_quadratic(p, q);
        if (!warm) {
            last_ = p.proximal_target_n;
        }
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            for (std::size_t i = 0; i < kStrings; ++i) {
                double slope = q.f[i];
                for (std::size_t j = 0; j < kStrings; ++j) {
                    slope += q.h[i][j] * last_[j];
                }
                last_[i] = std::clamp(last_[i] - slope / q.h[i][i], p.lower_n[i], p.upper_n[i]);
            }
        }
        tensions_n = last_;
        return true;
    }

private:
    StringArray last_{};
};

// Bounded-variable least squares (Stark and Parker 1995) by Householder QR of the free columns of [W A; sqrt(w) I].
class BoundedQr : public TensionMethod {
public:
    BoundedQr() : TensionMethod("bounded least squares by QR") {}
    bool solve(const TensionProblem &p, bool warm, StringArray &tensions_n) override {
        constexpr int kRounds = 60;
        load(p);
        for (std::size_t i = 0; i < kStrings; ++i) {
            const bool fixed = p.lower_n[i] >= p.upper_n[i];
            side_[i] = fixed ? -1 : warm ? side_[i] : 0;
            x_[i] = side_[i] == 0  ? std::clamp(p.proximal_target_n[i], p.lower_n[i], p.upper_n[i])
                    : side_[i] < 0 ? p.lower_n[i]
                                   : p.upper_n[i];
        }
        for (int round = 0; round < kRounds; ++round) {
            if (!minimise_free(p)) {
                continue;
            }
            if (!release(p)) {
                tensions_n = x_;
                return true;
            }
        }
        tensions_n = x_;
        return false;
    }

private:
    static constexpr std::size_t kRows = kDofs + kStrings;

    void load(const TensionProblem &p) {
        const double root = std::sqrt(p.proximal_weight);
        for (std::size_t c = 0; c < kStrings; ++c) {
            a_[c] = {};
            for (std::size_t k = 0; k < kDofs; ++k) {
                a_[c][k] = p.weights[k] * p.matrix.columns[c][k];
            }
            a_[c][kDofs + c] = root;
            b_[kDofs + c] = root * p.proximal_target_n[c];
        }
        for (std::size_t k = 0; k < kDofs; ++k) {
            b_[k] = p.weights[k] * p.wrench[k];
        }
    }

    using Column = std::array<double, kRows>;

    Column residual() const {
        Column r = b_;
        for (std::size_t c = 0; c < kStrings; ++c) {
            for (std::size_t k = 0; k < kRows; ++k) {
                r[k] -= a_[c][k] * x_[c];
            }
        }
        return r;
    }

    // To the least squares of the free strings, or to the first bound on the way there (false).
    bool minimise_free(const TensionProblem &p) {
        std::array<Column, kStrings> q{};
        std::array<std::size_t, kStrings> who{};
        std::size_t n = 0;
        for (std::size_t c = 0; c < kStrings; ++c) {
            if (side_[c] == 0) {
                who[n] = c;
                q[n++] = a_[c];
            }
        }
        Column r = residual();
        for (std::size_t j = 0; j < n; ++j) {
            double square = 0.0;
            for (std::size_t k = j; k < kRows; ++k) {
                square += q[j][k] * q[j][k];
            }
            const double norm = q[j][j] > 0.0 ? -std::sqrt(square) : std::sqrt(square);
            Column v = q[j];
            v[j] -= norm;
            const double scale = -1.0 / (norm * v[j]);
            const auto reflect = [&](Column &target) {
                double dot = 0.0;
                for (std::size_t k = j; k < kRows; ++k) {
                    dot += v[k] * target[k];
                }
                for (std::size_t k = j; k < kRows; ++k) {
                    target[k] -= scale * dot * v[k];
                }
            };
            for (std::size_t c = j; c < n; ++c) {
                reflect(q[c]);
            }
            reflect(r);
        }
        std::array<double, kStrings> step{};
        for (std::size_t j = n; j-- > 0;) {
            step[j] = r[j];
            for (std::size_t c = j + 1; c < n; ++c) {
                step[j] -= q[c][j] * step[c];
            }
            step[j] /= q[j][j];
        }
        double share = 1.0;
        std::size_t first = n;
        for (std::size_t j = 0; j < n; ++j) {
            const std::size_t c = who[j];
            const double bound = step[j] < 0.0 ? p.lower_n[c] : p.upper_n[c];
            if ((bound - x_[c]) / step[j] < share) {
                share = (bound - x_[c]) / step[j];
                first = j;
            }
        }
        for (std::size_t j = 0; j < n; ++j) {
            const std::size_t c = who[j];
            x_[c] = std::clamp(x_[c] + share * step[j], p.lower_n[c], p.upper_n[c]);
        }
        if (first < n) {
            const std::size_t c = who[first];
            side_[c] = step[first] < 0.0 ? -1 : 1;
            x_[c] = side_[c] < 0 ? p.lower_n[c] : p.upper_n[c];
        }
        return first == n;
    }

    bool release(const TensionProblem &p) {
        const Column r = residual();
        double worst = 1e-12;
        std::size_t which = kStrings;
        for (std::size_t c = 0; c < kStrings; ++c) {
            if (side_[c] == 0 || p.lower_n[c] >= p.upper_n[c]) {
                continue;
            }
            double pull = 0.0;
            for (std::size_t k = 0; k < kRows; ++k) {
                pull += a_[c][k] * r[k];
            }
            pull = side_[c] < 0 ? pull : -pull;
            if (pull > worst) {
                worst = pull;
                which = c;
            }
        }
        if (which < kStrings) {
            side_[which] = 0;
        }
        return which < kStrings;
    }

    std::array<Column, kStrings> a_{};
    Column b_{};
    StringArray x_{};
    std::array<int, kStrings> side_{};
};

} // namespace

std::vector<std::unique_ptr<TensionMethod>> tension_methods() {
    std::vector<std::unique_ptr<TensionMethod>> daqp = daqp_methods();
    std::vector<std::unique_ptr<TensionMethod>> methods;
    if (supports(SimdLevel::avx2)) {
        methods.push_back(std::make_unique<Ours>("ours, AVX2", SimdLevel::avx2, false));
    }
    methods.push_back(std::make_unique<Ours>("ours, 16-byte vectors", SimdLevel::plain, false));
    std::move(daqp.begin(), daqp.end(), std::back_inserter(methods));
    methods.push_back(std::make_unique<Ours>("ours, safe search alone", SimdLevel::plain, true));
    methods.push_back(std::make_unique<BoundedQr>());
    for (auto &other : other_library_methods()) {
        methods.push_back(std::move(other));
    }
    methods.push_back(std::make_unique<Clamp>());
    methods.push_back(std::make_unique<ProjectedGaussSeidel>());
    return methods;
}

} // namespace spidar::bench
