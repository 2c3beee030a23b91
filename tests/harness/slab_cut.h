/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs that are cut by hand out of a lattice, whatever bodies it is of. */
#ifndef DEM_TEST_SLAB_CUT_H
#define DEM_TEST_SLAB_CUT_H

#include <stdlib.h>

#include <dem/dem.h>

/* Marks own nodes and their neighbours.  \return [n_nodes], NULL without memory */
static inline bool *slab_cut_mark(const dem_lattice *l, dem_index first, dem_index end)
{
    bool *keep = calloc((size_t)l->n_nodes, sizeof *keep);
    for (dem_index i = first; i < end && keep != NULL; i++) keep[i] = true;
    for (dem_index t = 0; t < l->n_triangles && keep != NULL; t++) {
        const dem_index *c = &l->triangles[3 * t];
        bool has_own = false;
        for (int k = 0; k < 3; k++) has_own = has_own || (c[k] >= first && c[k] < end);
        for (int k = 0; k < 3 && has_own; k++) keep[c[k]] = true;
    }
    return keep;
}

static inline void slab_cut_list_rim(dem_slab *s, const bool *keep)
{
    dem_index n_rim = 0;
    for (dem_index i = 0; i < s->n_nodes; i++) {
        if (i == s->first_node) s->first_own = n_rim;
        if (keep[i] && (i < s->first_node || i >= s->first_node + s->n_own)) s->rim[n_rim++] = i;
    }
}

/** Cuts the slab with own nodes `first` to `end` - 1.  \return an empty slab without memory */
static inline dem_slab slab_cut(const dem_lattice *whole, dem_index first, dem_index end)
{
    dem_slab s = dem_slab_empty();
    bool *keep = slab_cut_mark(whole, first, end);
    s.rim = malloc((size_t)whole->n_nodes * sizeof *s.rim);
    s.n_nodes = whole->n_nodes;
    s.n_triangles = whole->n_triangles;
    s.first_node = first;
    s.n_own = end - first;
    if (keep != NULL && s.rim != NULL && dem_lattice_append(&s.lattice, whole) == DEM_OK &&
        dem_lattice_select(&s.lattice, keep) == DEM_OK)
        slab_cut_list_rim(&s, keep);
    else
        dem_slab_free(&s);
    free(keep);
    return s;
}

#endif
