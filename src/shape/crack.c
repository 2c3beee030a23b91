/* SPDX-License-Identifier: BSD-3-Clause */
/* Cracks: which triangles and springs of a lattice a polyline crosses. */
#include <dem/shape.h>

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "lattice/lattice.h"

/* Both ends of every segment to its left; between two segments they make a link, so that the crack has no gaps.
 * \param[out] path  [2 n_points - 2][2] */
static void shift_path(double *path, const double *points, dem_index n_points, double shift)
{
    for (dem_index k = 0; k + 1 < n_points; k++) {
        const double *a = points + 2 * k, *b = a + 2;
        const double tx = b[0] - a[0], ty = b[1] - a[1], length = sqrt(tx * tx + ty * ty);
        for (int end = 0; end < 2; end++) {
            path[4 * k + 2 * end] = a[2 * end] - shift * ty / length;
            path[4 * k + 2 * end + 1] = a[2 * end + 1] + shift * tx / length;
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

static bool is_hit(const elements *e, dem_index k, const double *path, dem_index n_points)
{
    const double *corner[3];
    bool hit = false;
    for (int c = 0; c < 3; c++) corner[c] = e->x + 2 * e->nodes[e->arity * k + (c < e->arity ? c : e->arity - 1)];
    for (dem_index p = 0; p + 1 < n_points && !hit; p++) hit = crosses(path + 2 * p, path + 2 * p + 2, corner);
    return hit;
}

static void mark(bool *flags, const elements *e, const double *path, dem_index n_points)
{
    for (dem_index k = 0; k < e->n && flags != NULL; k++) flags[k] = is_hit(e, k, path, n_points);
}

dem_status dem_lattice_crossed(const dem_lattice *lattice, const double *points, dem_index n_points, double aside,
                               bool *triangles, bool *springs)
{
    TRY(lattice_check(lattice));
    CHECK(isfinite(aside) && aside >= 0.0, DEM_ERROR_ARGUMENT, "aside must be >= 0: %g m", aside);
    CHECK(n_points >= 2, DEM_ERROR_ARGUMENT, "a crack must have at least 2 points, got %lld", (long long)n_points);
    TRY(dem_points_check(points, n_points));
    const dem_index n = 2 * n_points - 2;
    double *path = lattice_zeros(n, 2 * sizeof *path);
    CHECK_MEMORY(path);
    shift_path(path, points, n_points, aside);
    mark(triangles, &(elements){lattice->x, lattice->triangles, lattice->n_triangles, 3}, path, n);
    mark(springs, &(elements){lattice->x, lattice->ends, lattice->n_springs, 2}, path, n);
    free(path);
    return DEM_OK;
}
