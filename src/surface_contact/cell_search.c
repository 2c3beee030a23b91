/* SPDX-License-Identifier: BSD-3-Clause */
/* Hashed cells. Cells in a row along x have buckets one after the other, so that a box reads neighbouring memory; rows
 * are spread by a large odd factor. Several cells may share a bucket: every point of it is compared with the box. */
#include "surface_contact/cell_search.h"

#include <stdint.h>
#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

void cell_search_free(cell_search *c)
{
    free(c->first);
    free(c->points);
    free(c->found);
    *c = (cell_search){0};
}

/* The cell of a coordinate. Whatever the coordinate is, not finite included, the number fits into an integer. */
static int64_t cell_at(const cell_search *c, double coordinate)
{
    static const double most = 1e15;
    const double cell = coordinate * c->per_side;
    if (!(cell > -most)) return -(int64_t)most;
    if (cell > most) return (int64_t)most;
    const int64_t towards_zero = (int64_t)cell;
    return towards_zero - ((double)towards_zero > cell);
}

static dem_index bucket_of(const cell_search *c, int64_t column, int64_t row)
{
    const uint64_t hash = (uint64_t)column + (uint64_t)row * 0x9e3779b97f4a7c15u;
    return (dem_index)(hash & (uint64_t)(c->n_buckets - 1));
}

static dem_status reserve(cell_search *c, dem_index n)
{
    c->n_buckets = 16;
    while (c->n_buckets < 2 * n) c->n_buckets *= 2;
    CHECK(grow_array((void **)&c->points, &c->capacity, n, sizeof *c->points) &&
              grow_array((void **)&c->first, &c->bucket_capacity, c->n_buckets + 2, sizeof *c->first),
          DEM_ERROR_MEMORY, "out of memory for the search among %lld points", (long long)n);
    return DEM_OK;
}

/* Counting sort: counts are entered two places ahead and summed up, so that first[b + 1] is where bucket b goes on
 * while it is filled, and first[b] where it begins once all are. */
dem_status cell_search_fill(cell_search *c, const double *x, dem_index n, double side)
{
    c->side = side;
    c->per_side = 1.0 / side;
    c->n = n;
    TRY(reserve(c, n));
    for (dem_index b = 0; b < c->n_buckets + 2; b++) c->first[b] = 0;
    for (dem_index i = 0; i < n; i++) c->first[bucket_of(c, cell_at(c, x[2 * i]), cell_at(c, x[2 * i + 1])) + 2]++;
    for (dem_index b = 1; b < c->n_buckets + 2; b++) c->first[b] += c->first[b - 1];
    for (dem_index i = 0; i < n; i++) {
        const dem_index b = bucket_of(c, cell_at(c, x[2 * i]), cell_at(c, x[2 * i + 1]));
        c->points[c->first[b + 1]++] = (cell_point){vec2_at(x, i), i};
    }
    return DEM_OK;
}

static bool is_inside(vec2 x, vec2 low, vec2 high)
{
    return x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y;
}

/* Looks at the points of buckets `begin` to `end` - 1. */
static dem_status look_into(cell_search *c, dem_index begin, dem_index end, const vec2 box[2])
{
    const dem_index first = c->first[begin], last = c->first[end];
    CHECK(grow_array((void **)&c->found, &c->found_capacity, c->n_found + last - first, sizeof *c->found),
          DEM_ERROR_MEMORY, "out of memory for the points of a box");
    for (dem_index k = first; k < last; k++)
        if (is_inside(c->points[k].x, box[0], box[1])) c->found[c->n_found++] = c->points[k].number;
    return DEM_OK;
}

/* The cells of a row are buckets one after the other, which begin again at the first one behind the last. */
dem_status cell_search_find(cell_search *c, vec2 low, vec2 high)
{
    const vec2 box[2] = {low, high};
    const int64_t column = cell_at(c, low.x), last_row = cell_at(c, high.y);
    const int64_t n_columns = cell_at(c, high.x) - column + 1, n = n_columns < c->n_buckets ? n_columns : c->n_buckets;
    c->n_found = 0;
    for (int64_t row = cell_at(c, low.y); row <= last_row; row++) {
        const dem_index begin = bucket_of(c, column, row), beyond = begin + n - c->n_buckets;
        TRY(look_into(c, begin, beyond > 0 ? c->n_buckets : begin + n, box));
        if (beyond > 0) TRY(look_into(c, 0, beyond, box));
    }
    return DEM_OK;
}
