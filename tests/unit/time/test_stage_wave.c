/* SPDX-License-Identifier: BSD-3-Clause */
/* stage_wave.c and deferral.c, as the integrator uses them: runs of which the stages are waves beside runs whose stages
 * are evaluated one by one. Both give the same bits, whatever else happens, so that no tolerance is needed. */
#include "verification/support.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/status.h"
#include "harness/message.h"
#include "time/integrator.h"

enum { calm = -1 };

/* A chain of pendulums, in which node i feels those next to it and those a band further away. */
typedef struct chain {
    state_layout layout;
    dem_index band;     /* rows */
    dem_index restless; /* a node that swings much faster; calm: none */
    bool is_rough;      /* that node jumps to and fro in no time instead */
    double fails_after; /* s: derivatives later than this fail, */
    int failures_left;  /* as often as this */
    int refuses_every;  /* bands are not to be had every so many times; 0: they always are */
    int doubts_every;   /* and do not hold in the end every so many times */
    int n_stages, judged;
    int asked;         /* times for bands */
    int wholes;        /* derivatives of whole states */
    atomic_int bands;  /* evaluated, */
    atomic_int faults; /* with the scratch of others */
    double root_at;    /* s: where the root function is 0 */
} chain;

static double pull(const chain *c, const double *x, dem_index i, dem_index j, int d)
{
    return j >= 0 && j < c->layout.n_nodes ? x[2 * j + d] - x[2 * i + d] : 0.0;
}

static void accelerate(const chain *c, double t, const double *x, const double *v, double *a, dem_index i)
{
    const double stiffness = i == c->restless ? 4e4 : 1.0;
    for (int d = 0; d < 2; d++) {
        const double near = pull(c, x, i, i - 1, d) + pull(c, x, i, i + 1, d);
        const double far = pull(c, x, i, i - c->band, d) + pull(c, x, i, i + c->band, d);
        a[2 * i + d] = -stiffness * sin(x[2 * i + d]) + 0.3 * near + 0.2 * far - 0.01 * v[2 * i + d];
        if (c->is_rough && i == c->restless) a[2 * i + d] = 1e20 * sin(1e15 * t);
    }
}

static void set_rates(const chain *c, double *a)
{
    for (dem_index k = state_row(&c->layout, c->layout.n_nodes); k < state_velocities(&c->layout); k++) a[k] = 0.0;
    a[state_total_index(&c->layout, STATE_TIME)] = 1.0;
}

static bool is_due(const chain *c, double t)
{
    return t > c->fails_after && c->failures_left != 0;
}

static int swing(double t, const double *y, double *u, double *a, void *context)
{
    chain *c = context;
    const double *v = y + state_velocities(&c->layout);
    c->wholes++;
    memcpy(u, v, (size_t)state_velocities(&c->layout) * sizeof *u);
    for (dem_index i = 0; i < c->layout.n_nodes; i++) accelerate(c, t, y, v, a, i);
    set_rates(c, a);
    if (!is_due(c, t)) return 0;
    c->failures_left--;
    (void)status_fail(DEM_ERROR_INTEGRATOR, "the test's force fails at %.17g s", t);
    return 1;
}

static double swing_band(const ode_band *b, void *context)
{
    chain *c = context;
    const dem_index end = b->end < c->layout.n_nodes ? b->end : c->layout.n_nodes;
    (void)atomic_fetch_add(&c->bands, 1);
    if (b->goes_on && b->scratch[0] != (double)b->first) (void)atomic_fetch_add(&c->faults, 1);
    b->scratch[0] = (double)b->end;
    for (dem_index i = b->first; i < end; i++) accelerate(c, b->t, b->x, b->v, b->a, i);
    if (b->end > end) set_rates(c, b->a);
    return is_due(c, b->t) ? (double)NAN : 0.0;
}

static bool has_bands(int n_stages, void *context)
{
    chain *c = context;
    c->n_stages = n_stages;
    c->asked++;
    return c->refuses_every == 0 || c->asked % c->refuses_every != 0;
}

static bool bands_hold(int n_stages, void *context)
{
    chain *c = context;
    assert_int_equal(n_stages, c->n_stages);
    c->judged++;
    return c->doubts_every == 0 || c->judged % c->doubts_every != 0;
}

