/* SPDX-License-Identifier: BSD-3-Clause */
/* Decks and logs have degrees, the library has radians. */
#ifndef DEM_ANGLE_H
#define DEM_ANGLE_H

static const double angle_degree = 3.14159265358979323846 / 180.0; /* rad */

#endif
