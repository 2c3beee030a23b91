/* SPDX-License-Identifier: BSD-3-Clause */
/* What is doubtful about a run before it begins, as warnings of its log. */
#ifndef DEM_DOUBTS_H
#define DEM_DOUBTS_H

#include "deck.h"
#include "run_log.h"

/** Warns of bodies that are too light, or whose walls are too thin, for their lattice. */
void doubts_of_lattices(run_log *log, const deck *d);

/** Warns of restitution and of a law of friction that do not act on rigid bodies. */
void doubts_of_rigid(run_log *log, const deck *d);

/** Warns where bodies with triangles do not touch each other because of bodies without. */
void doubts_of_surfaces(run_log *log, const deck *d, const dem_simulation *simulation);

/** Warns where bodies may break, and touch others but not themselves: so do not their pieces. */
void doubts_of_pieces(run_log *log, const deck *d, const dem_simulation *simulation);

/** Warns of a fixed step with which the run may overflow. */
void doubts_of_step(run_log *log, const dem_simulation *simulation);

/** Warns of bodies that overlap at t = 0. */
void doubts_of_overlap(run_log *log, const dem_simulation *simulation);

/** Warns of bodies that are pressed together at t = 0, or rigid ones against an obstacle, with much energy beside that
 *  of their motion. */
void doubts_of_pressing(run_log *log, const dem_simulation *simulation);

/** Warns if a body comes to the obstacles fast for the waves in it.
 *  \param number  of its group in the deck, from 0
 *  \param wave_speed  m/s, of long waves */
void doubts_of_speed(run_log *log, const dem_model *model, const lattice_body *body, dem_index number,
                     double wave_speed);

#endif
