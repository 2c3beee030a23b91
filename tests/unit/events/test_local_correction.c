/* SPDX-License-Identifier: BSD-3-Clause */
/* local_correction.c: an event's change of a step against two oracles that know of no rings: one step of GSL's rkf45,
 * which is Fehlberg's, for the change of the whole body, quadratures and all, and its error estimate; and the body
 * itself, integrated by GSL's rk8pd with the jump of the velocity in it. */
#include "verification/triplets.h"

#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>

#include "contact/automaton_step.h"
#include "contact/contact_constraints.h"
#include "events/local_correction.h"
#include "forces/local_springs.h"
#include "unit/events/chain.h"
#include "unit/contact/look.h"
#include "verification/support.h"

static const double spacing = 0.01, start = 2e-4, position_error = 1e-8, velocity_error = 1e-5;

/* What a case has besides springs. */
typedef struct kind {
    double nu, damping_time, mass_damping;
    bool drives, ridges, parabolic;
} kind;

/* A block of rubber whose lower edge is y = 0, smoothly deformed and moving, and a step of it. */
typedef struct step {
    kind kind;
    dem_model *model;
    boundary_conditions b;
    forces acting;
    automaton c, before; /* contacts as they are, and as they were */
    constraints closed;  /* those of c */
    local_springs springs;
    local_forces near;
    dem_index n, n_all;
    double h;
    double *y0, *f0, *y1, *f1, *state, *first, *last;
    dense_output dense;
    changed_motion changed;
    local_correction correction;
} step;

/* ---- the whole body ---- */

/* Derivative of a state, of nodes and quadratures. */
static void derive(const step *s, automaton *c, double t, const double *y, double *f)
{
    const state_layout *l = look_layout(c);
    const dem_index n = 2 * s->n_all;
    const double *v = y + n;
    double *a = f + n;
    memcpy(f, v, (size_t)n * sizeof *f);
    for (dem_index i = 0; i < s->n; i++) vec2_put(a, i, forces_acceleration(&s->acting, i, y, v));
    automaton_constrain(c, 0.0, y, a);
    const double work = forces_prescribe(&s->acting, t, v, f, a);
    for (dem_index k = 2 * s->n; k < n; k++) a[k] = 0.0;
    automaton_add_rates(c, 0.0, y, a);
    a[state_total_index(l, STATE_DAMPING)] = forces_damping_power(&s->acting, y, v);
    a[state_total_index(l, STATE_WORK)] = work;
    a[state_total_index(l, STATE_TIME)] = 1.0;
}

static int of_the_body(double t, const double y[], double f[], void *context)
{
    step *s = context;
    derive(s, &s->before, t, y, f);
    return GSL_SUCCESS;
}

/* d' of the change d: the derivative with it and the contacts after the event, less that without and before. */
static int of_the_change(double t, const double d[], double f[], void *context)
{
    step *s = context;
    const dem_index n = 4 * s->n_all;
    dense_output_state(&s->dense, t, s->first);
    derive(s, &s->before, t, s->first, s->last);
    for (dem_index k = 0; k < n; k++) s->first[k] += d[k];
    derive(s, &s->c, t, s->first, f);
    for (dem_index k = 0; k < n; k++) f[k] -= s->last[k];
    return GSL_SUCCESS;
}

static void apply(step *s, const gsl_odeiv2_step_type *type, int (*rates)(double, const double *, double *, void *),
                  double t, double h, double *y, double *error)
{
    const size_t size = 4 * (size_t)s->n_all;
    gsl_odeiv2_system system = {rates, NULL, size, s};
    gsl_odeiv2_step *gsl = gsl_odeiv2_step_alloc(type, size);
    assert_non_null(gsl);
    assert_int_equal(gsl_odeiv2_step_apply(gsl, t, h, y, error, NULL, NULL, &system), GSL_SUCCESS);
    gsl_odeiv2_step_free(gsl);
}

/* ---- the step ---- */

static double *zeros(const step *s)
{
    double *y = calloc(4 * (size_t)s->n_all, sizeof *y);
    assert_non_null(y);
    return y;
}

static void make_model(step *s)
{
    static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};
    static const double ridge_points[10] = {-1.0, -1.0, -0.013, 0.0, 0.003, -0.01, 0.014, 0.0, 1.0, -1.0};
    const dem_obstacle ground =
        SIZED(dem_obstacle, .n_points = s->kind.ridges ? 5 : 2, .points = s->kind.ridges ? ridge_points : floor_points,
              .restitution = 0.5, .friction = 0.3);
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = s->kind.nu, .density = 1050.0, .thickness = 1.0,
              .guard = 0.02, .damping_time = s->kind.damping_time);
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(0.15, 0.13, spacing, &rubber);
    assert_ok(dem_model_create(&s->model, &lattice, &ground, 1));
}

static dem_index node_near(const step *s, double x, double y)
{
    dem_index best = 0;
    double least = INFINITY;
    for (dem_index i = 0; i < s->n; i++) {
        const vec2 at = vec2_at(s->model->lattice.x, i);
        const double d = hypot(at.x - x, at.y - y);
        if (d >= least) continue;
        least = d;
        best = i;
    }
    return best;
}

