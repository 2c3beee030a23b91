/* SPDX-License-Identifier: BSD-3-Clause */
/* Any bytes may come as a trajectory: what is not refused is read whole, or as far as it goes. What HDF5 itself
 * does with damaged files is not ours: docs/fuzzing.md. */
#include <dem/reader.h>

#include "bytes.h"
#include "scratch.h"

enum { MOST_NUMBERS = 1 << 20 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require_message(dem_status status)
{
    require(status == DEM_ERROR_IO && strstr(dem_status_message(), "run.vtkhdf") != NULL);
}

/* Rows of frames lie one behind the other within the table. */
static void require_fragments(const dem_reader *reader, dem_index n_frames)
{
    const dem_reader_column *column = dem_reader_column_find(reader, "fragments", "t");
    dem_index first = 0, count = 0;
    require(dem_reader_fragments(reader, n_frames - 1, &first, &count) == DEM_OK);
    require(first >= 0 && count >= 0 && (column == NULL || first + count == column->n_rows));
}

static void read_frames(const dem_reader *reader, double *values)
{
    dem_index n_frames = 0, n = 0;
    const dem_lattice *l = dem_reader_lattice(reader);
    const dem_reader_array *arrays = dem_reader_arrays(reader, &n);
    (void)dem_reader_times(reader, &n_frames);
    require(l->n_nodes > 0 && n_frames >= 0);
    for (dem_index k = 0; k < n; k++) {
        const dem_index rows = arrays[k].of_springs ? l->n_springs : l->n_nodes;
        require(arrays[k].components >= 1 && arrays[k].components <= 9);
        if (rows * arrays[k].components > MOST_NUMBERS || (n_frames == 0 && !arrays[k].constant)) continue;
        const dem_status status = dem_reader_read(reader, &arrays[k], n_frames - 1, values);
        if (status != DEM_OK) require_message(status);
    }
    if (n_frames == 0) return;
    require_fragments(reader, n_frames);
    if (2 * l->n_nodes > MOST_NUMBERS) return;
    const dem_status status = dem_reader_positions(reader, n_frames - 1, values);
    if (status != DEM_OK) require_message(status);
    if (l->n_triangles > MOST_NUMBERS) return;
    const dem_status broken = dem_reader_broken_triangles(reader, n_frames - 1, (unsigned char *)values);
    if (broken != DEM_OK) require_message(broken);
}

static void read_tables(const dem_reader *reader, double *values)
{
    dem_index n = 0;
    const dem_reader_column *columns = dem_reader_columns(reader, &n);
    for (dem_index k = 0; k < n; k++) {
        const dem_reader_column *c = &columns[k];
        require(c->n_rows >= 0 && c->width >= 1 && c->width == c->items * c->components);
        require(k == 0 || strcmp(columns[k - 1].table, c->table) != 0 || columns[k - 1].n_rows == c->n_rows);
        if (c->n_rows > MOST_NUMBERS / c->width) continue;
        const dem_status status = dem_reader_read_column(reader, c, values);
        if (status != DEM_OK) require_message(status);
    }
}

static void read_obstacles(const dem_reader *reader)
{
    dem_index segments[2];
    for (dem_index k = 0; k < dem_reader_n_obstacles(reader); k++)
        require(dem_obstacle_check(dem_reader_obstacle(reader, k), segments) == DEM_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static double values[MOST_NUMBERS];
    const char *path = scratch_path("run.vtkhdf");
    dem_reader *reader = NULL;
    scratch_write(path, data, size);
    const dem_status status = dem_reader_open(&reader, path);
    require(status == DEM_OK || status == DEM_ERROR_IO || status == DEM_ERROR_MODEL || status == DEM_ERROR_MEMORY);
    require((status == DEM_OK) == (reader != NULL));
    require(status == DEM_OK || strstr(dem_status_message(), "run.vtkhdf") != NULL);
    if (status != DEM_OK) return 0;
    read_frames(reader, values);
    read_tables(reader, values);
    read_obstacles(reader);
    dem_reader_close(reader);
    return 0;
}
