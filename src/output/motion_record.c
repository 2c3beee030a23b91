/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields of motions that are numbers are written with an obstacle and read back (obstacle_file.c). A function of a
 * program cannot be written. But the history has the place and angle of each obstacle after every step, which is enough
 * to draw it: between rows they are off by the acceleration times an eighth of the square of a step. */
#include "output/motion_record.h"

#include <math.h>
#include <stdlib.h>

#include "base/status.h"
#include "lattice/lattice.h"

/* Rows of a column of the history, of which one obstacle's numbers are kept, `width` to a row; `items`: of how many
 * obstacles the column has numbers, 0 if there is no item. */
typedef struct column {
    const char *name;
    dem_index items, width;
} column;

static dem_status measure(const hdf5_file *file, const column *c, dem_index *n)
{
    hdf5_untrusted_shape shape;
    const hsize_t items = c->items > 0 ? (hsize_t)c->items : 1;
    TRY(hdf5_untrusted_measure(file, c->name, HDF5_F64, &shape));
    if (shape.extent[1] != items || shape.extent[2] != (hsize_t)c->width)
        return hdf5_untrusted_refuse(file, c->name, "has not a row of numbers for each obstacle");
    if ((dem_index)shape.extent[0] < *n) *n = (dem_index)shape.extent[0];
    return DEM_OK;
}

/* Reads n rows of all obstacles, and keeps those of one. */
static dem_status read_column(double **out, const hdf5_file *file, const column *c, dem_index obstacle, dem_index n)
{
    const dem_index items = c->items > 0 ? c->items : 1, row = items * c->width;
    double *all = lattice_zeros(n, (size_t)row * sizeof *all);
    *out = lattice_zeros(n, (size_t)c->width * sizeof **out);
    dem_status status = DEM_OK;
    if (all == NULL || *out == NULL) status = status_fail(DEM_ERROR_MEMORY, "out of memory");
    if (status == DEM_OK)
        status = hdf5_untrusted_read(file, c->name, HDF5_F64, (hdf5_untrusted_rows){0, (hsize_t)n, 0}, all);
    for (dem_index k = 0; k < n && status == DEM_OK; k++)
        for (dem_index d = 0; d < c->width; d++) (*out)[k * c->width + d] = all[k * row + obstacle * c->width + d];
    free(all);
    return status;
}

dem_status motion_record_read(motion_record *out, const hdf5_file *file, dem_index obstacle, dem_index n_obstacles)
{
    const column t = {"/history/t", 0, 1}, place = {"/history/obstacle_displacement", n_obstacles, 2},
                 angle = {"/history/obstacle_angle", n_obstacles, 1};
    bool present = false;
    dem_index n = INT64_MAX;
    *out = (motion_record){.n = 0};
    TRY(hdf5_untrusted_find(file, place.name, &present));
    if (!present) return DEM_OK;
    TRY(measure(file, &t, &n));
    TRY(measure(file, &place, &n));
    TRY(measure(file, &angle, &n));
    TRY(read_column(&out->t, file, &t, 0, n));
    TRY(read_column(&out->place, file, &place, obstacle, n));
    TRY(read_column(&out->angle, file, &angle, obstacle, n));
    out->n = n;
    return DEM_OK;
}

void motion_record_free(motion_record *r)
{
    free(r->t);
    free(r->place);
    free(r->angle);
}

/* The last row that is not later than t, by bisection; 0 before the first. */
static dem_index row_before(const motion_record *r, double t)
{
    dem_index low = 0, high = r->n;
    while (high - low > 1) {
        const dem_index middle = low + (high - low) / 2;
        if (r->t[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

dem_status motion_record_pose(void *context, double t, dem_pose *pose)
{
    const motion_record *r = context;
    if (r->n == 0) return DEM_OK;
    const dem_index k = row_before(r, t), next = k + 1 < r->n ? k + 1 : k;
    const double span = r->t[next] - r->t[k];
    const double share = span > 0.0 ? fmin(fmax((t - r->t[k]) / span, 0.0), 1.0) : 0.0;
    for (int d = 0; d < 2; d++)
        pose->place[d] = r->place[2 * k + d] + share * (r->place[2 * next + d] - r->place[2 * k + d]);
    pose->angle = r->angle[k] + share * (r->angle[next] - r->angle[k]);
    return DEM_OK;
}
