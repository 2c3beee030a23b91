/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/rank_call.h"

#include "base/status.h"

static void join(void *packet, const void *other)
{
    if (!((const rank_call *)packet)->is_known) *(rank_call *)packet = *(const rank_call *)other;
}

rank_call rank_call_send(const ranks *r, rank_call given)
{
    given.is_known = r->rank == 0;
    r->reduce(r->self, &given, sizeof given, join);
    return given;
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
    case RANK_CALL_BOUNDARY:
        return dem_simulation_boundary(part, what->number, out);
    case RANK_CALL_STRESS_AT:
        return dem_simulation_stress_at(part, what->number, out);
    case RANK_CALL_FORCE_AT:
        return dem_simulation_force_at(part, what->number, out);
    default:
        return status_fail(DEM_ERROR_ARGUMENT, "call %d has no answer", (int)what->kind);
    }
}