/* A node that is driven upwards, near the middle of the lower edge, and one that is pushed. */
static void make_boundaries(step *s)
{
    const dem_index driven = node_near(s, 0.0, 0.017), pushed = node_near(s, 0.02, 0.01);
    const dem_boundary list[2] = {SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_Y,
                                        .n_nodes = 1, .nodes = &driven, .value = {0.0, 3.0}, .ramp = 1e-3),
                                  SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .components = 3, .n_nodes = 1,
                                        .nodes = &pushed, .value = {50.0, -20.0}, .ramp = 1e-3)};
    dem_lattice lattice = s->model->lattice;
    unsigned char *flags = malloc((size_t)s->n);
    assert_non_null(flags);
    memcpy(flags, lattice.flags, (size_t)s->n);
    flags[driven] = 0;
    lattice.flags = flags;
    assert_ok(boundary_conditions_compile(&s->b, list, 2, &lattice, NULL, 1));
    free(flags);
}

static void make_contacts(step *s)
{
    const contact_rule rule = {.penetration_tolerance = 1e-8,
                               .position_error = 1e-9,
                               .max_step = s->h,
                               .storm_time = 1.0,
                               .max_impacts = 100,
                               .vertices = true,
                               .layout = {.dim = 2,
                                          .n_nodes = s->n,
                                          .n_obstacles = s->model->obstacles.n,
                                          .n_totals = STATE_OBSTACLE,
                                          .n_rows = s->n_all}};
    s->acting = (forces){.model = s->model,
                         .gravity = {0.0, -9.81},
                         .mass_damping = s->kind.mass_damping,
                         .boundaries = s->kind.drives ? &s->b : NULL,
                         .clock = 2 * s->n_all - 1};
    assert_ok(automaton_create(&s->c, &s->acting, &rule));
    assert_ok(automaton_create(&s->before, &s->acting, &rule));
}

/* Stretched, sheared and bent by some percent, at speeds of some m/s. */
static void put_start(step *s)
{
    double *v = s->y0 + 2 * s->n_all;
    for (dem_index i = 0; i < s->n; i++) {
        const vec2 x = vec2_at(s->model->lattice.x, i);
        vec2_put(s->y0, i, (vec2){x.x * (1.0 + 0.4 * x.y) - 0.02 * x.y, x.y * (0.98 + 0.3 * x.x)});
        vec2_put(v, i, (vec2){1.0 + 20.0 * x.x * x.y + 3.0 * x.y, -4.0 + 10.0 * x.y - 15.0 * x.x * x.x});
        if (s->b.held == NULL || s->b.held[i] == 0) continue;
        v[2 * i + 1] = boundary_condition_velocity(&s->b.list[0], start).y;
    }
    v[2 * s->n_all - 1] = start;
}

static void open_step(step *s, kind k)
{
    *s = (step){.kind = k};
    make_model(s);
    s->n = s->model->lattice.n_nodes;
    s->n_all = s->n + 4;
    s->h = 0.5 / s->model->omega_max;
    if (k.drives) make_boundaries(s);
    make_contacts(s);
    s->y0 = zeros(s), s->f0 = zeros(s), s->y1 = zeros(s), s->f1 = zeros(s);
    s->state = zeros(s), s->first = zeros(s), s->last = zeros(s);
    put_start(s);
    local_springs_create(&s->springs, &s->acting, look_layout(&s->c));
    s->near = local_springs_forces(&s->springs);
    s->closed = contact_constraints_of(&s->c);
    assert_ok(local_correction_create(
        &s->correction, look_layout(&s->c), &s->near, &s->closed,
        &(local_correction_rule){5, position_error, velocity_error, look_layout(&s->c)->n_nodes}));
    assert_ok(changed_motion_create(&s->changed, look_layout(&s->c)));
}

static void close_step(step *s)
{
    local_correction_destroy(&s->correction);
    local_springs_destroy(&s->springs);
    changed_motion_destroy(&s->changed);
    automaton_destroy(&s->c);
    automaton_destroy(&s->before);
    boundary_conditions_free(&s->b);
    dem_model_destroy(s->model);
    double *const arrays[] = {s->y0, s->f0, s->y1, s->f1, s->state, s->first, s->last};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) free(arrays[k]);
}

/* Takes the step with the contacts that there are. */
static void go(step *s)
{
    CLEANUP(free_memory) double *error = zeros(s);
    memcpy(s->y1, s->y0, 4 * (size_t)s->n_all * sizeof *s->y1);
    apply(s, gsl_odeiv2_step_rkf45, of_the_body, start, s->h, s->y1, error);
    s->y1[4 * s->n_all - 1] = start + s->h;
    derive(s, &s->before, start, s->y0, s->f0);
    derive(s, &s->before, start + s->h, s->y1, s->f1);
    const double end = start + s->h;
    s->dense = (dense_output){*look_layout(&s->c), start,      end, end, s->y0, s->f0, s->y1, s->f1,
                              s->kind.parabolic,   &s->changed};
    changed_motion_start(&s->changed, s->dense.t1, s->y1, s->f1);
    automaton_begin_step(&s->c, &s->dense, s->state);
}

