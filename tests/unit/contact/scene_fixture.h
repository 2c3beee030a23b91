/* SPDX-License-Identifier: BSD-3-Clause */
/* Free masses, loose or with edges between them, over obstacles: contacts without an integrator, all events noted. */
#ifndef DEM_TEST_SCENE_H
#define DEM_TEST_SCENE_H

#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "contact/automaton.h"

enum { SCENE_NODES = 6, SCENE_EVENTS = 32 };

static const double scene_penetration_tolerance = 1e-6, scene_gravity = 10.0;

typedef struct scene {
    dem_model *model;
    forces acting;
    automaton c;
    double y[4 * SCENE_NODES];
    dem_event events[SCENE_EVENTS], impacts[SCENE_EVENTS]; /* all, and the impacts among them */
    int n_events, n_impacts;
    dem_status value; /* what the listener returns */
} scene;

static inline dem_status scene_note(void *context, const dem_event *event)
{
    scene *s = context;
    assert_true(s->n_events < SCENE_EVENTS);
    s->events[s->n_events++] = *event;
    if (event->kind == DEM_EVENT_IMPACT) s->impacts[s->n_impacts++] = *event;
    return s->value;
}

static inline void scene_start(scene *s, const dem_lattice *lattice, const dem_obstacle *obstacles, dem_index n)
{
    const contact_rule rule = {.penetration_tolerance = scene_penetration_tolerance,
                               .position_error = 1e-9,
                               .max_step = 0.01,
                               .storm_time = 0.5,
                               .max_impacts = 100,
                               .vertices = true,
                               .layout = {.dim = 2, .n_nodes = lattice->n_nodes, .n_rows = lattice->n_nodes}};
    *s = (scene){0};
    assert_ok(dem_model_create(&s->model, lattice, obstacles, n));
    s->acting = (forces){.model = s->model, .gravity = {0.0, -scene_gravity}};
    assert_ok(automaton_create(&s->c, &s->acting, &rule));
}

/* n masses, each a body of its own, with the triangles' sides for edges; nothing else holds them together. */
static inline void scene_open(scene *s, dem_index n, const double *x, const double *mass, dem_index n_triangles,
                              const dem_index *corners, const dem_obstacle *obstacles, dem_index n_obstacles)
{
    dem_lattice lattice = support_lattice(n, x, mass, 0, NULL, 0.0, 0.0, NULL);
    lattice.body = malloc((size_t)n * sizeof *lattice.body);
    assert_non_null(lattice.body);
    for (dem_index i = 0; i < n; i++) lattice.body[i] = (int32_t)i;
    if (n_triangles > 0) {
        const size_t size = 3 * (size_t)n_triangles * sizeof *corners;
        lattice.n_triangles = n_triangles;
        lattice.triangles = malloc(size);
        assert_non_null(lattice.triangles);
        memcpy(lattice.triangles, corners, size);
    }
    scene_start(s, &lattice, obstacles, n_obstacles);
    dem_lattice_free(&lattice);
    memcpy(s->y, x, 2 * (size_t)n * sizeof *x);
}

/* A triangle of three masses (kg) with its edges; the lower one goes from node 0 at (x, y) to node 1, 2 m along. */
static inline void scene_open_triangle(scene *s, const double mass[3], double x, double y,
                                       const dem_obstacle *obstacles, dem_index n_obstacles)
{
    const double at[6] = {x, y, x + 2.0, y, x + 1.0, y + 1.0};
    const dem_index corners[3] = {0, 1, 2};
    scene_open(s, 3, at, mass, 1, corners, obstacles, n_obstacles);
}

static inline void scene_close(scene *s)
{
    automaton_destroy(&s->c);
    dem_model_destroy(s->model);
}

static inline double *scene_v(scene *s)
{
    return s->y + 2 * s->model->lattice.n_nodes;
}

/* Puts a node elsewhere; after that all candidates are active. */
static inline void scene_put(scene *s, dem_index i, double x, double y, double u, double v)
{
    vec2_put(s->y, i, (vec2){x, y});
    vec2_put(scene_v(s), i, (vec2){u, v});
    for (dem_index k = 0; k < s->c.set.n; k++) s->c.set.list[k].clearance.inactive = false;
}

static inline void scene_check(scene *s, dem_index i, double x, double y, double u, double v)
{
    const vec2 at = vec2_at(s->y, i), velocity = vec2_at(scene_v(s), i);
    assert_close(at.x, x, 1e-14);
    assert_close(at.y, y, 1e-14);
    assert_close(velocity.x, u, 1e-14);
    assert_close(velocity.y, v, 1e-14);
}

/* The candidate of the edge from node a to node b. */
static inline dem_index scene_edge(const scene *s, dem_index a, dem_index b)
{
    const dem_index k = contact_set_find(&s->c.set, (contact_key){a, b});
    if (k < 0) fail_msg("no edge from node %lld to node %lld", (long long)a, (long long)b);
    return k;
}

static inline dem_status scene_take_up(scene *s)
{
    const event_listener listener = {scene_note, s};
    return automaton_start(&s->c, 0.0, s->y, &listener);
}

static inline dem_status scene_resolve(scene *s, double t)
{
    const event_listener listener = {scene_note, s};
    return automaton_resolve(&s->c, t, s->y, &listener);
}

/* A step of length h from s->y with the same acceleration of all nodes, which the quintic of the dense output follows
 * exactly. */
typedef struct scene_flight {
    double f0[4 * SCENE_NODES], y1[4 * SCENE_NODES], f1[4 * SCENE_NODES], scratch[4 * SCENE_NODES];
    dense_output dense; /* points into this and into the scene */
} scene_flight;

static inline void scene_fly(const scene *s, vec2 a, double t0, double h, scene_flight *out)
{
    const dem_index n = s->model->lattice.n_nodes;
    for (dem_index i = 0; i < n; i++) {
        const vec2 v = vec2_at(s->y, n + i), v1 = vec2_along(v, h, a);
        vec2_put(out->y1, i, vec2_along(vec2_at(s->y, i), h, vec2_along(v, 0.5 * h, a)));
        vec2_put(out->y1, n + i, v1);
        vec2_put(out->f0, i, v);
        vec2_put(out->f1, i, v1);
        vec2_put(out->f0, n + i, a);
        vec2_put(out->f1, n + i, a);
    }
    out->dense = (dense_output){
        *scene_layout(&s->c.set.scene), t0, t0 + h, t0 + h, s->y, out->f0, out->y1, out->f1, false, NULL};
}

/** Adds the rates of the quadratures of one obstacle, [3][2], in the same state with room for them. */
static inline void scene_add_rates(const scene *s, double rate[6])
{
    enum { more = 4 };
    const dem_index n = s->model->lattice.n_nodes;
    const size_t size = 2 * (size_t)n * sizeof(double);
    double y[4 * (SCENE_NODES + more)] = {0.0}, a[2 * (SCENE_NODES + more)] = {0.0};
    automaton c = s->c;
    state_layout *l = &c.set.scene.rule.layout;
    *l = (state_layout){.dim = 2, .n_nodes = n, .n_obstacles = 1, .n_totals = STATE_OBSTACLE, .n_rows = n + more};
    memcpy(y, s->y, size);
    memcpy(y + state_velocities(l), s->y + 2 * n, size);
    memcpy(a + state_row(l, state_impulse(l, 0)), rate, 6 * sizeof *rate);
    automaton_add_rates(&c, 0.0, y, a);
    memcpy(rate, a + state_row(l, state_impulse(l, 0)), 6 * sizeof *rate);
}

#endif
