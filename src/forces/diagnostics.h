/* SPDX-License-Identifier: BSD-3-Clause */
/* What is measured on a state besides what survey.h measures of all nodes: energy of contact, reactions of obstacles
 * and boundary conditions, residual, the largest speed. */
#ifndef DEM_FORCES_DIAGNOSTICS_H
#define DEM_FORCES_DIAGNOSTICS_H

#include "forces/survey.h"

/** Kinetic, elastic, area, guard, contact and gravity energy of positions x and velocities v [n][2]; the other entries
 *  are 0.  \param s  whose last survey was of this state */
dem_energy diagnostics_energy(const forces *f, const survey *s, const double *x, const double *v);

/** Resultant of the contacts that are on an obstacle, where it acts, and their number; no impulses. */
dem_obstacle_load diagnostics_reaction(const dem_contact *list, dem_index n, dem_index obstacle,
                                       const rigid_contact *rigid);

/** What a boundary does to its nodes in a state.
 *  \param external  [n_nodes][2] N, of which those on its nodes are read if it prescribes a motion; NULL: none */
dem_boundary_load diagnostics_boundary(const forces *f, const boundary_condition *b, const double *external,
                                       const double *x, const double *v);

/** Largest force without drag on a node that may move, from accelerations a and velocities v at positions x, over the
 *  largest force of a spring. */
double diagnostics_residual(const forces *f, const double *x, const double *v, const double *a);

/** The largest |v_x| + |v_y|, of velocities v [n][2]. */
double diagnostics_fastest(const dem_model *model, const double *v);

#endif