/* Closes a contact now, and before if it was there. */
static void touch(step *s, dem_index k, dem_index feature, int sign, bool was_there)
{
    const contact_point point = look_point(feature, sign, 0.4);
    assert_ok(contact_set_close(&s->c.set, k, point));
    if (was_there) assert_ok(contact_set_close(&s->before.set, k, point));
}

/* ---- one event ---- */

/* Rings round the nodes marked 0; -1: not reached. A group of contacts is in the ring of its nearest node. */
static void count_rings(const step *s, int *ring, int most)
{
    const springs *sp = &s->model->springs;
    for (int r = 0; r <= most; r++) {
        for (dem_index i = 0; i < s->n && r > 0; i++)
            for (dem_index q = sp->row[i]; q < sp->row[i + 1] && ring[i] == r - 1; q++)
                if (ring[sp->neighbour[q]] < 0) ring[sp->neighbour[q]] = r;
        for (dem_index i = 0; i < s->n; i++)
            for (dem_index j = 0; j < s->n && ring[i] == r && contact_set_group_at(&s->c.set, i) >= 0; j++)
                if (ring[j] < 0 && contact_set_group_at(&s->c.set, j) == contact_set_group_at(&s->c.set, i))
                    ring[j] = r;
    }
}

/* The change at the end of the step against GSL's; quadratures are sums of thousands of terms of 1e-13. */
static void check_change(const step *s, const double *was, const double *change, double jump)
{
    const dem_index n = 2 * s->n_all;
    for (dem_index k = 0; k < n; k++) {
        const bool book = k >= 2 * s->n;
        assert_close(s->y1[n + k] - was[n + k], change[n + k], book ? 1e-12 : 2e-14 * (jump + fabs(s->y1[n + k])));
        if (!book) assert_close(s->y1[k] - was[k], change[k], 1e-16 + 2e-14 * jump * s->h);
    }
}

static double norm_of(const step *s, const double *error)
{
    double sum = 0.0;
    for (dem_index k = 0; k < 2 * s->n; k++)
        sum += pow(error[k] / position_error, 2.0) + pow(error[2 * s->n_all + k] / velocity_error, 2.0);
    return sum / (4.0 * (double)s->n);
}

/* What is outside has not changed by a bit and goes on as it did; the oracle's change ends on the last ring too.
 * Returns how many coordinates change there: where only an acceleration jumps it does not get that far. */
static int check_rings(const step *s, const int *ring, const double *was, const double *change, const bool *turned)
{
    const int last = s->kind.damping_time > 0.0 ? 6 : 3;
    int n_last = 0, n_outside = 0;
    for (dem_index k = 0; k < 2 * s->n; k++) {
        const dem_index i = k / 2, v = 2 * s->n_all + k;
        const bool changes = change[k] != 0.0 || change[v] != 0.0;
        n_last += ring[i] == last && changes;
        if (ring[i] >= 0 && ring[i] <= last) continue;
        assert_false(changes);
        assert_memory_equal(s->y1 + k, was + k, sizeof *was);
        assert_memory_equal(s->y1 + v, was + v, sizeof *was);
        assert_int_equal(changed_motion_has(&s->changed, i), turned[i]);
        n_outside++;
    }
    assert_true(n_outside > 0);
    return n_last;
}

/* Before an event of a candidate. */
static dem_status open_at(local_correction *p, const automaton *c, const dense_output *dense, dem_index candidate,
                          double t, double *state)
{
    dem_index seeds[16];
    const dem_index n = contact_set_seeds(&c->set, candidate, seeds, 16);
    assert_true(n <= 16);
    return local_correction_open(p, dense, (neighbourhood_seeds){seeds, n, false}, t, state);
}

/* A velocity jumps at node i at a share of the step, and contacts are what the caller made them meanwhile. */
static void begin(step *s, dem_index candidate, double share)
{
    assert_ok(open_at(&s->correction, &s->c, &s->dense, candidate, start + share * s->h, s->state));
}

static void finish(step *s, dem_index candidate, vec2 shift, vec2 jump)
{
    const size_t size = 4 * (size_t)s->n_all * sizeof(double);
    const dem_index i = look_node(&s->c, candidate);
    double *was = zeros(s), *change = zeros(s), *estimate = zeros(s), error;
    CLEANUP(free_memory) int *ring = malloc((size_t)s->n * sizeof *ring);
    CLEANUP(free_memory) bool *turned = malloc((size_t)s->n * sizeof *turned);
    assert_true(ring != NULL && turned != NULL);
    for (dem_index j = 0; j < s->n; j++) ring[j] = j == i || j == look_other(&s->c, candidate) ? 0 : -1;
    for (dem_index e = s->model->surface.row[i]; e < s->model->surface.row[i + 1] && s->kind.ridges; e++)
        for (int end = 0; end < 2; end++) ring[s->model->surface.ends[2 * s->model->surface.at[e] + end]] = 0;
    count_rings(s, ring, s->kind.damping_time > 0.0 ? 7 : 4);
    vec2_put(change, i, shift);
    vec2_put(change, s->n_all + i, jump);
    vec2_put(s->state, i, vec2_add(vec2_at(s->state, i), shift));
    vec2_put(s->state, s->n_all + i, vec2_add(vec2_at(s->state, s->n_all + i), jump));
    for (dem_index j = 0; j < s->n; j++) turned[j] = changed_motion_has(&s->changed, j);
    memcpy(was, s->y1, size);
    apply(s, gsl_odeiv2_step_rkf45, of_the_change, s->correction.t, s->dense.t1 - s->correction.t, change, estimate);
    assert_ok(local_correction_close(&s->correction, &s->dense, &s->changed, s->state, &error));
    changed_motion_end_rows(&s->changed);
    check_change(s, was, change, 1.0 + vec2_norm(jump));
    const int n_last = check_rings(s, ring, was, change, turned);
    assert_true(n_last > 0 || s->correction.h < 0.5 * s->h || vec2_norm(jump) == 0.0);
    assert_close(error, norm_of(s, estimate), 1e-7 * error + 1e-18);
    free(was);
    free(change);
    free(estimate);
}

