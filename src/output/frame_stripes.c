/* SPDX-License-Identifier: BSD-3-Clause */
#include "output/frame_stripes.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "base/team.h"

/* Where stripe k begins, and its rows. */
static dem_index first_of(const frames *f, frame_of of, int k)
{
    return team_share(frame_arrays_count(f, of), f->n_stripes, k);
}

static dem_index rows_of(const frames *f, frame_of of, int k)
{
    return first_of(f, of, k + 1) - first_of(f, of, k);
}

frames frame_stripes_get(const frames *f, int k)
{
    return (frames){.n_nodes = rows_of(f, FRAME_OF_NODES, k),
                    .n_springs = rows_of(f, FRAME_OF_SPRINGS, k),
                    .n_triangles = rows_of(f, FRAME_OF_TRIANGLES, k),
                    .fields = f->fields,
                    .real = f->real,
                    .deflate = f->deflate,
                    .n = f->n};
}

dem_status frame_stripes_create(const frames *stripe, const hdf5_file *file)
{
    for (int k = 0; k < FRAME_ARRAYS; k++) {
        const hdf5_rows rows = frame_arrays_rows(stripe, k);
        if (frame_arrays_is_wanted(stripe, k)) TRY(hdf5_create(file, &rows));
    }
    return DEM_OK;
}

dem_status frame_stripes_copy(const frames *f, int k, const hdf5_file *from, const hdf5_file *to, hdf5_span span)
{
    const frames stripe = frame_stripes_get(f, k);
    frame_arrays_copying c = {.whole = f, .target = &stripe, .from = from, .to = to};
    for (frame_of of = 0; of < FRAME_OFS; of++) c.first[of] = first_of(f, of, k);
    return frame_arrays_copy(&c, span);
}

/* A stripe may have no row of a small array. */
static dem_status map_array(const frames *f, const hdf5_file *file, int array, frame_stripes_mapped n,
                            hdf5_stripe *stripes)
{
    const hdf5_rows rows = frame_arrays_rows(f, array);
    const frame_of of = frame_arrays_of(array);
    const hsize_t all = (hsize_t)frame_arrays_count(f, of);
    for (int k = 0; k < f->n_stripes; k++) {
        stripes[k].first = (hsize_t)first_of(f, of, k);
        stripes[k].stride = all;
        stripes[k].n = n.frames;
        stripes[k].grows = n.grow;
        stripes[k].rows = (hsize_t)rows_of(f, of, k);
    }
    return all > 0 ? hdf5_map(file, &rows, n.frames * all, stripes, f->n_stripes) : DEM_OK;
}

/* Without frames the arrays are as they were made. */
dem_status frame_stripes_map(const frames *f, const hdf5_file *file, frame_stripes_mapped n,
                             const char (*names)[HDF5_STRIPES_NAME])
{
    hdf5_stripe *stripes = calloc((size_t)f->n_stripes + 1, sizeof *stripes);
    dem_status status = DEM_OK;
    CHECK_MEMORY(stripes);
    for (int k = 0; k < f->n_stripes; k++) memcpy(stripes[k].file, names[k], sizeof stripes[k].file);
    for (int k = 0; k < FRAME_ARRAYS && (n.frames > 0 || n.grow) && status == DEM_OK; k++)
        if (frame_arrays_is_wanted(f, k)) status = map_array(f, file, k, n, stripes);
    free(stripes);
    return status;
}

hsize_t frame_stripes_map_bytes(const frames *f)
{
    enum { OF_STRIPE = FRAME_ARRAYS * 1024 };
    return (hsize_t)f->n_stripes * OF_STRIPE;
}
