/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_forces.c: groups of coupled contacts; their forces, impulses and shifts by hand and against a dense
 * solution. */
#include "unit/contact/bench.h"

#include <string.h>

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "contact/contact_forces.h"
#include "harness/cleanup_gsl.h"

static void check_vector(vec2 actual, double x, double y, double tolerance)
{
    assert_close(actual.x, x, tolerance);
    assert_close(actual.y, y, tolerance);
}

static void regroup(bench *b, contact_forces *r)
{
    assert_ok(contact_forces_create(r, &b->scene, b->candidates, b->n_candidates));
    assert_ok(contact_forces_regroup(r));
}

/* ---- groups ---- */

/* Nodes 0 .. n-1 on the x axis 1 m apart, an edge from each to the next: candidate n + i from node i. */
static void open_row(bench *b, dem_index n)
{
    bench_open(b, n);
    for (dem_index i = 0; i < n; i++) vec2_put(b->x, i, (vec2){(double)i, 0.0});
    for (dem_index i = 0; i + 1 < n; i++) bench_edge(b, i, i + 1);
}

static void check_group(const contact_forces *r, dem_index group, dem_index n, const dem_index *members)
{
    assert_true(group < r->n_groups);
    dem_index k = r->groups[group];
    for (dem_index p = 0; p < n; p++, k = r->next[k]) {
        assert_int_equal(k, members[p]);
        assert_int_equal(r->group[k], r->groups[group]);
    }
    assert_int_equal(k, -1);
}

static dem_index n_candidates(const contact_forces *r, dem_index group)
{
    dem_index n = 0;
    for (dem_index k = r->groups[group]; k >= 0; k = r->next[k]) n++;
    return n;
}

TEST(without_closed_contacts_there_are_no_groups)
{
    bench b;
    contact_forces r;
    open_row(&b, 4);
    regroup(&b, &r);
    assert_int_equal(r.n_groups, 0);
    contact_forces_destroy(&r);
    assert_null(r.band);
}

/* Nodes 0 and 1 touch, but the edge between them does not; node 3 is in a corner. */
TEST(nodes_that_no_closed_edge_joins_are_groups_of_their_own)
{
    static const dem_index members[3] = {0, 1, 3};
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    open_row(&b, 4);
    bench_touch(&b, 1, 0, 1.5, 1);
    bench_touch(&b, 0, 0, 1.5, 0);
    bench_corner(&b, 3, 1.0, 2.0);
    regroup(&b, &r);
    assert_int_equal(r.n_groups, 3);
    for (int g = 0; g < 3; g++) check_group(&r, g, 1, &members[g]);
}

/* Of the row 0 .. 6 edges 0-1, 1-2 and 4-5 touch, and nodes 2, 3 and 5. Members come in the order of the boundary, a
 * node before the edge that starts there; a node that no edge starts at comes last. */
TEST(edges_that_share_nodes_and_nodes_at_their_ends_are_one_group)
{
    static const dem_index first[3] = {7, 8, 2}, second[1] = {3}, third[2] = {11, 5};
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    open_row(&b, 7);
    bench_touch(&b, 7, 0, 0.5, 1);
    bench_touch(&b, 8, 0, 0.5, 1);
    bench_touch(&b, 11, 0, 0.5, 1);
    bench_touch(&b, 2, 0, 1.5, 1);
    bench_touch(&b, 3, 0, 1.5, 1);
    bench_touch(&b, 5, 0, 1.5, 1);
    regroup(&b, &r);
    assert_int_equal(r.n_groups, 3);
    check_group(&r, 1, 3, first);
    check_group(&r, 0, 1, second); /* that of a node is before those of edges */
    check_group(&r, 2, 2, third);
}

TEST(opening_a_contact_splits_its_group)
{
    static const dem_index whole[3] = {4, 5, 6}, left[1] = {4}, right[1] = {6};
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    open_row(&b, 4);
    for (dem_index k = 4; k < 7; k++) bench_touch(&b, k, 0, 0.5, 1);
    regroup(&b, &r);
    assert_int_equal(r.n_groups, 1);
    check_group(&r, 0, 3, whole);
    b.candidates[5].n_closed = 0;
    assert_ok(contact_forces_regroup(&r));
    assert_int_equal(r.n_groups, 2);
    check_group(&r, 0, 1, left);
    check_group(&r, 1, 1, right);
}

TEST(a_closed_ring_is_one_group)
{
    static const dem_index members[4] = {3, 4, 5, 0};
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    open_row(&b, 3);
    bench_edge(&b, 2, 0);
    for (dem_index k = 3; k < 6; k++) bench_touch(&b, k, 0, 0.5, 1);
    regroup(&b, &r);
    assert_int_equal(r.n_groups, 1);
    check_group(&r, 0, 3, members);
}

static void check_same_groups(const contact_forces *r, const contact_forces *expected)
{
    assert_int_equal(r->n_groups, expected->n_groups);
    assert_memory_equal(r->groups, expected->groups, (size_t)r->n_groups * sizeof *r->groups);
    assert_memory_equal(r->group, expected->group, (size_t)r->n_candidates * sizeof *r->group);
    for (dem_index k = 0; k < r->n_candidates; k++)
        if (r->group[k] >= 0) assert_int_equal(r->next[k], expected->next[k]);
    for (dem_index i = 0; i < r->scene->model->lattice.n_nodes; i++)
        assert_int_equal(r->at_node[i], expected->at_node[i]);
    assert_true(r->capacity >= expected->capacity / 2); /* of which half is spare */
}