/* The end's derivative is that of the end's state, where the change has got to. */
static void check_derivative(step *s)
{
    CLEANUP(free_memory) double *f = zeros(s);
    derive(s, &s->c, s->dense.t1, s->y1, f);
    const local_nodes *nodes = &s->correction.near.nodes;
    for (dem_index j = 0; j < nodes->end[nodes->n_rings - 2]; j++)
        for (dem_index k = 2 * nodes->list[j]; k < 2 * nodes->list[j] + 2; k++) {
            assert_close(s->f1[k], f[k], 1e-13 * (1.0 + fabs(f[k])));
            assert_close(s->f1[2 * s->n_all + k], f[2 * s->n_all + k], 1e-10 * s->model->omega_max);
        }
    for (dem_index k = 2 * (s->n_all + s->n); k < 4 * s->n_all - 1; k++)
        assert_close(s->f1[k], f[k], 1e-8 * (1.0 + fabs(f[k])));
}

static const vec2 nothing = {0.0, 0.0};

/* ---- the same as of the whole body ---- */

static const kind plain = {.nu = 1.0 / 3.0};

static dem_index lower_node(const step *s, double x)
{
    return look_candidate(&s->c, node_near(s, x, 0.0));
}

/* Anywhere on the lower edge, a corner too, early and late in the step. */
TEST(an_impact_changes_three_rings_as_a_step_of_the_whole_body_would)
{
    static const double places[3] = {0.0, -0.075, 0.04}, shares[4] = {0.0, 0.3, 0.7, 0.999};
    for (int p = 0; p < 3; p++)
        for (int q = 0; q < 4; q++) {
            CLEANUP(close_step) step s;
            open_step(&s, plain);
            go(&s);
            begin(&s, lower_node(&s, places[p]), shares[q]);
            finish(&s, lower_node(&s, places[p]), (vec2){0.0, 1e-8}, (vec2){0.5, 6.0});
            if (q == 1) check_derivative(&s);
        }
}

TEST(so_it_does_with_area_terms_and_mass_damping)
{
    CLEANUP(close_step) step s;
    open_step(&s, (kind){.nu = 0.2, .mass_damping = 200.0});
    go(&s);
    begin(&s, lower_node(&s, 0.02), 0.25);
    finish(&s, lower_node(&s, 0.02), nothing, (vec2){-1.0, 7.0});
}

TEST(damped_springs_carry_it_over_six_rings)
{
    CLEANUP(close_step) step s;
    open_step(&s, (kind){.nu = 1.0 / 3.0, .damping_time = 1e-4});
    go(&s);
    begin(&s, lower_node(&s, -0.075), 0.25);
    finish(&s, lower_node(&s, -0.075), (vec2){0.0, 1e-8}, (vec2){-1.0, 7.0});
    check_derivative(&s);
}

/* Nodes near the event set out with the accelerations of the state there, and come to the end of the step: in powers
 * of their share of the rest of it, positions and velocities are of degree 2. */
static void check_parabolas(step *s)
{
    CLEANUP(free_memory) double *y = zeros(s), *f = zeros(s);
    const dem_index n = 2 * s->n_all;
    dense_output_state(&s->dense, s->correction.t, y);
    derive(s, &s->c, s->correction.t, y, f);
    for (dem_index j = 0; j < s->correction.near.nodes.end[1]; j++) {
        const dem_index i = s->correction.near.nodes.list[j];
        const motion_polynomial *m = changed_motion_of(&s->changed, i);
        assert_true(m->parabolic);
        for (int d = 0; d < 2; d++) {
            const double *x1 = s->y1 + 2 * i + d;
            assert_close(m->v[1][d] / s->correction.h, f[n + 2 * i + d], 1e-10 * s->model->omega_max);
            assert_close(m->x[0][d] + m->x[1][d] + m->x[2][d], x1[0], 1e-16);
            assert_close(m->v[0][d] + m->v[1][d] + m->v[2][d], x1[n], 1e-13);
        }
    }
}

