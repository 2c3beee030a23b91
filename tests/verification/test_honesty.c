/* SPDX-License-Identifier: BSD-3-Clause */
/* Is the error estimate of a step with impacts in it honest? A block strikes a floor, or an uneven one. Every accepted
 * step is redone from its start by the parts that make it, for the estimates that it was accepted by: GSL's rkf45,
 * which is Fehlberg's, for the free step, and the queue for its events; and by the root-located method at rtol 1e-12,
 * for its true error. All in the same norm, over all unknowns and in units of the tolerance. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <stdlib.h>
#include <string.h>

#include "queue.h"
#include "support.h"

enum { most_steps = 400 };

static const double spacing = 5e-3;
static const double flat[4] = {-0.2, 0.0, 0.2, 0.0};

/* Facets of 8 mm, 2 mm high and low. */
static const double facets[30] = {-0.2,   -2e-3,  -0.044, 1e-3,   -0.036, -1.5e-3, -0.028, 2e-3,  -0.02, -1e-3,
                                  -0.012, 1.2e-3, -0.004, -2e-3,  0.004,  1.5e-3,  0.012,  -1e-3, 0.02,  2e-3,
                                  0.028,  -2e-3,  0.036,  0.5e-3, 0.2,    -1e-3,   0.3,    -1e-3, 0.4,   -1e-3};
static const dem_obstacle grounds[2] = {{.n_points = 2, .points = flat, .restitution = 1.0},
                                        {.n_points = 15, .points = facets, .restitution = 1.0}};

/* A run that keeps its states after accepted steps. */
typedef struct record {
    dem_index n; /* nodes */
    int n_steps;
    double t[most_steps], *y[most_steps]; /* [4 n] */
    dem_index impacts[most_steps];
} record;

static dem_status keep(void *context, const dem_simulation *simulation)
{
    record *r = context;
    const size_t size = 2 * (size_t)r->n * sizeof(double);
    dem_state state;
    dem_simulation_state(simulation, &state);
    assert_true(r->n_steps < most_steps);
    r->t[r->n_steps] = state.t;
    r->impacts[r->n_steps] = dem_simulation_counts(simulation).impacts;
    double *y = malloc(2 * size);
    assert_non_null(y);
    memcpy(y, state.x, size);
    memcpy(y + 2 * r->n, state.v, size);
    r->y[r->n_steps++] = y;
    return DEM_OK;
}

static void forget(record *r)
{
    for (int k = 0; k < r->n_steps; k++) free(r->y[k]);
}

/* ---- the parts of a step ---- */

typedef struct parts {
    dem_model *model;
    contact_rule rule;
    dem_options options;
    dem_index n, n_all;
} parts;

static int derive(double t, const double y[], double f[], void *context)
{
    const parts *p = context;
    const double *v = y + 2 * p->n_all;
    (void)t;
    memset(f, 0, 4 * (size_t)p->n_all * sizeof *f);
    memcpy(f, v, 2 * (size_t)p->n * sizeof *f);
    for (dem_index i = 0; i < p->n; i++)
        vec2_put(f, p->n_all + i, model_acceleration(p->model, &p->rule.load, i, y, v));
    return GSL_SUCCESS;
}

/* What is estimated for a step, and where it ends. */
typedef struct estimates {
    double free, events;
} estimates;

static double norm(const parts *p, const double *x, const double *v)
{
    const double px = p->options.rtol * p->options.spacing, pv = p->options.rtol * p->options.v_scale;
    double sum = 0.0;
    for (dem_index k = 0; k < 2 * p->n; k++) sum += pow(x[k] / px, 2.0) + pow(v[k] / pv, 2.0);
    return sqrt(sum / (4.0 * (double)p->n));
}

/* A whole state of n_all nodes from that of n. */
static void spread(const parts *p, const double *y, double *whole)
{
    memset(whole, 0, 4 * (size_t)p->n_all * sizeof *whole);
    memcpy(whole, y, 2 * (size_t)p->n * sizeof *y);
    memcpy(whole + 2 * p->n_all, y + 2 * p->n, 2 * (size_t)p->n * sizeof *y);
}

