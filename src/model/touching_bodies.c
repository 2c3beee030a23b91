/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/touching_bodies.h"

#include <stdlib.h>

#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"

dem_status touching_bodies_sum_up(touching_bodies *out, const dem_lattice *l)
{
    touching_bodies o = {.n_bodies = lattice_count_bodies(l)};
    o.bodies = calloc((size_t)o.n_bodies + 1, sizeof *o.bodies);
    CHECK_MEMORY(o.bodies);
    for (dem_index k = 0; k < l->n_springs; k++)
        o.bodies[l->body[l->ends[2 * k]]].springs += l->stiffness[k] * l->rest_length[k];
    for (dem_index k = 0; k < l->n_triangles; k++)
        o.bodies[l->body[l->triangles[3 * k]]].area += vec2_area_of(l->x, &l->triangles[3 * k]);
    *out = o;
    return DEM_OK;
}

dem_status touching_bodies_create(touching_bodies *out, const dem_lattice *lattice)
{
    touching_bodies o;
    TRY(touching_bodies_sum_up(&o, lattice));
    const dem_status status = mesh_boundary_create(&o.boundary, lattice, NULL);
    if (status == DEM_OK)
        *out = o;
    else
        touching_bodies_free(&o);
    return status;
}

void touching_bodies_free(touching_bodies *o)
{
    mesh_boundary_free(&o->boundary);
    free(o->bodies);
    *o = (touching_bodies){0};
}
