// eiquadprog's fixed-size solver (Goldfarb and Idnani) behind the interface of every peer (tests/bench/library_peers.h).
// Bounds are 16 general inequalities to it. It has no warm start.
#include <new>

#include <eiquadprog/eiquadprog-rt.hpp>

namespace {

constexpr int kN = 8;
using Solver = eiquadprog::solvers::RtEiquadprog<kN, 0, 2 * kN>;
using Matrix = Eigen::Matrix<double, kN, kN>; // symmetric: the order of storage does not matter
using Vector = Eigen::Matrix<double, kN, 1>;

struct Peer {
    EIGEN_MAKE_ALIGNED_OPERATOR_NEW
    Peer(const double *h, const double *f, const double *upper, const double *lower)
        : h(h), f(f), upper(upper), lower(lower) {
        bounds << Matrix::Identity(), -Matrix::Identity();
    }
    Eigen::Map<const Matrix> h;
    Eigen::Map<const Vector> f, upper, lower;
    Eigen::Matrix<double, 2 * kN, kN> bounds;
    Eigen::Matrix<double, 2 * kN, 1> limits;
    Vector x;
    Solver solver;
};

} // namespace

extern "C" {

void *peer_create(double *h, double *f, double *upper, double *lower) {
    return new (std::nothrow) Peer(h, f, upper, lower);
}

int peer_solve(void *handle, int /*warm*/, int /*quick*/, double *x) {
    auto &peer = *static_cast<Peer *>(handle);
    peer.limits << -peer.lower, peer.upper;
    const Eigen::Matrix<double, 0, kN> no_equations;
    const Eigen::Matrix<double, 0, 1> nothing;
    const auto status =
        peer.solver.solve_quadprog(peer.h, peer.f, no_equations, nothing, peer.bounds, peer.limits, peer.x);
    Eigen::Map<Vector>(x, kN) = peer.x;
    return status == eiquadprog::solvers::RT_EIQUADPROG_OPTIMAL;
}

void peer_free(void *handle) {
    delete static_cast<Peer *>(handle);
}

} // extern "C"
