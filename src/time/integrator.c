/* SPDX-License-Identifier: BSD-3-Clause */
/* One of two. */
#include "time/integrator.h"

#include "time/arkode_integrator.h"
#include "time/verlet_integrator.h"

dem_status engine_create(engine *out, const motion *problem, double t, const double *y)
{
    *out = (engine){0};
    if (problem->method == DEM_METHOD_VERLET) return verlet_create(&out->verlet, problem, t, y);
    return integrator_create(&out->integrator, problem, t, y);
}

void engine_destroy(engine *e)
{
    integrator_destroy(e->integrator);
    verlet_destroy(e->verlet);
    *e = (engine){0};
}

dem_status engine_step(engine *e, path *step, bool *rooted)
{
    return e->verlet != NULL ? verlet_step(e->verlet, step, rooted) : integrator_step(e->integrator, step, rooted);
}

void engine_end(engine *e, double **y1, double **f1)
{
    if (e->verlet != NULL)
        verlet_end(e->verlet, y1, f1);
    else
        integrator_end(e->integrator, y1, f1);
}

dem_status engine_redo(engine *e, double factor)
{
    return integrator_redo(e->integrator, factor); /* the other has no error control */
}

void engine_settle(engine *e, const path *step)
{
    if (e->verlet != NULL)
        verlet_settle(e->verlet, step);
    else
        integrator_settle(e->integrator, step);
}

double *engine_state(const engine *e)
{
    return e->verlet != NULL ? verlet_state(e->verlet) : integrator_state(e->integrator);
}

dem_status engine_bound(engine *e, double longest)
{
    return e->verlet != NULL ? DEM_OK : integrator_bound(e->integrator, longest);
}

dem_status engine_resume(engine *e)
{
    return e->verlet != NULL ? DEM_OK : integrator_resume(e->integrator);
}

dem_status engine_restart(engine *e, double t, const double *y)
{
    if (e->verlet == NULL) return integrator_restart(e->integrator, t, y);
    verlet_restart(e->verlet, t, y);
    return DEM_OK;
}

double engine_next_step(const engine *e)
{
    return e->verlet != NULL ? 0.0 : integrator_next_step(e->integrator);
}

dem_status engine_renew(engine *e, const engine_start *from)
{
    if (e->verlet == NULL) return integrator_renew(e->integrator, from);
    verlet_renew(e->verlet, from);
    return DEM_OK;
}

dem_counts engine_counts(const engine *e)
{
    return e->verlet != NULL ? verlet_counts(e->verlet) : integrator_counts(e->integrator);
}
