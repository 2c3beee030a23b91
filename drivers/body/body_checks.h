/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether the keys of &body, &void, &pores, &crack and &inclusion go together, as far as the deck alone can say; what
 * depends on files and on the lattice is found when the body is built (body_geometry.h). */
#ifndef DEM_BODY_CHECKS_H
#define DEM_BODY_CHECKS_H

#include "schema.h"

/* Keys that a shape lacks or does not use, numbers that do not go together, groups for bodies that there are not. */
void body_checks_all(const schema_deck *groups, namelist_errors *errors);

/* Takes the defaults of keys away that a choice does not use: they mean nothing, and stated they are faults. */
void body_checks_drop_unused(schema_deck *groups);

/* Reports a spacing that exceeds a size, m; `what` it is the size of. */
void body_checks_refuse_spacing(const schema_instance *body, const char *what, const double size[2],
                                namelist_errors *errors);

#endif
