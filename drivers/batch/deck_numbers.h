/* SPDX-License-Identifier: BSD-3-Clause */
/* The library counts bodies and obstacles from 0, decks count them from 1. */
#ifndef DEM_DECK_NUMBERS_H
#define DEM_DECK_NUMBERS_H

#include <stddef.h>

/** Copies a message of the library, in which bodies and obstacles get the numbers that they have in the deck.
 *  \param[out] out  [size] */
void deck_numbers_translate(char *out, size_t size, const char *message);

#endif
