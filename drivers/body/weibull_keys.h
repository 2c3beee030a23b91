/* SPDX-License-Identifier: BSD-3-Clause */
/* The keys of a material whose strengths scatter. */
#ifndef DEM_WEIBULL_KEYS_H
#define DEM_WEIBULL_KEYS_H

#include <dem/lattice.h>

#include "schema.h"

/* Keys that need each other, or a kind of fracture. */
void weibull_keys_check(const schema_deck *groups, namelist_errors *errors);

/* Takes the defaults of keys away that a material does not use: they mean nothing, and stated they are faults. */
void weibull_keys_drop_unused(schema_deck *groups);

/* The law of the material of a group that names one, which exists; of shape 0 where strengths do not scatter. */
dem_weibull weibull_keys_law(const schema_deck *groups, const schema_instance *user);

#endif
