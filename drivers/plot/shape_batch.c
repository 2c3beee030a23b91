/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape_batch.h"

#include <stdlib.h>
#include <string.h>

bool shape_batch_create(shape_batch *s, size_t most, size_t corners)
{
    *s = (shape_batch){0, corners, malloc((most + 1) * corners * 2 * sizeof *s->xy), malloc(most + 1)};
    if (s->xy != NULL && s->shade != NULL) return true;
    shape_batch_free(s);
    return false;
}

void shape_batch_free(shape_batch *s)
{
    free(s->xy);
    free(s->shade);
    *s = (shape_batch){0};
}

/* From the colour of 0 outwards: both ways of a diverging palette, else to its other end. */
static int shade_at(palette_kind kind, int rank)
{
    if (kind == PALETTE_LOWER) return PALETTE_SIZE - 1 - rank;
    if (kind != PALETTE_DIVERGING) return rank;
    const int out = (rank + 1) / 2;
    return PALETTE_SIZE / 2 + (rank % 2 == 0 ? out : -out);
}

/* A sort by counting. \param[out] begin  [PALETTE_SIZE + 1] where each shade begins in xy */
static void sort(const shape_batch *s, size_t *begin, double *xy)
{
    const size_t wide = 2 * s->corners;
    size_t next[PALETTE_SIZE];
    memset(begin, 0, (PALETTE_SIZE + 1) * sizeof *begin);
    for (size_t k = 0; k < s->n; k++) begin[s->shade[k] + 1]++;
    for (int k = 0; k < PALETTE_SIZE; k++) {
        next[k] = begin[k];
        begin[k + 1] += begin[k];
    }
    for (size_t k = 0; k < s->n; k++) memcpy(xy + wide * next[s->shade[k]]++, s->xy + wide * k, wide * sizeof *xy);
}

bool shape_batch_draw(const shape_batch *s, const palette *colours, double width, canvas *c)
{
    size_t begin[PALETTE_SIZE + 1];
    double *xy = malloc((s->n + 1) * 2 * s->corners * sizeof *xy);
    if (xy == NULL) return false;
    sort(s, begin, xy);
    for (int rank = 0; rank < PALETTE_SIZE; rank++) {
        const int shade = shade_at(colours->kind, rank);
        const size_t n = begin[shade + 1] - begin[shade];
        const double *first = xy + 2 * s->corners * begin[shade];
        if (n > 0 && width > 0.0) c->strokes(c, (canvas_pen){colours->of[shade], width}, s->corners, n, first);
        if (n > 0 && width == 0.0) c->fills(c, colours->of[shade], s->corners, n, first);
    }
    free(xy);
    return true;
}
