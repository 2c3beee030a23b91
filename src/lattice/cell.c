/* SPDX-License-Identifier: BSD-3-Clause */
#include "lattice/cell.h"

#include <stdlib.h>

#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"

/* Both triangles are counter-clockwise, so their common edge runs from a to b in one and from b to a in the other. */
bool cell_corners(const dem_lattice *l, dem_index first, dem_index second, dem_index corner[4])
{
    const dem_index *s = l->triangles + 3 * first, *t = l->triangles + 3 * second;
    for (int c = 0; c < 9; c++) {
        const int a = c % 3, b = c / 3;
        if (s[a] != t[(b + 1) % 3] || s[(a + 1) % 3] != t[b]) continue;
        corner[0] = s[(a + 2) % 3];
        corner[1] = s[a];
        corner[2] = t[(b + 2) % 3];
        corner[3] = s[(a + 1) % 3];
        return true;
    }
    return false;
}

bool cell_is_convex(const dem_lattice *l, const dem_index corner[4])
{
    for (int c = 0; c < 4; c++)
        if (vec2_triangle_area(vec2_at(l->x, corner[c]), vec2_at(l->x, corner[(c + 1) % 4]),
                               vec2_at(l->x, corner[(c + 2) % 4])) <= 0.0)
            return false;
    return true;
}

/* ---- which triangles ---- */

/* The other ends of springs, those of node i at row[i] to row[i + 1] - 1: each spring is listed at its first end. */
typedef struct spring_table {
    dem_index *row, *other; /* [n_nodes + 2], [n_springs] */
} spring_table;

static void list_springs(spring_table *s, const dem_lattice *l)
{
    for (dem_index k = 0; k < l->n_springs; k++) s->row[l->ends[2 * k] + 2]++;
    for (dem_index i = 0; i < l->n_nodes; i++) s->row[i + 2] += s->row[i + 1];
    for (dem_index k = 0; k < l->n_springs; k++) s->other[s->row[l->ends[2 * k] + 1]++] = l->ends[2 * k + 1];
}

static bool leads(const spring_table *s, dem_index from, dem_index to)
{
    for (dem_index p = s->row[from]; p < s->row[from + 1]; p++)
        if (s->other[p] == to) return true;
    return false;
}

/* In a mesh of triangles a spring may join the far corners of two as the side of a third, inside of which both are if
 * they share a node of three triangles: such a quadrilateral is not convex. */
static bool is_cell(const spring_table *s, const dem_lattice *l, dem_index first, dem_index second)
{
    dem_index q[4];
    if (!cell_corners(l, first, second, q) || !cell_is_convex(l, q)) return false;
    return leads(s, q[0], q[2]) || leads(s, q[2], q[0]);
}

dem_status cell_mark(unsigned char *half, const dem_lattice *l)
{
    spring_table s = {.row = lattice_zeros(l->n_nodes + 2, sizeof *s.row),
                      .other = lattice_zeros(l->n_springs, sizeof *s.other)};
    const bool complete = s.row != NULL && s.other != NULL;
    if (complete) list_springs(&s, l);
    for (dem_index t = 0; t < l->n_triangles; t++) half[t] = 0;
    for (dem_index t = 0; complete && t + 1 < l->n_triangles; t++)
        if (is_cell(&s, l, t, t + 1)) half[t] = half[t + 1] = 1;
    free(s.row);
    free(s.other);
    CHECK(complete, DEM_ERROR_MEMORY, "out of memory for %lld springs", (long long)l->n_springs);
    return DEM_OK;
}
