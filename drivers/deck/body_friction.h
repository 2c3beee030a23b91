/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction of bodies with each other: that of &contact, or of their materials where these say so. */
#ifndef DEM_DECK_BODY_FRICTION_H
#define DEM_DECK_BODY_FRICTION_H

#include "placement.h"
#include "schema.h"

/* Reports materials with friction where bodies do not touch. */
void body_friction_check(const schema_deck *groups, namelist_errors *errors);

/* Makes the list of all bodies' coefficients, if any material has one, and puts it into the options; NULL otherwise.
 * The groups of bodies are at these places of the lattice. False when memory runs out. */
bool body_friction_make(double **out, dem_options *options, const schema_deck *groups, const dem_lattice *l,
                        const placement *places);

#endif
