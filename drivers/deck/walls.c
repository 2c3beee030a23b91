/* SPDX-License-Identifier: BSD-3-Clause */
#include "walls.h"

#include <math.h>
#include <string.h>

#include "body_outline.h"

/* Of a mask, a mesh or a lattice file the deck does not give the outline. */
static bool has_outline(const schema_instance *body)
{
    return strstr("rectangle, disc, ring, polygon", schema_text(body, "shape")) != NULL;
}

/* Without the hole of a ring: how far a void is from that is asked for apart. */
static dem_outline outer_edge(const schema_instance *body)
{
    dem_outline o = body_outline(body);
    if (o.kind == DEM_OUTLINE_RING) o.kind = DEM_OUTLINE_DISC;
    return o;
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
    if (k >= schema_count(groups, "body")) return least;
    const schema_instance *body = schema_get(groups, "body", k);
    if (!has_outline(body)) return least;
    const dem_outline o = outer_edge(body);
    const double hole_radius = schema_real(body, "inner_radius");
    double out; /* of the outer edge, m */
    if (schema_is(body, "shape", "ring")) least = o.radius - hole_radius;
    for (size_t i = 0; i < schema_count(groups, "void"); i++) {
        const schema_instance *hole = schema_get(groups, "void", i);
        if (!is_round_void(hole, k)) continue;
        const double *x = schema_reals(hole, "centre"), radius = schema_real(hole, "radius");
        if (dem_outline_distance(&o, x, 1, &out) == DEM_OK) least = thinner(least, -out - radius);
        if (schema_is(body, "shape", "ring")) least = thinner(least, hypot(x[0], x[1]) - hole_radius - radius);
        least = thinnest_between(groups, k, i, least);
    }
    return least;
}
