/* SPDX-License-Identifier: BSD-3-Clause */
/* What a checkpoint contains of a run: everything on which its further motion depends bit for bit, and its sums and
 * counts so far. What follows from these is left out: forces in contacts, groups, clearances, the integrator's history.
 * It is computed anew, in the run that takes the checkpoint just as in one that is resumed from it (docs/algorithms.md,
 * Checkpoints). Entries are structs of numbers of 8 bytes, without gaps, so that all their bytes are defined. Event
 * sources add their own (src/contact/contact_entry.c). Files, and their checksums, are written and read in
 * src/base/checkpoint_entries.c; nothing that comes from one is trusted here. */
#include "simulation/body_contact.h"
#include "simulation/breaking.h"
#include "simulation/checkpoint.h"
#include "simulation/pausing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/checkpoint_entries.h"
#include "base/reduce.h"
#include "base/status.h"

/* Single numbers. The energies, `step` and `events` are only reported; the others decide about later steps. */
typedef struct numbers {
    double t, step;    /* s */
    double next_step;  /* s; 0: fixed ones */
    double impact;     /* J, ledger of contacts */
    double projection; /* J */
    double work;       /* J, done by obstacles at impacts */
    double projected;  /* m */
    dem_index events, unlooked, idle;
} numbers;

/* What two models must have in common for a state of one to be read as one of the other. */
typedef struct sizes {
    dem_index n_nodes, n_springs, n_triangles, n_segments, n_vertices, n_obstacles, n_candidates, n_unknowns;
} sizes;

/* Those of the whole where ranks share the model: all have what may touch obstacles, if there are any. */
static sizes sizes_of(const dem_simulation *s)
{
    const dem_model *m = s->model;
    const domain *d = m->domain;
    sizes all = {m->lattice.n_nodes,      m->lattice.n_springs, m->lattice.n_triangles, m->obstacles.n_segments,
                 m->obstacles.n_vertices, m->obstacles.n,       s->automaton.set.n,     state_velocities(&s->layout)};
    if (d == NULL) return all;
    all.n_nodes = d->n_whole;
    all.n_springs = d->n_springs;
    all.n_triangles = d->n_triangles;
    if (m->obstacles.n == 0) all.n_candidates = d->n_surface_nodes;
    all.n_unknowns = state_velocities(&s->shared.whole);
    return all;
}

/* Exact sums are rounded in a checkpoint, and go on from there in every run. */
static dem_status pass_impulses(dem_simulation *s, const checkpoint_entries_way *way)
{
    contact_ledger *ledger = &s->automaton.set.ledger;
    const dem_index n_obstacles = s->model->obstacles.n;
    double *list = calloc(4 * (size_t)n_obstacles + 1, sizeof *list);
    CHECK(list != NULL, DEM_ERROR_MEMORY, "out of memory for the impulses of a checkpoint");
    ledger_list_impulses(ledger, n_obstacles, list);
    const dem_status status = checkpoint_entries_pass(way, "impulses", list, 4 * (size_t)n_obstacles * sizeof *list);
    if (status == DEM_OK && way->from != NULL) ledger_begin_impulses(ledger, n_obstacles, list);
    free(list);
    return status;
}

/* Puts the entries into a checkpoint, or gets them from it: one list for both ways, so that they cannot differ. */
static dem_status pass(dem_simulation *s, const checkpoint_entries_way *way, numbers *n, dem_counts *counts)
{
    TRY(checkpoint_entries_pass(way, "numbers", n, sizeof *n));
    TRY(checkpoint_entries_pass(way, "counts", counts, sizeof *counts));
    TRY(pass_impulses(s, way));
    return checkpoint_entries_pass(way, "overlap", &s->overlap.found, sizeof s->overlap.found);
}

/* How many numbers say how one obstacle moves: all fields that a motion may have, unused ones too. */
static size_t count_motion(void)
{
    size_t n = 0;
    const dem_motion_field *field;
    for (dem_index k = 0; (field = dem_motion_field_at(k)) != NULL; k++) n += (size_t)field->n;
    return n;
}

/* All numbers of an obstacle's motion laws, one behind the other, in the order of their fields. */
static double *copy_motion(double *to, const dem_obstacle *obstacle)
{
    const dem_motion_field *field;
    for (dem_index k = 0; (field = dem_motion_field_at(k)) != NULL; k++, to += field->n)
        memcpy(to, (const char *)obstacle + field->offset, (size_t)field->n * sizeof *to);
    return to;
}

