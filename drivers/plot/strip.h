/* SPDX-License-Identifier: BSD-3-Clause */
/* The layout of a film strip: panels of one shape in rows, times above them, what colours and lengths mean below. */
#ifndef DEM_STRIP_H
#define DEM_STRIP_H

#include <stddef.h>

#include <dem/dem.h>

#include "panel.h"

typedef struct strip {
    size_t n, columns, rows;
    double width, height; /* of the picture, pixels, even */
    double across, down;  /* of a panel */
    box view;             /* of all panels, m, of their shape */
} strip;

/** \param n        panels, > 0
 *  \param view     what they show at least, m; not empty
 *  \param width    of the picture, pixels
 *  \param columns  0: as few as make a picture that is no higher than three quarters of its width; more than have
 *                 room are not taken */
strip strip_plan(size_t n, box view, double width, size_t columns);

panel strip_panel(const strip *s, size_t k);

/** Places for what stands below the panels: the bar of the colours, and the left end of the bar of the scale, from
 *  x0, y0 to x1. */
box strip_colours(const strip *s);
box strip_scale(const strip *s);

/** What is to be seen of the bodies. */
box strip_view(box bodies);

/** A view with what of an obstacle lies near the bodies. */
box strip_view_with(box view, box bodies, const dem_obstacle *obstacle);

/** A view of the bodies, in all frames, with what of all obstacles lies near them. */
box strip_view_of_all(box bodies, const dem_reader *reader);

#endif
