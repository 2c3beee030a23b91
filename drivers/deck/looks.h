/* SPDX-License-Identifier: BSD-3-Clause */
/* How often a run is looked at, by rows of the history and for peaks, where its deck does not say. */
#ifndef DEM_LOOKS_H
#define DEM_LOOKS_H

#include "deck.h"

enum { LOOKS_FEW_STEPS = 4 }; /* from look to look at the peaks of bodies of few nodes */

/** Time between rows of the history, s, at least; 0: every accepted step has one.
 *  \param step  s, the longest of the run; infinite where it is unknown */
double looks_row_interval(dem_method method, double nodes, double step);

/** Accepted steps from one look at peaks to the next. */
dem_index looks_peak_every(dem_method method, double nodes);

/** Chooses what the deck leaves open, for the run of a simulation. */
void looks_settle(deck *d, const dem_simulation *simulation);

#endif
