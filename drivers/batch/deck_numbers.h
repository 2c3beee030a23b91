/* SPDX-License-Identifier: BSD-3-Clause */
/* The library counts bodies and obstacles from 0, and copies as bodies; decks count their groups from 1. */
#ifndef DEM_DECK_NUMBERS_H
#define DEM_DECK_NUMBERS_H

#include <stddef.h>

#include "schema.h"

/** Copies a message of the library, in which bodies and obstacles get the numbers that they have in the deck. The model
 *  must have the bodies of the groups, which is not so where a lattice file has several.
 *  \param[out] out  [size] */
void deck_numbers_translate(char *out, size_t size, const char *message, const schema_deck *groups);

/** The &body of the first body that a message of the library names, the first of the deck if it names none. */
const schema_instance *deck_numbers_body(const char *message, const schema_deck *groups);

#endif
