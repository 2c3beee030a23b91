/* SPDX-License-Identifier: BSD-3-Clause */
#include "cracks.h"

#include <stdlib.h>

/* By nodes, then by triangles. */
static int compare(const void *a, const void *b)
{
    const cracks_side *one = a, *other = b;
    for (int k = 0; k < 2; k++)
        if (one->node[k] != other->node[k]) return one->node[k] < other->node[k] ? -1 : 1;
    return (one->triangle[0] > other->triangle[0]) - (one->triangle[0] < other->triangle[0]);
}

static void list_sides(cracks_side *side, const dem_lattice *l)
{
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index t = k / 3, a = l->triangles[k], b = l->triangles[3 * t + (k + 1) % 3];
        side[k] = (cracks_side){{a < b ? a : b, a < b ? b : a}, {t, t}};
    }
}

bool cracks_create(cracks *c, const dem_lattice *l)
{
    const size_t n = 3 * (size_t)l->n_triangles;
    *c = (cracks){.side = malloc((n + 1) * sizeof *c->side)};
    if (c->side == NULL) return false;
    list_sides(c->side, l);
    if (n > 0) qsort(c->side, n, sizeof *c->side, compare);
    for (size_t k = 1; k < n; k++) {
        const cracks_side one = c->side[k - 1], other = c->side[k];
        if (one.node[0] != other.node[0] || one.node[1] != other.node[1]) continue;
        c->side[c->n++] = (cracks_side){{one.node[0], one.node[1]}, {one.triangle[0], other.triangle[0]}};
    }
    return true;
}

void cracks_free(cracks *c)
{
    free(c->side);
    *c = (cracks){0};
}

bool cracks_open(const cracks_side *side, const unsigned char *broken)
{
    return (broken[side->triangle[0]] != 0) != (broken[side->triangle[1]] != 0);
}
