/* SPDX-License-Identifier: BSD-3-Clause */
#include "body_outline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "angle.h"

static outline polygon_of(const schema_instance *group)
{
    const schema_value *points = schema_value_of(group, "points");
    const size_t n = (size_t)points->count / 2;
    const bool closed = n > 1 && memcmp(points->reals, points->reals + 2 * n - 2, 2 * sizeof(double)) == 0;
    return (outline){.kind = OUTLINE_POLYGON, .n_points = closed ? n - 1 : n, .points = points->reals};
}

static outline rectangle_of(const schema_instance *group)
{
    const double *size = schema_reals(group, "size");
    outline o = {.kind = OUTLINE_RECTANGLE};
    for (int c = 0; c < 2 && size != NULL; c++) o.size[c] = size[c];
    if (strcmp(group->group->name, "body") == 0) o.centre[1] = 0.5 * o.size[1];
    return o;
}

outline body_outline(const schema_instance *group)
{
    const double radius = schema_real(group, "radius");
    if (schema_is(group, "shape", "polygon")) return polygon_of(group);
    if (schema_is(group, "shape", "disc")) return (outline){.kind = OUTLINE_DISC, .radius = radius};
    if (schema_is(group, "shape", "ring"))
        return (outline){.kind = OUTLINE_RING, .radius = radius, .inner = schema_real(group, "inner_radius")};
    return rectangle_of(group);
}

bool body_outline_copy(outline *out, const schema_instance *group)
{
    *out = body_outline(group);
    if (out->kind != OUTLINE_POLYGON) return true;
    const size_t size = out->n_points * 2 * sizeof *out->points;
    double *points = malloc(size);
    if (points != NULL) memcpy(points, out->points, size);
    out->points = points;
    return points != NULL;
}

bool body_outline_place(outline *out, const schema_instance *group)
{
    const double *centre = schema_reals(group, "centre"), angle = angle_degree * schema_real(group, "angle");
    const double turn[2] = {cos(angle), sin(angle)};
    bool good = body_outline_copy(out, group);
    if (out->kind == OUTLINE_POLYGON || angle != 0.0) {
        good = good && outline_place(out, turn, centre);
    } else {
        out->centre[0] = centre[0];
        out->centre[1] = centre[1];
    }
    if (!good) outline_free(out);
    return good;
}