/* Two rings of nodes and edges, of which up to four candidates at a time open or close: the second ring's numbers lie
 * between those of the first, so that groups interleave. */
TEST(groups_found_again_near_a_change_are_those_found_from_nothing)
{
    enum { n = 12 };
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    dem_index most = 0;
    bench_open(&b, n);
    for (dem_index i = 0; i < n; i++) bench_edge(&b, i, (i + 2) % n);
    regroup(&b, &r);
    for (int turn = 0; turn < 20000; turn++) {
        dem_index changed[4];
        const dem_index n_changed = 1 + (dem_index)gsl_rng_uniform_int(rng, 4);
        for (dem_index c = 0; c < n_changed; c++) {
            changed[c] = (dem_index)gsl_rng_uniform_int(rng, (unsigned long)b.n_candidates);
            b.candidates[changed[c]].n_closed = gsl_rng_uniform(rng) < 0.5 ? 0 : 1 + (int)gsl_rng_uniform_int(rng, 2);
        }
        CLEANUP(contact_forces_destroy) contact_forces from_nothing;
        assert_ok(contact_forces_regroup_some(&r, changed, n_changed));
        regroup(&b, &from_nothing);
        if (r.n_groups > 0) check_same_groups(&r, &from_nothing);
        most = r.n_groups > most ? r.n_groups : most;
    }
    assert_true(most >= 6); /* of 12 nodes at most 12 */
}

/* ---- by hand ---- */

/* 2 kg on an incline of 30 degrees in a field of 10 m/s^2: N = 20 cos 30, T = mu N up or down, or what gravity asks. */
TEST(a_node_on_an_incline_slides_or_sticks)
{
    const double normal = 20.0 * cos(M_PI / 6.0), along = 20.0 * sin(M_PI / 6.0);
    for (int sign = -1; sign <= 1; sign++) {
        bench b;
        CLEANUP(contact_forces_destroy) contact_forces r;
        double a[2] = {0.0, -10.0};
        bench_open(&b, 1);
        bench_mass(&b, 0, 2.0);
        bench_touch(&b, 0, 1, M_PI / 3.0, sign); /* falls to the right; the tangent points down the slope */
        regroup(&b, &r);
        contact_forces_hold(&r, (scene_state){0.0, b.x, b.v}, a);
        const double friction = sign == 0 ? -along : -sign * 0.3 * normal;
        const double left = sign == 0 ? 0.0 : (along + friction) / 2.0;
        /* rounding of forces of order 10 */
        assert_close(r.force[0][0].normal, normal, 1e-14);
        assert_close(r.force[0][0].tangent, friction, 1e-14);
        check_vector(vec2_at(a, 0), left * cos(M_PI / 6.0), -left * sin(M_PI / 6.0), 1e-14);
    }
}

/* 3 kg in a groove of 45 degrees, pulled down and to the right. */
TEST(a_corner_holds_its_node_with_two_normal_forces)
{
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    double a[2] = {2.0, -10.0};
    bench_open(&b, 1);
    bench_mass(&b, 0, 3.0);
    bench_corner(&b, 0, 0.25 * M_PI, 0.75 * M_PI);
    regroup(&b, &r);
    contact_forces_hold(&r, (scene_state){0.0, b.x, b.v}, a);
    /* rounding of forces of order 30 */
    assert_close(r.force[0][0].normal, 3.0 * 8.0 / sqrt(2.0), 1e-14);
    assert_close(r.force[0][1].normal, 3.0 * 12.0 / sqrt(2.0), 1e-14);
    assert_close(r.force[0][0].tangent, 0.0, 0.0);
    assert_close(r.force[0][1].tangent, 0.0, 0.0);
    check_vector(vec2_at(a, 0), 0.0, 0.0, 0.0);
}

/* An edge of 1 and 4 kg lies level with a vertex under its quarter: W = (3/4)^2/1 + (1/4)^2/4 = 37/64, N = g/W; with
 * mu = 0.3 it slides to the right. */
TEST(an_edge_balances_on_a_vertex)
{
    const double force = 9.25 * 64.0 / 37.0;
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    double a[4] = {0.0, -9.25, 0.0, -9.25};
    open_row(&b, 2);
    bench_mass(&b, 1, 4.0);
    bench_touch(&b, 2, 1, 0.25, 1);
    regroup(&b, &r);
    contact_forces_hold(&r, (scene_state){0.0, b.x, b.v}, a);
    /* rounding of forces of order 10 */
    assert_close(r.force[2][0].normal, force, 1e-14);
    assert_close(r.force[2][0].tangent, -0.3 * force, 1e-14);
    check_vector(vec2_at(a, 0), -0.3 * 0.75 * force, -9.25 + 0.75 * force, 1e-14);
    check_vector(vec2_at(a, 1), -0.3 * 0.0625 * force, -9.25 + 0.0625 * force, 1e-14);
}

/* Steps of 0.1 s: what has drifted is drawn back with beta = 1/s, -(2 v + beta off) along both. The edge lies on the x
 * axis and sticks 0.02 m behind its vertex and 0.01 m above it; P moves (-0.05, 0.3) m/s. */
