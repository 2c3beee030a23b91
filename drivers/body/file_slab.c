/* SPDX-License-Identifier: BSD-3-Clause */
/* Own nodes have all of their triangles, so that those of them that are on the boundary are known. */
#include "file_slab.h"

#include <stdlib.h>
#include <string.h>

#include <dem/dem.h>

#include "slab_nodes.h"

/* ---- whether it is plain ---- */

static bool is_elastic(const dem_lattice *l)
{
    return l->strength == NULL && l->critical_stretch == NULL && l->softening == NULL &&
           l->compressive_strength == NULL && l->confinement == NULL && l->own_stress == NULL;
}

/* As every lattice has them that was assembled: one that lacks them cannot be beside others. */
static bool has_moduli(const dem_lattice *l)
{
    return l->thickness != NULL && l->modulus != NULL;
}

/* \param is_used  whether it is in a triangle, \param n_edges  of the boundary at it */
static bool is_plain(const dem_lattice *l, dem_index i, bool is_used, dem_index n_edges)
{
    const unsigned boundary = n_edges > 0 ? DEM_NODE_CONTACT : 0;
    return is_used && (l->flags == NULL || l->flags[i] == boundary) &&
           (l->position == NULL || memcmp(l->position + 2 * i, l->x + 2 * i, 2 * sizeof *l->x) == 0);
}

/* \param is_used, n_edges  [n_nodes] zeros */
static dem_status check_nodes(const dem_slab *slab, bool *is_used, dem_index *n_edges)
{
    const dem_lattice *l = &slab->lattice;
    const dem_status status = dem_lattice_rims(l, n_edges);
    if (status != DEM_OK) return status;
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) is_used[l->triangles[k]] = true;
    for (dem_index i = slab->first_own; i < slab->first_own + slab->n_own; i++)
        if (!is_plain(l, i, is_used[i], n_edges[i])) return DEM_ERROR_MODEL;
    return DEM_OK;
}

/* Whether a slab has the springs along all sides of a triangle: not those between two nodes of the rim. */
static bool has_sides(const dem_slab *slab, const dem_index *corner)
{
    int own = 0;
    for (int c = 0; c < 3; c++) own += slab_nodes_own(slab, corner[c]);
    return own >= 2;
}

/* By the rules for nodes, springs and triangles, as the whole is checked: what they refuse is to be said of it. A
 * triangle with a coupling needs its springs. */
static dem_status check_rules(const dem_slab *slab)
{
    dem_lattice l = slab->lattice;
    dem_model *model = NULL;
    double *coupling = calloc(3 * (size_t)l.n_triangles + 1, sizeof *coupling);
    if (coupling == NULL) return DEM_ERROR_MEMORY;
    for (dem_index t = 0; t < l.n_triangles && l.coupling != NULL; t++)
        if (has_sides(slab, l.triangles + 3 * t)) memcpy(coupling + 3 * t, l.coupling + 3 * t, 3 * sizeof *coupling);
    if (l.coupling != NULL) l.coupling = coupling;
    const dem_status status = dem_model_create_borrowing(&model, &l, NULL, 0);
    dem_model_destroy(model);
    free(coupling);
    return status;
}

/* ---- what is asked for ---- */

dem_status file_slab_check(const dem_slab *slab)
{
    const size_t n = (size_t)slab->lattice.n_nodes + 1;
    if (!is_elastic(&slab->lattice) || !has_moduli(&slab->lattice)) return DEM_ERROR_MODEL;
    bool *is_used = calloc(n, sizeof *is_used);
    dem_index *n_edges = calloc(n, sizeof *n_edges);
    dem_status status = is_used != NULL && n_edges != NULL ? check_nodes(slab, is_used, n_edges) : DEM_ERROR_MEMORY;
    free(is_used);
    free(n_edges);
    if (status == DEM_OK) status = check_rules(slab);
    return status == DEM_OK || status == DEM_ERROR_MEMORY ? status : DEM_ERROR_MODEL;
}

void file_slab_forget_start(dem_slab *slab)
{
    free(slab->lattice.position);
    slab->lattice.position = NULL;
}

dem_status file_slab_join_strip(dem_lattice *strip, double rest_length)
{
    const dem_material any = {
        .struct_size = sizeof any, .youngs_modulus = 1.0, .poissons_ratio = 0.3, .density = 1.0, .thickness = 1.0};
    const dem_status status = dem_lattice_assemble(strip, &any);
    for (dem_index k = 0; status == DEM_OK && k < strip->n_springs; k++) strip->rest_length[k] = rest_length;
    return status;
}
