/* SPDX-License-Identifier: BSD-3-Clause */
#include "body_outline.h"

#include <string.h>

#include "angle.h"

static dem_outline_kind kind_of(const schema_instance *group)
{
    if (schema_is(group, "shape", "polygon")) return DEM_OUTLINE_POLYGON;
    if (schema_is(group, "shape", "disc")) return DEM_OUTLINE_DISC;
    return schema_is(group, "shape", "ring") ? DEM_OUTLINE_RING : DEM_OUTLINE_RECTANGLE;
}

dem_outline body_outline(const schema_instance *group)
{
    const double *size = schema_reals(group, "size");
    dem_outline o = {.struct_size = sizeof o, .kind = kind_of(group)};
    if (o.kind == DEM_OUTLINE_POLYGON) {
        const schema_value *points = schema_value_of(group, "points");
        o.n_points = points->count / 2;
        o.points = points->reals;
    } else if (o.kind == DEM_OUTLINE_RECTANGLE) {
        for (int c = 0; c < 2 && size != NULL; c++) o.size[c] = size[c];
        if (strcmp(group->group->name, "body") == 0) o.centre[1] = 0.5 * o.size[1];
    } else {
        o.radius = schema_real(group, "radius");
        o.inner_radius = schema_real(group, "inner_radius");
    }
    return o;
}

dem_outline body_outline_placed(const schema_instance *group)
{
    const double *centre = schema_reals(group, "centre");
    dem_outline o = body_outline(group);
    o.angle = angle_degree * schema_real(group, "angle");
    for (int c = 0; c < 2; c++) o.centre[c] = centre[c];
    return o;
}