static double root_function(const dense_output *step, void *context)
{
    const chain *c = context;
    return c->root_at - state_time(&step->layout, step->y1) + step->t1 - step->end;
}

static void begin_roots(double t, const double *y, void *context)
{
    (void)t;
    (void)y;
    (void)context;
}

static chain make_chain(dem_index n_nodes, dem_index band)
{
    return (chain){.layout = state_layout_of(2, n_nodes, 0, false),
                   .band = band,
                   .restless = calm,
                   .fails_after = 1e9,
                   .root_at = 1e9};
}

/* What a pair of runs differs in from others. */
typedef struct setting {
    dem_method method;
    int threads;
    double error, max_step;
    bool rooted;
} setting;

static const setting usual = {DEM_METHOD_FEHLBERG45, 1, 1e-6, 2.0, false};

/* One run by waves, the other without, and the last step of both. */
typedef struct race {
    chain chains[2];
    team *team;
    integrator i[2];
    dense_output p[2];
    bool rooted[2];
} race;

static integrator start(chain *c, team *t, const setting *s, bool by_bands)
{
    const state_layout *l = &c->layout;
    CLEANUP(free_memory) double *y = aligned_zeros((size_t)state_size(l));
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) {
        y[k] = sin(0.7 * (double)k);
        y[state_velocities(l) + k] = cos(0.13 * (double)(k % 701));
    }
    const ode_problem problem = {.layout = *l,
                                 .derivative = swing,
                                 .band_rows = by_bands ? c->band : 0,
                                 .band_scratch = 1,
                                 .has_bands = by_bands ? has_bands : NULL,
                                 .bands_hold = bands_hold,
                                 .band_derivative = swing_band,
                                 .begin_roots = s->rooted ? begin_roots : NULL,
                                 .root_function = s->rooted ? root_function : NULL,
                                 .context = c,
                                 .method = s->method,
                                 .position_error = s->error,
                                 .velocity_error = s->error,
                                 .max_step = s->max_step,
                                 .ops = array_ops_fastest(),
                                 .team = t};
    integrator i;
    assert_ok(integrator_create(&i, &problem, 0.0, y));
    return i;
}

static void begin(race *r, const chain *c, const setting *s)
{
    r->team = team_create(s->threads, 1000);
    for (int k = 0; k < 2; k++) {
        r->chains[k] = *c;
        r->i[k] = start(&r->chains[k], r->team, s, k == 0);
    }
}

static void end(race *r)
{
    for (int k = 0; k < 2; k++) integrator_destroy(&r->i[k]);
    team_destroy(r->team);
}

static void assert_same_state(const race *r, const double *a, const double *b)
{
    assert_memory_equal(a, b, (size_t)state_size(&r->chains[0].layout) * sizeof *a);
}

static void assert_same_counts(const race *r)
{
    const dem_counts a = integrator_counts(&r->i[0]), b = integrator_counts(&r->i[1]);
    assert_int_equal(a.steps, b.steps);
    assert_int_equal(a.rejected, b.rejected);
    assert_int_equal(a.evaluations, b.evaluations);
    assert_int_equal(a.retries, b.retries);
    assert_close(integrator_next_step(&r->i[0]), integrator_next_step(&r->i[1]), 0.0);
}

/* Both take a step, or fail. */
static dem_status step(race *r)
{
    dem_status status[2];
    char message[512] = "";
    for (int k = 0; k < 2; k++) {
        status[k] = integrator_step(&r->i[k], &r->p[k], &r->rooted[k]);
        if (status[k] == DEM_OK) continue;
        if (k == 0) (void)snprintf(message, sizeof message, "%s", dem_status_message());
        if (k == 1) assert_string_equal(dem_status_message(), message);
    }
    assert_int_equal(status[0], status[1]);
    assert_same_counts(r);
    if (status[0] != DEM_OK) return status[0];
    assert_close(r->p[0].t1, r->p[1].t1, 0.0);
    assert_close(r->p[0].end, r->p[1].end, 0.0);
    assert_same_state(r, r->p[0].y0, r->p[1].y0);
    assert_same_state(r, r->p[0].y1, r->p[1].y1);
    assert_same_state(r, r->p[0].f0, r->p[1].f0);
    assert_same_state(r, r->p[0].f1, r->p[1].f1);
    assert_true(r->rooted[0] == r->rooted[1]);
    return DEM_OK;
}

