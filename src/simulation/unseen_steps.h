/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of Verlet's method that are taken several at once (forces/step_wave.h), where nobody sees those between and
 * nothing can touch within them. The run has the same bits, counts and frames as by single steps. */
#ifndef DEM_SIMULATION_UNSEEN_STEPS_H
#define DEM_SIMULATION_UNSEEN_STEPS_H

#include "domain/ring_use.h"
#include "simulation/private.h"

/** Of rings of ghosts, in simulations with such options. */
ring_use unseen_steps_ring_use(const dem_options *o);

/** For a simulation whose kernel and contacts are set up.  \return DEM_ERROR_MEMORY */
dem_status unseen_steps_create(dem_simulation *s);
void unseen_steps_destroy(dem_simulation *s);

/** Takes steps from the state, at most `most`, none of which ends behind t_end or the next frame: the end of the last
 *  is the state then.
 *  \return how many; 0: the next step is to be taken by itself */
int unseen_steps_take(dem_simulation *s, int most, double t_end);

#endif