TEST(a_sticking_edge_that_has_drifted_is_accelerated_back)
{
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    double a[4] = {3.0, -10.0, 5.0, 2.0};
    open_row(&b, 2);
    b.scene.rule.max_step = 0.1;
    for (dem_index i = 0; i < 2; i++) vec2_put(b.v, i, (vec2){-0.05, 0.3});
    contact_point *point = bench_touch(&b, 2, 0, 0.5, 0);
    b.vertices[point->feature].at = (vec2){0.52, -0.01};
    regroup(&b, &r);
    contact_forces_hold(&r, (scene_state){0.0, b.x, b.v}, a);
    /* rounding of accelerations of order 10; 2 kg move with P, at (4, -4) m/s^2 without the force */
    check_vector(vec2_scale(0.5, vec2_add(vec2_at(a, 0), vec2_at(a, 1))), 0.12, -0.61, 1e-14);
    assert_close(r.force[2][0].normal, 2.0 * (-0.61 + 4.0), 1e-14);
    assert_close(r.force[2][0].tangent, 2.0 * (0.12 - 4.0), 1e-14);
}

/* Both ends of a level edge lie on level segments and a vertex is under it: three contacts for two motions. The one
 * that comes last is redundant: 0. The vertex carries node 1, node 0 what is left. */
TEST(a_contact_that_the_others_hold_already_gets_no_force)
{
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    double a[4] = {0.0, -10.0, 0.0, -10.0};
    open_row(&b, 2);
    bench_mass(&b, 1, 3.0);
    bench_touch(&b, 0, 0, 0.5 * M_PI, 1);
    bench_touch(&b, 1, 0, 0.5 * M_PI, 1);
    bench_touch(&b, 2, 0, 0.75, 1);
    regroup(&b, &r);
    contact_forces_hold(&r, (scene_state){0.0, b.x, b.v}, a);
    /* rounding of forces of order 40 over the place of the vertex */
    assert_close(r.force[1][0].normal, 0.0, 0.0);
    assert_close(r.force[2][0].normal, 30.0 / 0.75, 1e-13);
    assert_close(r.force[0][0].normal, 10.0 - 0.25 * 40.0, 1e-13);
    for (int i = 0; i < 4; i++) assert_close(a[i], 0.0, 1e-13);
}

/* ---- the same constraints, written out ---- */

/* A closed contact as the documentation of contact_frame has it. */
typedef struct link {
    dem_index candidate, node[2];
    double weight[2], keep, friction;
    vec2 normal, tangent;
    int n, q, slide;
    bool held;
} link;

static link link_of(const bench *b, dem_index k, int q)
{
    const contact_candidate *candidate = &b->candidates[k];
    const contact_point *point = &candidate->closed[q];
    const segment *s = &b->segments[point->feature];
    const dem_obstacle *o = &b->list[s->obstacle];
    link l = {.candidate = k, .q = q, .node = {candidate->node, -1}, .weight = {1.0, 0.0}, .n = 1};
    l.slide = point->slide;
    l.held = point->held;
    l.friction = o->friction_law == DEM_FRICTION_COULOMB ? o->friction : 0.0;
    l.normal = s->normal;
    if (candidate_is_edge(candidate)) {
        const vec2 start = vec2_at(b->x, candidate->node), along = vec2_sub(vec2_at(b->x, candidate->other), start);
        const vec2 to = vec2_sub(b->vertices[point->feature].at, start);
        const double square = vec2_dot(along, along), length = sqrt(square);
        const double place = point->slide == 0 ? point->place : vec2_dot(to, along) / square;
        l.n = 2;
        l.node[1] = candidate->other;
        l.weight[0] = 1.0 - place;
        l.weight[1] = place;
        l.normal = (vec2){-along.y / length, along.x / length};
        const vec2 va = vec2_at(b->v, candidate->node), vb = vec2_at(b->v, candidate->other);
        const vec2 at = vec2_along(va, place, vec2_sub(vb, va)); /* velocity of the point */
        const double omega = vec2_cross(along, vec2_sub(vb, va)) / square;
        if (point->slide != 0) l.keep = 2.0 * omega * vec2_dot(at, along) / length;
    }
    l.tangent = (vec2){l.normal.y, -l.normal.x};
    return l;
}

static int list_links(const bench *b, link *list)
{
    int n = 0;
    for (dem_index k = 0; k < b->n_candidates; k++)
        for (int q = 0; q < b->candidates[k].n_closed; q++) list[n++] = link_of(b, k, q);
    return n;
}

/* Part of u at the point of a contact along a direction. */
static double part_of(const link *l, const double *u, vec2 direction)
{
    double sum = 0.0;
    for (int p = 0; p < l->n; p++) sum += l->weight[p] * vec2_dot(vec2_at(u, l->node[p]), direction);
    return sum;
}

enum { MOST_UNKNOWNS = 2 * BENCH_NODES + 2 * BENCH_FEATURES };

/* Unknowns: accelerations of the nodes, then (N, T) of each contact. Equations: a - sum w (N n + T t)/m = a_free; of
 * each contact n.a_P = keep; then t.a_P = 0 if it sticks, T + sign mu N = 0 if it slides, T = 0 if a corner holds. */
