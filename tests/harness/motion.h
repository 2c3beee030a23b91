/* SPDX-License-Identifier: BSD-3-Clause */
/* All that a simulation shows of its motion, in one piece. */
#ifndef DEM_TEST_MOTION_H
#define DEM_TEST_MOTION_H

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "ask.h"

enum { MOTION_CONTACTS = 512 };

typedef struct motion {
    double t, step;
    const double *x, *v; /* views, as those of dem_state */
    dem_energy energy;
    dem_index n_contacts; /* at most MOTION_CONTACTS */
    dem_contact contacts[MOTION_CONTACTS];
} motion;

static inline dem_status motion_see(const dem_simulation *simulation, motion *out)
{
    dem_state state = {.struct_size = sizeof state};
    const dem_status status = dem_simulation_state(simulation, &state);
    memset(out, 0, offsetof(motion, contacts));
    if (status != DEM_OK) return status;
    if (state.n_contacts > MOTION_CONTACTS) abort();
    out->t = state.t;
    out->step = state.step;
    out->x = state.x;
    out->v = state.v;
    out->energy = ask_energy(simulation);
    out->n_contacts = state.n_contacts;
    for (dem_index k = 0; k < state.n_contacts; k++) out->contacts[k] = ask_contact(simulation, k);
    return DEM_OK;
}

#endif
