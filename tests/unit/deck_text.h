/* SPDX-License-Identifier: BSD-3-Clause */
/* Decks of a text, which stands in a file of the group's folder (scratch.h) while it is read. */
#ifndef DEM_TESTS_DECK_TEXT_H
#define DEM_TESTS_DECK_TEXT_H

#include "harness/test.h"
#include "unit/scratch.h"
#include "unit/whole_deck.h"

/** As whole_deck_read(). */
static inline deck_status deck_text_read(deck *out, const char *text, namelist_errors *errors)
{
    const char *path = folder_at(&scratch, "a.nml");
    file_put(path, text, strlen(text));
    const deck_status status = whole_deck_read(out, path, errors);
    assert_int_equal(unlink(path), 0);
    return status;
}

/** A deck without faults, or the test fails. Free with deck_free(). */
static inline deck deck_text_good(const char *text)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    deck d;
    const deck_status status = deck_text_read(&d, text, &errors);
    if (errors.n > 0) fail_msg("%s", errors.list[0].text);
    assert_int_equal(status, DECK_OK);
    return d;
}

#endif
