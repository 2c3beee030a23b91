/* SPDX-License-Identifier: BSD-3-Clause */
/* Replaces the motion of a simulation between two advances (docs/method.md, Motion set by the program). The step in
 * hand ends at the time that the caller has seen; the rest of it is dropped. A motion is checked before anything is
 * replaced, and a refused one leaves all as it was. The energy that the change takes is entered as work from outside,
 * so that the ledger closes. Contacts open, and the next advance begins as a run does: see start() in simulation.c. */
#include "simulation/set_motion.h"

#include <string.h>

#include "base/reduce.h"
#include "base/status.h"
#include "forces/diagnostics.h"
#include "simulation/body_contact.h"
#include "simulation/query.h"

/* Which components of a node may not be changed: all of a fixed one, those that are prescribed. */
static int held(const dem_simulation *s, dem_index i)
{
    if (s->model->inverse_mass[i] == 0.0) return DEM_COMPONENT_X | DEM_COMPONENT_Y;
    return s->boundaries.held != NULL ? s->boundaries.held[i] : 0;
}

/* Whether one of the two arrays may replace `now`: it is finite, and the same where nodes are fixed or prescribed. NULL
 * replaces nothing. */
static dem_status check(const dem_simulation *s, const char *what, const double *wanted, const double *now)
{
    for (dem_index k = 0; wanted != NULL && k < state_row(&s->layout, s->layout.n_nodes); k++) {
        const dem_index dim = s->layout.dim, i = k / dim, row = state_row(&s->layout, i);
        CHECK(isfinite(wanted[k]), DEM_ERROR_ARGUMENT, "the %s (%g, %g) of node %lld is not finite", what, wanted[row],
              wanted[row + 1], (long long)i);
        CHECK(!(held(s, i) & (DEM_COMPONENT_X << k % dim)) || wanted[k] == now[k], DEM_ERROR_ARGUMENT,
              "the %s (%.17g, %.17g) of node %lld, which is fixed or prescribed, is not (%.17g, %.17g)", what,
              wanted[row], wanted[row + 1], (long long)i, now[row], now[row + 1]);
    }
    return DEM_OK;
}

/* The motion that is about to be set must be rigid where bodies are; an array that is NULL stays as it is. */
static dem_status check_rigid(const dem_simulation *s, const double *x, const double *v)
{
    const rigid_bodies *r = &s->model->rigid;
    for (dem_index k = 0; k < r->n; k++) {
        const dem_index misplaced = rigid_body_misplaced(&r->list[k], x);
        const dem_index deviating = rigid_body_deviating(&r->list[k], x, v);
        CHECK(misplaced < 0, DEM_ERROR_ARGUMENT,
              "the place (%g, %g) of node %lld deforms its body %lld, which is rigid", x[2 * misplaced],
              x[2 * misplaced + 1], (long long)model_node(s->model, misplaced), (long long)r->list[k].number);
        CHECK(deviating < 0, DEM_ERROR_ARGUMENT,
              "the velocity (%g, %g) of node %lld is not that of a rigid motion of its body %lld%s", v[2 * deviating],
              v[2 * deviating + 1], (long long)model_node(s->model, deviating), (long long)r->list[k].number,
              r->list[k].guide != DEM_GUIDE_NONE ? " along its guide" : "");
    }
    return DEM_OK;
}

/* What the new state may have more or less of. */
double set_motion_energy(dem_simulation *s, const double *y)
{
    (void)body_contact_follow(s, y); /* cannot fail: positions have been checked */
    const double *v = y + state_velocities(&s->layout);
    survey_take(s->survey, &s->forces, y, v);
    s->measures->has_survey = false; /* of what is seen */
    const dem_energy e = diagnostics_energy(&s->forces, s->survey, y, v);
    return e.motion + e.friction + e.gravity;
}

/* Puts x and v into a state, and the energy that this takes into its work: the difference of mechanical energies, J. */
static void put(dem_simulation *s, const double *x, const double *v, double *y)
{
    const state_layout *l = &s->layout;
    const size_t size = (size_t)state_row(l, l->n_nodes) * sizeof *y;
    double *own_v = y + state_velocities(l), *work = own_v + state_total_index(l, STATE_WORK);
    const double before = set_motion_energy(s, y);
    if (x != NULL) memmove(y, x, size); /* x may be the array that is seen */
    if (v != NULL) memmove(own_v, v, size);
    *work += set_motion_energy(s, y) - before;
}

/* Refused positions leave the lists of surfaces as they were before. */
static dem_status check_surfaces(dem_simulation *s, const double *x)
{
    const dem_status status = reduce_status(s->model->ranks, body_contact_check_start(s, x), 0.0);
    return status == DEM_OK ? DEM_OK : status_first(status, body_contact_follow(s, s->seen));
}

/* It takes the queue back to that time. */
dem_status set_motion_take_seen(dem_simulation *s, dem_state *seen)
{
    CHECK(s->model->domain == NULL && s->leads == NULL, DEM_ERROR_ARGUMENT,
          "a model that ranks share cannot be changed in a run yet");
    TRY(dem_simulation_state(s, seen));
    if (s->seen != s->frame) memcpy(s->frame, s->seen, (size_t)state_size(&s->layout) * sizeof *s->frame);
    return DEM_OK;
}

dem_status set_motion_begin_anew(dem_simulation *s)
{
    s->events += s->in_hand ? reduce_count(s->model->ranks, s->queue.n_taken) : 0;
    s->t = s->seen_t;
    s->path = (dense_output){0};
    s->in_hand = s->at_event = s->started = s->has_checkpoint = false;
    TRY(automaton_open_all(&s->automaton));
    TRY(integrator_restart(&s->integrator, s->t, s->frame));
    s->y = integrator_state(&s->integrator);
    query_at(s, s->t, s->y);
    return DEM_OK;
}

dem_status dem_simulation_set_motion(dem_simulation *s, const double *x, const double *v)
{
    dem_state seen = {.struct_size = sizeof seen};
    CHECK(s != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_set_motion: simulation is NULL");
    CHECK(!s->advancing, DEM_ERROR_ARGUMENT, "dem_simulation_set_motion: an advance is under way");
    TRY(set_motion_take_seen(s, &seen));
    TRY(reduce_status(s->model->ranks, check(s, "place", x, seen.x), 0.0));
    TRY(reduce_status(s->model->ranks, check(s, "velocity", v, seen.v), 0.0));
    TRY(reduce_status(s->model->ranks, check_rigid(s, x != NULL ? x : seen.x, v != NULL ? v : seen.v), 0.0));
    if (x != NULL) TRY(reduce_status(s->model->ranks, automaton_check_start(&s->automaton, s->seen_t, x), 0.0));
    if (x != NULL) TRY(check_surfaces(s, x));
    if (run_force_failed(s)) return run_force_failure(s);
    body_contact_forget(s); /* what it has stored is lost to friction, and not part of the change */
    put(s, x, v, s->frame);
    return set_motion_begin_anew(s);
}
