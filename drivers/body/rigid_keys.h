/* SPDX-License-Identifier: BSD-3-Clause */
/* The keys of a body that is rigid: how it is made so, and what does not go together with that. */
#ifndef DEM_RIGID_KEYS_H
#define DEM_RIGID_KEYS_H

#include <dem/dem.h>

#include "schema.h"

/* Whether a &body asks for a rigid body. */
bool rigid_keys_ask(const schema_instance *body);

/* The first node of the bodies that are rigid, by this key or by their lattice file; -1 if there is none. */
dem_index rigid_keys_node(const dem_lattice *lattice);

/* Reports what does not go together in all &body groups, and boundaries that would move rigid bodies. */
void rigid_keys_check(const schema_deck *groups, namelist_errors *errors);

/* Takes the keys away from the bodies that are not rigid. */
void rigid_keys_drop_unused(schema_deck *groups);

/* Makes a lattice rigid if its &body asks for that. */
dem_status rigid_keys_apply(dem_lattice *lattice, const schema_instance *body);

#endif
