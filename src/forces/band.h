/* SPDX-License-Identifier: BSD-3-Clause */
/* The accelerations of consecutive nodes when only the positions of the nodes near them are known: of a state that
 * comes into being band by band. For each node they have the bits of kernel_accelerate(). */
#ifndef DEM_FORCES_BAND_H
#define DEM_FORCES_BAND_H

#include "forces/kernel.h"

/** Nodes of a band, but the last: no node depends on others further away. A multiple of LAYOUT_LANES; 0: nodes are
 *  numbered otherwise than in the layout, or there are no blocks. */
dem_index band_nodes(const kernel *k);

/** Numbers of scratch. */
size_t band_scratch(const kernel *k);

/** Begins a step of so many stages from positions x [n_nodes][2]: whether accelerations depend on nothing but the
 *  positions of neighbours, unless surfaces of bodies come near each other. */
bool band_is_possible(kernel *k, const forces *f, const double *x, int n_stages);

/** Whether they have not at any stage, of which all bands have been evaluated. */
bool band_was_possible(const forces *f, int n_stages);

/** Arrays [n_nodes][2], of which x is there in the bands beside this one too, v and a in this one alone. */
typedef struct band {
    dem_index first, end; /* nodes; `first` is a multiple of band_nodes(), `end` too or all nodes */
    bool goes_on;         /* the scratch was last used for the band before, of the same state */
    int stage;            /* of the step */
    bool is_own;          /* no other thread has this band as its own, too, but it may evaluate it */
    const double *x, *v;
    double *a;
    double *scratch; /* zeros at first */
} band;

/** Fills a; threads may do so at the same time.  \return a sum that is not finite if an acceleration is not */
double band_accelerate(const kernel *k, const forces *f, const band *b);

#endif