/* The motion laws of all obstacles, by which check_motion() knows a model whose obstacles move otherwise. */
static dem_status put_motion(const dem_model *model, dem_checkpoint *checkpoint)
{
    const obstacle_set *o = &model->obstacles;
    const size_t n = count_motion() * (size_t)o->n;
    double *list = malloc((n + 1) * sizeof *list), *end = list;
    CHECK(list != NULL, DEM_ERROR_MEMORY, "out of memory for the obstacles of a checkpoint");
    for (dem_index k = 0; k < o->n; k++) end = copy_motion(end, &o->list[k]);
    const dem_status status = dem_checkpoint_put(checkpoint, "motions", list, n * sizeof *list);
    free(list);
    return status;
}

/* Counts of steps are the integrator's, those of contacts the ledger's; in a checkpoint they are one entry. The length
 * of the next step is what the integrator would have tried next. */
dem_status checkpoint_take(dem_simulation *s, dem_checkpoint *checkpoint)
{
    const contact_ledger *ledger = &s->automaton.set.ledger;
    const checkpoint_entries_way way = {.into = checkpoint};
    const dem_counts of_integrator = integrator_counts(&s->integrator);
    dem_counts counts = ledger->counts;
    sizes size = sizes_of(s);
    numbers n = {s->t,
                 s->step,
                 integrator_next_step(&s->integrator),
                 exact_sum_value(&ledger->impact),
                 exact_sum_value(&ledger->projection),
                 exact_sum_value(&ledger->work),
                 s->automaton.set.projected,
                 s->events,
                 s->unlooked,
                 s->automaton.idle};
    counts.steps = of_integrator.steps;
    counts.rejected = of_integrator.rejected;
    counts.evaluations = of_integrator.evaluations;
    counts.retries = of_integrator.retries;
    counts.crossings = s->crossings;
    TRY(checkpoint_entries_pass(&way, "sizes", &size, sizeof size));
    TRY(put_motion(s->model, checkpoint));
    TRY(pass(s, &way, &n, &counts));
    TRY(breaking_save(s, checkpoint));
    TRY(pausing_save(s, checkpoint));
    TRY(body_contact_save(s, checkpoint));
    TRY(source_list_save(&s->sources, checkpoint));
    return checkpoint_entries_pass(&way, "state", s->y, (size_t)state_size(&s->layout) * sizeof *s->y);
}

/* Finds the state in a checkpoint, of the size of this run's, and finite. */
static dem_status find_state(const dem_simulation *s, const dem_checkpoint *checkpoint, const double **out)
{
    const size_t n = (size_t)state_size(&s->layout);
    size_t size;
    const double *y = dem_checkpoint_find(checkpoint, "state", &size);
    CHECK(y != NULL && size == n * sizeof *y, DEM_ERROR_IO, "the checkpoint has %zu bytes of state, %zu are expected",
          size, n * sizeof *y);
    for (size_t k = 0; k < n; k++) CHECK(isfinite(y[k]), DEM_ERROR_IO, "the state in the checkpoint is not finite");
    *out = y;
    return DEM_OK;
}

/* Without obstacles candidates need not be those of the present surface. */
static dem_status check_sizes(const dem_simulation *s, const dem_checkpoint *checkpoint)
{
    const sizes here = sizes_of(s);
    sizes there;
    TRY(dem_checkpoint_get(checkpoint, "sizes", &there, sizeof there));
    if (here.n_obstacles == 0) there.n_candidates = here.n_candidates;
    CHECK(memcmp(&here, &there, sizeof here) == 0, DEM_ERROR_IO,
          "the checkpoint is of another model: %lld nodes, %lld springs, %lld segments, not %lld, %lld, %lld",
          (long long)there.n_nodes, (long long)there.n_springs, (long long)there.n_segments, (long long)here.n_nodes,
          (long long)here.n_springs, (long long)here.n_segments);
    return DEM_OK;
}

