/* SPDX-License-Identifier: BSD-3-Clause */
/* The entry `contacts` of a checkpoint: what candidates have to remember. */
#ifndef DEM_CONTACT_CONTACT_ENTRY_H
#define DEM_CONTACT_CONTACT_ENTRY_H

#include "contact/contact_set.h"

/** \return DEM_ERROR_MEMORY */
dem_status contact_entry_put(const contact_set *c, dem_checkpoint *checkpoint);

/** \return DEM_ERROR_IO for an entry that is not there or impossible: candidates are then partly those of the entry */
dem_status contact_entry_get(contact_set *c, const dem_checkpoint *checkpoint);

#endif
