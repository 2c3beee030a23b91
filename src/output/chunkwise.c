/* SPDX-License-Identifier: BSD-3-Clause */
#include "output/chunkwise.h"

#include <stdlib.h>

#include "base/status.h"

/* A dataset that is being written. */
typedef struct writing {
    const hdf5_file *file;
    hdf5_rows rows;
    hsize_t per_item;
} writing;

static hsize_t least(hsize_t a, hsize_t b)
{
    return a < b ? a : b;
}

static dem_status fill_chunks(const writing *w, hsize_t count, chunkwise_filler *fill, const void *context, void *chunk)
{
    for (hsize_t first = 0; first < count; first += w->rows.chunk) {
        const hsize_t n = least(count - first, w->rows.chunk);
        fill(context, first, n, chunk);
        TRY(hdf5_append(w->file, &w->rows, first, n, chunk));
    }
    return DEM_OK;
}

dem_status chunkwise_fill(const hdf5_file *file, hdf5_rows rows, hsize_t count, chunkwise_filler *fill,
                          const void *context)
{
    writing w = {file, rows, 1};
    w.rows.chunk = ROWS_CHUNK;
    TRY(hdf5_create_for(file, &w.rows, count));
    void *chunk = malloc((size_t)w.rows.chunk * hdf5_row_bytes(&w.rows) + 1);
    CHECK_MEMORY(chunk);
    const dem_status status = fill_chunks(&w, count, fill, context, chunk);
    free(chunk);
    return status;
}

static dem_status append(void *context, dem_index first, dem_index n, const void *items)
{
    const writing *w = context;
    return hdf5_append(w->file, &w->rows, w->per_item * (hsize_t)first, w->per_item * (hsize_t)n, items);
}

dem_status chunkwise_copy(const hdf5_file *file, hdf5_rows rows, const lattice_source *from, size_t member, dem_index n,
                          int per_item)
{
    writing w = {file, rows, (hsize_t)per_item};
    w.rows.chunk = w.per_item * ROWS_CHUNK;
    TRY(hdf5_create_for(file, &w.rows, w.per_item * (hsize_t)n));
    return dem_private_lattice_visit(from, member, append, &w);
}
