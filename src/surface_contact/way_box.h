/* SPDX-License-Identifier: BSD-3-Clause */
/* The box of the ways that points have moved: its diagonal is the most by which two of them have moved relative to each
 * other. It is asked for at every evaluation of the forces, so it has vector instructions of its own. */
#ifndef DEM_SURFACE_CONTACT_WAY_BOX_H
#define DEM_SURFACE_CONTACT_WAY_BOX_H

#include "base/box.h"

/** Of the ways of n twos of points, from from[4 k] to x[at[k]] and from from[4 k + 2] to x[at[k] + 2], each with the
 *  component behind it. A coordinate that is not a number is passed over. The bits do not depend on the machine. */
box way_box_of(const double *x, const dem_index *at, const double *from, dem_index n);

#endif
