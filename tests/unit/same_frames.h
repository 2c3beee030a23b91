/* SPDX-License-Identifier: BSD-3-Clause */
/* Two trajectories that have to have the same frames. */
#ifndef DEM_TEST_SAME_FRAMES_H
#define DEM_TEST_SAME_FRAMES_H

#include "lattice/lattice_arrays.h"
#include "verification/support.h"

#include <dem/reader.h>

static inline void same_frames_check_array(const void *one, const void *other, dem_index n, size_t size)
{
    assert_int_equal(one == NULL, other == NULL);
    if (one != NULL) assert_memory_equal(one, other, (size_t)n * size);
}

static inline void same_frames_check_lattices(const dem_lattice *one, const dem_lattice *other)
{
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        assert_int_equal(lattice_count(one, a->of), lattice_count(other, a->of));
        same_frames_check_array(lattice_array_of(one, a), lattice_array_of(other, a), lattice_count(one, a->of),
                                a->size);
    }
}

/* Every array of the lattice, and of every frame. */
static inline void same_frames_check(const char *one, const char *other)
{
    dem_reader *readers[2] = {NULL, NULL};
    dem_index n, n_frames[2];
    assert_ok(dem_reader_open(&readers[0], one));
    assert_ok(dem_reader_open(&readers[1], other));
    const dem_lattice *l = dem_reader_lattice(readers[0]);
    same_frames_check_lattices(l, dem_reader_lattice(readers[1]));
    const size_t most = 9 * (size_t)(l->n_nodes + l->n_springs + l->n_triangles) * sizeof(double);
    double *values[2] = {calloc(1, most), calloc(1, most)};
    for (int k = 0; k < 2; k++) (void)dem_reader_times(readers[k], &n_frames[k]);
    assert_int_equal(n_frames[0], n_frames[1]);
    assert_true(n_frames[0] > 3);
    const dem_reader_array *arrays = dem_reader_arrays(readers[0], &n);
    for (dem_index frame = 0; frame < n_frames[0]; frame++) {
        for (int k = 0; k < 2; k++) assert_ok(dem_reader_positions(readers[k], frame, values[k]));
        assert_memory_equal(values[0], values[1], most);
        for (const dem_reader_array *a = arrays; a < arrays + n; a++) {
            for (int k = 0; k < 2; k++) assert_ok(dem_reader_read(readers[k], a, frame, values[k]));
            assert_memory_equal(values[0], values[1], most);
        }
    }
    for (int k = 0; k < 2; k++) {
        free(values[k]);
        dem_reader_close(readers[k]);
    }
}

#endif
