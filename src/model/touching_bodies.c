/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/touching_bodies.h"

#include <stdlib.h>

#include "base/exact_terms.h"
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

static void add_elements(content_sums *sums, const dem_lattice *l)
{
    exact_terms terms;
    exact_terms_begin(&terms, &sums[0].springs);
    for (dem_index k = 0; k < l->n_springs; k++)
        add_term(&terms, &sums[body_of(l, l->ends[2 * k])].springs, l->stiffness[k] * l->rest_length[k]);
    for (dem_index k = 0; k < l->n_triangles; k++)
        add_term(&terms, &sums[body_of(l, l->triangles[3 * k])].area, vec2_area_of(l->x, &l->triangles[3 * k]));
    exact_terms_end(&terms);
}

dem_status touching_bodies_sum_up(touching_bodies *out, const dem_lattice *l)
{
    const dem_index n = lattice_count_bodies(l);
    content_sums *sums = calloc((size_t)n + 1, sizeof *sums);
    body_content *bodies = malloc(((size_t)n + 1) * sizeof *bodies);
    const bool complete = sums != NULL && bodies != NULL;
    if (complete) add_elements(sums, l);
    for (dem_index b = 0; complete && b < n; b++)
        bodies[b] = (body_content){exact_sum_value(&sums[b].springs), exact_sum_value(&sums[b].area)};
    free(sums);
    if (complete)
        *out = (touching_bodies){.n_bodies = n, .bodies = bodies};
    else
        free(bodies);
    CHECK(complete, DEM_ERROR_MEMORY, "out of memory for %lld bodies", (long long)n);
    return DEM_OK;
}

/* ---- bodies ---- */

dem_status touching_bodies_create(touching_bodies *out, const dem_lattice *lattice)
{
    touching_bodies o;
    TRY(touching_bodies_sum_up(&o, lattice));
    const dem_status status = mesh_boundary_create(&o.boundary, lattice, NULL);
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
