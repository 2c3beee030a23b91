/* SPDX-License-Identifier: BSD-3-Clause */
/* Any bytes may come as a trajectory: what is not refused is read whole, or as far as it goes. What HDF5 itself
 * does with damaged files is not ours: docs/fuzzing.md. */
#include <dem/film.h>

#include "bytes.h"
#include "scratch.h"

enum { MOST_NUMBERS = 1 << 20 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require_message(dem_status status)
{
    require(status == DEM_ERROR_IO && strstr(dem_status_message(), "run.vtkhdf") != NULL);
}

static void read_frames(const dem_film *film, double *values)
{
    dem_index n_frames = 0, n = 0;
    const dem_lattice *l = dem_film_lattice(film);
    const dem_film_array *arrays = dem_film_arrays(film, &n);
    (void)dem_film_times(film, &n_frames);
    require(l->n_nodes > 0 && n_frames >= 0);
    for (dem_index k = 0; k < n; k++) {
        const dem_index rows = arrays[k].of_springs ? l->n_springs : l->n_nodes;
        require(arrays[k].components >= 1 && arrays[k].components <= 9);
        if (rows * arrays[k].components > MOST_NUMBERS || (n_frames == 0 && !arrays[k].constant)) continue;
        const dem_status status = dem_film_read(film, &arrays[k], n_frames - 1, values);
        if (status != DEM_OK) require_message(status);
    }
    if (n_frames == 0 || 2 * l->n_nodes > MOST_NUMBERS) return;
    const dem_status status = dem_film_positions(film, n_frames - 1, values);
    if (status != DEM_OK) require_message(status);
}

static void read_tables(const dem_film *film, double *values)
{
    dem_index n = 0;
    const dem_film_column *columns = dem_film_columns(film, &n);
    for (dem_index k = 0; k < n; k++) {
        const dem_film_column *c = &columns[k];
        require(c->n_rows >= 0 && c->width >= 1 && c->width == c->items * c->components);
        require(k == 0 || strcmp(columns[k - 1].table, c->table) != 0 || columns[k - 1].n_rows == c->n_rows);
        if (c->n_rows > MOST_NUMBERS / c->width) continue;
        const dem_status status = dem_film_read_column(film, c, values);
        if (status != DEM_OK) require_message(status);
    }
}

static void read_obstacles(const dem_film *film)
{
    dem_index n = 0, segments[2];
    const dem_obstacle *obstacles = dem_film_obstacles(film, &n);
    for (dem_index k = 0; k < n; k++) require(dem_obstacle_check(&obstacles[k], segments) == DEM_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static double values[MOST_NUMBERS];
    const char *path = scratch_path("run.vtkhdf");
    dem_film *film = NULL;
    scratch_write(path, data, size);
    const dem_status status = dem_film_open(&film, path);
    require(status == DEM_OK || status == DEM_ERROR_IO || status == DEM_ERROR_MODEL || status == DEM_ERROR_MEMORY);
    require((status == DEM_OK) == (film != NULL));
    require(status == DEM_OK || strstr(dem_status_message(), "run.vtkhdf") != NULL);
    if (status != DEM_OK) return 0;
    read_frames(film, values);
    read_tables(film, values);
    read_obstacles(film);
    dem_film_close(film);
    return 0;
}
