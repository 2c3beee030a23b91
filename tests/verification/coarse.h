/* SPDX-License-Identifier: BSD-3-Clause */
/* The decks in inputs/ at another spacing. */
#ifndef DEM_TEST_COARSE_H
#define DEM_TEST_COARSE_H

#include "deck.h"

/** Reads the deck NAME.nml of a folder as if its spacing were this, m. Free with deck_free. */
void coarse_read(deck *d, const char *folder, const char *name, double spacing);

#endif