/* All accepted steps are waves but for the derivative at their end, and where bands are not to be had. */
static void run(const chain *c, const setting *s, int steps)
{
    CLEANUP(end) race r = {0};
    dem_method_traits traits = {.struct_size = sizeof traits};
    begin(&r, c, s);
    for (int k = 0; k < steps; k++) assert_ok(step(&r));
    const chain *by_bands = &r.chains[0];
    const int refused = (c->refuses_every > 0 ? by_bands->asked / c->refuses_every : 0) +
                        (c->doubts_every > 0 ? by_bands->judged / c->doubts_every : 0);
    assert_ok(dem_method_describe(&traits, s->method));
    assert_int_equal(integrator_counts(&r.i[0]).evaluations - r.chains[0].wholes,
                     (steps - refused) * (traits.evaluations - 1));
    assert_true(atomic_load(&r.chains[0].bands) > 0);
    assert_true(by_bands->judged >= steps - refused);
    assert_int_equal(atomic_load(&r.chains[0].faults), 0);
    assert_int_equal(atomic_load(&r.chains[1].bands), 0);
}

/* Whole bands, one node too many, one too few, a last band that is as long as a line; short bands and long ones. */
TEST(a_wave_gives_the_bits_of_stage_after_stage_for_any_number_of_nodes)
{
    static const dem_index nodes[] = {8000, 8001, 8007, 8008, 8319, 8320, 8321};
    for (size_t k = 0; k < sizeof nodes / sizeof *nodes; k++) {
        const chain c = make_chain(nodes[k], 320);
        run(&c, &usual, 4);
    }
    for (dem_index band = 8; band < 320; band *= 3) {
        const chain c = make_chain(8005, band);
        run(&c, &usual, 4);
    }
}

TEST(a_wave_gives_the_bits_of_stage_after_stage_with_any_method)
{
    static const dem_method methods[] = {DEM_METHOD_CASHKARP45, DEM_METHOD_ZONNEVELD34};
    const chain c = make_chain(8100, 80);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        setting s = usual;
        s.method = methods[k];
        s.max_step = 0.2;
        run(&c, &s, 6);
    }
}

TEST(a_wave_gives_the_same_bits_with_threads)
{
    for (int threads = 2; threads <= 3; threads++) {
        setting s = usual;
        s.threads = threads;
        for (dem_index band = 40; band <= 320; band *= 2) {
            const chain c = make_chain(26001, band);
            run(&c, &s, 4);
        }
    }
}

static bool uses_bands(const chain *c, const setting *s)
{
    CLEANUP(end) race r = {0};
    begin(&r, c, s);
    for (int k = 0; k < 3; k++) assert_ok(step(&r));
    return atomic_load(&r.chains[0].bands) > 0;
}

/* The derivative at the end of a step of Dormand and Prince is its last stage, which a wave would not keep. */
TEST(what_does_not_pay_or_is_read_later_is_no_wave)
{
    setting s = usual;
    chain c = make_chain(7999, 80);
    assert_false(uses_bands(&c, &s)); /* in the cache */
    c = make_chain(8800, 480);
    assert_false(uses_bands(&c, &s)); /* 19 bands */
    c = make_chain(8800, 80);
    assert_true(uses_bands(&c, &s));
    s.method = DEM_METHOD_DOPRI45;
    assert_false(uses_bands(&c, &s));
}

/* The first step is too long by far. */
TEST(steps_are_rejected_alike)
{
    CLEANUP(end) race r = {0};
    const chain c = make_chain(8100, 80);
    setting s = usual;
    s.error = 1e-9;
    s.max_step = 20.0;
    begin(&r, &c, &s);
    for (int k = 0; k < 6; k++) assert_ok(step(&r));
    assert_true(integrator_counts(&r.i[0]).rejected > 1);
}

/* The largest of 32,400 errors is then over 32 times the mean one, which is up to 1. */
TEST(an_error_of_one_node_alone_is_as_large)
{
    CLEANUP(end) race r = {0};
    chain c = make_chain(8100, 80);
    setting s = usual;
    c.restless = 4000;
    begin(&r, &c, &s);
    for (int k = 0; k < 40; k++) assert_ok(step(&r));
    assert_true(integrator_counts(&r.i[0]).rejected > 0);
}

