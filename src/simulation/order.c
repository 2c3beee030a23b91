/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/order.h"

#include "base/status.h"

static void join(void *packet, const void *other)
{
    if (!((const order *)packet)->is_known) *(order *)packet = *(const order *)other;
}

order order_pass(const ranks *r, order given)
{
    given.is_known = r->rank == 0;
    r->reduce(r->self, &given, sizeof given, join);
    return given;
}

dem_status order_answer(const dem_simulation *part, const order *what, void *out)
{
    switch (what->kind) {
    case ORDER_ENERGY:
        return dem_simulation_energy(part, out);
    case ORDER_STRAIN:
        return dem_simulation_strain(part, out);
    case ORDER_COUNTS:
        return dem_simulation_counts(part, out);
    case ORDER_RESIDUAL:
        *(double *)out = dem_simulation_residual(part);
        return DEM_OK;
    case ORDER_BODY:
        return dem_simulation_body(part, what->number, out);
    case ORDER_BOUNDARY:
        return dem_simulation_boundary(part, what->number, out);
    case ORDER_STRESS_AT:
        return dem_simulation_stress_at(part, what->number, out);
    case ORDER_FORCE_AT:
        return dem_simulation_force_at(part, what->number, out);
    default:
        return status_fail(DEM_ERROR_ARGUMENT, "order %d has no answer", (int)what->kind);
    }
}
