/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/rank_call.h"

#include "base/status.h"
#include "simulation/rank_shares.h"
#include "simulation/shared_field.h"

/* From rank 0 the call, from the others what is asked of them. */
typedef struct packet {
    bool is_known; /* the call, on rank 0 at first */
    rank_call call;
    int requests[RANKS_REQUESTS];
} packet;

static void join(void *both, const void *other)
{
    packet *own = both;
    const packet *theirs = other;
    if (!own->is_known && theirs->is_known) own->call = theirs->call;
    own->is_known = own->is_known || theirs->is_known;
    for (int k = 0; k < RANKS_REQUESTS; k++)
        if (theirs->requests[k] > own->requests[k]) own->requests[k] = theirs->requests[k];
}

/* Takes what is asked of a rank but rank 0, which is reported once. */
static void take_requests(const ranks *r, int *requests)
{
    for (int k = 0; k < RANKS_REQUESTS && r->rank > 0; k++) {
        volatile sig_atomic_t *noted = r->requests[k];
        requests[k] = noted != NULL ? *noted : 0;
        if (requests[k] != 0) *noted = 0;
    }
}

static void note_requests(const ranks *r, const int *requests)
{
    for (int k = 0; k < RANKS_REQUESTS && r->rank == 0; k++)
        if (requests[k] != 0 && r->requests[k] != NULL) *r->requests[k] = requests[k];
}

rank_call rank_call_send(const ranks *r, rank_call given)
{
    packet all = {.is_known = r->rank == 0, .call = given};
    take_requests(r, all.requests);
    r->reduce(r->self, &all, sizeof all, join);
    note_requests(r, all.requests);
    return all.call;
}

dem_status rank_call_answer(const dem_simulation *part, const rank_call *what, void *out)
{
    switch (what->kind) {
    case RANK_CALL_ENERGY:
        return dem_simulation_energy(part, out);
    case RANK_CALL_STRAIN:
        return dem_simulation_strain(part, out);
    case RANK_CALL_COUNTS:
        return dem_simulation_counts(part, out);
    case RANK_CALL_FASTEST:
        *(double *)out = dem_simulation_fastest(part);
        return DEM_OK;
    case RANK_CALL_RESIDUAL:
        *(double *)out = dem_simulation_residual(part);
        return DEM_OK;
    case RANK_CALL_BODY:
        return dem_simulation_body(part, what->number, out);
    case RANK_CALL_INERTIA:
        return dem_simulation_inertia(part, what->number, out);
    case RANK_CALL_BOUNDARY:
        return dem_simulation_boundary(part, what->number, out);
    case RANK_CALL_STRESS_AT:
        return dem_simulation_stress_at(part, what->number, out);
    case RANK_CALL_FORCE_AT:
        return dem_simulation_force_at(part, what->number, out);
    case RANK_CALL_FIELD:
        CHECK(part != NULL, DEM_ERROR_ARGUMENT, "this rank has no part of the simulation");
        return shared_field_gather(part, (field_kind)what->number, out);
    case RANK_CALL_SHARES:
        rank_shares_measure(out, part);
        return DEM_OK;
    default:
        return status_fail(DEM_ERROR_ARGUMENT, "call %d has no answer", (int)what->kind);
    }
}
