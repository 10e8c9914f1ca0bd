/* DAQP behind the interface of every peer (tests/bench/library_peers.h): built by fetch_peers.py together with its own
 * sources, opened by spidar_bench at run time. 8 variables, box bounds only. */
#include <stdlib.h>

#include "api.h"
#include "daqp.h"
#include "utils.h"

enum { N = 8 };

typedef struct {
    DAQPProblem qp;
    DAQPWorkspace work;
    DAQPResult result;
    int sense[N];
    double x[N];
} Peer;

/* h: row-major 8 x 8. The arrays are kept and read at each solve. */
void *peer_create(double *h, double *f, double *upper, double *lower) {
    Peer *peer = calloc(1, sizeof(Peer));
    peer->qp.n = N;
    peer->qp.m = N;
    peer->qp.ms = N;
    peer->qp.H = h;
    peer->qp.f = f;
    peer->qp.bupper = upper;
    peer->qp.blower = lower;
    peer->qp.sense = peer->sense;
    peer->result.x = peer->x;
    peer->result.lam = NULL; /* nobody reads the multipliers */
    if (setup_daqp(&peer->qp, &peer->work, NULL) < 0) {
        return NULL;
    }
    return peer;
}

/* warm: from the working set of the last solve. quick: look at the unconstrained optimum first.
 * Returns the exit flag, 1 for an optimum. */
int peer_solve(void *handle, int warm, int quick, double *x) {
    Peer *peer = handle;
    int mask = DAQP_UPDATE_Rinv | DAQP_UPDATE_M | DAQP_UPDATE_v | DAQP_UPDATE_d;
    if (!warm) {
        mask |= DAQP_UPDATE_sense;
        reset_daqp_workspace(&peer->work);
    }
    if (quick) {
        mask |= DAQP_UPDATE_unconstrained;
    }
    int flag = daqp_update_ldp(mask, &peer->work, &peer->qp);
    if (flag < 0) {
        return flag;
    }
    daqp_solve(&peer->result, &peer->work);
    for (int i = 0; i < N; ++i) {
        x[i] = peer->result.x[i];
    }
    return peer->result.exitflag;
}

void peer_free(void *handle) {
    Peer *peer = handle;
    free_daqp_workspace(&peer->work);
    free_daqp_ldp(&peer->work);
    free(peer);
}
