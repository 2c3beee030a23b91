/* SPDX-License-Identifier: BSD-3-Clause */
/* See field.h. */
#include "field.h"
#include "harness/cleanup_gsl.h"

dem_status field_act(void *context, const dem_force_query *q, double *force)
{
    field *f = context;
    f->calls++;
    f->alone += q->n == 1;
    const int fails = f->calls == f->fails_at || (q->n == 1 && f->alone == f->fails_at_alone);
    for (dem_index k = 0; k < q->n; k++) {
        const double *x = q->x + 2 * k, *v = q->v + 2 * k, turned[2] = {-v[1], v[0]};
        for (int e = 0; e < 2; e++)
            force[2 * k + e] =
                f->mass * (f->a[e] + f->b[e][0] * (x[0] - f->c[0]) + f->b[e][1] * (x[1] - f->c[1]) - f->d * v[e] +
                           f->w * turned[e] + f->f[e] * cos(f->o * q->t + (double)q->nodes[k]));
    }
    if (fails && f->status == DEM_OK) force[2 * q->n - 1] = NAN;
    return fails ? f->status : DEM_OK;
}

double field_uniform(gsl_rng *rng, double most)
{
    return most * (2.0 * gsl_rng_uniform(rng) - 1.0);
}

void field_random(field *f, const scene *sc, unsigned long seed)
{
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(rng);
    gsl_rng_set(rng, seed);
    *f = (field){.d = gsl_rng_uniform(rng) * 200.0, .w = field_uniform(rng, 1000.0), .o = field_uniform(rng, 1e4)};
    for (dem_index i = 0; i < sc->body.n_nodes; i++) f->mass += sc->body.mass[i] / (double)sc->body.n_nodes;
    for (int e = 0; e < 2; e++) {
        f->a[e] = field_uniform(rng, 1000.0);
        f->f[e] = field_uniform(rng, 1000.0);
        f->c[e] = sc->body.x[e];
        for (int g = 0; g < 2; g++) f->b[e][g] = field_uniform(rng, 5e4);
    }
}
