/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/stars.h"

#include <stdlib.h>

/* Counting sort of the corners by their nodes: the triangles of a node keep their order. */
bool stars_create(stars *out, const dem_lattice *lattice)
{
    const dem_index n = lattice->n_nodes, n_sides = 3 * lattice->n_triangles;
    stars s = {calloc((size_t)n + 2, sizeof *s.first), calloc((size_t)n_sides + 1, sizeof *s.list)};
    *out = (stars){0};
    if (s.first == NULL || s.list == NULL) {
        stars_free(&s);
        return false;
    }
    /* Counts are entered two places ahead, so that first[i + 1] is where node i goes on while its list is filled. */
    for (dem_index k = 0; k < n_sides; k++) s.first[lattice->triangles[k] + 2]++;
    for (dem_index i = 0; i <= n; i++) s.first[i + 1] += s.first[i];
    for (dem_index k = 0; k < n_sides; k++) s.list[s.first[lattice->triangles[k] + 1]++] = k / 3;
    *out = s;
    return true;
}

void stars_free(stars *s)
{
    free(s->first);
    free(s->list);
    *s = (stars){0};
}

dem_index stars_end(const dem_lattice *lattice, dem_index side)
{
    return lattice->triangles[side % 3 == 2 ? side - 2 : side + 1];
}

dem_index stars_across(const stars *s, const dem_lattice *lattice, dem_index side)
{
    const dem_index from = lattice->triangles[side], to = stars_end(lattice, side);
    for (dem_index p = s->first[from]; p < s->first[from + 1]; p++)
        for (dem_index other = 3 * s->list[p]; other < 3 * s->list[p] + 3; other++)
            if (lattice->triangles[other] == to && stars_end(lattice, other) == from) return other;
    return -1;
}
