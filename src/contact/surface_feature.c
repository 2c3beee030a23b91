/* SPDX-License-Identifier: BSD-3-Clause */
/* What contacts ask of the obstacles. */
#include "contact/surface_feature.h"

bool surface_at_free_end(const contact_scene *scene, dem_index id, double along, double tolerance)
{
    const segment *s = &scene->model->obstacles.segments[id];
    const double margin = scene_margin(scene) + tolerance;
    return (s->before < 0 && fabs(along) <= fmax(margin, s->buried[0] + tolerance)) ||
           (s->after < 0 && fabs(along - s->length) <= fmax(margin, s->buried[1] + tolerance));
}

bool surface_in_cone(const contact_scene *scene, dem_index vertex, double t, vec2 direction)
{
    const obstacle_vertex *v = &scene->model->obstacles.vertices[vertex];
    return vec2_cross(surface_line_at(scene, v->before, t).normal, direction) <= 0.0 &&
           vec2_cross(direction, surface_line_at(scene, v->after, t).normal) <= 0.0;
}

obstacle_motion surface_corner_motion(const contact_scene *scene, const dem_index ids[2], surface_query at)
{
    const obstacle_set *o = &scene->model->obstacles;
    const segment *here = &o->segments[ids[0]], *there = &o->segments[ids[1]];
    const obstacle_motion a = surface_motion(scene, ids[0], at), b = surface_motion(scene, ids[1], at);
    if (motion_law_is_same(&o->laws[here->obstacle], &o->laws[there->obstacle])) return a;
    const vec2 n = surface_line_at(scene, ids[0], at.t).normal, m = surface_line_at(scene, ids[1], at.t).normal;
    return (obstacle_motion){.moves = true,
                             .velocity = vec2_with_products(vec2_dot(a.velocity, n), n, vec2_dot(b.velocity, m), m),
                             .acceleration =
                                 vec2_with_products(vec2_dot(a.acceleration, n), n, vec2_dot(b.acceleration, m), m)};
}