/* The way of Verlet's method, whose next event starts from parabolas as well. */
TEST(a_step_of_parabolas_goes_on_in_parabolas)
{
    CLEANUP(close_step) step s;
    open_step(&s, (kind){.nu = 1.0 / 3.0, .parabolic = true});
    go(&s);
    begin(&s, lower_node(&s, 0.0), 0.4);
    finish(&s, lower_node(&s, 0.0), nothing, (vec2){-1.0, 7.0});
    check_parabolas(&s);
    begin(&s, lower_node(&s, spacing), 0.7);
    finish(&s, lower_node(&s, spacing), (vec2){0.0, 1e-8}, (vec2){0.5, 6.0});
    check_parabolas(&s);
}

/* What a boundary prescribes keeps its slope: no force accelerates it. */
TEST(prescribed_nodes_keep_their_parabolas)
{
    CLEANUP(close_step) step s;
    double error;
    open_step(&s, (kind){.nu = 1.0 / 3.0, .drives = true, .parabolic = true});
    go(&s);
    const dem_index k = lower_node(&s, 0.0), i = look_node(&s.c, k), next = node_near(&s, 0.005, 0.0087);
    motion_polynomial expected;
    dense_output_motions(&s.dense, 1, &next, &expected);
    s.b.held[next] = DEM_COMPONENT_Y;
    begin(&s, k, 0.25);
    assert_true(local_nodes_have(&s.correction.near.nodes, next, 1));
    vec2_put(s.state, s.n_all + i, vec2_add(vec2_at(s.state, s.n_all + i), (vec2){0.0, 7.0}));
    assert_ok(local_correction_close(&s.correction, &s.dense, &s.changed, s.state, &error));
    changed_motion_end_rows(&s.changed);
    const motion_polynomial *m = changed_motion_of(&s.changed, next);
    motion_polynomial_restart(&expected, s.correction.t, s.dense.t1);
    for (int q = 0; q < MOTION_PARABOLA; q++) {
        assert_true(m->x[q][1] == expected.x[q][1] && m->v[q][1] == expected.v[q][1]);
        assert_true(q == 0 || m->v[q][0] != expected.v[q][0]); /* the other component is free */
    }
}

/* One component given, a force that grows: their work is in the quadratures. */
TEST(prescribed_nodes_stay_on_their_way)
{
    CLEANUP(close_step) step s;
    double was[2];
    open_step(&s, (kind){.nu = 1.0 / 3.0, .drives = true});
    go(&s);
    const dem_index driven = node_near(&s, 0.0, 0.017), work = s.n_all - 1;
    was[0] = s.y1[2 * driven + 1], was[1] = s.y1[2 * (s.n_all + work)];
    begin(&s, lower_node(&s, 0.0), 0.25);
    finish(&s, lower_node(&s, 0.0), nothing, (vec2){0.0, 7.0});
    assert_close(s.y1[2 * driven + 1], was[0], 0.0);
    assert_true(s.y1[2 * (s.n_all + work)] != was[1]);
}

/* A neighbour slides, another sticks; the node between them hits, closes and slides, or sticks, or opens. */
TEST(contacts_near_by_hold_and_rub)
{
    for (int after = -1; after <= 2; after++) { /* sign of the contact; 2: it is released */
        CLEANUP(close_step) step s;
        open_step(&s, plain);
        const dem_index k = lower_node(&s, 0.0);
        touch(&s, lower_node(&s, spacing), 0, 1, true);
        touch(&s, lower_node(&s, -2.0 * spacing), 0, 0, true);
        if (after == 2) touch(&s, k, 0, 1, true);
        go(&s);
        begin(&s, k, 0.35);
        if (after == 2)
            assert_ok(contact_set_open(&s.c.set, k, 0));
        else
            touch(&s, k, 0, after, false);
        finish(&s, k, nothing, after == 2 ? nothing : (vec2){after == 0 ? -1.0 : 0.5, 4.0});
        check_derivative(&s);
    }
}

TEST(so_they_do_where_springs_are_damped)
{
    CLEANUP(close_step) step s;
    open_step(&s, (kind){.nu = 0.3, .damping_time = 1e-4, .mass_damping = 50.0, .drives = true});
    const dem_index k = lower_node(&s, 0.03);
    touch(&s, lower_node(&s, 0.03 + spacing), 0, 1, true);
    go(&s);
    begin(&s, k, 0.35);
    touch(&s, k, 0, -1, false);
    finish(&s, k, nothing, (vec2){0.5, 4.0});
}

/* Edges on two ridges are two groups, of two nodes each; a node near them hits. */
TEST(edges_on_vertices_move_together)
{
    CLEANUP(close_step) step s;
    open_step(&s, (kind){.nu = 1.0 / 3.0, .ridges = true});
    const dem_index k = lower_node(&s, 0.0), n_nodes = s.model->surface.n_nodes;
    dem_index left = -1, right = -1;
    for (dem_index e = n_nodes; e < s.c.set.n; e++) {
        const double a = s.model->lattice.x[2 * look_node(&s.c, e)], b = s.model->lattice.x[2 * look_other(&s.c, e)];
        if (s.model->lattice.x[2 * look_node(&s.c, e) + 1] > 1e-9) continue;
        if (s.model->lattice.x[2 * look_other(&s.c, e) + 1] > 1e-9) continue;
        if ((a + 0.013) * (b + 0.013) < 0.0) left = e;
        if ((a - 0.014) * (b - 0.014) < 0.0) right = e;
    }
    assert_true(left >= 0 && right >= 0);
    touch(&s, left, 0, 1, true);
    touch(&s, right, 1, 0, true);
    go(&s);
    begin(&s, k, 0.35);
    finish(&s, k, nothing, (vec2){0.5, 4.0});
}

