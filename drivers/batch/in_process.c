/* SPDX-License-Identifier: BSD-3-Clause */
#include "in_process.h"

#include <locale.h>
#include <stdlib.h>

#include "batch.h"

_Static_assert(sizeof(requests) == 2 * sizeof(int), "python/dem/batch.py has it as two of them");

static exit_code do_words(const host *h, int n, char **words)
{
    command c;
    exit_code code = command_parse(&c, h, n, words);
    if (code == EXIT_DONE) code = batch_do(&c, NULL);
    command_free(&c);
    return code;
}

/* Numbers have a decimal point, whatever the program prefers. */
static exit_code do_in_c(const host *h, int n, char **words)
{
    const locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0) return EXIT_MEMORY;
    const locale_t before = uselocale(plain);
    const exit_code code = do_words(h, n, words);
    (void)uselocale(before);
    freelocale(plain);
    return code;
}

/* Ends a stream.  \return false where not all that was printed is in it */
static bool end(FILE *stream)
{
    const bool good = ferror(stream) == 0;
    return fclose(stream) == 0 && good;
}

int dem_private_batch(int n, char **words, requests *asked, volatile double *part, char **printed)
{
    size_t sizes[2];
    exit_code code = EXIT_MEMORY;
    printed[0] = printed[1] = NULL;
    FILE *out = open_memstream(&printed[0], &sizes[0]), *err = open_memstream(&printed[1], &sizes[1]);
    const host h = {.out = out, .err = err, .requests = asked, .part = part};
    if (out != NULL && err != NULL) code = do_in_c(&h, n, words);
    const bool out_whole = out == NULL || end(out), err_whole = err == NULL || end(err);
    return code == EXIT_DONE && !(out_whole && err_whole) ? (int)EXIT_MEMORY : (int)code;
}

void dem_private_batch_free(char *text)
{
    free(text);
}
