/* SPDX-License-Identifier: BSD-3-Clause */
/* The length of material on a horizontal line, integrated over its height by Gauss's rule between the levels where that
 * length may jump or bend. Crossing edges bend it in between. */
#include "shape/area.h"

#include <math.h>
#include <stdlib.h>

#include "base/gauss_rule.h"

static const size_t least_points = 2, most_points = GAUSS_RULE_MOST, all_points = 4096; /* in a panel, in all panels */

typedef struct place {
    double x;
    int of_void; /* 0: of the outline */
    bool enters;
} place;

/* What a slice needs: room, and the shape. */
typedef struct slicer {
    const shape *shape;
    double *cuts;
    place *places;
} slicer;

static int by_x(const void *a, const void *b)
{
    const double x = ((const place *)a)->x, y = ((const place *)b)->x;
    return (x > y) - (x < y);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static size_t add_places(slicer *c, size_t n, size_t n_cuts, int of_void)
{
    for (size_t k = 0; k < n_cuts; k++)
        c->places[n + k] = (place){.x = c->cuts[k], .of_void = of_void, .enters = k % 2 == 0};
    return n + n_cuts;
}

static size_t slice_body(slicer *c, double y)
{
    const shape *s = c->shape;
    if (s->mask.solid == NULL) return outline_slice(&s->outline, y, c->cuts);
    const size_t row = (size_t)fmax(y / s->mask.scale, 0.0);
    return mask_slice(&s->mask, row < s->mask.height ? row : s->mask.height - 1, c->cuts);
}

/* Length of material at height y: within the outline and in none of the voids. */
static double length_at(slicer *c, double y)
{
    int within = 0, voids = 0;
    double length = 0.0;
    size_t n = add_places(c, 0, slice_body(c, y), 0);
    for (size_t k = 0; k < c->shape->n_voids; k++)
        n = add_places(c, n, outline_slice(&c->shape->voids[k], y, c->cuts), 1);
    qsort(c->places, n, sizeof *c->places, by_x);
    for (size_t k = 0; k < n; k++) {
        const place *p = &c->places[k];
        if (k > 0 && within > 0 && voids == 0) length += p->x - c->places[k - 1].x;
        *(p->of_void ? &voids : &within) += p->enters ? 1 : -1;
    }
    return length;
}

/* Levels of outline and voids, and those of rows of pixels. */
static size_t find_levels(double *levels, const slicer *c)
{
    const shape *s = c->shape;
    size_t n = outline_levels(&s->outline, levels);
    for (size_t k = 0; k <= s->mask.height && s->mask.solid != NULL; k++) levels[n++] = (double)k * s->mask.scale;
    for (size_t k = 0; k < s->n_voids; k++) n += outline_levels(&s->voids[k], levels + n);
    qsort(levels, n, sizeof *levels, by_size);
    return n;
}

static double integrate(slicer *c, const double *levels, size_t n_levels, const gauss_rule *rule)
{
    double area = 0.0;
    for (size_t k = 1; k < n_levels; k++) {
        if (levels[k] <= levels[k - 1]) continue;
        const double half = 0.5 * (levels[k] - levels[k - 1]), middle = 0.5 * (levels[k] + levels[k - 1]);
        for (int i = 0; i < rule->n; i++) area += half * rule->weight[i] * length_at(c, middle + half * rule->x[i]);
    }
    return area;
}

static double sliced_area(const shape *s)
{
    size_t room = outline_cuts(&s->outline) + s->mask.width + s->mask.height + 2;
    for (size_t k = 0; k < s->n_voids; k++) room += outline_cuts(&s->voids[k]);
    double *levels = calloc(room, sizeof *levels), *cuts = calloc(room, sizeof *cuts), area = -1.0;
    place *places = calloc(room, sizeof *places);
    slicer c = {.shape = s, .cuts = cuts, .places = places};
    if (levels != NULL && cuts != NULL && places != NULL) {
        const size_t n = find_levels(levels, &c), wanted = all_points / n;
        const size_t taken = wanted > most_points ? most_points : (wanted > least_points ? wanted : least_points);
        const gauss_rule rule = gauss_rule_of((int)taken);
        area = integrate(&c, levels, n, &rule);
    }
    free(levels);
    free(cuts);
    free(places);
    return area;
}

double area_of(const shape *s)
{
    if (s->mask.solid != NULL && s->n_voids == 0) return (double)s->mask.n_solid * (s->mask.scale * s->mask.scale);
    return sliced_area(s);
}
