/* SPDX-License-Identifier: BSD-3-Clause */
/* Random sequential addition, largest first. IEEE operations and square roots only: no digit depends on a libm. */
#include "pores.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>

static const int max_tries = 100000;

static bool is_sound(const pores_recipe *r)
{
    const bool box = r->box[0] <= r->box[2] && r->box[1] <= r->box[3] && isfinite(r->box[2] - r->box[0]) &&
                     isfinite(r->box[3] - r->box[1]);
    return box && r->number <= PORES_MAX && r->radius_min > 0.0 && r->radius_min <= r->radius_max &&
           isfinite(r->radius_max) && r->wall >= 0.0 && isfinite(r->wall);
}

static int by_falling_radius(const void *a, const void *b)
{
    const double ra = ((const pore *)a)->radius, rb = ((const pore *)b)->radius;
    return (ra < rb) - (ra > rb);
}

static bool is_admissible(const pore *list, size_t n, double wall, pores_region region, void *context)
{
    const pore *p = list + n;
    for (size_t k = 0; k < n; k++) {
        const double dx = p->centre[0] - list[k].centre[0], dy = p->centre[1] - list[k].centre[1];
        if (sqrt(dx * dx + dy * dy) < p->radius + list[k].radius + wall) return false;
    }
    return region(context, p->centre) >= p->radius + wall;
}

static bool place_next(pore *list, size_t n, gsl_rng *rng, const pores_recipe *r, pores_region region, void *context)
{
    for (int k = 0; k < max_tries; k++) {
        for (int c = 0; c < 2; c++) list[n].centre[c] = r->box[c] + (r->box[c + 2] - r->box[c]) * gsl_rng_uniform(rng);
        if (is_admissible(list, n, r->wall, region, context)) return true;
    }
    return false;
}

/* GSL's handler would end the process where memory runs out. */
static gsl_rng *make_generator(unsigned long seed)
{
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_set_error_handler(handler);
    if (rng != NULL) gsl_rng_set(rng, seed);
    return rng;
}

dem_status pores_place(pore *out, size_t *n_placed, const pores_recipe *recipe, pores_region region, void *context)
{
    size_t n = 0;
    if (!is_sound(recipe)) return DEM_ERROR_ARGUMENT;
    gsl_rng *rng = make_generator(recipe->seed);
    if (rng == NULL) return DEM_ERROR_MEMORY;
    for (size_t k = 0; k < recipe->number; k++)
        out[k].radius = recipe->radius_min + (recipe->radius_max - recipe->radius_min) * gsl_rng_uniform(rng);
    qsort(out, recipe->number, sizeof *out, by_falling_radius);
    while (n < recipe->number && place_next(out, n, rng, recipe, region, context)) n++;
    gsl_rng_free(rng);
    *n_placed = n;
    return n == recipe->number ? DEM_OK : DEM_ERROR_MODEL;
}
