/* SPDX-License-Identifier: BSD-3-Clause */
/* A small body that meets all kinds of contacts, for runs that have to be the same in another frame of reference. */
#ifndef DEM_TEST_VIEW_H
#define DEM_TEST_VIEW_H

#include <dem/dem.h>

typedef struct view {
    const char *name;
    dem_obstacle ground[2];
    dem_index n;
    double height, tilt, velocity[2], gravity, t_end; /* tilt: rad */
} view;

enum { VIEWS = 7 };
extern const view views[VIEWS];

/** A rubber block of 20 x 25 mm, 5 mm apart, turned by the tilt, at the height, with the velocity. */
void view_make_body(dem_lattice *out, const view *v);

#endif