/* The step from y at t to y1 at t1, which is to be the product's. */
static estimates take_step(parts *p, double t, double t1, const double *y, const double *product)
{
    const size_t size = 4 * (size_t)p->n_all;
    double *arrays = calloc(6 * size, sizeof *arrays);
    double *y0 = arrays, *y1 = y0 + size, *f0 = y1 + size, *f1 = f0 + size, *error = f1 + size, *state = error + size;
    gsl_odeiv2_system system = {derive, NULL, size, p};
    gsl_odeiv2_step *gsl = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rkf45, size);
    const contact_listener nobody = {NULL, NULL};
    const double one[2] = {p->options.rtol * p->options.spacing, p->options.rtol * p->options.v_scale};
    contact c;
    queue q;
    assert_true(arrays != NULL && gsl != NULL);
    spread(p, y, y0);
    assert_ok(contact_create(&c, p->model, &p->rule));
    assert_ok(contact_start(&c, t, y0, &nobody));
    assert_ok(queue_create(&q, &c, &(patch_rule){5, one[0], one[1], NULL}, true));
    memcpy(y1, y0, size * sizeof *y1);
    assert_int_equal(gsl_odeiv2_step_apply(gsl, t, t1 - t, y1, error, NULL, NULL, &system), GSL_SUCCESS);
    (void)derive(t, y0, f0, p);
    (void)derive(t1, y1, f1, p);
    path step = {p->n_all, t, t1, t1, y0, f0, y1, f1, false, NULL};
    queue_start(&q, &step, y1, f1, state);
    assert_ok(queue_show(&q, t1));
    const estimates e = {norm(p, error, error + 2 * p->n_all), queue_error(&q)};
    for (dem_index k = 0; k < 2 * p->n; k++) {
        assert_close(y1[k], product[k], 1e-3 * one[0] + 1e-15);
        assert_close(y1[2 * p->n_all + k], product[2 * p->n + k], 1e-3 * one[1] + 1e-12);
    }
    queue_destroy(&q);
    contact_destroy(&c);
    gsl_odeiv2_step_free(gsl);
    free(arrays);
    return e;
}

/* The same step by the root-located method at rtol 1e-12: how far its end is from the product's. */
static double true_error(const parts *p, double t, double t1, const double *y, const double *product)
{
    dem_lattice lattice = *dem_model_lattice(p->model);
    dem_options options = p->options;
    dem_index n_obstacles;
    double *start = malloc(8 * (size_t)p->n * sizeof *start), *off = start + 4 * p->n;
    dem_model *model;
    dem_simulation *simulation;
    dem_state state;
    assert_non_null(start);
    memcpy(start, y, 4 * (size_t)p->n * sizeof *start);
    lattice.position = start;
    lattice.velocity = start + 2 * p->n;
    options.contact = DEM_CONTACT_EXACT;
    options.rtol = 1e-12;
    const dem_obstacle *obstacles = dem_model_obstacles(p->model, &n_obstacles);
    assert_ok(dem_model_create(&model, &lattice, obstacles, n_obstacles));
    assert_ok(dem_simulation_create(&simulation, model, &options));
    assert_ok(dem_simulation_advance(simulation, t1 - t));
    dem_simulation_state(simulation, &state);
    for (dem_index k = 0; k < 2 * p->n; k++) {
        off[k] = product[k] - state.x[k];
        off[2 * p->n + k] = product[2 * p->n + k] - state.v[k];
    }
    const double error = norm(p, off, off + 2 * p->n);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    free(start);
    return error;
}

/* ---- the comparison ---- */

/* Over all steps of a kind: of the true error over the estimate. */
typedef struct verdict {
    int n;
    double logs, worst; /* sum of logarithms, and the largest */
} verdict;

static void judge(verdict *v, double ratio)
{
    v->n++;
    v->logs += log(ratio);
    v->worst = fmax(v->worst, ratio);
}

/* Whether every node is clear of the ground by more than a new start takes for touching. */
static bool is_clear(const parts *p, const double *x)
{
    for (dem_index k = 0; k < p->model->n_sites; k++)
        if (dem_model_gap(p->model, x + 2 * p->model->sites[k]) < 1e-15) return false;
    return true;
}

static void make_parts(parts *p, const support_run *run)
{
    *p = (parts){.model = run->model, .options = dem_simulation_options(run->simulation)};
    const dem_options *o = &p->options;
    p->n = p->model->lattice.n_nodes;
    p->n_all = p->n + 4;
    p->rule = (contact_rule){.skin = o->skin,
                             .position_error = o->rtol * o->spacing,
                             .max_step = o->max_step,
                             .storm_time = 1.0 / p->model->omega_max,
                             .max_impacts = o->max_impacts,
                             .n_books = 4,
                             .load = {.gravity = {o->gravity[0], o->gravity[1]}}};
}