static size_t write_out(const bench *b, const link *list, int n_links, const double *free_a, gsl_matrix *m, double *rhs)
{
    const size_t n_a = 2 * (size_t)b->model.lattice.n_nodes, n = n_a + 2 * (size_t)n_links;
    gsl_matrix_set_zero(m);
    for (size_t i = 0; i < n_a; i++) {
        gsl_matrix_set(m, i, i, 1.0);
        rhs[i] = free_a[i];
    }
    for (size_t c = 0; c < (size_t)n_links; c++) {
        const link *l = &list[c];
        const size_t force = n_a + 2 * c;
        const bool sticks = l->slide == 0 && !l->held;
        for (int p = 0; p < l->n; p++)
            for (size_t e = 0; e < 2; e++) {
                const size_t i = 2 * (size_t)l->node[p] + e;
                const double w = l->weight[p], normal = e == 0 ? l->normal.x : l->normal.y;
                const double tangent = e == 0 ? l->tangent.x : l->tangent.y;
                gsl_matrix_set(m, i, force, -w * normal * b->inverse_mass[l->node[p]]);
                gsl_matrix_set(m, i, force + 1, -w * tangent * b->inverse_mass[l->node[p]]);
                gsl_matrix_set(m, force, i, w * normal);
                if (sticks) gsl_matrix_set(m, force + 1, i, w * tangent);
            }
        rhs[force] = l->keep;
        rhs[force + 1] = 0.0;
        if (sticks) continue;
        gsl_matrix_set(m, force + 1, force + 1, 1.0);
        gsl_matrix_set(m, force + 1, force, l->held ? 0.0 : l->slide * l->friction);
    }
    return n;
}

/* Solves by singular values; returns their largest ratio. */
static double solve_dense(const gsl_matrix *m, size_t n, const double *rhs, double *solution)
{
    CLEANUP(free_matrix) gsl_matrix *u = gsl_matrix_alloc(n, n), *v = gsl_matrix_alloc(n, n);
    CLEANUP(free_vector) gsl_vector *s = gsl_vector_alloc(n), *work = gsl_vector_alloc(n);
    const gsl_matrix_const_view part = gsl_matrix_const_submatrix(m, 0, 0, n, n);
    const gsl_vector_const_view b = gsl_vector_const_view_array(rhs, n);
    gsl_vector_view x = gsl_vector_view_array(solution, n);
    gsl_matrix_memcpy(u, &part.matrix);
    assert_int_equal(gsl_linalg_SV_decomp(u, v, s, work), 0);
    assert_int_equal(gsl_linalg_SV_solve(u, v, s, &b.vector, &x.vector), 0);
    const double smallest = gsl_vector_get(s, n - 1), ratio = gsl_vector_get(s, 0) / fmax(smallest, 1e-300);
    return ratio;
}

/* ---- random configurations ---- */

typedef struct mix {
    gsl_rng *rng;
    bench b;
    double a[2 * BENCH_NODES];
    link list[BENCH_FEATURES];
    int n_links;
} mix;

static double any(mix *w)
{
    return 2.0 * gsl_rng_uniform(w->rng) - 1.0;
}

static bool chance(mix *w, double p)
{
    return gsl_rng_uniform(w->rng) < p;
}

static void close_node(mix *w, dem_index k)
{
    const double angle = M_PI * any(w);
    if (w->b.inverse_mass[k] == 0.0 || !chance(w, 0.3)) return; /* what is fixed is no candidate */
    if (chance(w, 0.3))
        bench_corner(&w->b, k, angle, angle + (chance(w, 0.5) ? 1.0 : -1.0) * (0.5 + 2.0 * gsl_rng_uniform(w->rng)));
    else
        bench_touch(&w->b, k, (dem_index)gsl_rng_uniform_int(w->rng, 3), angle,
                    (int)gsl_rng_uniform_int(w->rng, 3) - 1);
}

/* On one vertex or two, some of them held without friction. */
static void close_edge(mix *w, dem_index k)
{
    if (!chance(w, 0.5)) return;
    const int n = chance(w, 0.2) ? 2 : 1;
    for (int q = 0; q < n; q++) {
        const double place = n == 1 ? gsl_rng_uniform(w->rng) : 0.1 + 0.5 * q + 0.3 * gsl_rng_uniform(w->rng);
        const bool held = chance(w, 0.2);
        const int sign = held ? 1 : (int)gsl_rng_uniform_int(w->rng, 3) - 1;
        bench_touch(&w->b, k, (dem_index)gsl_rng_uniform_int(w->rng, 3), place, sign)->held = held;
    }
}

/* A ring of 4 to 11 nodes, or a row of them, a few fixed, with contacts of all kinds. */
static void mix_next(mix *w)
{
    const dem_index n = 4 + (dem_index)gsl_rng_uniform_int(w->rng, 8);
    bench *b = &w->b;
    bench_open(b, n);
    for (dem_index i = 0; i < n; i++) {
        const double angle = 2.0 * M_PI * (double)i / (double)n;
        bench_mass(b, i, 0.5 + 2.0 * gsl_rng_uniform(w->rng));
        vec2_put(b->x, i, (vec2){cos(angle) + 0.1 * any(w), sin(angle) + 0.1 * any(w)});
        vec2_put(b->v, i, (vec2){any(w), any(w)});
        vec2_put(w->a, i, (vec2){10.0 * any(w), 10.0 * any(w)});
        if (!chance(w, 0.1)) continue;
        b->inverse_mass[i] = 0.0;
        vec2_put(b->v, i, (vec2){0.0, 0.0});
        vec2_put(w->a, i, (vec2){0.0, 0.0});
    }
    const bool ring = chance(w, 0.5);
    for (dem_index i = 0; i < n - !ring; i++)
        if (b->inverse_mass[i] != 0.0 || b->inverse_mass[(i + 1) % n] != 0.0) bench_edge(b, i, (i + 1) % n);
    for (dem_index k = 0; k < b->n_candidates; k++) k < n ? close_node(w, k) : close_edge(w, k);
    w->n_links = list_links(b, w->list);
}

