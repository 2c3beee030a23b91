/* SPDX-License-Identifier: BSD-3-Clause */
/* Any bytes may come as a deck. One that is accepted has an echo that is accepted and is its own echo. */
#include "schema.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The echo of a deck; NULL if it has faults. */
static char *echo_of(const char *text, size_t size)
{
    namelist list;
    namelist_errors errors = {0};
    schema_deck deck = {0};
    char *echo = NULL;
    if (!namelist_parse(&list, text, size, &errors) || !schema_resolve(&deck, &list, &errors)) abort();
    namelist_errors_sort(&errors);
    if (errors.n == 0 && !schema_echo(&deck, SCHEMA_MARKED, &echo)) abort();
    schema_free(&deck);
    namelist_free(&list);
    namelist_errors_free(&errors);
    return echo;
}

/* "! default" marks what the echo states. */
static void remove_marks(char *text)
{
    static const char mark[] = " ! default\n";
    const size_t n = sizeof mark - 2;
    for (char *at = strstr(text, mark); at != NULL; at = strstr(at, mark)) memmove(at, at + n, strlen(at + n) + 1);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *first = echo_of((const char *)data, size);
    if (first == NULL) return 0;
    char *second = echo_of(first, strlen(first));
    if (second == NULL) abort();
    remove_marks(first);
    if (strcmp(first, second) != 0) abort();
    free(second);
    free(first);
    return 0;
}
