/* SPDX-License-Identifier: BSD-3-Clause */
/* See coarse.h. */
#include "coarse.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "support.h"
#include "unit/whole_deck.h"

void coarse_read(deck *d, const char *folder, const char *name, double spacing)
{
    char path[4096], *at, text[8192];
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    (void)snprintf(path, sizeof path, "%s/%s.nml", folder, name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    const size_t n = fread(text, 1, sizeof text - 1, file);
    text[n] = '\0';
    (void)fclose(file);
    at = strstr(text, "2.5e-3");
    assert_non_null(at);
    char number[7];
    (void)snprintf(number, sizeof number, "%6.4f", spacing);
    memcpy(at, number, 6);
    (void)snprintf(path, sizeof path, "coarse_%s_%ld.nml", name, (long)getpid());
    file = fopen(path, "w");
    assert_true(file != NULL && fputs(text, file) >= 0 && fclose(file) == 0);
    if (whole_deck_read(d, path, &errors) != DECK_OK)
        fail_msg("%s: %s", path, errors.n > 0 ? errors.list[0].text : "?");
    (void)remove(path);
}
