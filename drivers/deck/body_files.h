/* SPDX-License-Identifier: BSD-3-Clause */
/* The files that bodies are made from, as a deck names them: in its echo by their whole paths, in what identifies its
 * problem by their bytes. They are read elsewhere (body.h). */
#ifndef DEM_BODY_FILES_H
#define DEM_BODY_FILES_H

#include "schema.h"

/* Puts the whole path of each file in the place of its name. False when memory runs out.
 * \param folder  of the deck, with its last '/', or "" */
bool body_files_name(schema_deck *groups, const char *folder, namelist_errors *errors);

/* Puts the hash of each file in the place of its whole path. False when memory runs out. */
bool body_files_hash(schema_deck *groups, namelist_errors *errors);

#endif
