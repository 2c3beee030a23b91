/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/touching_bodies.h"

#include <stdlib.h>

#include "base/exact_terms.h"
#include "base/reduce.h"
#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"

/* ---- sums over bodies ---- */

/* What a body_content is rounded from. */
typedef struct content_sums {
    exact_sum springs, area;
} content_sums;

/* Mostly many terms of one sum follow each other. */
static void add_term(exact_terms *t, exact_sum *to, double term)
{
    if (to != t->to) {
        exact_terms_end(t);
        exact_terms_begin(t, to);
    }
    exact_terms_add(t, term);
}

static dem_index body_of(const dem_lattice *l, dem_index node)
{
    return l->body != NULL ? l->body[node] : 0;
}

/* Of own springs and triangles: each is of the rank that owns its lowest node. */
static void add_elements(content_sums *sums, const domain *d, const dem_lattice *l)
{
    exact_terms terms;
    exact_terms_begin(&terms, &sums[0].springs);
    for (dem_index k = 0; k < l->n_springs; k++)
        if (domain_owns(d, domain_lowest(&l->ends[2 * k], 2)))
            add_term(&terms, &sums[body_of(l, l->ends[2 * k])].springs, l->stiffness[k] * l->rest_length[k]);
    for (dem_index k = 0; k < l->n_triangles; k++)
        if (domain_owns(d, domain_lowest(&l->triangles[3 * k], 3)))
            add_term(&terms, &sums[body_of(l, l->triangles[3 * k])].area, vec2_area_of(l->x, &l->triangles[3 * k]));
    exact_terms_end(&terms);
}

dem_status touching_bodies_sum_up(touching_bodies *o, const ranks *r, const dem_lattice *l, dem_index n_bodies)
{
    content_sums *sums = calloc((size_t)n_bodies + 1, sizeof *sums);
    o->bodies = malloc(((size_t)n_bodies + 1) * sizeof *o->bodies);
    const dem_status own = sums != NULL && o->bodies != NULL
                               ? DEM_OK
                               : status_fail(DEM_ERROR_MEMORY, "out of memory for %lld bodies", (long long)n_bodies);
    const dem_status status = reduce_status(r, own, 0.0);
    if (status == DEM_OK) {
        o->n_bodies = n_bodies;
        add_elements(sums, o->domain, l);
        for (dem_index b = 0; b < n_bodies; b++) {
            const exact_sum *const both[] = {&sums[b].springs, &sums[b].area};
            double values[2];
            reduce_sums(r, both, 2, values);
            o->bodies[b] = (body_content){values[0], values[1]};
        }
    }
    free(sums);
    return status;
}

/* ---- bodies ---- */

dem_status touching_bodies_create(touching_bodies *out, const dem_lattice *lattice)
{
    touching_bodies o = {0};
    dem_status status = touching_bodies_sum_up(&o, &ranks_alone, lattice, lattice_count_bodies(lattice));
    if (status == DEM_OK) status = mesh_boundary_create(&o.boundary, lattice, NULL);
    if (status == DEM_OK)
        *out = o;
    else
        touching_bodies_free(&o);
    return status;
}

void touching_bodies_free(touching_bodies *o)
{
    mesh_boundary_free(&o->boundary);
    free(o->bodies);
    *o = (touching_bodies){0};
}
