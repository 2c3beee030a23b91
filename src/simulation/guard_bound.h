/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether it is known that the folding guard acts on no triangle, from how far nodes may have moved relative to each
 * other since all triangles were looked at (surface_contact/approach_bound.h). Then evaluations need not look at them,
 * which has the same bits. */
#ifndef DEM_SIMULATION_GUARD_BOUND_H
#define DEM_SIMULATION_GUARD_BOUND_H

#include "simulation/private.h"

/** Nothing is known yet. */
dem_status guard_bound_create(dem_simulation *s);

/** Begins a step from the integrator's state, or begins it again. */
void guard_bound_begin_step(dem_simulation *s);

/** Whether the guard acts on no triangle of the next state that is evaluated in the step. */
bool guard_bound_holds(dem_simulation *s);

/** Takes the result of an evaluation, a sum for sweep_largest(). */
void guard_bound_take_accelerations(dem_simulation *s, double sum);

/** Ends the step, which is committed. */
void guard_bound_end_step(dem_simulation *s);

/** Nothing is known any more, since the state has changed, or has gone on by other ways. */
void guard_bound_forget(dem_simulation *s);

#endif
