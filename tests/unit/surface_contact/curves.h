/* SPDX-License-Identifier: BSD-3-Clause */
/* Lattices whose surfaces are any closed curves, as the contact of surfaces sees them: fans of triangles about a node
 * in the middle. The springs of a fan are its sides, with the stiffness 1 N. */
#ifndef DEM_TEST_CURVES_H
#define DEM_TEST_CURVES_H

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>

#include "base/vec2.h"

/** `n_bodies` stars of `n` corners each with radii of about 1 m, on a square grid `step` m apart. */
static inline dem_lattice curves_make(gsl_rng *rng, dem_index n_bodies, dem_index n, double step)
{
    dem_lattice l = dem_lattice_empty();
    const dem_index columns = (dem_index)ceil(sqrt((double)n_bodies));
    l.n_nodes = n_bodies * (n + 1);
    l.n_triangles = l.n_springs = n_bodies * n;
    l.x = calloc(2 * (size_t)l.n_nodes, sizeof *l.x);
    l.flags = calloc((size_t)l.n_nodes, sizeof *l.flags);
    l.body = calloc((size_t)l.n_nodes, sizeof *l.body);
    l.triangles = calloc(3 * (size_t)l.n_triangles, sizeof *l.triangles);
    l.ends = calloc(2 * (size_t)l.n_springs, sizeof *l.ends);
    l.stiffness = calloc((size_t)l.n_springs, sizeof *l.stiffness);
    l.rest_length = calloc((size_t)l.n_springs, sizeof *l.rest_length);
    for (dem_index b = 0; b < n_bodies; b++) {
        const dem_index middle = b * (n + 1);
        const vec2 at = {step * (double)(b % columns), step * (double)(b / columns)};
        vec2_put(l.x, middle, at);
        for (dem_index k = 0; k < n; k++) {
            const dem_index i = middle + 1 + k, j = middle + 1 + (k + 1) % n, edge = b * n + k;
            const double angle = 2.0 * M_PI * (double)k / (double)n;
            const vec2 out = {cos(angle), sin(angle)};
            vec2_put(l.x, i, vec2_along(at, 0.8 + 0.4 * gsl_rng_uniform(rng), out));
            memcpy(&l.triangles[3 * edge], (dem_index[]){middle, i, j}, 3 * sizeof *l.triangles);
            memcpy(&l.ends[2 * edge], (dem_index[]){i, j}, 2 * sizeof *l.ends);
            l.stiffness[edge] = l.rest_length[edge] = 1.0;
        }
        for (dem_index i = middle; i <= middle + n; i++) l.body[i] = (int32_t)b;
    }
    return l;
}

/** The nodes' places, each coordinate shifted by up to `most` m at random: [2 n_nodes], m. Free with free(). */
static inline double *curves_shift(gsl_rng *rng, const dem_lattice *l, double most)
{
    double *x = malloc(2 * (size_t)l->n_nodes * sizeof *x);
    for (dem_index k = 0; k < 2 * l->n_nodes; k++) x[k] = l->x[k] + 2.0 * most * (gsl_rng_uniform(rng) - 0.5);
    return x;
}

#endif
