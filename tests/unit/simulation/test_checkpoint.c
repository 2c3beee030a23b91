/* SPDX-License-Identifier: BSD-3-Clause */
/* checkpoint.c: what comes back is what was there, field by field; what cannot be is refused. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/message.h"
#include "simulation/checkpoint.h"
#include "ask.h"
#include "simulation/query.h"
#include "unit/contact/look.h"

/* A rectangle that stands on two apexes and touches nothing else: edges may close. */
typedef struct pair {
    dem_model *model;
    dem_simulation *from, *to;
    dem_checkpoint *checkpoint;
} pair;

static void open_pair(pair *p)
{
    static const double points[] = {-0.1, -0.1, -0.01, -1e-5, 0.0, -0.02, 0.01, -1e-5, 0.1, -0.1};
    const dem_obstacle ground =
        SIZED(dem_obstacle, .n_points = 5, .points = points, .restitution = 0.3, .friction = 0.8);
    const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                      .density = 1050.0, .thickness = 1.0, .damping_time = 1e-5);
    dem_options options = dem_options_default();
    options.mass_damping = 500.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(0.05, 0.03, 0.01, &rubber);
    assert_ok(dem_model_create(&p->model, &lattice, &ground, 1));
    assert_ok(dem_simulation_create(&p->from, p->model, &options));
    assert_ok(dem_simulation_create(&p->to, p->model, &options));
    assert_ok(dem_checkpoint_create(&p->checkpoint));
}

static void close_pair(pair *p)
{
    dem_checkpoint_destroy(p->checkpoint);
    dem_simulation_destroy(p->from);
    dem_simulation_destroy(p->to);
    dem_model_destroy(p->model);
}

static void same_memory(const dem_simulation *a, const dem_simulation *b)
{
    const contact_set *c = &a->automaton.set, *d = &b->automaton.set;
    const dem_counts n = ask_counts(a), m = ask_counts(b);
    for (dem_index k = 0; k < c->n; k++) look_assert_same(&a->automaton, &b->automaton, k);
    assert_close(a->t, b->t, 0.0);
    assert_close(a->step, b->step, 0.0);
    assert_close(integrator_next_step(&a->integrator), integrator_next_step(&b->integrator), 0.0);
    assert_close(exact_sum_value(&c->ledger.impact), exact_sum_value(&d->ledger.impact), 0.0);
    assert_close(exact_sum_value(&c->ledger.projection), exact_sum_value(&d->ledger.projection), 0.0);
    assert_close(c->projected, d->projected, 0.0);
    assert_int_equal(a->automaton.idle, b->automaton.idle);
    assert_int_equal(a->events, b->events);
    assert_int_equal(a->unlooked, b->unlooked);
    assert_memory_equal(&n, &m, sizeof n);
    double impulses[2][4];
    ledger_list_impulses(&c->ledger, 1, impulses[0]);
    ledger_list_impulses(&d->ledger, 1, impulses[1]);
    assert_memory_equal(impulses[0], impulses[1], sizeof impulses[0]);
    assert_memory_equal(&a->overlap.found, &b->overlap.found, sizeof a->overlap.found);
    assert_memory_equal(a->y, b->y, (size_t)state_size(&a->layout) * sizeof *a->y);
}

TEST(everything_comes_back)
{
    CLEANUP(close_pair) pair p;
    dem_index n_stuck = 0;
    open_pair(&p);
    assert_ok(dem_simulation_advance(p.from, 0.05));
    automaton *c = &p.from->automaton;
    for (dem_index k = 0; k < c->set.n; k++) n_stuck += look_sticks_at_vertex(c, k);
    assert_true(n_stuck > 0);
    p.from->in_hand = false; /* goes on from the start of the step in hand */
    p.from->automaton.idle = 3;
    p.from->unlooked = 5;
    p.from->overlap.found = (dem_overlap){.now = 1, .most = 2, .t = 0.25, .node = 3, .triangle = 4, .x = {5.0, 6.0}};
    look_set_storm(c, 0, 7, 0.125);
    assert_ok(integrator_restart(&p.from->integrator, p.from->t, p.from->y));
    assert_ok(integrator_bound(&p.from->integrator, 1e-9));
    p.from->y = integrator_state(&p.from->integrator);
    assert_ok(checkpoint_take(p.from, p.checkpoint));
    assert_ok(checkpoint_restore(p.to, p.checkpoint));
    assert_close(integrator_next_step(&p.to->integrator), 1e-9, 0.0);
    same_memory(p.from, p.to);
}

/* ---- a source besides contact ---- */

typedef struct counter {
    dem_index count;
    double t, y; /* s, m: of the state it was restored for */
} counter;

static dem_status counter_save(const void *self, dem_checkpoint *checkpoint)
{
    const counter *c = self;
    return dem_checkpoint_put(checkpoint, "count", &c->count, sizeof c->count);
}

static dem_status counter_restore(void *self, const dem_checkpoint *checkpoint, double t, const double *y)
{
    counter *c = self;
    c->t = t;
    c->y = y[1];
    return dem_checkpoint_get(checkpoint, "count", &c->count, sizeof c->count);
}

static event_source counter_source(counter *c)
{
    return (event_source){.name = "count", .self = c, .save = counter_save, .restore = counter_restore};
}

TEST(every_source_comes_back)
{
    counter from = {.count = 5}, to = {.count = 0};
    CLEANUP(close_pair) pair p;
    open_pair(&p);
    assert_ok(dem_simulation_advance(p.from, 1e-3));
    assert_ok(source_list_add(&p.from->sources, counter_source(&from)));
    assert_ok(source_list_add(&p.to->sources, counter_source(&to)));
    assert_ok(checkpoint_take(p.from, p.checkpoint));
    assert_ok(checkpoint_restore(p.to, p.checkpoint));
    assert_int_equal(to.count, 5);
    assert_close(to.t, p.from->t, 0.0);
    assert_close(to.y, p.from->y[1], 0.0);
}

