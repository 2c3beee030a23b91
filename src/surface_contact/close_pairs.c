/* SPDX-License-Identifier: BSD-3-Clause */
/* Chooses the close pairs, and says how long they hold. The distance of two points changes by no more than they move
 * relative to each other, and along straight lines they move by no more than at one of the ends. */
#include "surface_contact/close_pairs.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

void close_pairs_create(close_pairs *out, const contact_surface *of, const pair_rows *candidates)
{
    *out = (close_pairs){.ways.surface = of, .apart = {.surface = of, .of = candidates}};
}

void close_pairs_destroy(close_pairs *c)
{
    surface_ways_destroy(&c->ways);
    surface_ways_destroy(&c->apart);
    free(c->list);
    *c = (close_pairs){0};
}

void close_pairs_clear(close_pairs *c)
{
    c->chosen = false;
    c->n = 0;
    surface_ways_clear(&c->ways);
    surface_ways_clear(&c->apart);
}

/* What is no candidate is beyond the thickness. */
static void take_close(close_pairs *c, double margin, const double *x)
{
    const pair_rows *candidates = c->apart.of;
    const double least = c->ways.surface->least.thickness;
    double square = least * least;
    c->n = 0;
    for (dem_index k = 0; k < candidates->n; k++) {
        const contact_pair *p = &candidates->list[k];
        const double gap = contact_pair_square_gap(p, x), reach = p->thickness + margin;
        square = gap < square ? gap : square;
        if (gap <= reach * reach) c->list[c->n++] = *p;
    }
    c->least = sqrt(square);
}

dem_status close_pairs_choose(close_pairs *c, double margin, const double *x)
{
    const contact_surface *of = c->ways.surface;
    const pair_rows *candidates = c->apart.of;
    c->chosen = false;
    c->n = 0;
    c->margin = margin;
    TRY(surface_ways_note(&c->ways, contact_surface_reach(of) + margin, x));
    if (c->n_linked != candidates->n_linked) surface_ways_clear(&c->apart);
    c->n_linked = candidates->n_linked;
    TRY(surface_ways_note(&c->apart, contact_surface_reach(of) + margin, x));
    CHECK(grow_array((void **)&c->list, &c->capacity, candidates->n, sizeof *c->list), DEM_ERROR_MEMORY,
          "out of memory for %lld contact pairs", (long long)candidates->n);
    take_close(c, margin, x);
    c->chosen = true;
    c->n_chosen++;
    return DEM_OK;
}

bool close_pairs_hold(const close_pairs *c, const double *x)
{
    return c->chosen && surface_ways_within(&c->ways, c->margin, x);
}

bool close_pairs_stay_apart(const close_pairs *c, const double *x0, const double *x1)
{
    const double most = 0.99 * c->least; /* a bit less, for rounding */
    return c->chosen && surface_ways_within(&c->apart, most, x1) && surface_ways_within(&c->apart, most, x0);
}