/* The run, its steps told and kept. */
static void run_block(support_run *run, record *r, const dem_obstacle *ground, double rtol, double max_step)
{
    const dem_material rubber = {
        .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0};
    dem_options options = dem_options_default();
    dem_lattice lattice;
    double lowest = INFINITY;
    assert_ok(dem_lattice_rectangle(&lattice, 0.08, 0.13, spacing));
    assert_ok(dem_lattice_assemble(&lattice, &rubber));
    dem_lattice_move(&lattice, 0.03, (const double[2]){0.0, 0.0});
    for (dem_index i = 0; i < lattice.n_nodes; i++) lowest = fmin(lowest, lattice.x[2 * i + 1]);
    dem_lattice_move(&lattice, 0.0,
                     (const double[2]){0.0, 0.2 * spacing - lowest + (ground->n_points > 2 ? 2e-3 : 0.0)});
    assert_ok(dem_lattice_launch(&lattice, (const double[2]){0.0, -10.0}));
    options.rtol = rtol;
    options.max_step = max_step / 239.0 * spacing;
    options.skin = 1e-9 * spacing;
    options.vertices = 0;
    support_open(run, &lattice, ground, 1, &options);
    *r = (record){.n = lattice.n_nodes};
    dem_lattice_free(&lattice);
    const dem_observer observer = {.step = keep, .context = r};
    assert_ok(dem_simulation_observe(run->simulation, &observer));
    assert_ok(dem_simulation_advance(run->simulation, 5e-4));
}

/* The estimate is the error of the result of order 4, and what is kept is of order 5; the paper of this method found at
 * most 2.1 in steps with impacts, here it is 1.5. In the step after a first impact, which begins with the velocity of
 * one node, the leading term of the estimate, h^5 (1/104 - 1/120) K^2 v, is one of positions, and that of the error,
 * h^6 (1/720 - 1/2080) K^3 v, one of velocities: with omega a = 239 m/s against a scale of 10 m/s it may be 0.7 omega h
 * 23.9 times as large, 8.4 for omega h = 0.5, whatever method takes the impacts. Below a hundredth of the tolerance
 * rounding counts. */
static void judge_run(const dem_obstacle *ground, double rtol, double max_step, double *missed)
{
    support_run run;
    record r;
    parts p;
    verdict without = {0}, with = {0}, by_free_step = {0};
    run_block(&run, &r, ground, rtol, max_step);
    make_parts(&p, &run);
    for (int k = 0; k + 1 < r.n_steps; k++) {
        if (!is_clear(&p, r.y[k])) continue;
        const estimates e = take_step(&p, r.t[k], r.t[k + 1], r.y[k], r.y[k + 1]);
        const double error = true_error(&p, r.t[k], r.t[k + 1], r.y[k], r.y[k + 1]);
        if (error < 0.01) continue;
        if (r.impacts[k + 1] == r.impacts[k]) {
            judge(&without, error / e.free);
            continue;
        }
        judge(&with, error / fmax(e.free, e.events));
        judge(&by_free_step, error / e.free);
        assert_true(e.events <= 1.0); /* or it would have been rejected */
    }
    print_message("# rtol %g, omega h <= %g: %d steps without impacts, true/estimate %.2f, at most %.2f; %d with %.2f, "
                  "at most %.2f; by the free step alone %.2f, at most %.1e\n",
                  rtol, max_step, without.n, exp(without.logs / without.n), without.worst, with.n,
                  exp(with.logs / with.n), with.worst, exp(by_free_step.logs / with.n), by_free_step.worst);
    assert_true(with.n >= 10);
    assert_true(with.worst <= 2.1);
    assert_true(without.worst <= 8.4);
    *missed = fmax(*missed, by_free_step.worst);
    forget(&r);
    support_close(&run);
}

/* The first impact strikes a body at rest in itself, whose free step has no error: without the estimate of the events
 * it would be accepted however wrong it is. */
static void what_is_estimated_is_what_is_wrong(void **state)
{
    double missed = 0.0;
    (void)state;
    judge_run(&grounds[0], 1e-6, 1.5, &missed);
    judge_run(&grounds[0], 1e-8, 1.5, &missed);
    judge_run(&grounds[1], 1e-6, 0.5, &missed);
    judge_run(&grounds[1], 1e-8, 0.5, &missed);
    assert_true(missed > 1e3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_estimated_is_what_is_wrong)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
