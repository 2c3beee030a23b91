/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes of as many corners each, sorted by colour: those of one colour are drawn at once, the larger values on top. */
#ifndef DEM_SHAPE_BATCH_H
#define DEM_SHAPE_BATCH_H

#include "canvas.h"

typedef struct shape_batch {
    size_t n, corners;
    double *xy;           /* [n][corners][2] pixels */
    unsigned char *shade; /* [n] place in a palette */
} shape_batch;

/** Empty, with room for `most`; n is counted up by who fills it. False without memory. To be freed. */
bool shape_batch_create(shape_batch *s, size_t most, size_t corners);
void shape_batch_free(shape_batch *s);

/** As lines of that width; as filled polygons if it is 0. False without memory. */
bool shape_batch_draw(const shape_batch *s, const palette *colours, double width, canvas *c);

#endif
