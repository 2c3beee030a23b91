/* SPDX-License-Identifier: BSD-3-Clause */
/* What a variable holds is freed where its block ends: `CLEANUP(dem_lattice_free) dem_lattice lattice;`. Variables of
 * one block are freed in the reverse order of their declarations. A test that fails leaves its block by longjmp() and
 * frees nothing. */
#ifndef DEM_TEST_CLEANUP_H
#define DEM_TEST_CLEANUP_H

#include <stdlib.h>

#include <dem/checkpoint.h>
#include <dem/dem.h>
#include <dem/reader.h>
#include <dem/trajectory.h>

/** Calls function(&variable) where the block of the variable ends. Some variables are there for that alone. */
#define CLEANUP(function) __attribute__((unused, cleanup(function)))

/* For pointers, which the functions of the library take by value. */

static inline void free_memory(void *pointer)
{
    free(*(void **)pointer);
}

static inline void free_model(dem_model **model)
{
    dem_model_destroy(*model);
}

static inline void free_simulation(dem_simulation **simulation)
{
    dem_simulation_destroy(*simulation);
}

static inline void free_peaks(dem_peaks **peaks)
{
    dem_peaks_destroy(*peaks);
}

static inline void free_checkpoint(dem_checkpoint **checkpoint)
{
    dem_checkpoint_destroy(*checkpoint);
}

static inline void free_reader(dem_reader **reader)
{
    dem_reader_close(*reader);
}

static inline void free_trajectory(dem_trajectory **trajectory)
{
    dem_trajectory_destroy(*trajectory);
}

#endif