/* Forces and accelerations of the dense system, if that is well posed. Ratios of singular values up to this: */
static const double worst_ratio = 1e3;
/* Rounding of accelerations of order 10 times that ratio, and as much for the growth of what is not pivoted. */
static const double dense_tolerance = 1e-8;

static bool mix_solve(mix *w, double *solution)
{
    CLEANUP(free_matrix) gsl_matrix *m = gsl_matrix_alloc(MOST_UNKNOWNS, MOST_UNKNOWNS);
    double rhs[MOST_UNKNOWNS];
    const size_t n = write_out(&w->b, w->list, w->n_links, w->a, m, rhs);
    const double ratio = solve_dense(m, n, rhs, solution);
    return ratio < worst_ratio;
}

static void check_forces(const mix *w, const contact_forces *r, const double *expected)
{
    for (int c = 0; c < w->n_links; c++) {
        const contact_force f = r->force[w->list[c].candidate][w->list[c].q];
        assert_close(f.normal, expected[2 * c], dense_tolerance);
        assert_close(f.tangent, expected[2 * c + 1], dense_tolerance);
    }
}

/* How many of each kind of contact there were, alone or not: slip forwards, backwards, stick, held; on nodes, edges. */
static void tally(const mix *w, int kinds[2][4])
{
    for (int c = 0; c < w->n_links; c++) {
        const link *l = &w->list[c];
        kinds[l->n - 1][l->held ? 3 : 1 + l->slide]++;
    }
}

TEST(forces_and_accelerations_agree_with_a_dense_solution)
{
    mix w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_solved = 0, n_coupled = 0, kinds[2][4] = {{0}};
    for (int k = 0; k < 4000; k++) {
        double solution[MOST_UNKNOWNS];
        CLEANUP(contact_forces_destroy) contact_forces r = {0};
        mix_next(&w);
        if (!mix_solve(&w, solution)) continue;
        const dem_index n_a = 2 * w.b.model.lattice.n_nodes;
        regroup(&w.b, &r);
        contact_forces_hold(&r, (scene_state){0.0, w.b.x, w.b.v}, w.a);
        for (dem_index i = 0; i < n_a; i++) assert_close(w.a[i], solution[i], dense_tolerance);
        check_forces(&w, &r, solution + n_a);
        tally(&w, kinds);
        n_solved++;
        for (dem_index g = 0; g < r.n_groups; g++) n_coupled += n_candidates(&r, g) > 2;
    }
    assert_true(n_solved > 1000 && n_coupled > 500);
    for (int q = 0; q < 4; q++) assert_true(kinds[0][q] > 200 && kinds[1][q] > 200);
    gsl_rng_free(w.rng);
}

/* The same forces from accelerations that are known, of all nodes or of the first ones, whatever the model says of
 * them. */
static void check_known(mix *w, contact_forces *r, const double *expected)
{
    const dem_index n_nodes = w->b.model.lattice.n_nodes;
    const double gravity = w->b.acting.gravity[0];
    int32_t *number = malloc((size_t)n_nodes * sizeof *number);
    assert_non_null(number);
    for (int part = 1; part <= 2; part++) {
        const constraint_free known = {number, n_nodes / part, w->a};
        for (dem_index i = 0; i < n_nodes; i++) number[i] = part == 1 || i % 3 > 0 ? (int32_t)i : -1;
        if (part == 1) w->b.acting.gravity[0] = 100.0;
        for (dem_index g = 0; g < r->n_groups; g++)
            contact_forces_solve_free(r, r->groups[g], (scene_state){0.0, w->b.x, w->b.v}, &known);
        w->b.acting.gravity[0] = gravity;
        check_forces(w, r, expected);
    }
    free(number);
}

/* The free accelerations of gravity and drag, taken by contact_forces_solve from the model itself. */
TEST(solving_a_group_starts_from_the_accelerations_of_the_model)
{
    mix w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_solved = 0;
    for (int k = 0; k < 500; k++) {
        double solution[MOST_UNKNOWNS];
        CLEANUP(contact_forces_destroy) contact_forces r = {0};
        mix_next(&w);
        w.b.acting = (forces){.model = &w.b.model, .gravity = {3.0, -7.0}, .mass_damping = 0.5};
        for (dem_index i = 0; i < w.b.model.lattice.n_nodes; i++) {
            const bool moves = w.b.inverse_mass[i] != 0.0;
            const vec2 vi = vec2_at(w.b.v, i);
            vec2_put(w.a, i, moves ? (vec2){3.0 - 0.5 * vi.x, -7.0 - 0.5 * vi.y} : (vec2){0.0, 0.0});
        }
        if (!mix_solve(&w, solution)) continue;
        regroup(&w.b, &r);
        for (dem_index g = 0; g < r.n_groups; g++)
            contact_forces_solve(&r, r.groups[g], (scene_state){0.0, w.b.x, w.b.v});
        check_forces(&w, &r, solution + 2 * w.b.model.lattice.n_nodes);
        check_known(&w, &r, solution + 2 * w.b.model.lattice.n_nodes);
        n_solved++;
    }
    assert_true(n_solved > 100);
    gsl_rng_free(w.rng);
}