/* What the first has done is part of the way to which the second adds. */
TEST(a_second_event_adds_to_the_first)
{
    CLEANUP(close_step) step s;
    open_step(&s, plain);
    const dem_index k = lower_node(&s, 0.0), next = lower_node(&s, spacing);
    go(&s);
    begin(&s, k, 0.2);
    finish(&s, k, nothing, (vec2){0.5, 6.0});
    begin(&s, next, 0.6);
    finish(&s, next, nothing, (vec2){0.0, 5.0});
    begin(&s, k, 0.6); /* and at once another one */
    finish(&s, k, nothing, (vec2){0.0, 3.0});
}

/* ---- closed forms ---- */

/* A node by itself lands on the floor and slides: m g holds it, mu m g slows it; the quadratures have what that comes
 * to. */
TEST(the_ledger_of_a_node_that_lands_has_closed_forms)
{
    const double h = 0.1, at = 0.04, m = 2.0, g = 9.81, mu = 0.3, v = 1.5, tau = h - at;
    const double points[4] = {-1.0, 0.0, 1.0, 0.0}, x[2] = {0.0, 0.0};
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points, .friction = mu};
    const contact_rule rule = {
        .penetration_tolerance = 1e-8,
        .max_step = h,
        .layout = {.dim = 2, .n_nodes = 1, .n_obstacles = 1, .n_totals = STATE_OBSTACLE, .n_rows = 5}};
    double y0[20] = {0.0}, f0[20] = {0.0}, y1[20] = {0.0}, f1[20] = {0.0}, y[20] = {0.0}, middle[STATE_DIM_MOST], error;
    CLEANUP(automaton_destroy) automaton c;
    CLEANUP(local_correction_destroy) local_correction near;
    CLEANUP(local_springs_destroy) local_springs local;
    CLEANUP(changed_motion_destroy) changed_motion tr;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &m, 0, NULL, 0.0, 0.0, NULL);
    CLEANUP(free_model) dem_model *model = support_model(&lattice, &ground, 1);
    const forces acting = {.model = model, .gravity = {0.0, -g}};
    assert_ok(automaton_create(&c, &acting, &rule));
    local_springs_create(&local, &acting, &rule.layout);
    const local_forces forces_near = local_springs_forces(&local);
    const constraints closed = contact_constraints_of(&c);
    assert_ok(local_correction_create(&near, &rule.layout, &forces_near, &closed,
                                      &(local_correction_rule){5, 1.0, 1.0, rule.layout.n_nodes}));
    assert_ok(changed_motion_create(&tr, &rule.layout));
    y0[1] = 0.5 * g * at * at, y0[10] = v; /* falls on the floor at `at` */
    f0[11] = f1[11] = -g;
    y1[0] = v * h, y1[1] = y0[1] - 0.5 * g * h * h, y1[10] = v, y1[11] = -g * h;
    const dense_output p = {rule.layout, 0.0, h, h, y0, f0, y1, f1, false, &tr};
    changed_motion_start(&tr, h, y1, f1);
    assert_ok(open_at(&near, &c, &p, 0, at, y));
    assert_close(y[1], 0.0, 1e-16);
    assert_close(y[11], -g * at, 1e-15);
    y[11] = 0.0;
    assert_ok(contact_set_close(&c.set, 0, look_point(0, 1, 0.0)));
    assert_ok(local_correction_close(&near, &p, &tr, y, &error));
    changed_motion_end_rows(&tr);
    assert_close(error, 0.0, 1e-25);
    assert_close(y1[0], v * h - 0.5 * mu * g * tau * tau, 1e-15);
    assert_close(y1[1], 0.0, 1e-15);
    assert_close(y1[10], v - mu * g * tau, 1e-15);
    assert_close(y1[11], 0.0, 1e-15);
    assert_close(y1[12], -mu * m * g * tau, 1e-14); /* impulse of the obstacle, N s */
    assert_close(y1[13], m * g * tau, 1e-14);
    assert_close(y1[14], -mu * m * g * tau, 1e-14); /* that of friction */
    assert_close(y1[15], 0.0, 0.0);
    assert_close(y1[16], mu * m * g * (v * tau - 0.5 * mu * g * tau * tau), 1e-14); /* J */
    changed_motion_velocity(&tr, at + 0.5 * tau, 0, middle);
    assert_close(middle[0], v - 0.5 * mu * g * tau, 1e-14);
    changed_motion_undo(&tr);
    assert_close(y1[13], 0.0, 0.0);
}

/* ---- the body itself ---- */

