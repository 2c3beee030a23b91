/* SPDX-License-Identifier: BSD-3-Clause */
/* A lattice of free bodies and the options of a run, as named bytes that rank 0 sends to the others. */
#ifndef DEM_SIMULATION_SHARED_PROBLEM_H
#define DEM_SIMULATION_SHARED_PROBLEM_H

#include <dem/dem.h>

typedef struct shared_problem {
    dem_lattice lattice; /* its arrays are views */
    dem_options options;
    dem_boundary *boundaries; /* [options.n_boundaries] whose arrays are views */
} shared_problem;

/** Puts them into entries. The options are this library's, without functions of the program.
 *  \return DEM_ERROR_MEMORY */
dem_status shared_problem_put(dem_checkpoint *into, const dem_lattice *lattice, const dem_options *options);

/** Gets them from there. Views are valid as long as the entries are. Free with shared_problem_free().
 *  \return DEM_ERROR_MEMORY */
dem_status shared_problem_get(shared_problem *out, const dem_checkpoint *from);
void shared_problem_free(shared_problem *p);

#endif