TEST(what_is_held_has_the_acceleration_asked_for)
{
    mix w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_checked = 0;
    for (int k = 0; k < 2000; k++) {
        double solution[MOST_UNKNOWNS];
        CLEANUP(contact_forces_destroy) contact_forces r = {0};
        mix_next(&w);
        if (!mix_solve(&w, solution)) continue;
        regroup(&w.b, &r);
        contact_forces_hold(&r, (scene_state){0.0, w.b.x, w.b.v}, w.a);
        for (int c = 0; c < w.n_links; c++) {
            const link *l = &w.list[c];
            assert_close(part_of(l, w.a, l->normal), l->keep, dense_tolerance);
            if (l->slide == 0) assert_close(part_of(l, w.a, l->tangent), 0.0, dense_tolerance);
            n_checked++;
        }
    }
    assert_true(n_checked > 1000);
    gsl_rng_free(w.rng);
}

/* Candidates in another order -- nodes among nodes, edges among edges -- with the same contacts. */
static void shuffle(gsl_rng *rng, const bench *from, bench *to, dem_index *place)
{
    const dem_index n = from->model.surface.n_nodes;
    memcpy(to->mass, from->mass, sizeof to->mass);
    memcpy(to->inverse_mass, from->inverse_mass, sizeof to->inverse_mass);
    memcpy(to->x, from->x, sizeof to->x);
    memcpy(to->v, from->v, sizeof to->v);
    memcpy(to->segments, from->segments, sizeof to->segments);
    memcpy(to->vertices, from->vertices, sizeof to->vertices);
    for (dem_index k = 0; k < from->n_candidates; k++) place[k] = k;
    gsl_ran_shuffle(rng, place, (size_t)n, sizeof *place);
    gsl_ran_shuffle(rng, place + n, (size_t)(from->n_candidates - n), sizeof *place);
    for (dem_index k = 0; k < from->n_candidates; k++) to->candidates[place[k]] = from->candidates[k];
    to->n_candidates = from->n_candidates;
}

TEST(the_order_in_which_candidates_are_listed_does_not_matter)
{
    mix w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    for (int k = 0; k < 1000; k++) {
        double solution[MOST_UNKNOWNS], a[2 * BENCH_NODES];
        dem_index place[BENCH_CANDIDATES];
        bench other;
        contact_forces r, q;
        mix_next(&w);
        if (!mix_solve(&w, solution)) continue;
        bench_open(&other, w.b.model.lattice.n_nodes);
        shuffle(w.rng, &w.b, &other, place);
        memcpy(a, w.a, sizeof a);
        regroup(&w.b, &r);
        regroup(&other, &q);
        assert_int_equal(q.n_groups, r.n_groups);
        contact_forces_hold(&r, (scene_state){0.0, w.b.x, w.b.v}, w.a);
        contact_forces_hold(&q, (scene_state){0.0, w.b.x, w.b.v}, a);
        for (dem_index i = 0; i < 2 * w.b.model.lattice.n_nodes; i++) assert_close(a[i], w.a[i], dense_tolerance);
        for (int c = 0; c < w.n_links; c++) {
            const contact_force f = r.force[w.list[c].candidate][w.list[c].q],
                                g = q.force[place[w.list[c].candidate]][w.list[c].q];
            assert_close(g.normal, f.normal, dense_tolerance);
            assert_close(g.tangent, f.tangent, dense_tolerance);
        }
        contact_forces_destroy(&r);
        contact_forces_destroy(&q);
    }
    gsl_rng_free(w.rng);
}

/* ---- impulses ---- */

static void stop_all(mix *w, contact_forces *r, double *v)
{
    memcpy(v, w->b.v, sizeof w->b.v);
    for (dem_index g = 0; g < r->n_groups; g++) contact_forces_stop(r, r->groups[g], (scene_state){0.0, w->b.x, v}, v);
}

/* At least 1 N s. */
static double largest_impulse(const mix *w, const contact_forces *r)
{
    double largest = 1.0;
    for (int c = 0; c < w->n_links; c++) {
        const contact_force f = r->force[w->list[c].candidate][w->list[c].q];
        largest = fmax(largest, hypot(f.normal, f.tangent));
    }
    return largest;
}

static double kinetic_energy(const bench *b, const double *v)
{
    double sum = 0.0;
    for (dem_index i = 0; i < b->model.lattice.n_nodes; i++)
        sum += 0.5 * b->mass[i] * vec2_dot(vec2_at(v, i), vec2_at(v, i));
    return sum;
}

/* The fastest that the point of a contact goes with a kinetic energy. */
static double fastest(const mix *w, const link *l, double energy)
{
    double mobility = 0.0;
    for (int p = 0; p < l->n; p++) mobility += l->weight[p] * l->weight[p] * w->b.inverse_mass[l->node[p]];
    return sqrt(2.0 * energy * mobility);
}

/* The speed that a stop has left at a contact. */
static double speed_left(const link *l, const double *v)
{
    const double along = part_of(l, v, l->normal), across = l->slide == 0 ? part_of(l, v, l->tangent) : 0.0;
    return fmax(fabs(along), fabs(across));
}

