/* SPDX-License-Identifier: BSD-3-Clause */
/* To look at all triangles for the bound takes as long as some three evaluations look at them. Bodies so large that
 * their steps are waves do not use it: their evaluations are not followed. */
#include "simulation/guard_bound.h"

#include <math.h>

#include "base/status.h"
#include "time/butcher.h"

enum { worth_noting = 6 /* evaluations */ };

dem_status guard_bound_create(dem_simulation *s)
{
    const dem_options *o = &s->options;
    step_reach reach;
    TRY(butcher_reach(&reach, o->method));
    approach_bound_create(&s->unfolded, reach, o->fixed_step > 0.0 ? o->fixed_step : o->max_step, worth_noting);
    return DEM_OK;
}

/* Whether all that moves nodes are the accelerations that are taken, all of them are taken here, and no triangle has
 * broken. With an area term all triangles are looked at anyway. The pass has the order of the layout. */
static bool is_useful(const dem_simulation *s)
{
    const dem_model *m = s->model;
    return m->lattice.guard != NULL && !m->layout.stiff && m->layout.order == NULL && s->rigid == NULL &&
           s->boundaries.n == 0 && s->forces.elements == NULL && !run_is_shared(s);
}

void guard_bound_begin_step(dem_simulation *s)
{
    const double *x = integrator_state(&s->integrator), *v = x + state_velocities(&s->layout);
    if (!is_useful(s) || !approach_bound_begin_step(&s->unfolded)) return;
    const triangles_room room = kernel_room_to_fold(&s->kernel, x, v);
    approach_bound_note(&s->unfolded, room.way, room.speed);
}

bool guard_bound_holds(dem_simulation *s)
{
    return is_useful(s) && approach_bound_holds(&s->unfolded);
}

/* Those at closed contacts are changed afterwards. */
void guard_bound_take_accelerations(dem_simulation *s, double sum)
{
    const bool is_known = s->automaton.set.forces.n_groups == 0;
    approach_bound_take(&s->unfolded, is_known ? sweep_largest(sum) : INFINITY);
}

void guard_bound_end_step(dem_simulation *s)
{
    approach_bound_end_step(&s->unfolded, s->step);
}

void guard_bound_forget(dem_simulation *s)
{
    approach_bound_forget(&s->unfolded);
}
