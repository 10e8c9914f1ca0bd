/* quadprog (Goldfarb and Idnani's dual method, as in R) behind the interface of every peer (tests/bench/library_peers.h).
 * Bounds are 16 general constraints to it: it knows no others. It has no warm start. */
#include <stdlib.h>
#include <string.h>

enum { N = 8, BOUNDS = 2 * N, WORK = 2 * N + 2 * BOUNDS + N * (N + 5) / 2 };

int qpgen2_(double *G, double *av, int n, double *xv, double *lagr, double *obj, double *C, double *bv, int q, int meq,
            int *iact, int *nact, int *iter, double *work, int factorized);

typedef struct {
    const double *h, *f, *upper, *lower;
    double constraints[BOUNDS * N]; /* column by column */
} Peer;

void *peer_create(double *h, double *f, double *upper, double *lower) {
    Peer *peer = calloc(1, sizeof(Peer));
    peer->h = h;
    peer->f = f;
    peer->upper = upper;
    peer->lower = lower;
    for (int i = 0; i < N; ++i) {
        peer->constraints[i * N + i] = 1.0;        /* x >= lower */
        peer->constraints[(N + i) * N + i] = -1.0; /* -x >= -upper */
    }
    return peer;
}

int peer_solve(void *handle, int warm, int quick, double *x) {
    (void)warm;
    (void)quick;
    Peer *peer = handle;
    double h[N * N], linear[N], constraints[BOUNDS * N], limits[BOUNDS], multipliers[BOUNDS], work[WORK], objective;
    int active[BOUNDS], count = 0, iterations[2] = {0, 0};
    memcpy(h, peer->h, sizeof h); /* it destroys its input */
    memcpy(constraints, peer->constraints, sizeof constraints);
    for (int i = 0; i < N; ++i) {
        linear[i] = -peer->f[i];
        limits[i] = peer->lower[i];
        limits[N + i] = -peer->upper[i];
    }
    return qpgen2_(h, linear, N, x, multipliers, &objective, constraints, limits, BOUNDS, 0, active, &count, iterations,
                   work, 0) == 0;
}

void peer_free(void *handle) {
    free(handle);
}
