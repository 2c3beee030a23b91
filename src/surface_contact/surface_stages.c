/* SPDX-License-Identifier: BSD-3-Clause */
/* The twos of a group are in the order of nodes, and bodies have consecutive ones, so that few groups have any in a
 * range, and those are found by bisection. */
#include "surface_contact/surface_stages.h"

#include <stdlib.h>
#include <string.h>

enum { TWO = 4 /* numbers */ };

void surface_stages_destroy(surface_stages *s)
{
    free(s->x);
    free(s->at);
    *s = (surface_stages){0};
}

bool surface_stages_begin(surface_stages *s, const surface_ways *w, int n_stages)
{
    const dem_index n = w->begin[w->n_groups];
    if (s->n == n && s->n_stages >= n_stages) return true;
    surface_stages_destroy(s);
    s->x = malloc(((size_t)n * (size_t)n_stages * TWO + 1) * sizeof *s->x);
    s->at = malloc(((size_t)n + 1) * sizeof *s->at);
    if (s->x == NULL || s->at == NULL) {
        surface_stages_destroy(s);
        return false;
    }
    s->n = n;
    s->n_stages = n_stages;
    for (dem_index k = 0; k < n; k++) s->at[k] = TWO * k;
    return true;
}

/* The first two from k on, before `end`, of a node from `node` on. */
static dem_index first_from(const surface_ways *w, dem_index k, dem_index end, dem_index node)
{
    while (k < end) {
        const dem_index middle = k + (end - k) / 2;
        if (w->at[middle] < vec2_row(node))
            k = middle + 1;
        else
            end = middle;
    }
    return k;
}

void surface_stages_take(surface_stages *s, const surface_ways *w, int stage, const dem_index range[2], const double *x)
{
    double *to = s->x + TWO * stage * s->n;
    for (int g = 0; g < w->n_groups; g++) {
        const dem_index begin = w->begin[g], end = w->begin[g + 1];
        if (begin == end || w->at[end - 1] < vec2_row(range[0]) || w->at[begin] >= vec2_row(range[1])) continue;
        for (dem_index k = first_from(w, begin, end, range[0]); k < end && w->at[k] < vec2_row(range[1]); k++)
            memcpy(to + TWO * k, x + w->at[k], TWO * sizeof *to);
    }
}

bool surface_stages_within(const surface_stages *s, const surface_ways *w, int stage, double most)
{
    return surface_ways_within_at(w, most, s->x + TWO * stage * s->n, s->at);
}