/* ---- what is refused ---- */

static void refuse(pair *p, const char *name, void *entry, size_t size, const char *message)
{
    size_t n;
    const void *was = dem_checkpoint_find(p->checkpoint, name, &n);
    CLEANUP(free_memory) void *kept = malloc(n + 1);
    assert_non_null(kept);
    memcpy(kept, was, n);
    assert_ok(dem_checkpoint_put(p->checkpoint, name, entry, size));
    assert_int_equal(checkpoint_restore(p->to, p->checkpoint), DEM_ERROR_IO);
    assert_message_parts(message);
    assert_ok(dem_checkpoint_put(p->checkpoint, name, kept, n));
}

TEST(sizes_numbers_and_states_that_cannot_be_are_refused)
{
    CLEANUP(close_pair) pair p;
    size_t n;
    const double before = -1.0;
    dem_index sizes[8], numbers[10];
    open_pair(&p);
    assert_ok(checkpoint_take(p.from, p.checkpoint));
    assert_ok(dem_checkpoint_get(p.checkpoint, "sizes", sizes, sizeof sizes));
    sizes[0]++;
    char text[160];
    (void)snprintf(text, sizeof text,
                   "the checkpoint is of another model: %lld nodes, %lld springs, 4 segments, not %lld, %lld, 4",
                   (long long)sizes[0], (long long)sizes[1], (long long)sizes[0] - 1, (long long)sizes[1]);
    refuse(&p, "sizes", sizes, sizeof sizes, text);
    refuse(&p, "sizes", sizes, 8, "the checkpoint has 8 bytes of sizes, 64 are expected");
    assert_ok(dem_checkpoint_get(p.checkpoint, "numbers", numbers, sizeof numbers));
    memcpy(numbers, &before, sizeof before);
    (void)snprintf(text, sizeof text, "the checkpoint's time -1 s, step 0 s or next step %g s is impossible",
                   integrator_next_step(&p.from->integrator));
    refuse(&p, "numbers", numbers, sizeof numbers, text);
    double motions[256] = {0.0}; /* obstacle 0 begins with its velocity */
    size_t size;
    assert_non_null(dem_checkpoint_find(p.checkpoint, "motions", &size));
    assert_true(size <= sizeof motions);
    motions[1] = 2.5;
    refuse(&p, "motions", motions, size, "in the checkpoint obstacle 0 moves with velocity of 2.5 m/s, not 0 m/s");
    (void)snprintf(text, sizeof text, "the checkpoint has 8 bytes of the motion of obstacles, %zu are expected", size);
    refuse(&p, "motions", motions, 8, text);
    CLEANUP(free_memory) double *y = malloc((size_t)state_size(&p.from->layout) * sizeof *y);
    const void *stored = dem_checkpoint_find(p.checkpoint, "state", &n);
    assert_non_null(y);
    memcpy(y, stored, n);
    y[3] = NAN;
    refuse(&p, "state", y, n, "the state in the checkpoint is not finite");
}

typedef struct raw_candidate {
    dem_index k, n_closed, behind[2], storm;
    double storm_start;
    struct {
        dem_index feature, slide, held;
        double place, force, friction;
    } closed[2];
} raw_candidate;

static void refuse_candidate(pair *p, raw_candidate candidate)
{
    refuse(p, "contacts", &candidate, sizeof candidate, "entry 0 of the contacts in the checkpoint is impossible");
}

TEST(candidates_that_cannot_be_are_refused)
{
    CLEANUP(close_pair) pair p;
    const raw_candidate good = {.k = 0, .n_closed = 1, .behind = {-1, -1}, .closed = {{.feature = 1, .slide = 1}}};
    raw_candidate bad[2] = {good, good};
    open_pair(&p);
    assert_ok(checkpoint_take(p.from, p.checkpoint));
    assert_ok(dem_checkpoint_put(p.checkpoint, "contacts", &good, sizeof good));
    assert_ok(checkpoint_restore(p.to, p.checkpoint));
    assert_int_equal(look_closed(&p.to->automaton, 0), 1);
#define REFUSE(field, value)                                                                                           \
    do {                                                                                                               \
        raw_candidate candidate = good;                                                                                \
        candidate.field = (value);                                                                                     \
        refuse_candidate(&p, candidate);                                                                               \
    } while (0)
    REFUSE(k, -1);
    REFUSE(k, p.to->automaton.set.n);
    REFUSE(n_closed, 3);
    REFUSE(n_closed, -1);
    REFUSE(behind[0], 1);
    REFUSE(behind[1], -2);
    REFUSE(storm, -1);
    REFUSE(storm_start, INFINITY);
    REFUSE(closed[0].feature, 4);
    REFUSE(closed[0].feature, -1);
    REFUSE(closed[0].slide, 2);
    REFUSE(closed[0].held, 2);
    REFUSE(closed[0].place, NAN);
    REFUSE(closed[0].force, NAN);
    REFUSE(closed[0].friction, NAN);
#undef REFUSE
    bad[0].n_closed = 2; /* twice on the same segment */
    bad[0].closed[1] = bad[0].closed[0];
    refuse_candidate(&p, bad[0]);
    bad[0] = good;
    refuse(&p, "contacts", bad, sizeof bad,
           "entry 1 of the contacts in the checkpoint is impossible"); /* twice the same */
    refuse(&p, "contacts", bad, 17, "the checkpoint has no contacts");
}
