/* SPDX-License-Identifier: BSD-3-Clause */
/* A canvas that keeps what is drawn on it, for tests to look at. */
#ifndef DEM_TEST_WITNESS_H
#define DEM_TEST_WITNESS_H

#include "unit/close.h"

#include <stdio.h>
#include <string.h>

#include "canvas.h"

enum { WITNESS_LABELS = 80, WITNESS_TEXT = 120 };

typedef struct witness {
    canvas face;
    int depth, groups;             /* parts that are open, and all */
    char attributes[400];          /* of the last part but those with a class */
    size_t strokes, fills, images; /* shapes */
    box stroked, filled;
    double width; /* of the last pen */
    colour inks[8];
    size_t n_inks; /* one after the other; the first eight are kept */
    int n_labels;
    canvas_label label[WITNESS_LABELS]; /* but for their texts, which are these */
    char text[WITNESS_LABELS][WITNESS_TEXT];
    canvas_image image; /* size of the last */
    size_t opaque;      /* its pixels */
} witness;

static inline void witness_begin(canvas *c, const char *attributes, const box *clip)
{
    witness *s = (witness *)c;
    (void)clip;
    s->depth++, s->groups++;
    if (strncmp(attributes, "class", 5) != 0) (void)snprintf(s->attributes, sizeof s->attributes, "%s", attributes);
}

static inline void witness_end(canvas *c)
{
    ((witness *)c)->depth--;
}

static inline void witness_ink(witness *s, colour ink)
{
    if (s->n_inks < 8) s->inks[s->n_inks] = ink;
    s->n_inks++;
}

static inline void witness_strokes(canvas *c, canvas_pen pen, size_t corners, size_t n, const double *xy)
{
    witness *s = (witness *)c;
    s->strokes += n;
    s->width = pen.width;
    s->stroked = box_join(s->stroked, box_around((long)(n * corners), xy));
    witness_ink(s, pen.ink);
}

static inline void witness_fills(canvas *c, colour ink, size_t corners, size_t n, const double *xy)
{
    witness *s = (witness *)c;
    s->fills += n;
    s->filled = box_join(s->filled, box_around((long)(n * corners), xy));
    witness_ink(s, ink);
}

static inline void witness_write(canvas *c, const canvas_label *label)
{
    witness *s = (witness *)c;
    assert_true(s->n_labels < WITNESS_LABELS);
    s->label[s->n_labels] = *label;
    (void)snprintf(s->text[s->n_labels], WITNESS_TEXT, "%s", label->text);
    s->n_labels++;
}

static inline void witness_image(canvas *c, box place, const canvas_image *image)
{
    witness *s = (witness *)c;
    (void)place;
    s->images++;
    s->image = *image;
    s->opaque = 0;
    for (size_t k = 0; k < (size_t)image->width * (size_t)image->height; k++) s->opaque += image->argb[k] >> 24 == 255;
}

static inline witness witness_new(void)
{
    return (witness){
        .face = {witness_begin, witness_end, witness_strokes, witness_fills, witness_write, witness_image, NULL},
        .stroked = box_empty(),
        .filled = box_empty()};
}

/** The box that a label takes, about. */
static inline box witness_label_box(const witness *s, int k)
{
    const canvas_label *l = &s->label[k];
    const double length = canvas_length(s->text[k], l->size), before = 0.5 * (double)l->anchor * length;
    if (l->upright) return (box){l->x - 0.8 * l->size, l->y - length + before, l->x + 0.2 * l->size, l->y + before};
    return (box){l->x - before, l->y - 0.8 * l->size, l->x - before + length, l->y + 0.2 * l->size};
}

/** No two labels lie on each other, and none leaves the picture. */
static inline void witness_expect_legible(const witness *s, box picture)
{
    for (int k = 0; k < s->n_labels; k++) {
        const box b = witness_label_box(s, k);
        if (b.x0 < picture.x0 || b.x1 > picture.x1 || b.y0 < picture.y0 || b.y1 > picture.y1)
            fail_msg("'%s' leaves the picture", s->text[k]);
        for (int i = 0; i < k; i++)
            if (box_meets(b, witness_label_box(s, i))) fail_msg("'%s' lies on '%s'", s->text[k], s->text[i]);
    }
}

#endif
