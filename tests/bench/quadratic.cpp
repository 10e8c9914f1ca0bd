#include "bench/quadratic.h"

// The processor chooses when the program loads.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define SPIDAR_BENCH_CLONES                                                                        \
    __attribute__((target_clones("avx2,fma", "default"), optimize("O3", "fp-contract=fast")))
#else
#define SPIDAR_BENCH_CLONES
#endif

namespace spidar::bench {

namespace {

constexpr std::size_t kStrings = kStringCount;
constexpr std::size_t kDofs = kDofCount;
typedef double Wide __attribute__((vector_size(32)));

} // namespace

SPIDAR_BENCH_CLONES void build_quadratic(const TensionProblem &p, Quadratic &q) {
    alignas(32) double rows[kDofs][kStrings];
    for (std::size_t i = 0; i < kStrings; ++i) {
        for (std::size_t k = 0; k < kDofs; ++k) {
            rows[k][i] = p.weights[k] * p.matrix.columns[i][k];
        }
    }
    Wide f0{};
    Wide f1{};
    for (std::size_t k = 0; k < kDofs; ++k) {
        const double b = -p.weights[k] * p.wrench[k];
        const auto *row = reinterpret_cast<const Wide *>(rows[k]);
        f0 += row[0] * b;
        f1 += row[1] * b;
    }
    auto *f = reinterpret_cast<Wide *>(q.f);
    f[0] = f0;
    f[1] = f1;
    for (std::size_t i = 0; i < kStrings; ++i) {
        Wide h0{};
        Wide h1{};
        for (std::size_t k = 0; k < kDofs; ++k) {
            const auto *row = reinterpret_cast<const Wide *>(rows[k]);
            h0 += row[0] * rows[k][i];
            h1 += row[1] * rows[k][i];
        }
        auto *h = reinterpret_cast<Wide *>(q.h[i]);
        h[0] = h0;
        h[1] = h1;
    }
    for (std::size_t i = 0; i < kStrings; ++i) {
        q.h[i][i] += p.proximal_weight;
        q.f[i] -= p.proximal_weight * p.proximal_target_n[i];
    }
}

} // namespace spidar::bench
