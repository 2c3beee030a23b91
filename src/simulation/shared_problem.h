/* SPDX-License-Identifier: BSD-3-Clause */
/* The obstacles and the options of a run, as named bytes that rank 0 sends to all others. */
#ifndef DEM_SIMULATION_SHARED_PROBLEM_H
#define DEM_SIMULATION_SHARED_PROBLEM_H

#include "model/model.h"

typedef struct shared_problem {
    dem_index n_obstacles;
    dem_obstacle *obstacles; /* [n_obstacles] whose points are views */
    dem_options options;
    dem_boundary *boundaries; /* [options.n_boundaries] whose arrays are views */
} shared_problem;

/** Puts them into entries. Options and obstacles are this library's, without functions of the program.
 *  \param obstacles  [n_obstacles]
 *  \return DEM_ERROR_MEMORY */
dem_status shared_problem_put(dem_checkpoint *into, const dem_obstacle *obstacles, dem_index n_obstacles,
                              const dem_options *options);

/** Gets them from there. Views are valid as long as the entries are. Free with shared_problem_free(),
 *  after a failure, too.
 *  \return DEM_ERROR_MEMORY */
dem_status shared_problem_get(shared_problem *out, const dem_checkpoint *from);
void shared_problem_free(shared_problem *p);

#endif
