/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes for the resets of contacts: masses on floors, terraces and ridges. */
#ifndef DEM_TEST_RESETS_H
#define DEM_TEST_RESETS_H

#include "unit/contact/scene_fixture.h"

static const double penetration_tolerance = scene_penetration_tolerance, g = scene_gravity;

/* n nodes of 2 kg, each a body of its own, somewhere above. */
static inline void open_scene(scene *s, dem_index n, const dem_obstacle *obstacles, dem_index n_obstacles)
{
    const double x[6] = {0.0, 5.0, 1.0, 5.0, 2.0, 5.0}, mass[3] = {2.0, 2.0, 2.0};
    scene_open(s, n, x, mass, 0, NULL, obstacles, n_obstacles);
}

static const double floor_points[4] = {-4.0, 0.0, 4.0, 0.0}, wall_points[4] = {2.0, -1.0, 2.0, 3.0};
static const dem_obstacle
    half = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points, .restitution = 0.5},
    plastic = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points, .restitution = 0.0};

/* ---- the initial state ---- */

/* Node 0 on the floor, node 1 above it on a spring of 100 N and 1 m; 2 kg each. */
static inline void open_pair(scene *s)
{
    const double x[4] = {0.0, 0.0, 0.0, 1.0}, mass[2] = {2.0, 2.0};
    const dem_index ends[2] = {0, 1};
    dem_lattice lattice = support_lattice(2, x, mass, 1, ends, 1.0, 100.0, NULL);
    scene_start(s, &lattice, &plastic, 1);
    dem_lattice_free(&lattice);
    scene_put(s, 0, 0.0, 0.0, 0.5, 0.0);
    scene_put(s, 1, 0.0, 1.0, 0.5, 2.0);
    assert_ok(scene_take_up(s));
    assert_int_equal(s->c.set.list[0].n_closed, 1);
}

static inline void slide(scene *s, const dem_obstacle *obstacle, double x, double u)
{
    open_scene(s, 1, obstacle, 1);
    scene_put(s, 0, x, 0.0, u, 0.0);
    assert_ok(scene_take_up(s));
    assert_int_equal(s->c.set.list[0].n_closed, 1);
}

static const dem_obstacle rough = {.struct_size = sizeof(dem_obstacle),
                                   .n_points = 2,
                                   .points = floor_points,
                                   .friction = 0.5,
                                   .friction_law = DEM_FRICTION_COULOMB};

static inline void check_event(const scene *s, int k, dem_event_kind kind, dem_contact_state state)
{
    assert_true(k < s->n_events);
    assert_int_equal(s->events[k].kind, kind);
    assert_int_equal(s->events[k].state, state);
}

/* On the rough floor with speed u. */
static inline void rub(scene *s, double u)
{
    open_scene(s, 1, &rough, 1);
    scene_put(s, 0, 0.5, 0.0, u, 0.0);
    assert_ok(scene_take_up(s));
    assert_int_equal(s->c.set.list[0].n_closed, 1);
    check_event(s, 0, DEM_EVENT_CLOSE, u == 0.0 ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP);
    assert_int_equal(s->c.set.list[0].closed[0].slide, (u > 0.0) - (u < 0.0));
}

static const double roof_points[6] = {-4.0, -4.0, 0.0, 0.0, 4.0, -4.0}; /* its ridge is in the origin */
static const dem_obstacle roof = {
    .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = roof_points, .restitution = 0.0};
static const dem_obstacle rough_roof = {.struct_size = sizeof(dem_obstacle),
                                        .n_points = 3,
                                        .points = roof_points,
                                        .friction = 0.5,
                                        .friction_law = DEM_FRICTION_COULOMB};

/* A side of nodes 0, 1, 2, whose ends are 1 m from node 1 at (x, y) and higher by `bend`; node 3 above. */
static inline void open_side(scene *s, const dem_obstacle *obstacle, double x, double y, double bend)
{
    const double at[8] = {x - 1.0, y + bend, x, y, x + 1.0, y + bend, x, y + 1.0}, mass[4] = {1.0, 3.0, 2.0, 2.0};
    const dem_index corners[6] = {0, 1, 3, 1, 2, 3};
    scene_open(s, 4, at, mass, 2, corners, obstacle, 1);
}

static inline void launch(scene *s, double u, double v)
{
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++) vec2_put(scene_v(s), i, (vec2){u, v});
}

#endif
