/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of bodies with each other in the time loop: what steps have to do about it beside its force. Without it, all
 * functions do nothing. */
#ifndef DEM_SIMULATION_BODY_CONTACT_H
#define DEM_SIMULATION_BODY_CONTACT_H

#include "simulation/private.h"

/** Creates s->surfaces if the options ask for it, for the forces to have.
 *  \return DEM_ERROR_MODEL for bodies without surfaces, a thickness that is too large, and surfaces that cross */
dem_status body_contact_create(dem_simulation *s);

/** Refuses positions x in which surfaces cross or nearly touch; the lists fit x afterwards. \return DEM_ERROR_MODEL */
dem_status body_contact_check_start(dem_simulation *s, const double *x);

/** Makes the lists fit the state y, which need not be where the last step has ended. */
dem_status body_contact_follow(dem_simulation *s, const double *y);

/** Called before a step is taken, and before it is taken again: sets the status of evaluations back. */
void body_contact_begin_step(dem_simulation *s);

/** Takes what all nodes were evaluated to.  \param sum  of sweep_term() of all accelerations */
void body_contact_take_accelerations(dem_simulation *s, double sum);

/** Called when a step has become the state; then, if that has changed or its derivative has, or the integrator starts
 *  anew: then nothing is known any more of how near surfaces are, nor whether triangles fold (guard_bound.h). */
void body_contact_end_step(dem_simulation *s);
void body_contact_begin_anew(dem_simulation *s);

/** Steps without another look at surfaces, in which none come near each other: so many of `most` there are from the
 *  state on, if accelerations stay what they are. A step has been begun. */
int body_contact_free_steps(const dem_simulation *s, int most);

/** Such steps, one after the other. */
typedef struct body_flight {
    int n;
    const double *t;   /* [n + 1] s, their start and their ends */
    const double *sum; /* [n] of sweep_term() of all accelerations at each end */
    const double *x;   /* positions at the last end */
} body_flight;

/** Whether the steps were of this kind; and then, follows them as body_contact_end_step() does each. */
bool body_contact_can_fly(const dem_simulation *s, const body_flight *flight);
void body_contact_fly(dem_simulation *s, const body_flight *flight);

/** Why the forces could not be evaluated: DEM_ERROR_MEMORY if they once could not since, else the status of the last
 *  evaluation. */
dem_status body_contact_failure(const dem_simulation *s);

/** Called when its events have been resolved.
 *  \return DEM_ERROR_CONTACT if the step cannot be taken as it is */
dem_status body_contact_check_step(dem_simulation *s);

/** Makes the state y what friction of surfaces goes on from: of bodies with each other, and of rigid bodies with
 *  obstacles.  \return what pair_list_follow() returns */
dem_status body_contact_settle(dem_simulation *s, const double *y);

/** Forgets what this friction remembers. */
void body_contact_forget(dem_simulation *s);

/** Puts that into a checkpoint, and gets it from one with the state y; the lists fit that afterwards.
 *  \return DEM_ERROR_IO if it is impossible, DEM_ERROR_MEMORY */
dem_status body_contact_save(const dem_simulation *s, dem_checkpoint *checkpoint);
dem_status body_contact_restore(dem_simulation *s, const dem_checkpoint *checkpoint, const double *y);

/** What is seen of it in positions x of the step in hand, or of the state. */
dem_surfaces body_contact_surfaces(const dem_simulation *s, const double *x);

/** Lists the pairs that push each other in positions x into s->pushing.  \return DEM_ERROR_MEMORY */
dem_status body_contact_list(dem_simulation *s, const double *x);

/** Bound of the highest frequency in the state y, in units of that about the rest shape: the larger of `guard`, that of
 *  springs and triangles, and what contact needs for a fixed step to stay stable.
 *  \param is_known  the last evaluation of all forces was for just this state */
double body_contact_stiffening(dem_simulation *s, double guard, const double *y, bool is_known);

#endif
