/* SPDX-License-Identifier: BSD-3-Clause */
/* Questions of contacts about the surfaces of obstacles that need more than a line: free ends, the cone of normals at a
 * vertex, the motion of a corner. The geometry itself is in src/obstacle; contacts come here first, so that surfaces of
 * other bodies could be added in one place. */
#include "contact/surface_feature.h"

/* A free end that stands on another obstacle goes on inside it for `buried` m (docs/method.md, Start, free ends,
 * errors). */
bool surface_at_free_end(const contact_scene *scene, dem_index id, double along, double tolerance)
{
    const segment *s = &scene->model->obstacles.segments[id];
    const double margin = scene_margin(scene) + tolerance;
    return (s->before < 0 && fabs(along) <= fmax(margin, s->buried[0] + tolerance)) ||
           (s->after < 0 && fabs(along - s->length) <= fmax(margin, s->buried[1] + tolerance));
}

/* At a convex vertex the solid's corner sticks out: a body's edge may touch it with any normal between those of the
 * segment that ends there and of the one that begins. The normals turn clockwise from `before` to `after`. */
bool surface_in_cone(const contact_scene *scene, dem_index vertex, double t, vec2 direction)
{
    const obstacle_vertex *v = &scene->model->obstacles.vertices[vertex];
    return vec2_cross(surface_line_at(scene, v->before, t).normal, direction) <= 0.0 &&
           vec2_cross(direction, surface_line_at(scene, v->after, t).normal) <= 0.0;
}

/* The motion of the corner of two walls, of which a point follows both: its velocity v has v.n = w_a.n and
 * v.m = w_b.m, and its acceleration the normal parts of b_a and b_b, those of points that slide along each wall with v
 * (docs/method.md, Moving obstacles). Two equations each for two components. */
obstacle_motion surface_corner_motion(const contact_scene *scene, const dem_index ids[2], surface_query at)
{
    const obstacle_set *o = &scene->model->obstacles;
    const segment *here = &o->segments[ids[0]], *there = &o->segments[ids[1]];
    const obstacle_motion a = surface_motion(scene, ids[0], at), b = surface_motion(scene, ids[1], at);
    if (motion_law_is_same(&o->laws[here->obstacle], &o->laws[there->obstacle])) return a;
    const vec2 n = surface_line_at(scene, ids[0], at.t).normal, m = surface_line_at(scene, ids[1], at.t).normal;
    const vec2 v = vec2_with_products(vec2_dot(a.velocity, n), n, vec2_dot(b.velocity, m), m);
    return (obstacle_motion){.moves = true,
                             .velocity = v,
                             .acceleration = vec2_with_products(vec2_dot(obstacle_motion_sliding(&a, v), n), n,
                                                                vec2_dot(obstacle_motion_sliding(&b, v), m), m)};
}
