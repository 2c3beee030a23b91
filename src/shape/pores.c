/* SPDX-License-Identifier: BSD-3-Clause */
/* Random sequential addition, largest first. Uniform radii and all centres come by IEEE operations and square roots; of
 * the others, which need a libm, its last digits are rounded away. */
#include "shape/pores.h"

#include <math.h>
#include <stdlib.h>

#include "base/mersenne_twister.h"

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
    const bool shaped =
        r->distribution == DEM_PORE_RADII_UNIFORM || (is_positive(r->mean) && is_positive(r->deviation));
    return box && shaped && r->number <= DEM_PORES_MAX && r->area >= 0.0 && isfinite(r->area) && r->radius_min > 0.0 &&
           r->radius_min <= r->radius_max && isfinite(r->radius_max) && r->wall >= 0.0 && isfinite(r->wall);
}

/* ---- radii ---- */

/* Marsaglia's polar method: a random point of the unit disc, times a scale, is two numbers of a normal distribution of
 * the deviation 1. Which of them is taken, and whether 0 is drawn, is so that decks keep the pores that they have had
 * since the first version. */
static double draw_in_disc(double at[2], mersenne_twister *rng, double (*next)(mersenne_twister *rng))
{
    double square;
    do {
        for (int c = 0; c < 2; c++) at[c] = 2.0 * next(rng) - 1.0;
        square = at[0] * at[0] + at[1] * at[1];
    } while (square > 1.0 || square == 0.0);
    return sqrt(-2.0 * log(square) / square);
}

static double draw_any(mersenne_twister *rng, const pores_recipe *r)
{
    if (r->distribution == DEM_PORE_RADII_UNIFORM)
        return r->radius_min + (r->radius_max - r->radius_min) * mersenne_twister_uniform(rng);
    double at[2], scale;
    if (r->distribution == DEM_PORE_RADII_NORMAL) {
        scale = draw_in_disc(at, rng, mersenne_twister_positive);
        return (float)(r->mean + r->deviation * at[1] * scale);
    }
    const double ratio = r->deviation / r->mean, variance = log1p(ratio * ratio); /* of the logarithm */
    scale = draw_in_disc(at, rng, mersenne_twister_uniform);
    return (float)exp(sqrt(variance) * (at[0] * scale) + (log(r->mean) - 0.5 * variance));
}

/* Between the smallest and the largest; false if that is too rare. */
static bool draw(double *radius, mersenne_twister *rng, const pores_recipe *r)
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

static pores_status draw_all(pores *out, mersenne_twister *rng, const pores_recipe *r)
{
    double area = 0.0, radius = r->radius_min;
    while (r->number == 0 || out->n < r->number) {
        if (!draw(&radius, rng, r)) return PORES_RARE;
        if (!is_wanted(r, out->n, area, radius)) break;
        if (out->n == DEM_PORES_MAX) return PORES_TOO_MANY;
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

static bool place_next(pore *list, size_t n, mersenne_twister *rng, const pores_recipe *r, pores_region fits,
                       void *context)
{
    for (int k = 0; k < max_tries; k++) {
        for (int c = 0; c < 2; c++)
            list[n].centre[c] = r->box[c] + (r->box[c + 2] - r->box[c]) * mersenne_twister_uniform(rng);
        if (is_admissible(list, n, r->wall, fits, context)) return true;
    }
    return false;
}

pores_status pores_place(pores *out, const pores_recipe *recipe, pores_region fits, void *context)
{
    *out = (pores){0};
    if (!is_sound(recipe)) return PORES_UNSOUND;
    pores p = {.list = calloc(recipe->number > 0 ? recipe->number : DEM_PORES_MAX, sizeof *p.list)};
    mersenne_twister rng;
    mersenne_twister_start(&rng, recipe->seed);
    pores_status status = p.list != NULL ? draw_all(&p, &rng, recipe) : PORES_MEMORY;
    if (status == PORES_PLACED) {
        qsort(p.list, p.n, sizeof *p.list, by_falling_radius);
        while (p.n_placed < p.n && place_next(p.list, p.n_placed, &rng, recipe, fits, context)) p.n_placed++;
        status = p.n_placed == p.n ? PORES_PLACED : PORES_CROWDED;
        *out = p;
    } else {
        free(p.list);
    }
    return status;
}
