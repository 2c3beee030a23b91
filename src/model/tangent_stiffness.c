/* SPDX-License-Identifier: BSD-3-Clause */
/* Products with the tangent stiffness K, and conjugate gradients, preconditioned by a diagonal, for K u = f on the
 * nodes that are not held. K is never stored: a row is computed from springs and triangles when it is needed. Sums are
 * exact. The derivatives themselves are in elastic/springs.c and elastic/triangles.c; time integration
 * does not use K. */
#include "model/tangent_stiffness.h"

#include <stdlib.h>

#include "base/exact_terms.h"
#include "base/reduce.h"
#include "base/status.h"
#include "lattice/lattice.h"

void tangent_apply(const dem_model *model, const double *x, const double *u, double *out)
{
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) vec2_put(out, i, tangent_row(model, i, x, u));
}

/* Nodes that are free, one after another: held nodes cost nothing. Vectors are [n][2], 0 where held. */
typedef struct solver {
    const dem_model *model;
    const double *x;
    dem_index n_free;
    dem_index *free;      /* [n_free] */
    double *scale;        /* [n_free] m/N, about the inverse of the diagonal of K */
    double *direction;    /* p */
    double *image, *rest; /* K p, r */
} solver;

static double product(const solver *s, const double *a, const double *b)
{
    exact_sum sum = {0};
    exact_terms terms;
    exact_terms_begin(&terms, &sum);
    for (dem_index k = 0; k < s->n_free; k++)
        exact_terms_add(&terms, vec2_dot(vec2_at(a, s->free[k]), vec2_at(b, s->free[k])));
    exact_terms_end(&terms);
    return reduce_sum(s->model->ranks, &sum);
}

/* r.z with the preconditioned residual z = r times the scales. */
static double scaled_product(const solver *s)
{
    exact_sum sum = {0};
    exact_terms terms;
    exact_terms_begin(&terms, &sum);
    for (dem_index k = 0; k < s->n_free; k++) {
        const vec2 r = vec2_at(s->rest, s->free[k]);
        exact_terms_add(&terms, s->scale[k] * vec2_dot(r, r));
    }
    exact_terms_end(&terms);
    return reduce_sum(s->model->ranks, &sum);
}

/* u += step p and r -= step K p. */
static void advance(const solver *s, double step, double *u)
{
    for (dem_index k = 0; k < s->n_free; k++) {
        const dem_index i = s->free[k];
        vec2_put(u, i, vec2_along(vec2_at(u, i), step, vec2_at(s->direction, i)));
        vec2_put(s->rest, i, vec2_along(vec2_at(s->rest, i), -step, vec2_at(s->image, i)));
    }
}

/* p = z + ratio p: the new direction is conjugate to the ones before it. */
static void turn(const solver *s, double ratio)
{
    for (dem_index k = 0; k < s->n_free; k++) {
        const dem_index i = s->free[k];
        const vec2 old = vec2_scale(ratio, vec2_at(s->direction, i));
        vec2_put(s->direction, i, vec2_along(old, s->scale[k], vec2_at(s->rest, i)));
    }
}

/* Begins with u = 0, where the residual r is f; ends when |r| is at most `residual`. In exact arithmetic 2 n_free steps
 * are enough. p.K p <= 0 shows that K is not positive definite: the lattice is not stable. */
static dem_status iterate(const solver *s, double residual, double *u)
{
    const dem_index most = 20 * reduce_count(s->model->ranks, s->n_free) + 1000;
    double size = scaled_product(s), previous = 0.0;
    for (dem_index k = 0; product(s, s->rest, s->rest) > residual * residual; k++) {
        CHECK(k < most, DEM_ERROR_MODEL, "the shape of %lld free nodes is not found in %lld iterations",
              (long long)s->n_free, (long long)most);
        turn(s, k > 0 ? size / previous : 0.0);
        for (dem_index j = 0; j < s->n_free; j++)
            vec2_put(s->image, s->free[j], tangent_row(s->model, s->free[j], s->x, s->direction));
        const double curvature = product(s, s->direction, s->image);
        /* p.K p is twice the energy that the displacement p takes. */
        CHECK(curvature > 0.0, DEM_ERROR_MODEL,
              "the lattice is not stable: a displacement of %lld free nodes takes no energy", (long long)s->n_free);
        advance(s, size / curvature, u);
        previous = size;
        size = scaled_product(s);
    }
    return DEM_OK;
}

/* Lists the free nodes and their scales: 2 over the trace of an approximate diagonal block of K, m/N. f is moved from u
 * to the residual, and u begins at 0. */
static void fill(solver *s, const unsigned char *held, double *u)
{
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++) {
        const sym2 bonds = springs_block(&s->model->springs, s->model->springs.stiffness_of, i, s->x);
        const sym2 areas = triangles_block(&s->model->triangles, i, s->x);
        const double trace = bonds.xx + bonds.yy + areas.xx + areas.yy;
        if (!held[i]) {
            s->free[s->n_free] = i;
            s->scale[s->n_free++] = trace > 0.0 ? 2.0 / trace : 1.0;
            vec2_put(s->rest, i, vec2_at(u, i));
        }
        vec2_put(u, i, (vec2){0.0, 0.0});
    }
}

dem_status tangent_solve(const dem_model *model, const double *x, const unsigned char *held, double residual, double *u)
{
    const dem_index n = model->lattice.n_nodes;
    dem_status status = DEM_OK;
    solver s = {.model = model,
                .x = x,
                .free = lattice_zeros(n, sizeof *s.free),
                .scale = lattice_zeros(n, sizeof *s.scale),
                .direction = lattice_zeros(n, 2 * sizeof *s.direction),
                .image = lattice_zeros(n, 2 * sizeof *s.image),
                .rest = lattice_zeros(n, 2 * sizeof *s.rest)};
    if (s.free && s.scale && s.direction && s.image && s.rest) {
        fill(&s, held, u);
        status = iterate(&s, residual, u);
    } else {
        status = status_fail(DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)n);
    }
    free(s.free);
    free(s.scale);
    free(s.direction);
    free(s.image);
    free(s.rest);
    return status;
}
