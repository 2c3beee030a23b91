/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run takes: estimated from the deck alone, before anything is built, and from what has been built. */
#ifndef DEM_ESTIMATE_H
#define DEM_ESTIMATE_H

#include "deck.h"
#include "limit.h"

typedef struct estimate {
    double nodes, springs; /* about; 0 of bodies of which nothing is known before they are read */
    double cover;          /* nodes of the largest lattice before it is cut to its shape */
    size_t largest;        /* which body's, from 0 */
    double memory;         /* bytes, at least */
    double step, steps;    /* s, at most, infinite where unknown; their number, at least */
    double undamped;       /* s, what the step would be without damping, which has shortened it; 0: it has not */
    double frames;
    double output; /* bytes of frames and tables before they are deflated */
} estimate;

/** From areas, spacings, stiffnesses and densities: takes no time and no memory, however large the numbers are. False
 *  when memory runs out. */
bool estimate_deck(estimate *out, const deck *d);

/** How long a run lasts at least, s: to t_end, or, where it ends at rest, as long as loads grow. */
double estimate_duration(const deck *d);

/** Of what has been built, for a run that lasts so long. */
estimate estimate_run(const deck *d, const dem_simulation *simulation, double duration);

typedef enum estimate_breach { ESTIMATE_KEPT, ESTIMATE_DISK, ESTIMATE_STEPS, ESTIMATE_MEMORY } estimate_breach;

/** Reports, with its place in the deck and the option that sets it, each limit that is exceeded.
 *  \return the last of them in the order above */
estimate_breach estimate_check(const estimate *needed, const limits *most, const deck *d, namelist_errors *errors);

#endif
