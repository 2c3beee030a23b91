/* SPDX-License-Identifier: BSD-3-Clause */
/* What a program may do to a simulation between two advances: it ends the step in hand at the time that is seen. */
#ifndef DEM_SIMULATION_SET_MOTION_H
#define DEM_SIMULATION_SET_MOTION_H

#include "simulation/private.h"

/** Copies the state as seen to `s->frame`, where it may be changed. Contacts and ledger are those of its time. */
dem_status set_motion_take_seen(dem_simulation *s, dem_state *seen);

/** Energy of motion and deformation, and of weight, of a state, J. What friction has stored is not in it. Lists of
 *  surfaces fit the state afterwards. */
double set_motion_energy(dem_simulation *s, const double *y);

/** Goes on from `s->frame` at the time seen, as a run begins: contacts are looked for at the next advance. The rest of
 *  the step in hand is dropped; its events up to now have happened, and are counted. */
dem_status set_motion_begin_anew(dem_simulation *s);

#endif
