/* SPDX-License-Identifier: BSD-3-Clause */
/* A canvas that keeps what is drawn on it, for tests to look at. */
#ifndef DEM_TEST_CANVAS_SPY_H
#define DEM_TEST_CANVAS_SPY_H

#include "unit/close.h"

#include <stdio.h>
#include <string.h>

#include "canvas.h"

enum { CANVAS_SPY_LABELS = 80, CANVAS_SPY_TEXT = 120 };

typedef struct canvas_spy {
    canvas face;
    int depth, groups;             /* parts that are open, and all */
    char attributes[400];          /* of the last part but those with a class */
    size_t strokes, fills, images; /* shapes */
    box stroked, filled;
    double width; /* of the last pen */
    colour inks[8];
    size_t n_inks; /* one after the other; the first eight are kept */
    int n_labels;
    canvas_label label[CANVAS_SPY_LABELS]; /* but for their texts, which are these */
    char text[CANVAS_SPY_LABELS][CANVAS_SPY_TEXT];
    canvas_image image; /* size of the last */
    size_t opaque;      /* its pixels */
} canvas_spy;

static inline void canvas_spy_begin(canvas *c, const char *attributes, const box *clip)
{
    canvas_spy *s = (canvas_spy *)c;
    (void)clip;
    s->depth++, s->groups++;
    if (strncmp(attributes, "class", 5) != 0) (void)snprintf(s->attributes, sizeof s->attributes, "%s", attributes);
}

static inline void canvas_spy_end(canvas *c)
{
    ((canvas_spy *)c)->depth--;
}

static inline void canvas_spy_ink(canvas_spy *s, colour ink)
{
    if (s->n_inks < 8) s->inks[s->n_inks] = ink;
    s->n_inks++;
}

static inline void canvas_spy_strokes(canvas *c, canvas_pen pen, size_t corners, size_t n, const double *xy)
{
    canvas_spy *s = (canvas_spy *)c;
    s->strokes += n;
    s->width = pen.width;
    s->stroked = box_join(s->stroked, box_around((long)(n * corners), xy));
    canvas_spy_ink(s, pen.ink);
}

static inline void canvas_spy_fills(canvas *c, colour ink, size_t corners, size_t n, const double *xy)
{
    canvas_spy *s = (canvas_spy *)c;
    s->fills += n;
    s->filled = box_join(s->filled, box_around((long)(n * corners), xy));
    canvas_spy_ink(s, ink);
}

static inline void canvas_spy_write(canvas *c, const canvas_label *label)
{
    canvas_spy *s = (canvas_spy *)c;
    assert_true(s->n_labels < CANVAS_SPY_LABELS);
    s->label[s->n_labels] = *label;
    (void)snprintf(s->text[s->n_labels], CANVAS_SPY_TEXT, "%s", label->text);
    s->n_labels++;
}

static inline void canvas_spy_image(canvas *c, box place, const canvas_image *image)
{
    canvas_spy *s = (canvas_spy *)c;
    (void)place;
    s->images++;
    s->image = *image;
    s->opaque = 0;
    for (size_t k = 0; k < (size_t)image->width * (size_t)image->height; k++) s->opaque += image->argb[k] >> 24 == 255;
}

static inline canvas_spy canvas_spy_new(void)
{
    return (canvas_spy){.face = {canvas_spy_begin, canvas_spy_end, canvas_spy_strokes, canvas_spy_fills,
                                 canvas_spy_write, canvas_spy_image, NULL},
                        .stroked = box_empty(),
                        .filled = box_empty()};
}

/** The box that a label takes, about. */
static inline box canvas_spy_label_box(const canvas_spy *s, int k)
{
    const canvas_label *l = &s->label[k];
    const double length = canvas_length(s->text[k], l->size), before = 0.5 * (double)l->anchor * length;
    if (l->upright) return (box){l->x - 0.8 * l->size, l->y - length + before, l->x + 0.2 * l->size, l->y + before};
    return (box){l->x - before, l->y - 0.8 * l->size, l->x - before + length, l->y + 0.2 * l->size};
}

/** No two labels lie on each other, and none leaves the picture. */
static inline void canvas_spy_expect_legible(const canvas_spy *s, box picture)
{
    for (int k = 0; k < s->n_labels; k++) {
        const box b = canvas_spy_label_box(s, k);
        if (b.x0 < picture.x0 || b.x1 > picture.x1 || b.y0 < picture.y0 || b.y1 > picture.y1)
            fail_msg("'%s' leaves the picture", s->text[k]);
        for (int i = 0; i < k; i++)
            if (box_meets(b, canvas_spy_label_box(s, i))) fail_msg("'%s' lies on '%s'", s->text[k], s->text[i]);
    }
}

#endif
