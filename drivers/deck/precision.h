/* SPDX-License-Identifier: BSD-3-Clause */
/* Tolerances that rounding would hide. */
#ifndef DEM_PRECISION_H
#define DEM_PRECISION_H

#include <dem/dem.h>

#include "schema.h"

/* Reports the keys of &contact and &solver that ask for less than what rounding makes of places and speeds. */
void precision_check(const schema_deck *groups, const dem_lattice *lattice, namelist_errors *errors);

#endif