/* Also where contacts are redundant: rest is always allowed. To rounding of impulses, which nearly redundant contacts
 * make large: found is 2.5e-13 of the largest one in 1e6 scenes. A contact is taken as redundant where the others leave
 * it less than 1e-10 of its mobility: then the root of that may be left of the speed that all energy would give it.
 * Found are 4 such scenes in 1e5. */
TEST(after_a_stop_nothing_moves_along_closed_normals_and_where_it_sticks)
{
    mix w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_checked = 0, n_left = 0;
    for (int k = 0; k < 4000; k++) {
        double v[2 * BENCH_NODES];
        bool is_left = false;
        CLEANUP(contact_forces_destroy) contact_forces r;
        mix_next(&w);
        regroup(&w.b, &r);
        stop_all(&w, &r, v);
        const double rounding = 1e-12 * largest_impulse(&w, &r), energy = kinetic_energy(&w.b, w.b.v);
        for (int c = 0; c < w.n_links; c++, n_checked++) {
            const double speed = speed_left(&w.list[c], v);
            is_left = is_left || speed > rounding;
            assert_true(speed <= rounding + 1e-5 * fastest(&w, &w.list[c], energy));
        }
        n_left += is_left;
    }
    assert_true(n_checked > 10000 && n_left <= 4);
    gsl_rng_free(w.rng);
}

/* A stop is the smallest change, in the measure of kinetic energy, that does what is asked: what is left and what is
 * taken are orthogonal, T before = T after + T of the change. Friction takes no part. */
TEST(a_stop_takes_the_energy_of_the_change_and_gives_none)
{
    mix w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    for (int k = 0; k < 4000; k++) {
        double v[2 * BENCH_NODES], dv[2 * BENCH_NODES];
        CLEANUP(contact_forces_destroy) contact_forces r;
        mix_next(&w);
        regroup(&w.b, &r);
        stop_all(&w, &r, v);
        for (dem_index i = 0; i < 2 * w.b.model.lattice.n_nodes; i++) dv[i] = v[i] - w.b.v[i];
        const double before = kinetic_energy(&w.b, w.b.v), after = kinetic_energy(&w.b, v);
        const double largest = largest_impulse(&w, &r);
        /* rounding of impulses, which nearly redundant contacts make large, times what that leaves of velocities */
        assert_close(after + kinetic_energy(&w.b, dv), before, 1e-13 * largest * largest);
        assert_true(after <= before * (1.0 + 1e-14)); /* rounding of sums */
    }
    gsl_rng_free(w.rng);
}

/* What the contacts give to every node is its change of momentum; nodes of no group are left alone. A corner's impulse
 * is in the parts along the first segment. */
TEST(impulses_account_for_the_momentum_of_every_node)
{
    mix w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    for (int k = 0; k < 4000; k++) {
        double v[2 * BENCH_NODES], given[2 * BENCH_NODES] = {0.0};
        CLEANUP(contact_forces_destroy) contact_forces r;
        mix_next(&w);
        regroup(&w.b, &r);
        contact_forces_hold(&r, (scene_state){0.0, w.b.x, w.b.v}, w.a); /* forces are not taken for impulses */
        stop_all(&w, &r, v);
        for (int c = 0; c < w.n_links; c++) {
            const link *l = &w.list[c];
            const contact_force f = r.force[l->candidate][l->q];
            const vec2 impulse = vec2_along(vec2_scale(f.normal, l->normal), f.tangent, l->tangent);
            if (l->slide != 0 && !l->held) assert_close(f.tangent, 0.0, 1e-15); /* rounding of impulses of order 1 */
            for (int p = 0; p < l->n; p++)
                vec2_put(given, l->node[p], vec2_along(vec2_at(given, l->node[p]), l->weight[p], impulse));
        }
        for (dem_index i = 0; i < w.b.model.lattice.n_nodes; i++) {
            const double m = w.b.inverse_mass[i] == 0.0 ? 0.0 : w.b.mass[i];
            const vec2 change = vec2_scale(m, vec2_sub(vec2_at(v, i), vec2_at(w.b.v, i)));
            if (m == 0.0) assert_close(v[2 * i], 0.0, 0.0);
            if (m == 0.0) continue; /* a fixed node takes what it is given */
            /* rounding of some impulses, which nearly redundant contacts make large */
            check_vector(vec2_at(given, i), change.x, change.y, 1e-14 * largest_impulse(&w, &r));
        }
    }
    gsl_rng_free(w.rng);
}

/* The groups leave each other's nodes, and the nodes of open candidates, bit for bit. */
TEST(stopping_one_group_leaves_the_others_alone)
{
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    double v[8];
    open_row(&b, 4);
    for (dem_index i = 0; i < 4; i++) vec2_put(b.v, i, (vec2){0.3, -1.0});
    memcpy(v, b.v, sizeof v);
    bench_touch(&b, 4, 0, 0.5, 0);
    bench_touch(&b, 3, 0, 0.5 * M_PI, 1);
    regroup(&b, &r);
    assert_int_equal(r.n_groups, 2);
    contact_forces_stop(&r, r.groups[1], (scene_state){0.0, b.x, v}, v);
    /* an edge that turns about its middle has nothing left */
    for (int i = 0; i < 4; i++) assert_close(v[i], 0.0, 1e-15); /* rounding of velocities of order 1 */
    assert_memory_equal(v + 4, b.v + 4, 4 * sizeof *v);
    contact_forces_stop(&r, r.groups[0], (scene_state){0.0, b.x, v}, v);
    check_vector(vec2_at(v, 2), 0.3, -1.0, 0.0);
    check_vector(vec2_at(v, 3), 0.3, 0.0, 1e-16); /* the cosine of pi/2 */
}

