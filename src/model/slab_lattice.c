/* SPDX-License-Identifier: BSD-3-Clause */
/* Own nodes have all of their triangles, and so the flags that they have in the whole, and are on its boundary if they
 * are on that of the slab. What the rim has comes from its owners. */
#include "model/slab_lattice.h"

#include <stdlib.h>

#include "base/reduce.h"
#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"
#include "lattice/slab.h"
#include "model/breakable_nodes.h"
#include "model/mesh_boundary.h"
#include "model/model_rules.h"

static dem_status lacks_memory(const dem_lattice *l)
{
    return status_fail(DEM_ERROR_MEMORY, "out of memory for a slab of %lld nodes", (long long)l->n_nodes);
}

/* ---- what is refused ---- */

static dem_status check_kind(const dem_lattice *l)
{
    CHECK(l->n_triangles > 0, DEM_ERROR_MODEL, "slabs of bodies without triangles are not supported");
    CHECK(!breakable_lattice(l), DEM_ERROR_MODEL, "slabs of bodies that may break are not supported");
    for (dem_index i = 0; i < l->n_nodes; i++)
        CHECK(l->flags == NULL || !(l->flags[i] & DEM_NODE_RIGID), DEM_ERROR_MODEL,
              "node %lld: slabs of rigid bodies are not supported", (long long)i);
    return DEM_OK;
}

dem_status slab_lattice_check_bodies(const dem_slab *s, const slab_rows *rows)
{
    const dem_index own[2] = {s->first_own, s->first_own + s->n_own};
    unsigned char *is_loose = lattice_zeros(s->lattice.n_nodes, sizeof *is_loose);
    TRY(reduce_status(rows->ranks, is_loose != NULL ? DEM_OK : lacks_memory(&s->lattice), 0.0));
    for (dem_index i = own[0]; i < own[1]; i++) is_loose[i] = rows->springs.row[i] == rows->springs.row[i + 1];
    const dem_status status = model_rules_check_bodies(&s->lattice, rows->ranks, own, is_loose);
    free(is_loose);
    return status;
}

/* ---- what arrays stand for ---- */

/* A fixed node has no velocity. */
static dem_status complete(dem_lattice *l)
{
    const bool has_flags = l->flags != NULL;
    if (!has_flags) l->flags = lattice_zeros(l->n_nodes, sizeof *l->flags);
    if (l->body == NULL) l->body = lattice_zeros(l->n_nodes, sizeof *l->body);
    if (l->velocity == NULL) l->velocity = lattice_zeros(l->n_nodes, 2 * sizeof *l->velocity);
    if (l->flags == NULL || l->body == NULL || l->velocity == NULL) return lacks_memory(l);
    if (!has_flags) TRY(mesh_edges_contact_flags(l->flags, l));
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->flags[i] & DEM_NODE_FIXED) vec2_put(l->velocity, i, (vec2){0.0, 0.0});
    return DEM_OK;
}

/* ---- common nodes ---- */

dem_status slab_lattice_mark_common(unsigned char **out, const dem_lattice *l, bool has_obstacles, bool touching)
{
    *out = NULL;
    if (!has_obstacles && !touching) return DEM_OK;
    unsigned char *marks = *out = lattice_zeros(l->n_nodes, sizeof *marks);
    if (marks == NULL) return lacks_memory(l);
    if (touching) TRY(mesh_boundary_mark_nodes(l, marks, 1));
    for (dem_index i = 0; i < l->n_nodes && has_obstacles; i++)
        if (l->flags[i] & DEM_NODE_CONTACT) marks[i] = 1;
    return DEM_OK;
}

/* ---- public ---- */

dem_status slab_lattice_take(dem_slab *out, dem_slab *slab)
{
    *out = dem_slab_empty();
    TRY(slab_take(out, slab));
    TRY(model_rules_check(&out->lattice, out->n_nodes));
    TRY(check_kind(&out->lattice));
    return complete(&out->lattice);
}
