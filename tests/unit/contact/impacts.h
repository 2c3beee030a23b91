/* SPDX-License-Identifier: BSD-3-Clause */
/* Impacts by hand: obstacles, nodes and edges at the depth at which an impact is taken, and what comes of it. */
#ifndef DEM_TEST_IMPACTS_H
#define DEM_TEST_IMPACTS_H

#include "unit/contact/scene_fixture.h"

#include "contact/impact_solve.h"

static const double penetration_tolerance = scene_penetration_tolerance, g = scene_gravity,
                    masses[4] = {1.0, 3.0, 2.0, 2.0};

static const double floor_points[4] = {-8.0, 0.0, 8.0, 0.0}, wall_points[4] = {2.0, -1.0, 2.0, 3.0};
static const double roof_points[6] = {-4.0, -4.0, 0.0, 0.0, 4.0, -4.0}; /* its ridge is vertex 0, in the origin */

static inline dem_obstacle obstacle(dem_index n_points, const double *points, double eta, double mu)
{
    return (dem_obstacle){.struct_size = sizeof(dem_obstacle),
                          .n_points = n_points,
                          .points = points,
                          .restitution = eta,
                          .friction = mu,
                          .friction_law = DEM_FRICTION_COULOMB};
}

/** Vector k of a list of sums. */
static inline vec2 ledger_vector(const exact_sum *sums, dem_index k)
{
    return (vec2){exact_sum_value(&sums[2 * k]), exact_sum_value(&sums[2 * k + 1])};
}

static inline contact_instant moment(scene *s, event_listener *listener)
{
    *listener = (event_listener){scene_note, s};
    return (contact_instant){.t = 0.5, .x = s->y, .v = scene_v(s), .listener = listener};
}

static inline void hit(scene *s, dem_index k, dem_index n, dem_index first, dem_index second)
{
    event_listener listener;
    contact_instant now = moment(s, &listener);
    assert_ok(impact_solve(&s->c.set, k, (impact_target){(int)n, {first, second}}, &now));
}

static inline vec2 velocity(scene *s, dem_index i)
{
    return vec2_at(scene_v(s), i);
}

static inline double kinetic(scene *s)
{
    double energy = 0.0;
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++)
        energy += 0.5 * s->model->lattice.mass[i] * vec2_dot(velocity(s, i), velocity(s, i));
    return energy;
}

static inline void check_vec(vec2 actual, double x, double y, double tolerance)
{
    assert_close(actual.x, x, tolerance);
    assert_close(actual.y, y, tolerance);
}

/* One node of 2 kg at (0.25, -penetration tolerance). */
static inline void open_node(scene *s, const dem_obstacle *obstacles, dem_index n, double u, double v)
{
    const double at[2] = {0.25, -penetration_tolerance};
    scene_open(s, 1, at, &masses[2], 0, NULL, obstacles, n);
    vec2_put(scene_v(s), 0, (vec2){u, v});
}

/* Edge 0-1 of masses 1 and 3 kg, 2 m long and turned by `angle`, with the ridge at s of it. */
static inline dem_index open_edge(scene *s, const dem_obstacle *roof, double fraction, double angle)
{
    const vec2 t = {cos(angle), sin(angle)}, n = {-t.y, t.x};
    scene_open_triangle(s, masses, 0.0, 0.0, roof, 1);
    const vec2 start = vec2_scale(-2.0 * fraction, t);
    vec2_put(s->y, 0, start);
    vec2_put(s->y, 1, vec2_along(start, 2.0, t));
    vec2_put(s->y, 2, vec2_along(vec2_along(start, 1.0, t), 1.0, n));
    return scene_edge(s, 0, 1);
}

static inline double mobility(double fraction)
{
    return (1.0 - fraction) * (1.0 - fraction) / masses[0] + fraction * fraction / masses[1];
}

/* Nodes 0, 1, 2 in a line, 1 m apart, the body's flat side; node 3 above. Node 1 is at (x, y). */
static inline void open_side(scene *s, const dem_obstacle *roof, double x, double y, double bend)
{
    const double at[8] = {x - 1.0, y + bend, x, y, x + 1.0, y + bend, x, y + 1.0};
    const dem_index corners[6] = {0, 1, 3, 1, 2, 3};
    scene_open(s, 4, at, masses, 2, corners, roof, 1);
    for (dem_index i = 0; i < 4; i++) vec2_put(scene_v(s), i, (vec2){0.0, -1.0});
}

#endif
