/* SPDX-License-Identifier: BSD-3-Clause */
/* The questions of contacts to the obstacles. */
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
