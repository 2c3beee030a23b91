/* SPDX-License-Identifier: BSD-3-Clause */
/* Whatever could make a difference keeps steps single: observers of each step, forces that depend on more than the
 * positions of neighbours, contacts closed or near, surfaces of bodies near each other, elements that may break or
 * have done so. If it turns out afterwards that the guard acts or something came near, they are taken once more, one by
 * one. */
#include "simulation/unseen_steps.h"

#include <stdlib.h>

#include "base/sorted.h"
#include "contact/automaton_step.h"
#include "simulation/body_contact.h"

enum {
    FEWEST = 3,       /* steps that are worth it, and more than one; */
    FEWEST_RINGS = 4, /* of ghosts likewise */
    SHORT_WAIT = 16,  /* steps, after the first failure in a row, */
    LONG_WAIT = 1024, /* and after many */
    LONG_PAUSE = 63   /* steps until ranks ask each other again, after having done so in vain several times */
};

static dem_status list_surface(dem_simulation *s)
{
    const contact_set *c = &s->automaton.set;
    const dem_index n = c->surface->n_nodes;
    s->unseen.surface = malloc(((size_t)n + 1) * sizeof *s->unseen.surface);
    CHECK(s->unseen.surface != NULL, DEM_ERROR_MEMORY, "out of memory for %lld contact candidates", (long long)n);
    for (dem_index k = 0; k < n; k++) s->unseen.surface[k] = c->list[k].node;
    qsort(s->unseen.surface, (size_t)n, sizeof *s->unseen.surface, sorted_compare);
    s->unseen.n_surface = n;
    return DEM_OK;
}

ring_use unseen_steps_ring_use(const dem_options *o)
{
    const bool some = o->method == DEM_METHOD_VERLET && o->contact == DEM_CONTACT_LOCAL;
    return some ? ring_use_of_steps(FEWEST_RINGS, ODE_FUSED_STEPS) : ring_use_none();
}

/* Ranks integrate ghosts, a ring less in each step. */
static int most_at_once(const dem_simulation *s)
{
    const int most = step_wave_most(s->unseen.wave);
    return run_is_shared(s) && s->model->domain->n_rings < most ? s->model->domain->n_rings : most;
}

/* With `exact` the whole body stops at roots, which are found among all candidates that are near. */
static bool may_be_unseen(const dem_simulation *s)
{
    const bool fixed = s->options.method == DEM_METHOD_VERLET && s->options.fixed_step > 0.0;
    const bool alone = s->rigid == NULL && s->external == NULL && s->boundaries.n == 0 && !s->model->obstacles.is_asked;
    const bool few = run_is_shared(s) && s->model->domain->n_rings < FEWEST_RINGS; /* those of Fehlberg's pair */
    return fixed && alone && !few && !run_may_break(s) && run_is_local(s) && kernel_can_fuse(&s->kernel, &s->forces);
}

/* Those of ranks pay by the exchanges that they save, too. */
static bool pays(const dem_simulation *s)
{
    return s->unseen.wave != NULL && (run_is_shared(s) || step_wave_pays(s->unseen.wave));
}

/* All ranks take them, or none does. */
dem_status unseen_steps_create(dem_simulation *s)
{
    run_unseen *u = &s->unseen;
    if (may_be_unseen(s)) u->wave = step_wave_create(&s->kernel);
    if (reduce_any(s->model->ranks, !pays(s))) unseen_steps_destroy(s);
    return u->wave != NULL && s->model->obstacles.n > 0 ? list_surface(s) : DEM_OK;
}

void unseen_steps_destroy(dem_simulation *s)
{
    step_wave_free(s->unseen.wave);
    free(s->unseen.surface);
    s->unseen = (run_unseen){0};
}

/* How many steps end before t_end and before the next frame; `most` if there are more. Ranks have the same. */
static int count_to_frame(const dem_simulation *s, int most, double t_end)
{
    double t = s->t, due;
    for (int n = 0; n < most; n++) {
        t += s->options.fixed_step;
        if (t > t_end || observers_due(&s->observers, t, t_end, &due) >= 0) return n;
    }
    return most;
}

/* Observers of this rank; in a run that rank 0 leads its own ones. NULL: none. */
static const observers *observers_of(const dem_simulation *s)
{
    if (!s->is_led) return &s->observers;
    return s->whole != NULL ? &s->whole->observers : NULL;
}

/* How many of them there are up to the first whose end an observer sees. */
static int count_to_seen(const dem_simulation *s, int most)
{
    const observers *those = observers_of(s);
    accepted_step step = {run_count_steps(s), s->t, false};
    for (int n = 0; n < most && those != NULL; n++) {
        step.number++;
        step.t += s->options.fixed_step;
        if (observers_step_due(those, &step)) return n + 1;
    }
    return most;
}

/* How many of them touch nothing that this rank knows of. Whether its observers want the run to stop ranks ask each
 * other at the end of a single step. */
static int count_free(dem_simulation *s, int most)
{
    const int n = count_to_seen(s, most);
    if (s->stop.status != DEM_OK || !automaton_may_fly(&s->automaton, n * s->options.fixed_step)) return 0;
    body_contact_begin_step(s);
    return body_contact_free_steps(s, n);
}

/* Steps are single for a while, longer after each failure in a row. */
static void wait(run_unseen *u)
{
    const int next = u->last_wait > 0 ? 2 * u->last_wait : SHORT_WAIT;
    u->wait = u->last_wait = next < LONG_WAIT ? next : LONG_WAIT;
}

/* Ranks do not ask each other again at once. */
static void ask_later(run_unseen *u)
{
    const int next = 2 * u->last_pause + 1;
    u->wait = u->last_pause;
    u->last_pause = next < LONG_PAUSE ? next : LONG_PAUSE;
}

static bool is_waiting(run_unseen *u)
{
    if (u->wait == 0) return false;
    u->wait--;
    return true;
}

int unseen_steps_take(dem_simulation *s, int most, double t_end)
{
    run_unseen *u = &s->unseen;
    if (u->wave == NULL || s->forces.elements != NULL) return 0;
    const int at_once = most_at_once(s);
    int n = count_to_frame(s, most < at_once ? most : at_once, t_end);
    if (n < FEWEST || is_waiting(u)) return 0;
    n = (int)reduce_min(s->model->ranks, count_free(s, n));
    if (n < FEWEST) {
        if (run_is_shared(s)) ask_later(u);
        return 0;
    }
    u->last_pause = 0;
    double ends[ODE_FUSED_STEPS];
    if (!integrator_take_unseen(&s->integrator, n, ends, &s->path)) {
        wait(u);
        return 0;
    }
    u->last_wait = 0;
    s->y = integrator_state(&s->integrator);
    s->step = ends[n - 1] - ends[n - 2];
    s->t = ends[n - 1];
    return n;
}
