/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the points in a box: points are sorted into square cells, whose numbers are hashed, so that memory goes with
 * the number of points and not with the area over which they are spread. */
#ifndef DEM_SURFACE_CONTACT_CELL_SEARCH_H
#define DEM_SURFACE_CONTACT_CELL_SEARCH_H

#include "base/vec2.h"

/** A point and its number. */
typedef struct cell_point {
    vec2 x;
    dem_index number;
} cell_point;

typedef struct cell_search {
    double side;         /* m, of a cell */
    double per_side;     /* its inverse */
    dem_index n;         /* points */
    dem_index n_buckets; /* a power of two */
    dem_index *first;    /* [n_buckets + 1] the points of each bucket */
    dem_index capacity, bucket_capacity;
    cell_point *points; /* [n] by bucket, ascending in each */
    dem_index n_found, found_capacity;
    dem_index *found; /* [n_found] numbers */
} cell_search;

/** An empty one is {0}. Free with cell_search_free(). */
void cell_search_free(cell_search *c);

/** Sorts points x [n][2] into cells.  \return DEM_ERROR_MEMORY */
dem_status cell_search_fill(cell_search *c, const double *x, dem_index n, double side);

/** Finds all points from `low` to `high`, into `found`; some may come more than once. The time goes with the number of
 *  cells of the box.  \return DEM_ERROR_MEMORY */
dem_status cell_search_find(cell_search *c, vec2 low, vec2 high);

#endif
