/* SPDX-License-Identifier: BSD-3-Clause */
/* A deck read and built in one call, without settings: for tests. */
#ifndef DEM_TESTS_WHOLE_DECK_H
#define DEM_TESTS_WHOLE_DECK_H

#include "deck.h"

/* *out is empty unless DECK_OK is returned. */
static inline deck_status whole_deck_read(deck *out, const char *path, namelist_errors *errors)
{
    const deck_status status = deck_parse(out, path, NULL, 0, errors);
    return status == DECK_OK ? deck_build(out, errors) : status;
}

#endif
