/* SPDX-License-Identifier: BSD-3-Clause */
/* Own nodes have all of their triangles, and so the flags that they have in the whole. Those of the rim come
 * from their owners. */
#include "model/slab_lattice.h"

#include <stdlib.h>

#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"
#include "lattice/slab.h"
#include "model/breakable_nodes.h"
#include "model/model_rules.h"

/* ---- what is refused ---- */

static dem_status check_kind(const dem_lattice *l)
{
    CHECK(l->n_triangles > 0, DEM_ERROR_MODEL, "slabs of bodies without triangles are not supported");
    CHECK(!breakable_lattice(l), DEM_ERROR_MODEL, "slabs of bodies that may break are not supported");
    for (dem_index i = 0; i < l->n_nodes; i++) {
        CHECK(l->body == NULL || l->body[i] == 0, DEM_ERROR_MODEL,
              "node %lld: slabs of several bodies are not supported", (long long)i);
        CHECK(l->flags == NULL || !(l->flags[i] & DEM_NODE_RIGID), DEM_ERROR_MODEL,
              "node %lld: slabs of rigid bodies are not supported", (long long)i);
    }
    return DEM_OK;
}

/* Own nodes have springs. */
static dem_status check_springs(const dem_slab *s)
{
    const dem_lattice *l = &s->lattice;
    bool *has_spring = lattice_zeros(l->n_nodes, sizeof *has_spring);
    dem_index loose = -1;
    CHECK_MEMORY(has_spring);
    for (dem_index k = 0; k < 2 * l->n_springs; k++) has_spring[l->ends[k]] = true;
    for (dem_index i = s->first_own; i < s->first_own + s->n_own && loose < 0; i++)
        if (!has_spring[i]) loose = i;
    free(has_spring);
    CHECK(loose < 0, DEM_ERROR_MODEL, "node %lld at (%g, %g) m has no springs", (long long)loose, l->x[2 * loose],
          l->x[2 * loose + 1]);
    return DEM_OK;
}

/* ---- what arrays stand for ---- */

/* A fixed node has no velocity. */
static dem_status complete(dem_lattice *l)
{
    const bool has_flags = l->flags != NULL;
    if (!has_flags) l->flags = lattice_zeros(l->n_nodes, sizeof *l->flags);
    if (l->body == NULL) l->body = lattice_zeros(l->n_nodes, sizeof *l->body);
    if (l->velocity == NULL) l->velocity = lattice_zeros(l->n_nodes, 2 * sizeof *l->velocity);
    CHECK(l->flags && l->body && l->velocity, DEM_ERROR_MEMORY, "out of memory for a slab of %lld nodes",
          (long long)l->n_nodes);
    if (!has_flags) TRY(mesh_edges_contact_flags(l->flags, l));
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->flags[i] & DEM_NODE_FIXED) vec2_put(l->velocity, i, (vec2){0.0, 0.0});
    return DEM_OK;
}

/* ---- public ---- */

dem_status slab_lattice_take(dem_slab *out, dem_slab *slab)
{
    *out = dem_slab_empty();
    TRY(slab_take(out, slab));
    TRY(model_rules_check(&out->lattice, out->n_nodes));
    TRY(check_kind(&out->lattice));
    TRY(check_springs(out));
    return complete(&out->lattice);
}
