/* SPDX-License-Identifier: BSD-3-Clause */
/* Positions of a surface at the stages of a step, which are known band by band and gone when the step is complete. Here
 * is kept of them what surface ways ask for, so that it can be judged in the end whether bodies have come near each
 * other at any stage. */
#ifndef DEM_SURFACE_CONTACT_SURFACE_STAGES_H
#define DEM_SURFACE_CONTACT_SURFACE_STAGES_H

#include "surface_contact/surface_ways.h"

typedef struct surface_stages {
    dem_index n;   /* twos of the ways */
    int n_stages;  /* for which there is room */
    double *x;     /* [n_stages][n][2][2] m */
    dem_index *at; /* [n] where in those of a stage a two is */
} surface_stages;

/** Free with surface_stages_destroy(). */
void surface_stages_destroy(surface_stages *s);

/** Makes room for so many stages of a surface whose state has been noted.  \return whether there is memory */
bool surface_stages_begin(surface_stages *s, const surface_ways *w, int n_stages);

/** Takes the nodes `first` to `end` - 1 out of x [n][2], and those next to them in memory. Threads may do so with other
 *  nodes or another stage at the same time. */
void surface_stages_take(surface_stages *s, const surface_ways *w, int stage, const dem_index range[2],
                         const double *x);

/** surface_ways_within() of a stage of which all nodes have been taken. */
bool surface_stages_within(const surface_stages *s, const surface_ways *w, int stage, double most);

#endif
