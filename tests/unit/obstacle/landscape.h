/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles that the tests of the folder share: two small ones, and random landscapes with what may tie in them. */
#ifndef DEM_TEST_LANDSCAPE_H
#define DEM_TEST_LANDSCAPE_H

#include "verification/support.h"

#include <gsl/gsl_rng.h>

#include "harness/message.h"
#include "obstacle/obstacle_set.h"
#include "obstacle/point_gap.h"

/* A polyline with a free end at (-2, 0), a convex vertex at (0, 0), a concave one at (1, -1) and a free end at (3,
 * -1). */
static const double valley[8] = {-2.0, 0.0, 0.0, 0.0, 1.0, -1.0, 3.0, -1.0};

/* A block standing on y = 0, clockwise: its inside is on the right. */
static const double block[10] = {5.0, 0.0, 5.0, 1.0, 6.0, 1.0, 6.0, 0.0, 5.0, 0.0};

static inline obstacle_set compile(const double *points, dem_index n_points, double restitution)
{
    const dem_obstacle obstacle = {
        .struct_size = sizeof(dem_obstacle), .n_points = n_points, .points = points, .restitution = restitution};
    obstacle_set o;
    assert_ok(obstacles_compile(&o, &obstacle, 1));
    return o;
}

static inline obstacle_set compile_both(void)
{
    const dem_obstacle list[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .restitution = 0.25},
        {.struct_size = sizeof(dem_obstacle), .n_points = 5, .points = block, .restitution = 0.5}};
    obstacle_set o;
    assert_ok(obstacles_compile(&o, list, 2));
    return o;
}

/* The valley at rest, and the block with this velocity; or where it is after a time, at rest. */
static inline obstacle_set compile_moving(vec2 velocity, vec2 way)
{
    double there[10];
    for (int k = 0; k < 5; k++) vec2_put(there, k, vec2_add(vec2_at(block, k), way));
    const dem_obstacle list[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 4, .points = valley, .restitution = 0.25},
        {.struct_size = sizeof(dem_obstacle),
         .n_points = 5,
         .points = there,
         .restitution = 0.5,
         .velocity = {velocity.x, velocity.y}}};
    obstacle_set o;
    assert_ok(obstacles_compile(&o, list, 2));
    return o;
}

static inline obstacle_gap gap_at(const obstacle_set *o, double x, double y)
{
    return obstacles_gap(o, 0.0, (vec2){x, y}, 0.0, -1, -1);
}

static inline void refuse(const dem_obstacle *list, dem_index n, const char *message)
{
    obstacle_set o = {.n = 77};
    assert_int_equal(obstacles_compile(&o, list, n), DEM_ERROR_MODEL);
    assert_message_parts(message);
    assert_int_equal(o.n, 77);
}

static inline double uniform(gsl_rng *rng, double a, double b)
{
    return a + (b - a) * gsl_rng_uniform(rng);
}

/* Three polylines: rough ground from the left to the right, a ring above it, and a wall that stands on the ground;
 * scaled, turned and put somewhere. */
typedef struct landscape {
    obstacle_set set;
    vec2 origin, axis;
} landscape;

static inline vec2 placed(const landscape *l, double x, double y)
{
    return (vec2){l->origin.x + l->axis.x * x - l->axis.y * y, l->origin.y + l->axis.y * x + l->axis.x * y};
}

enum { ground_points = 41, ring_points = 14, wall_points = 4 };

static inline landscape random_landscape(gsl_rng *rng)
{
    double ground[2 * ground_points], ring[2 * ring_points], wall[2 * wall_points];
    const dem_obstacle list[3] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = ground_points, .points = ground, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = ring_points, .points = ring, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = wall_points, .points = wall, .restitution = 0.0}};
    const double size = pow(10.0, uniform(rng, -3.0, 1.0)), turn = uniform(rng, 0.0, 6.28);
    landscape l = {.axis = {size * cos(turn), size * sin(turn)}};
    l.origin = gsl_rng_uniform(rng) < 0.5 ? (vec2){0.0, 0.0} : (vec2){uniform(rng, -9.0, 9.0), uniform(rng, -9.0, 9.0)};
    double foot = 0.0;
    for (int k = 0; k < ground_points; k++) {
        const double y = k % 3 == 0 ? 0.0 : uniform(rng, -0.1, 0.1);
        if (k == 30) foot = y;
        vec2_put(ground, k, placed(&l, k / 10.0 - 2.0, y));
    }
    for (int k = 0; k < ring_points - 1; k++) {
        const double r = uniform(rng, 0.3, 0.9), angle = -2.0 * M_PI * k / (ring_points - 1);
        vec2_put(ring, k, placed(&l, r * cos(angle), 1.2 + r * sin(angle)));
    }
    vec2_put(ring, ring_points - 1, vec2_at(ring, 0));
    for (int k = 0; k < wall_points; k++) vec2_put(wall, k, placed(&l, 1.0, foot + 0.4 * (wall_points - 1 - k)));
    assert_ok(obstacles_compile(&l.set, list, 3));
    return l;
}

/* Points in the plane, and near or on what may tie: vertices, middles and prolongations of segments. */
static inline vec2 telling_point(gsl_rng *rng, const landscape *l)
{
    const segment *s = &l->set.segments[gsl_rng_uniform_int(rng, (unsigned long)l->set.n_segments)];
    switch (gsl_rng_uniform_int(rng, 5)) {
    case 0:
        return s->end;
    case 1:
        return vec2_along(vec2_along(s->end, uniform(rng, -0.3, 0.3) * s->length, s->normal), 0.0, s->tangent);
    case 2:
        return vec2_along(vec2_along(s->start, uniform(rng, -0.5, 1.5) * s->length, s->tangent),
                          pow(10.0, uniform(rng, -16.0, 0.0)) * s->length, s->normal);
    case 3:
        return vec2_along(s->start, uniform(rng, -2.0, 2.0) * s->length, s->tangent);
    default:
        return placed(l, uniform(rng, -3.0, 3.0), uniform(rng, -1.0, 3.0));
    }
}

#endif
