/* SPDX-License-Identifier: BSD-3-Clause */
/* The one interface to all methods of integration. Which integrator takes the steps is decided once, by the method:
 * velocity Verlet (verlet_integrator.c) or an explicit Runge-Kutta method (arkode_integrator.c). Every call goes
 * through that integrator's table of functions, so that a new method is one file and one line here. What a step is and
 * what holds after it is said in integrator.h; the equations are in ode_problem.h. Nothing here knows of forces or
 * contacts. */
#include "time/integrator.h"

#include "time/arkode_integrator.h"
#include "time/verlet_integrator.h"

dem_status integrator_create(integrator *out, const ode_problem *problem, double t, const double *y)
{
    *out = (integrator){.ops = problem->method == DEM_METHOD_VERLET ? &verlet_integrator_ops : &arkode_integrator_ops};
    return out->ops->create(&out->self, problem, t, y);
}

void integrator_destroy(integrator *e)
{
    if (e->ops != NULL) e->ops->destroy(e->self);
    *e = (integrator){0};
}

dem_status integrator_step(integrator *e, dense_output *step, bool *rooted)
{
    return e->ops->step(e->self, step, rooted);
}

bool integrator_take_unseen(integrator *e, int n, double *ends, dense_output *last)
{
    return e->ops->take_unseen != NULL && e->ops->take_unseen(e->self, n, ends, last);
}

void integrator_end(integrator *e, double **y1, double **f1)
{
    e->ops->end(e->self, y1, f1);
}

dem_status integrator_redo(integrator *e, double factor)
{
    return e->ops->redo(e->self, factor);
}

void integrator_settle(integrator *e, const dense_output *step)
{
    e->ops->settle(e->self, step);
}

double *integrator_state(const integrator *e)
{
    return e->ops->state(e->self);
}

dem_status integrator_bound(integrator *e, double longest)
{
    return e->ops->bound(e->self, longest);
}

dem_status integrator_resume(integrator *e)
{
    return e->ops->resume(e->self);
}

dem_status integrator_restart(integrator *e, double t, const double *y)
{
    return e->ops->restart(e->self, t, y);
}

double integrator_next_step(const integrator *e)
{
    return e->ops->next_step(e->self);
}

dem_status integrator_renew(integrator *e, const integrator_start *from)
{
    return e->ops->renew(e->self, from);
}

dem_counts integrator_counts(const integrator *e)
{
    return e->ops->counts(e->self);
}