/* ---- shifts ---- */

/* An edge of 1 and 3 kg 0.1 m above a vertex under its middle falls so that P comes down by 0.1 m: W = 1/4 + 1/12, and
 * the ends by 0.1 w/(m W) = 0.15 and 0.05 m. A fixed end stays, the other does it all. */
TEST(a_shift_closes_the_gap_with_the_light_node_moving_more)
{
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    open_row(&b, 2);
    bench_mass(&b, 1, 3.0);
    contact_point *point = bench_touch(&b, 2, 1, 0.5, 1);
    b.vertices[point->feature].at.y = -0.1;
    regroup(&b, &r);
    const double *shift = contact_forces_shift(&r, r.groups[0], (scene_state){0.0, b.x, b.v});
    /* rounding of lengths of order 0.1 */
    check_vector(vec2_at(shift, 0), 0.0, -0.15, 1e-16);
    check_vector(vec2_at(shift, 1), 0.0, -0.05, 1e-16);
    b.inverse_mass[0] = 0.0;
    shift = contact_forces_shift(&r, r.groups[0], (scene_state){0.0, b.x, b.v});
    check_vector(vec2_at(shift, 0), 0.0, 0.0, 0.0);
    check_vector(vec2_at(shift, 1), 0.0, -0.2, 1e-16);
}

/* An upright edge whose lower end sticks to the floor, 0.2 m beside its vertex: both ends go 0.2 m, the lower one along
 * the floor. */
TEST(a_shift_lets_what_sticks_slide)
{
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    open_row(&b, 2);
    vec2_put(b.x, 1, (vec2){0.0, 1.0});
    bench_touch(&b, 0, 1, 0.5 * M_PI, 0);
    contact_point *point = bench_touch(&b, 2, 1, 0.5, 0);
    b.vertices[point->feature].at.x = 0.2;
    regroup(&b, &r);
    const double *shift = contact_forces_shift(&r, r.groups[0], (scene_state){0.0, b.x, b.v});
    check_vector(vec2_at(shift, 0), 0.2, 0.0, 1e-16); /* rounding of lengths of order 0.1 */
    check_vector(vec2_at(shift, 1), 0.2, 0.0, 1e-16);
}

/* Moves every feature by `size` (m); returns the largest gap after the shift over the square of the shift, 1/m. */
static double left_after_shift(const mix *w, double size)
{
    double x[2 * BENCH_NODES], largest = 0.0, change = 0.0;
    bench b;
    CLEANUP(contact_forces_destroy) contact_forces r;
    bench_open(&b, w->b.model.lattice.n_nodes);
    dem_index place[BENCH_CANDIDATES];
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    shuffle(rng, &w->b, &b, place);
    for (dem_index f = 0; f < BENCH_FEATURES; f++) {
        const vec2 off = {size * cos((double)(f * f)), size * sin((double)(f * f))};
        b.vertices[f].at = vec2_add(b.vertices[f].at, off);
        b.segments[f].start = vec2_add(b.segments[f].start, off);
    }
    regroup(&b, &r);
    memcpy(x, b.x, sizeof x);
    for (dem_index g = 0; g < r.n_groups; g++) {
        const double *shift = contact_forces_shift(&r, r.groups[g], (scene_state){0.0, b.x, b.v});
        for (dem_index k = r.groups[g]; k >= 0; k = r.next[k]) {
            const contact_candidate *s = &b.candidates[k];
            vec2_put(x, s->node, vec2_add(vec2_at(b.x, s->node), vec2_at(shift, s->node)));
            if (candidate_is_edge(s)) vec2_put(x, s->other, vec2_add(vec2_at(b.x, s->other), vec2_at(shift, s->other)));
        }
    }
    for (dem_index i = 0; i < 2 * w->b.model.lattice.n_nodes; i++) change = fmax(change, fabs(x[i] - b.x[i]));
    for (dem_index k = 0; k < b.n_candidates; k++)
        for (int q = 0; q < b.candidates[k].n_closed; q++)
            largest =
                fmax(largest, fabs(contact_frame_at(&b.scene, &b.candidates[k], q, (scene_state){0.0, x, b.v}).gap));
    return change > 0.0 ? largest / (change * change) : 0.0;
}

/* What is left is of second order, from the turning of edges: one of length L whose ends go ways up to d turns by up to
 * 2 d/L, and P slides on it by up to 2 d; most of our edges are longer than 0.4 m, and the worst of both at once is not
 * met. What a wrong solution leaves is a part of d, and over its square a part of 1e4 to 1e6 per metre. */
TEST(a_shift_closes_the_gaps_to_first_order)
{
    mix w = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
    int n_checked = 0;
    for (int k = 0; k < 2000; k++) {
        double solution[MOST_UNKNOWNS];
        mix_next(&w);
        if (!mix_solve(&w, solution)) continue;
        assert_true(left_after_shift(&w, 1e-5) <= 10.0);
        assert_true(left_after_shift(&w, 1e-6) <= 10.0);
        n_checked++;
    }
    assert_true(n_checked > 500);
    gsl_rng_free(w.rng);
}