TEST(a_run_may_have_waves_at_times)
{
    chain c = make_chain(8100, 80);
    c.refuses_every = 3;
    run(&c, &usual, 9);
    c.doubts_every = 4;
    run(&c, &usual, 9);
}

/* ---- failures ---- */

TEST(a_failed_stage_is_tried_again_alike)
{
    for (int failures = 1; failures <= 4; failures++) {
        CLEANUP(end) race r = {0};
        chain c = make_chain(8100, 80);
        c.fails_after = 0.5;
        c.failures_left = failures;
        begin(&r, &c, &usual);
        for (int k = 0; k < 12; k++) assert_ok(step(&r));
        assert_int_equal(integrator_counts(&r.i[0]).retries, failures);
        assert_true(r.p[0].t1 > 0.5);
    }
}

TEST(a_stage_that_fails_for_good_ends_both_with_the_same_message_at_the_last_good_state)
{
    CLEANUP(end) race r = {0};
    chain c = make_chain(8100, 80);
    c.fails_after = 0.5;
    c.failures_left = -1;
    begin(&r, &c, &usual);
    dem_status status = DEM_OK;
    for (int k = 0; k < 1000 && status == DEM_OK; k++) status = step(&r);
    assert_int_equal(status, DEM_ERROR_INTEGRATOR);
    assert_message_parts("the test's force fails");
    assert_same_state(&r, integrator_state(&r.i[0]), integrator_state(&r.i[1]));
    for (int k = 0; k < 2; k++) r.chains[k].failures_left = 0;
    assert_ok(step(&r));
}

/* The force on one node is another in every stage of the shortest step, too, 1e-9 of the longest. The message has that
 * node, which is found by the errors themselves. */
TEST(an_error_that_no_step_brings_down_is_reported_alike)
{
    CLEANUP(end) race r = {0};
    chain c = make_chain(8100, 80);
    c.restless = 4321;
    c.is_rough = true;
    begin(&r, &c, &usual);
    assert_int_equal(step(&r), DEM_ERROR_INTEGRATOR);
    assert_message_parts("the error is largest at node 4321");
    assert_true(integrator_counts(&r.i[0]).rejected > 5);
}

/* ---- what callers do between steps ---- */

TEST(roots_within_a_step_are_found_alike)
{
    CLEANUP(end) race r = {0};
    chain c = make_chain(8100, 80);
    setting s = usual;
    c.root_at = 0.73;
    s.rooted = true;
    begin(&r, &c, &s);
    int rooted = 0;
    for (int k = 0; k < 12; k++) {
        assert_ok(step(&r));
        rooted += r.rooted[0];
        if (!r.rooted[0]) continue;
        assert_close(r.p[0].end, 0.73, 1e-12);
        for (int q = 0; q < 2; q++) {
            r.chains[q].root_at = 1e9;
            integrator_settle(&r.i[q], &r.p[q]);
            assert_ok(integrator_restart(&r.i[q], r.p[q].end, integrator_state(&r.i[q])));
        }
    }
    assert_int_equal(rooted, 1);
}

/* A step is taken back, its end changed, begun anew; the dense output is read in between. */
TEST(steps_may_be_taken_back_and_changed_in_between)
{
    CLEANUP(end) race r = {0};
    const chain c = make_chain(8100, 80);
    CLEANUP(free_memory) double *a = aligned_zeros((size_t)state_size(&c.layout));
    CLEANUP(free_memory) double *b = aligned_zeros((size_t)state_size(&c.layout));
    double *const at[2] = {a, b};
    begin(&r, &c, &usual);
    for (int k = 0; k < 12; k++) {
        assert_ok(step(&r));
        for (int q = 0; q < 2; q++) {
            dense_output_state(&r.p[q], 0.5 * (r.p[q].t0 + r.p[q].t1), at[q]);
            if (k % 4 == 1) assert_ok(integrator_redo(&r.i[q], 0.5));
            if (k % 4 == 2) {
                double *y1, *f1;
                integrator_end(&r.i[q], &y1, &f1);
                y1[state_velocities(&c.layout) + 7] += 0.25;
                f1[7] += 0.25;
                integrator_settle(&r.i[q], &r.p[q]);
                assert_ok(integrator_resume(&r.i[q]));
            }
            if (k % 4 == 3) integrator_settle(&r.i[q], &r.p[q]);
        }
        assert_same_state(&r, a, b);
    }
}
