/* SPDX-License-Identifier: BSD-3-Clause */
#include "crack.h"

#include <math.h>
#include <stdlib.h>

/* Both ends of every segment to its left; between two segments they make a link, so that the crack has no gaps.
 * \param[out] path  [2 n_points - 2][2] */
static void shift_path(double *path, const double *points, size_t n_points, double shift)
{
    for (size_t k = 0; k + 1 < n_points; k++) {
        const double *a = points + 2 * k, *b = a + 2;
        const double tx = b[0] - a[0], ty = b[1] - a[1], length = sqrt(tx * tx + ty * ty);
        for (int end = 0; end < 2; end++) {
            path[4 * k + 2 * (size_t)end] = a[2 * end] - shift * ty / length;
            path[4 * k + 2 * (size_t)end + 1] = a[2 * end + 1] + shift * tx / length;
        }
    }
}

static double side_of(const double *a, const double *b, const double *p)
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* Whether all of three corners lie beyond the box of a segment. */
static bool is_far(const double *a, const double *b, const double *const corner[3])
{
    for (int c = 0; c < 2; c++) {
        const double low = fmin(a[c], b[c]), high = fmax(a[c], b[c]);
        if (corner[0][c] < low && corner[1][c] < low && corner[2][c] < low) return true;
        if (corner[0][c] > high && corner[1][c] > high && corner[2][c] > high) return true;
    }
    return false;
}

/* By separating lines: none of the segment, of its box, or of a side of the counter-clockwise triangle. */
static bool crosses(const double *a, const double *b, const double *const corner[3])
{
    if (is_far(a, b, corner)) return false;
    const double s[3] = {side_of(a, b, corner[0]), side_of(a, b, corner[1]), side_of(a, b, corner[2])};
    if ((s[0] > 0.0 && s[1] > 0.0 && s[2] > 0.0) || (s[0] < 0.0 && s[1] < 0.0 && s[2] < 0.0)) return false;
    for (int c = 0; c < 3; c++) {
        const double *p = corner[c], *q = corner[(c + 1) % 3];
        if (side_of(p, q, a) < 0.0 && side_of(p, q, b) < 0.0) return false;
    }
    return true;
}

/* Elements of a lattice, with `arity` nodes each. */
typedef struct elements {
    const double *x;
    const dem_index *nodes;
    dem_index n;
    int arity; /* 3, or 2: of a triangle without height */
} elements;

static bool is_hit(const elements *e, dem_index k, const double *path, size_t n_points)
{
    const double *corner[3];
    bool hit = false;
    for (int c = 0; c < 3; c++) corner[c] = e->x + 2 * e->nodes[e->arity * k + (c < e->arity ? c : e->arity - 1)];
    for (size_t p = 0; p + 1 < n_points && !hit; p++) hit = crosses(path + 2 * p, path + 2 * p + 2, corner);
    return hit;
}

static dem_index mark(bool *keep, const elements *e, const double *points, size_t n_points, double shift)
{
    const size_t n = 2 * n_points - 2;
    double *path = calloc(n, 2 * sizeof *path);
    dem_index crossed = 0;
    if (path == NULL) return -1;
    shift_path(path, points, n_points, shift);
    for (dem_index k = 0; k < e->n; k++) {
        const bool hit = is_hit(e, k, path, n);
        if (hit) keep[k] = 0;
        crossed += hit;
    }
    free(path);
    return crossed;
}

dem_index crack_mark(bool *keep, const dem_lattice *lattice, const double *points, size_t n_points, double shift)
{
    const elements triangles = {lattice->x, lattice->triangles, lattice->n_triangles, 3};
    return mark(keep, &triangles, points, n_points, shift);
}

dem_index crack_mark_springs(bool *keep, const dem_lattice *lattice, const double *points, size_t n_points,
                             double shift)
{
    const elements springs = {lattice->x, lattice->ends, lattice->n_springs, 2};
    return mark(keep, &springs, points, n_points, shift);
}
