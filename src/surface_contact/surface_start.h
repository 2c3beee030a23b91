/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether surfaces may start where they are: they must neither cross nor touch. */
#ifndef DEM_SURFACE_CONTACT_SURFACE_START_H
#define DEM_SURFACE_CONTACT_SURFACE_START_H

#include "surface_contact/surface_contact.h"

/** Called after surface_contact_follow() with the same x [n][2].
 *  \return DEM_ERROR_MODEL with nodes, bodies, place and depth; DEM_ERROR_MEMORY */
dem_status surface_start_check(surface_contact *c, const double *x);

#endif
