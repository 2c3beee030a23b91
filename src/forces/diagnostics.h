/* SPDX-License-Identifier: BSD-3-Clause */
/* What is measured on a state: energies, powers, mean motions, strains. Sums are exact: they do not depend on the order
 * of their terms. */
#ifndef DEM_FORCES_DIAGNOSTICS_H
#define DEM_FORCES_DIAGNOSTICS_H

#include "forces/forces.h"

/** Kinetic, elastic, area, guard, contact and gravity energy of positions x and velocities v [n][2]; the other entries
 *  are 0. */
dem_energy diagnostics_energy(const forces *f, const double *x, const double *v);

dem_body_motion diagnostics_body(const dem_model *model, dem_index body, const double *x, const double *v);

dem_strain diagnostics_strain(const forces *f, const double *x);

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

#endif
