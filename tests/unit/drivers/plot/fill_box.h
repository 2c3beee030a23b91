/* SPDX-License-Identifier: BSD-3-Clause */
/* A filled rectangle on a canvas: for tests. */
#ifndef DEM_TESTS_FILL_BOX_H
#define DEM_TESTS_FILL_BOX_H

#include "canvas.h"

static inline void fill_box(canvas *c, colour ink, box b)
{
    const double corners[] = {b.x0, b.y0, b.x1, b.y0, b.x1, b.y1, b.x0, b.y1};
    c->fills(c, ink, 4, 1, corners);
}

#endif
