/* SPDX-License-Identifier: BSD-3-Clause */
/* Passes each call on to ARKODE or to velocity Verlet, by the method of the problem. */
#include "time/integrator.h"

#include "time/arkode_integrator.h"
#include "time/verlet_integrator.h"

dem_status integrator_create(integrator *out, const ode_problem *problem, double t, const double *y)
{
    *out = (integrator){0};
    if (problem->method == DEM_METHOD_VERLET) return verlet_integrator_create(&out->verlet, problem, t, y);
    return arkode_integrator_create(&out->integrator, problem, t, y);
}

void integrator_destroy(integrator *e)
{
    arkode_integrator_destroy(e->integrator);
    verlet_integrator_destroy(e->verlet);
    *e = (integrator){0};
}

dem_status integrator_step(integrator *e, dense_output *step, bool *rooted)
{
    return e->verlet != NULL ? verlet_integrator_step(e->verlet, step, rooted)
                             : arkode_integrator_step(e->integrator, step, rooted);
}

void integrator_end(integrator *e, double **y1, double **f1)
{
    if (e->verlet != NULL)
        verlet_integrator_end(e->verlet, y1, f1);
    else
        arkode_integrator_end(e->integrator, y1, f1);
}

dem_status integrator_redo(integrator *e, double factor)
{
    return arkode_integrator_redo(e->integrator, factor); /* the other has no error control */
}

void integrator_settle(integrator *e, const dense_output *step)
{
    if (e->verlet != NULL)
        verlet_integrator_settle(e->verlet, step);
    else
        arkode_integrator_settle(e->integrator, step);
}

double *integrator_state(const integrator *e)
{
    return e->verlet != NULL ? verlet_integrator_state(e->verlet) : arkode_integrator_state(e->integrator);
}

dem_status integrator_bound(integrator *e, double longest)
{
    return e->verlet != NULL ? DEM_OK : arkode_integrator_bound(e->integrator, longest);
}

dem_status integrator_resume(integrator *e)
{
    return e->verlet != NULL ? DEM_OK : arkode_integrator_resume(e->integrator);
}

dem_status integrator_restart(integrator *e, double t, const double *y)
{
    if (e->verlet == NULL) return arkode_integrator_restart(e->integrator, t, y);
    verlet_integrator_restart(e->verlet, t, y);
    return DEM_OK;
}

double integrator_next_step(const integrator *e)
{
    return e->verlet != NULL ? 0.0 : arkode_integrator_next_step(e->integrator);
}

dem_status integrator_renew(integrator *e, const integrator_start *from)
{
    if (e->verlet == NULL) return arkode_integrator_renew(e->integrator, from);
    verlet_integrator_renew(e->verlet, from);
    return DEM_OK;
}

dem_counts integrator_counts(const integrator *e)
{
    return e->verlet != NULL ? verlet_integrator_counts(e->verlet) : arkode_integrator_counts(e->integrator);
}