/* Positions of obstacles follow from their motion laws, so that those of the checkpoint must be the model's. */
static dem_status check_field(const dem_obstacle *obstacle, dem_index number, const dem_motion_field *field,
                              const double *there)
{
    const double *here = (const double *)(const void *)((const char *)obstacle + field->offset);
    for (dem_index d = 0; d < field->n; d++)
        CHECK(here[d] == there[d], DEM_ERROR_IO, "in the checkpoint obstacle %lld moves with %s of %g %s, not %g %s",
              (long long)number, field->name, there[d], field->unit, here[d], field->unit);
    return DEM_OK;
}

/* The motions of all obstacles, in the order of put_motion(). */
static dem_status check_motion(const dem_simulation *s, const dem_checkpoint *checkpoint)
{
    const obstacle_set *o = &s->model->obstacles;
    const size_t expected = count_motion() * (size_t)o->n * sizeof(double);
    size_t size;
    const dem_motion_field *field;
    const double *there = dem_checkpoint_find(checkpoint, "motions", &size);
    CHECK(there != NULL && size == expected, DEM_ERROR_IO,
          "the checkpoint has %zu bytes of the motion of obstacles, %zu are expected", there != NULL ? size : 0,
          expected);
    for (dem_index i = 0; i < o->n; i++)
        for (dem_index k = 0; (field = dem_motion_field_at(k)) != NULL; k++, there += field->n)
            TRY(check_field(&o->list[i], i, field, there));
    return DEM_OK;
}

/* Whether single numbers are possible: finite, times not negative, counts within their range. */
static dem_status check_numbers(const numbers *n)
{
    const bool finite = isfinite(n->impact) && isfinite(n->projection) && isfinite(n->work) && isfinite(n->projected);
    const bool timely = isfinite(n->t) && n->t >= 0.0 && isfinite(n->step) && n->step >= 0.0;
    CHECK(finite && timely && isfinite(n->next_step) && n->next_step >= 0.0, DEM_ERROR_IO,
          "the checkpoint's time %g s, step %g s or next step %g s is impossible", n->t, n->step, n->next_step);
    CHECK(n->unlooked >= 0 && n->unlooked <= INT32_MAX && n->events >= 0 && n->idle >= 0, DEM_ERROR_IO,
          "the checkpoint's counts are impossible");
    return DEM_OK;
}

/* Gets everything from a checkpoint, with all checks, the model's sizes before what depends on them: they decide how
 * long the entries must be. After a failure the simulation is partly that of the checkpoint, and must not go on. */
static dem_status get(dem_simulation *s, const dem_checkpoint *checkpoint, numbers *n, const double **y)
{
    const checkpoint_entries_way way = {.from = checkpoint};
    TRY(breaking_restore(s, checkpoint)); /* decides how many candidates there are */
    TRY(check_sizes(s, checkpoint));
    TRY(check_motion(s, checkpoint));
    TRY(pass(s, &way, n, &s->automaton.set.ledger.counts));
    TRY(check_numbers(n));
    TRY(pausing_restore(s, checkpoint));
    TRY(find_state(s, checkpoint, y));
    TRY(body_contact_restore(s, checkpoint, *y));
    return source_list_restore(&s->sources, checkpoint, n->t, *y);
}

/* The contacts' forces and clearances are found by the source (automaton_restore()), the integrator begins without a
 * history: integrator_renew(). No step is in hand afterwards. */
dem_status checkpoint_restore(dem_simulation *s, const dem_checkpoint *checkpoint)
{
    contact_set *c = &s->automaton.set;
    const double *y = NULL;
    numbers n;
    TRY(reduce_status(s->model->ranks, get(s, checkpoint, &n, &y), 0.0));
    c->ledger.impact = exact_sum_of(n.impact);
    c->ledger.projection = exact_sum_of(n.projection);
    c->ledger.work = exact_sum_of(n.work);
    c->projected = n.projected;
    s->automaton.idle = n.idle;
    s->t = n.t;
    s->step = n.step;
    s->events = n.events;
    s->crossings = c->ledger.counts.crossings;
    s->unlooked = (int)n.unlooked;
    s->since_checkpoint = 0;
    s->in_hand = s->at_event = false;
    s->path = (dense_output){0};
    TRY(integrator_renew(&s->integrator, &(integrator_start){n.t, n.next_step, y, c->ledger.counts}));
    s->y = integrator_state(&s->integrator);
    return DEM_OK;
}
