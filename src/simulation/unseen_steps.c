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
    LEAST_NODES = 250000, /* of fewer the third cache has all arrays of a step */
    FEWEST = 3,           /* steps that are worth it, and more than one */
    SHORT_WAIT = 16,      /* steps, after the first failure in a row, */
    LONG_WAIT = 1024      /* and after many */
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

/* With `exact` the whole body stops at roots, which are found among all candidates that are near. */
dem_status unseen_steps_create(dem_simulation *s)
{
    const bool fixed = s->options.method == DEM_METHOD_VERLET && s->options.fixed_step > 0.0;
    const bool alone = s->model->domain == NULL && s->rigid == NULL && s->external == NULL && s->boundaries.n == 0 &&
                       !s->model->obstacles.is_asked;
    if (!fixed || !alone || s->layout.n_nodes < LEAST_NODES || run_may_break(s) || !run_is_local(s) ||
        !kernel_can_fuse(&s->kernel, &s->forces))
        return DEM_OK;
    s->unseen.wave = step_wave_create(&s->kernel);
    return s->unseen.wave != NULL && s->model->obstacles.n > 0 ? list_surface(s) : DEM_OK;
}

void unseen_steps_destroy(dem_simulation *s)
{
    step_wave_free(s->unseen.wave);
    free(s->unseen.surface);
    s->unseen = (run_unseen){0};
}

/* How many steps end before t_end and before the next frame, up to the first whose end is seen; `most` if there are
 * more. */
static int count_free(const dem_simulation *s, int most, double t_end)
{
    accepted_step step = {run_count_steps(s), s->t, false};
    double due;
    for (int n = 0; n < most; n++) {
        step.number++;
        step.t += s->options.fixed_step;
        if (step.t > t_end || observers_due(&s->observers, step.t, t_end, &due) >= 0) return n;
        if (observers_step_due(&s->observers, &step)) return n + 1;
    }
    return most;
}

/* Steps are single for a while, longer after each failure in a row. */
static void wait(run_unseen *u)
{
    const int next = u->last_wait > 0 ? 2 * u->last_wait : SHORT_WAIT;
    u->wait = u->last_wait = next < LONG_WAIT ? next : LONG_WAIT;
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
    int n = count_free(s, most < ODE_FUSED_STEPS ? most : ODE_FUSED_STEPS, t_end);
    if (n < FEWEST || !automaton_may_fly(&s->automaton, n * s->options.fixed_step)) return 0;
    if (is_waiting(u)) return 0;
    body_contact_begin_step(s);
    n = body_contact_free_steps(s, n);
    if (n < FEWEST) return 0;
    double ends[ODE_FUSED_STEPS];
    if (!integrator_take_unseen(&s->integrator, n, ends)) {
        wait(u);
        return 0;
    }
    u->last_wait = 0;
    s->y = integrator_state(&s->integrator);
    s->step = ends[n - 1] - ends[n - 2];
    s->t = ends[n - 1];
    return n;
}
