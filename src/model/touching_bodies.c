/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/touching_bodies.h"

#include <stdlib.h>
#include <string.h>

#include "base/exact_terms.h"
#include "base/reduce.h"
#include "base/status.h"
#include "base/vec2.h"
#include "lattice/lattice.h"

/* ---- sums over bodies ---- */

/* Springs or triangles, and what each of them adds to its body. */
typedef struct summands {
    dem_index n;
    int arity;
    const dem_index *node; /* [n][arity] */
    double (*term)(const dem_lattice *l, dem_index k);
    size_t at; /* where in a body_content the sum belongs */
} summands;

static double spring_term(const dem_lattice *l, dem_index k)
{
    return l->stiffness[k] * l->rest_length[k];
}

static double area_term(const dem_lattice *l, dem_index k)
{
    return vec2_area_of(l->x, &l->triangles[3 * k]);
}

static bool counts_here(const summands *s, dem_index k, const unsigned char *is_own)
{
    const dem_index *node = s->node + s->arity * k;
    dem_index lowest = node[0];
    for (int c = 1; c < s->arity; c++) lowest = node[c] < lowest ? node[c] : lowest;
    return is_own == NULL || is_own[lowest];
}

/* Mostly many of one body follow each other, and are added together. */
static void add_terms(exact_sum *sums, const summands *s, const dem_lattice *l, const unsigned char *is_own)
{
    exact_terms terms;
    exact_terms_begin(&terms, sums);
    for (dem_index k = 0; k < s->n; k++) {
        exact_sum *const to = &sums[l->body != NULL ? l->body[s->node[s->arity * k]] : 0];
        if (!counts_here(s, k, is_own)) continue;
        if (to != terms.to) {
            exact_terms_end(&terms);
            exact_terms_begin(&terms, to);
        }
        exact_terms_add(&terms, s->term(l, k));
    }
    exact_terms_end(&terms);
}

/* As many sums at once as a reduction takes. */
static void reduce_terms(touching_bodies *o, const exact_sum *sums, const summands *s, const ranks *r)
{
    for (dem_index first = 0; first < o->n_bodies; first += REDUCE_SUMS_MOST) {
        const int n = (int)(o->n_bodies - first < REDUCE_SUMS_MOST ? o->n_bodies - first : REDUCE_SUMS_MOST);
        const exact_sum *own[REDUCE_SUMS_MOST];
        double values[REDUCE_SUMS_MOST];
        for (int q = 0; q < n; q++) own[q] = &sums[first + q];
        reduce_sums(r, own, n, values);
        for (int q = 0; q < n; q++) memcpy((char *)&o->bodies[first + q] + s->at, &values[q], sizeof values[q]);
    }
}

dem_status touching_bodies_sum_up(touching_bodies *out, const dem_lattice *l, const ranks *r,
                                  const unsigned char *is_own)
{
    const summands both[] = {{l->n_springs, 2, l->ends, spring_term, offsetof(body_content, springs)},
                             {l->n_triangles, 3, l->triangles, area_term, offsetof(body_content, area)}};
    touching_bodies o = {.n_bodies = (dem_index)reduce_max(r, (double)lattice_count_bodies(l))};
    exact_sum *sums = malloc(((size_t)o.n_bodies + 1) * sizeof *sums);
    o.bodies = calloc((size_t)o.n_bodies + 1, sizeof *o.bodies);
    const bool complete = sums != NULL && o.bodies != NULL;
    const dem_status status = reduce_status(
        r, complete ? DEM_OK : status_fail(DEM_ERROR_MEMORY, "out of memory for %lld bodies", (long long)o.n_bodies),
        0.0);
    for (size_t k = 0; status == DEM_OK && k < sizeof both / sizeof *both; k++) {
        memset(sums, 0, ((size_t)o.n_bodies + 1) * sizeof *sums);
        add_terms(sums, &both[k], l, is_own);
        reduce_terms(&o, sums, &both[k], r);
    }
    free(sums);
    if (status == DEM_OK)
        *out = o;
    else
        touching_bodies_free(&o);
    return status;
}

/* ---- bodies ---- */

dem_status touching_bodies_create(touching_bodies *out, const dem_lattice *lattice)
{
    touching_bodies o;
    TRY(touching_bodies_sum_up(&o, lattice, &ranks_alone, NULL));
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
