/* SPDX-License-Identifier: BSD-3-Clause */
/* What the keys of &material say, and who refers to one. */
#ifndef DEM_MATERIAL_H
#define DEM_MATERIAL_H

#include <dem/lattice.h>

#include "schema.h"

/* NULL where there is none of this name. */
const schema_instance *material_find(const schema_deck *groups, const char *name);

/* Of a group that names one, which exists. */
dem_material material_of(const schema_deck *groups, const schema_instance *user);

/* Numbers that do not go together, names given twice. */
void material_check_all(const schema_deck *groups, namelist_errors *errors);

/* Whether the material that a &body or an &inclusion names exists. */
void material_check_user(const schema_deck *groups, const schema_instance *user, namelist_errors *errors);

/* Takes the defaults of keys away that a choice does not use: they mean nothing, and stated they are faults. */
void material_drop_unused(schema_deck *groups);

#endif
