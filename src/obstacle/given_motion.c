/* SPDX-License-Identifier: BSD-3-Clause */
/* Asks the caller's function for a pose, checks it, and keeps the first failure of this thread: the function returned a
 * status, or a number is not finite, or a point is faster than the bounds that the caller has stated. Those are what
 * the search of events relies on. Obstacles are shared by simulations and do not change, so the failure is not theirs;
 * a simulation asks for it after each step, in the thread of the call. */
#include "obstacle/given_motion.h"

#include "base/status.h"

/* Share by which rounding may exceed a bound. */
static const double rounding = 1e-9;

static _Thread_local struct failure {
    dem_status status; /* DEM_OK: none */
    double t;
    const char *fault; /* NULL: the status was returned */
} failure;

static void fail(dem_status status, double t, const char *fault)
{
    if (failure.status == DEM_OK) failure = (struct failure){status, t, fault};
}

bool given_motion_failed(void)
{
    return failure.status != DEM_OK;
}

dem_status given_motion_failure(void)
{
    const struct failure last = failure;
    failure = (struct failure){DEM_OK, 0.0, NULL};
    if (last.status == DEM_OK) return DEM_OK;
    if (last.fault == NULL)
        return status_fail(last.status, "the motion of an obstacle was refused at t = %.9g s", last.t);
    return status_fail(last.status, "the motion of an obstacle %s at t = %.9g s", last.fault, last.t);
}

double given_motion_reach(const dem_obstacle *obstacle)
{
    double reach = 0.0;
    for (dem_index k = 0; k < obstacle->n_points && obstacle->motion != NULL; k++)
        reach = fmax(reach, vec2_norm(vec2_at(obstacle->points, k)));
    return reach;
}

static const char *find_fault(const dem_obstacle *obstacle)
{
    const double other[] = {obstacle->velocity[0],  obstacle->velocity[1], obstacle->amplitude[0],
                            obstacle->amplitude[1], obstacle->spin,        obstacle->ramp};
    bool alone = true;
    if (obstacle->motion == NULL) return NULL;
    for (size_t k = 0; k < sizeof other / sizeof *other; k++) alone = alone && other[k] == 0.0;
    if (!alone) return "a motion is given by a function and by numbers, too";
    if (!(isfinite(obstacle->most_speed) && obstacle->most_speed > 0.0)) return "its motion needs a most_speed > 0";
    if (!(isfinite(obstacle->most_acceleration) && obstacle->most_acceleration >= 0.0))
        return "its motion needs a most_acceleration >= 0";
    return isfinite(obstacle->longest_step) && obstacle->longest_step >= 0.0 ? NULL : "its longest_step must be >= 0";
}

static motion_bounds bounds_of(const dem_obstacle *obstacle)
{
    if (obstacle->motion == NULL) return (motion_bounds){0};
    return (motion_bounds){.speed = obstacle->most_speed,
                           .acceleration = obstacle->most_acceleration,
                           .step_rate = obstacle->longest_step > 0.0 ? 1.0 / obstacle->longest_step : 0.0};
}

/* What is wrong with a pose; NULL: nothing. */
static const char *fault_of(const dem_pose *p, const dem_obstacle *obstacle, double reach)
{
    const vec2 c = vec2_at(p->place, 0), v = vec2_at(p->velocity, 0), a = vec2_at(p->acceleration, 0);
    const double sum = c.x + c.y + v.x + v.y + a.x + a.y + p->angle + p->spin + p->spin_rate;
    const double speed = vec2_norm(v) + fabs(p->spin) * reach,
                 acceleration = vec2_norm(a) + hypot(p->spin_rate, p->spin * p->spin) * reach;
    if (!isfinite(sum)) return "is not finite";
    if (p->place[2] != 0.0 || p->velocity[2] != 0.0 || p->acceleration[2] != 0.0)
        return "has a third component in the plane";
    if (speed > (1.0 + rounding) * obstacle->most_speed) return "is faster than its most_speed";
    return acceleration > (1.0 + rounding) * obstacle->most_acceleration ? "exceeds its most_acceleration" : NULL;
}

/* After a failure nothing is asked, so that the function is not called again before the failure is reported. */
static void add(const motion_law *law, double t, pose *to)
{
    const dem_obstacle *obstacle = law->of;
    dem_pose p = {.struct_size = sizeof p};
    if (failure.status == DEM_OK) {
        const dem_status status = obstacle->motion(obstacle->motion_context, t, &p);
        const char *fault = status == DEM_OK ? fault_of(&p, obstacle, law->reach) : NULL;
        if (status != DEM_OK) fail(status, t, NULL);
        if (fault != NULL) fail(DEM_ERROR_INTEGRATOR, t, fault);
    }
    if (failure.status != DEM_OK) p = (dem_pose){.struct_size = sizeof p};
    to->centre = vec2_add(to->centre, vec2_at(p.place, 0));
    to->velocity = vec2_add(to->velocity, vec2_at(p.velocity, 0));
    to->acceleration = vec2_add(to->acceleration, vec2_at(p.acceleration, 0));
    to->angle = p.angle;
    to->axis = (vec2){cos(p.angle), sin(p.angle)};
    to->spin = p.spin;
    to->spin_rate = p.spin_rate;
}

const motion_kind given_motion = {NULL, 0, find_fault, bounds_of, add};