/* Of a step of length h with a jump of 5 m/s in it: what is wrong at its end, and within, in positions. */
static void errors_of_jump(double h, double *at_end, double *inside)
{
    const double at = 0.3 * h, at_inside = 0.65 * h;
    const dem_material rubber =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
    const double points[4] = {-1.0, -0.5, 1.0, -0.5};
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points};
    contact_rule rule = {.penetration_tolerance = 1e-8, .max_step = h};
    CLEANUP(close_step) step s = {.h = h};
    double error;
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(0.1, 0.08, spacing, &rubber);
    assert_ok(dem_model_create(&s.model, &l, &ground, 1));
    s.n = s.n_all = l.n_nodes;
    rule.layout = (state_layout){.dim = 2, .n_nodes = s.n, .n_rows = s.n};
    s.acting = (forces){.model = s.model};
    local_springs_create(&s.springs, &s.acting, &rule.layout);
    s.near = local_springs_forces(&s.springs);
    assert_ok(automaton_create(&s.c, &s.acting, &rule));
    assert_ok(local_correction_create(&s.correction, &rule.layout, &s.near, NULL,
                                      &(local_correction_rule){5, 1.0, 1.0, s.n}));
    assert_ok(changed_motion_create(&s.changed, &rule.layout));
    s.y0 = zeros(&s), s.f0 = zeros(&s), s.y1 = zeros(&s), s.f1 = zeros(&s);
    s.state = zeros(&s), s.first = zeros(&s), s.last = zeros(&s);
    put_start(&s);
    memcpy(s.y1, s.y0, 4 * (size_t)s.n * sizeof(double));
    memcpy(s.first, s.y0, 4 * (size_t)s.n * sizeof(double));
    triplets_reach(&l, h, s.y1);
    (void)triplets_derivative(0.0, s.y0, s.f0, &l);
    (void)triplets_derivative(h, s.y1, s.f1, &l);
    s.dense = (dense_output){rule.layout, 0.0, h, h, s.y0, s.f0, s.y1, s.f1, false, &s.changed};
    changed_motion_start(&s.changed, h, s.y1, s.f1);
    const dem_index hit = node_near(&s, 0.0, 0.0);
    assert_ok(open_at(&s.correction, &s.c, &s.dense, look_candidate(&s.c, hit), at, s.state));
    s.state[2 * (s.n + hit) + 1] += 5.0;
    assert_ok(local_correction_close(&s.correction, &s.dense, &s.changed, s.state, &error));
    changed_motion_end_rows(&s.changed);
    triplets_reach(&l, at, s.first);
    s.first[2 * (s.n + hit) + 1] += 5.0;
    triplets_reach(&l, at_inside - at, s.first);
    dense_output_state(&s.dense, at_inside, s.last);
    *at_end = *inside = 0.0;
    for (dem_index k = 0; k < 2 * s.n; k++) *inside = fmax(*inside, fabs(s.last[k] - s.first[k]));
    triplets_reach(&l, h - at_inside, s.first);
    for (dem_index k = 0; k < 2 * s.n; k++) *at_end = fmax(*at_end, fabs(s.y1[k] - s.first[k]));
}

/* Local errors of a method of order 5, and of the quintic: h^6 at least. */
TEST(its_error_falls_with_the_sixth_power_of_the_step)
{
    const double omega = 239.0 / spacing;
    double end[3], inside[3];
    for (int k = 0; k < 3; k++) errors_of_jump(2.0 / omega / (1 << k), &end[k], &inside[k]);
    for (int k = 0; k < 2; k++) {
        print_message("# order %.2f at the end, %.2f within; error %.1e spacings\n", log2(end[k] / end[k + 1]),
                      log2(inside[k] / inside[k + 1]), end[k + 1] / spacing);
        assert_true(log2(end[k] / end[k + 1]) > 5.5);
        assert_true(log2(inside[k] / inside[k + 1]) > 5.5);
    }
}

/* ---- three dimensions ---- */

/* Corrects a chain whose node 6 gets another velocity. */
typedef struct chain_correction {
    chain chain;
    changed_motion changed;
    double middle[CHAIN_STATE]; /* state at three quarters of the step */
    int felt;                   /* ring up to which it is felt */
} chain_correction;

static void kick_chain(chain_correction *s, int dim, const int *axes, int order)
{
    static const double kick[3] = {1.0, -2.0, 3.0};
    static const dem_index seed = 6;
    chain *c = &s->chain;
    local_correction p;
    double error;
    chain_open(c, dim, axes, 7, order == 2);
    assert_ok(changed_motion_create(&s->changed, &c->layout));
    changed_motion_start(&s->changed, chain_step, c->y1, c->f1);
    c->step.changed = &s->changed;
    assert_ok(local_correction_create(&p, &c->layout, &c->forces, NULL,
                                      &(local_correction_rule){order, 1.0, 1.0, c->layout.n_nodes}));
    assert_ok(local_correction_open(&p, &c->step, (neighbourhood_seeds){&seed, 1, false}, 0.25 * chain_step, c->state));
    double *v = c->state + state_velocities(&c->layout) + state_row(&c->layout, seed);
    for (int d = 0; d < dim; d++) v[d] += kick[axes[d]];
    assert_ok(local_correction_close(&p, &c->step, &s->changed, c->state, &error));
    changed_motion_end_rows(&s->changed);
    assert_true(error > 0.0);
    dense_output_state(&c->step, 0.75 * chain_step, s->middle);
    local_correction_destroy(&p);
    changed_motion_destroy(&s->changed);
}

