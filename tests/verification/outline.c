/* SPDX-License-Identifier: BSD-3-Clause */
/* See outline.h. */
#include "outline.h"

#include <stdbool.h>
#include <stdlib.h>

#include "../unit/close.h"

outline outline_create(const dem_lattice *l)
{
    outline o = {0, malloc(6 * (size_t)l->n_triangles * sizeof *o.ends)};
    assert_non_null(o.ends);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index a = l->triangles[k], b = l->triangles[k % 3 == 2 ? k - 2 : k + 1];
        bool twice = false;
        for (dem_index q = 0; q < 3 * l->n_triangles && !twice; q++)
            twice = l->triangles[q] == b && l->triangles[q % 3 == 2 ? q - 2 : q + 1] == a;
        if (twice) continue;
        o.ends[2 * o.n] = a;
        o.ends[2 * o.n++ + 1] = b;
    }
    return o;
}

static double distance_to(const double a[2], const double b[2], const double p[2])
{
    const double w[2] = {b[0] - a[0], b[1] - a[1]}, d[2] = {p[0] - a[0], p[1] - a[1]};
    const double s = fmin(1.0, fmax(0.0, (w[0] * d[0] + w[1] * d[1]) / (w[0] * w[0] + w[1] * w[1])));
    return hypot(d[0] - s * w[0], d[1] - s * w[1]);
}

/* Inside is what the boundary winds round. */
double outline_depth(const outline *o, const double *x, const double p[2])
{
    double nearest = INFINITY;
    int winding = 0;
    for (dem_index k = 0; k < o->n; k++) {
        const double *a = &x[2 * o->ends[2 * k]], *b = &x[2 * o->ends[2 * k + 1]];
        const double side = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        if (a[1] <= p[1] && b[1] > p[1] && side > 0.0) winding++;
        if (a[1] > p[1] && b[1] <= p[1] && side < 0.0) winding--;
        nearest = fmin(nearest, distance_to(a, b, p));
    }
    return winding != 0 ? nearest : -nearest;
}

void outline_free(outline *o)
{
    free(o->ends);
    *o = (outline){0};
}
