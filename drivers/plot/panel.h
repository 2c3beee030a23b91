/* SPDX-License-Identifier: BSD-3-Clause */
/* One frame, drawn in its place in the picture. */
#ifndef DEM_PANEL_H
#define DEM_PANEL_H

#include "canvas.h"
#include "outcome.h"
#include "snapshot.h"

/** How all panels of a picture are drawn. */
typedef struct panel_look {
    const palette *colours;
    colour_range range; /* of the colours */
    double thick;       /* of springs, pixels */
    bool is_binned;     /* to pixels */
} panel_look;

enum { PANEL_BINNED_FROM = 50000 }; /* springs */

/** What is seen in metres, and where that is in the picture, in pixels, y down; of the same shape. */
typedef struct panel {
    box view, place;
} panel;

double panel_scale(const panel *p); /* pixels per metre */

/** Obstacles, what is seen of the bodies, and a thin frame around. False without memory. */
bool panel_draw(const panel *p, const snapshot *s, const panel_look *look, canvas *c);

/** A width of lines fit for springs of that length, pixels. */
double panel_thickness(double length);

#endif