/* Node 7, of which one component is prescribed, is in the first ring. */
TEST(in_three_dimensions_each_component_is_that_of_two)
{
    static const int axes[3] = {0, 1, 2}, others[2] = {2, 0};
    static const int orders[2] = {2, 5};
    for (int k = 0; k < 2; k++) {
        chain_correction three, two, other;
        kick_chain(&three, 3, axes, orders[k]);
        kick_chain(&two, 2, axes, orders[k]);
        kick_chain(&other, 2, others, orders[k]);
        chain_check_components(&three.chain, three.chain.y1, &two.chain, two.chain.y1);
        chain_check_components(&three.chain, three.chain.y1, &other.chain, other.chain.y1);
        chain_check_components(&three.chain, three.middle, &two.chain, two.middle);
        chain_check_components(&three.chain, three.middle, &other.chain, other.middle);
        chain untouched;
        chain_open(&untouched, 3, axes, 7, orders[k] == 2);
        const state_layout *l = &untouched.layout;
        const double *held = state_v(l, three.chain.y1, 7), *free_one = state_v(l, untouched.y1, 7);
        assert_close(held[2], free_one[2], 0.0);
        assert_true(held[0] != free_one[0] && held[1] != free_one[1]);
        assert_memory_equal(state_x(l, three.chain.y1, 12), state_x(l, untouched.y1, 12), 3 * sizeof(double));
        /* what the springs take of the kick of 3 m/s until the end: h^2 omega^2 of it, 0.2 */
        assert_close(state_v(l, three.chain.y1, 6)[2] - state_v(l, untouched.y1, 6)[2], 3.0, 3.0 * 0.25);
    }
}

/* ---- forces alone ---- */

static int ring_of(const local_nodes *nodes, dem_index number)
{
    int ring = 0;
    while (nodes->end[ring] < number) ring++;
    return ring;
}

/* Breaks the spring before node 7 of a chain, with the rings that are enough if forces alone change, or with all. An
 * error of 1 is one of so many metres. */
static void break_chain(chain_correction *s, int order, bool by_forces, double error_of_one)
{
    static const int axes[2] = {0, 1};
    static const dem_index seeds[2] = {6, 7};
    chain *c = &s->chain;
    local_correction p;
    double error;
    chain_open(c, 2, axes, -1, order == 2);
    const local_correction_rule rule = {order, error_of_one, 1.0, c->layout.n_nodes};
    assert_ok(changed_motion_create(&s->changed, &c->layout));
    changed_motion_start(&s->changed, chain_step, c->y1, c->f1);
    c->step.changed = &s->changed;
    assert_ok(local_correction_create(&p, &c->layout, &c->forces, NULL, &rule));
    const neighbourhood_seeds both = {seeds, 2, by_forces};
    assert_ok(local_correction_open(&p, &c->step, both, 0.25 * chain_step, c->state));
    assert_int_equal(neighbourhood_is_short(&p.near), by_forces);
    c->broken = 7;
    assert_ok(local_correction_close(&p, &c->step, &s->changed, c->state, &error));
    changed_motion_end_rows(&s->changed);
    s->felt = ring_of(&p.near.nodes, p.near.n_felt);
    local_correction_destroy(&p);
    changed_motion_destroy(&s->changed);
}

/* The nodes of the ring that is left out end where they would without the event, and as fast. The others do to rounding
 * of 10 m/s: positions at the event have other last digits than those of which accelerations before it are taken. */
TEST(what_changes_forces_alone_needs_one_ring_less)
{
    for (int order = 2; order <= 5; order += 3) {
        chain_correction all, less, none;
        const int rings = order == 2 ? 0 : 2;
        break_chain(&all, order, false, 1.0);
        break_chain(&less, order, true, 1.0);
        chain_open(&none.chain, 2, (const int[2]){0, 1}, -1, order == 2);
        for (dem_index k = 0; k < state_size(&all.chain.layout); k++)
            assert_close(less.chain.y1[k], all.chain.y1[k], 1e-14);
        for (dem_index i = 0; i < CHAIN_NODES; i++) {
            const state_layout *l = &all.chain.layout;
            const bool near = i >= 6 - rings && i <= 7 + rings;
            assert_int_equal(state_x(l, less.chain.y1, i)[0] != state_x(l, none.chain.y1, i)[0], near);
        }
    }
}

/* Rings 0, 1, 2 end 0.07, 5e-4 and 1e-6 m from where they would; of the last ring, which only has other forces, nothing
 * is felt beyond. */
TEST(it_is_felt_a_ring_beyond_what_moves_by_more_than_a_hundredth_of_an_error)
{
    static const double errors[5] = {100.0, 1.0, 1e-3, 1e-5, 0.0};
    static const int rings[5] = {1, 1, 2, 3, 3};
    for (int k = 0; k < 5; k++) {
        chain_correction s;
        break_chain(&s, 5, true, errors[k]);
        assert_int_equal(s.felt, rings[k]);
    }
}
