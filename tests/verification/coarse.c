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
    static const char body[] = "&body", written[] = "2.5e-3";
    char path[4096], text[8192];
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    (void)snprintf(path, sizeof path, "%s/%s.nml", folder, name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    const size_t n = fread(text, 1, sizeof text - 1, file);
    text[n] = '\0';
    (void)fclose(file);
    const char *group = strstr(text, body), *number = strstr(text, written);
    assert_true(group != NULL && number > group);
    group += strlen(body);
    (void)snprintf(path, sizeof path, "coarse_%s_%ld.nml", name, (long)getpid());
    file = fopen(path, "w");
    assert_non_null(file);
    (void)fprintf(file, "%.*s%s%.*s%g%s", (int)(group - text), text,
                  strstr(text, "outline") == NULL ? " outline = 'lattice'," : "", (int)(number - group), group, spacing,
                  number + strlen(written));
    assert_int_equal(fclose(file), 0);
    const deck_status status = whole_deck_read(d, path, &errors);
    (void)remove(path);
    if (status != DECK_OK) fail_msg("%s: %s", path, errors.n > 0 ? errors.list[0].text : "?");
}
