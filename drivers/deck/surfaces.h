/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether the bodies of a deck have surfaces that can push each other off, as the key `bodies` of &contact asks. */
#ifndef DEM_SURFACES_H
#define DEM_SURFACES_H

#include <dem/dem.h>

#include "placement.h"
#include "schema.h"

/* Settles `bodies` when all bodies are built. Where one of them has no triangles, a default becomes 'none', in `groups`
 * too; what the deck asks for by hand is refused, and appended to `errors`. Returns false only when memory runs out.
 * \param bodies  [number of &body] */
bool surfaces_settle(dem_options *options, schema_deck *groups, const dem_lattice *lattice, const placement *bodies,
                     namelist_errors *errors);

#endif
