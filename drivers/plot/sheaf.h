/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes of as many corners each, sorted by colour: those of one colour are drawn at once, the larger values on top. */
#ifndef DEM_SHEAF_H
#define DEM_SHEAF_H

#include "canvas.h"

typedef struct sheaf {
    size_t n, corners;
    double *xy;           /* [n][corners][2] pixels */
    unsigned char *shade; /* [n] place in a palette */
} sheaf;

/** Empty, with room for `most`; n is counted up by who fills it. False without memory. To be freed. */
bool sheaf_create(sheaf *s, size_t most, size_t corners);
void sheaf_free(sheaf *s);

/** As lines of that width; as filled polygons if it is 0. False without memory. */
bool sheaf_draw(const sheaf *s, const palette *colours, double width, canvas *c);

#endif
