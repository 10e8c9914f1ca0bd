// qpOASES (parametric active set) for bounded problems behind the interface of every peer
// (tests/bench/library_peers.h). A new Hessian needs init(); warm, it is given the last working set.
#include <new>

#include <qpOASES.hpp>

namespace {

constexpr int kN = 8;
constexpr int kWorkingSets = 200;

struct Peer {
    Peer(double *h, double *f, double *upper, double *lower)
        : h(h), f(f), upper(upper), lower(lower), problem(kN, qpOASES::HST_POSDEF) {
        qpOASES::Options options;
        options.setToMPC(); // its fastest set of options
        options.printLevel = qpOASES::PL_NONE;
        problem.setOptions(options);
    }
    double *h, *f, *upper, *lower;
    qpOASES::QProblemB problem;
};

} // namespace

extern "C" {

void *peer_create(double *h, double *f, double *upper, double *lower) {
    return new (std::nothrow) Peer(h, f, upper, lower);
}

int peer_solve(void *handle, int warm, int /*quick*/, double *x) {
    auto &peer = *static_cast<Peer *>(handle);
    qpOASES::Bounds last;
    if (warm) {
        peer.problem.getBounds(last);
    }
    peer.problem.reset();
    peer.problem.setHessianType(qpOASES::HST_POSDEF);
    qpOASES::int_t rounds = kWorkingSets;
    const auto status = peer.problem.init(peer.h, peer.f, peer.lower, peer.upper, rounds, nullptr, nullptr,
                                          nullptr, warm ? &last : nullptr);
    return peer.problem.getPrimalSolution(x) == qpOASES::SUCCESSFUL_RETURN &&
           status == qpOASES::SUCCESSFUL_RETURN;
}

void peer_free(void *handle) {
    delete static_cast<Peer *>(handle);
}

} // extern "C"
