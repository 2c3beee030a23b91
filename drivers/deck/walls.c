/* SPDX-License-Identifier: BSD-3-Clause */
#include "walls.h"

#include <math.h>

#include "outline.h"

/* False for shapes whose outline the deck does not give. */
static bool read_outline(outline *o, const schema_instance *body)
{
    const schema_value *points = schema_value_of(body, "points");
    const double *size = schema_reals(body, "size"), radius = schema_real(body, "radius");
    *o = (outline){.kind = OUTLINE_DISC, .radius = radius};
    if (schema_is(body, "shape", "rectangle"))
        *o = (outline){.kind = OUTLINE_RECTANGLE, .centre = {0.0, 0.5 * size[1]}, .size = {size[0], size[1]}};
    else if (schema_is(body, "shape", "polygon"))
        *o = (outline){.kind = OUTLINE_POLYGON, .n_points = (size_t)points->count / 2, .points = points->reals};
    else
        return schema_is(body, "shape", "disc") || schema_is(body, "shape", "ring");
    return true;
}

/* Where two of them meet there is no wall. */
static double thinner(double least, double wall)
{
    return wall > 0.0 ? fmin(least, wall) : least;
}

static bool is_round_void(const schema_instance *hole, size_t k)
{
    return schema_real(hole, "body") == (double)(k + 1) && schema_is(hole, "shape", "disc");
}

/* Between a void and those behind it in the deck. */
static double thinnest_between(const schema_deck *groups, size_t k, size_t i, double least)
{
    const schema_instance *hole = schema_get(groups, "void", i);
    const double *x = schema_reals(hole, "centre");
    for (size_t q = i + 1; q < schema_count(groups, "void"); q++) {
        const schema_instance *other = schema_get(groups, "void", q);
        if (!is_round_void(other, k)) continue;
        const double *y = schema_reals(other, "centre");
        least = thinner(least,
                        hypot(x[0] - y[0], x[1] - y[1]) - schema_real(hole, "radius") - schema_real(other, "radius"));
    }
    return least;
}

double walls_thinnest(const schema_deck *groups, size_t k)
{
    double least = (double)INFINITY;
    outline o;
    if (k >= schema_count(groups, "body")) return least;
    const schema_instance *body = schema_get(groups, "body", k);
    if (!read_outline(&o, body)) return least;
    const double hole_radius = schema_real(body, "inner_radius");
    if (schema_is(body, "shape", "ring")) least = o.radius - hole_radius;
    for (size_t i = 0; i < schema_count(groups, "void"); i++) {
        const schema_instance *hole = schema_get(groups, "void", i);
        if (!is_round_void(hole, k)) continue;
        const double *x = schema_reals(hole, "centre"), radius = schema_real(hole, "radius");
        least = thinner(least, -outline_distance(&o, x[0], x[1]) - radius);
        if (schema_is(body, "shape", "ring")) least = thinner(least, hypot(x[0], x[1]) - hole_radius - radius);
        least = thinnest_between(groups, k, i, least);
    }
    return least;
}
