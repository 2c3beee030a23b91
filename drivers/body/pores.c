/* SPDX-License-Identifier: BSD-3-Clause */
/* Random sequential addition, largest first. Uniform radii and all centres come by IEEE operations and square roots; of
 * the others, which need a libm, its last digits are rounded away. */
#include "pores.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

static const int max_tries = 100000;
static const double pi = 3.14159265358979323846;

static bool is_positive(double x)
{
    return x > 0.0 && isfinite(x);
}

static bool is_sound(const pores_recipe *r)
{
    const bool box = r->box[0] <= r->box[2] && r->box[1] <= r->box[3] && isfinite(r->box[2] - r->box[0]) &&
                     isfinite(r->box[3] - r->box[1]);
    const bool shaped = r->distribution == PORES_UNIFORM || (is_positive(r->mean) && is_positive(r->deviation));
    return box && shaped && r->number <= PORES_MAX && r->area >= 0.0 && isfinite(r->area) && r->radius_min > 0.0 &&
           r->radius_min <= r->radius_max && isfinite(r->radius_max) && r->wall >= 0.0 && isfinite(r->wall);
}

/* ---- radii ---- */

static double draw_any(gsl_rng *rng, const pores_recipe *r)
{
    if (r->distribution == PORES_UNIFORM) return r->radius_min + (r->radius_max - r->radius_min) * gsl_rng_uniform(rng);
    if (r->distribution == PORES_NORMAL) return (float)(r->mean + gsl_ran_gaussian(rng, r->deviation));
    const double ratio = r->deviation / r->mean, variance = log1p(ratio * ratio); /* of the logarithm */
    return (float)gsl_ran_lognormal(rng, log(r->mean) - 0.5 * variance, sqrt(variance));
}

/* Between the smallest and the largest; false if that is too rare. */
static bool draw(double *radius, gsl_rng *rng, const pores_recipe *r)
{
    for (int k = 0; k < max_tries; k++) {
        *radius = draw_any(rng, r);
        if (*radius >= r->radius_min && *radius <= r->radius_max) return true;
    }
    return false;
}

/* Whether one more pore brings the area nearer to what it shall be. */
static bool is_wanted(const pores_recipe *r, size_t n, double area, double radius)
{
    return r->number > 0 ? n < r->number : area + 0.5 * pi * radius * radius <= r->area;
}

static pores_status draw_all(pores *out, gsl_rng *rng, const pores_recipe *r)
{
    double area = 0.0, radius = r->radius_min;
    while (r->number == 0 || out->n < r->number) {
        if (!draw(&radius, rng, r)) return PORES_RARE;
        if (!is_wanted(r, out->n, area, radius)) break;
        if (out->n == PORES_MAX) return PORES_TOO_MANY;
        out->list[out->n++].radius = radius;
        area += pi * radius * radius;
    }
    return PORES_PLACED;
}

/* ---- places ---- */

static int by_falling_radius(const void *a, const void *b)
{
    const double ra = ((const pore *)a)->radius, rb = ((const pore *)b)->radius;
    return (ra < rb) - (ra > rb);
}

static bool is_admissible(const pore *list, size_t n, double wall, pores_region fits, void *context)
{
    const pore *p = list + n;
    for (size_t k = 0; k < n; k++) {
        const double dx = p->centre[0] - list[k].centre[0], dy = p->centre[1] - list[k].centre[1];
        if (sqrt(dx * dx + dy * dy) < p->radius + list[k].radius + wall) return false;
    }
    return fits(context, p->centre, p->radius + wall);
}

static bool place_next(pore *list, size_t n, gsl_rng *rng, const pores_recipe *r, pores_region fits, void *context)
{
    for (int k = 0; k < max_tries; k++) {
        for (int c = 0; c < 2; c++) list[n].centre[c] = r->box[c] + (r->box[c + 2] - r->box[c]) * gsl_rng_uniform(rng);
        if (is_admissible(list, n, r->wall, fits, context)) return true;
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

pores_status pores_place(pores *out, const pores_recipe *recipe, pores_region fits, void *context)
{
    *out = (pores){0};
    if (!is_sound(recipe)) return PORES_UNSOUND;
    pores p = {.list = calloc(recipe->number > 0 ? recipe->number : PORES_MAX, sizeof *p.list)};
    gsl_rng *rng = make_generator(recipe->seed);
    pores_status status = p.list != NULL && rng != NULL ? draw_all(&p, rng, recipe) : PORES_MEMORY;
    if (status == PORES_PLACED) {
        qsort(p.list, p.n, sizeof *p.list, by_falling_radius);
        while (p.n_placed < p.n && place_next(p.list, p.n_placed, rng, recipe, fits, context)) p.n_placed++;
        status = p.n_placed == p.n ? PORES_PLACED : PORES_CROWDED;
        *out = p;
    } else {
        free(p.list);
    }
    gsl_rng_free(rng);
    return status;
}
