/* SPDX-License-Identifier: BSD-3-Clause */
#include "deck_numbers.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "copies.h"

/* The word with which "body N" or "obstacle N" begins here, as words of their own; NULL if none does. */
static const char *word_at(const char *message, const char *here)
{
    static const char *const words[] = {"body ", "obstacle "};
    const bool begins = here == message || !isalnum((unsigned char)here[-1]);
    for (size_t k = 0; k < sizeof words / sizeof *words && begins; k++)
        if (strncmp(here, words[k], strlen(words[k])) == 0 && isdigit((unsigned char)here[strlen(words[k])]))
            return words[k];
    return NULL;
}

/* As snprintf(). */
static int put(char *out, size_t size, const char *word, size_t number, const schema_deck *groups)
{
    if (word[0] == 'o') return snprintf(out, size, "%s%zu", word, number + 1);
    const copies_origin at = copies_find(groups, number);
    if (copies_count(schema_get(groups, "body", at.group)) == 1)
        return snprintf(out, size, "%s%zu", word, at.group + 1);
    return snprintf(out, size, "%s%zu (copy %zu)", word, at.group + 1, at.copy + 1);
}

void deck_numbers_translate(char *out, size_t size, const char *message, const schema_deck *groups)
{
    size_t used = 0;
    for (const char *p = message; *p != '\0' && used + 1 < size;) {
        char *end = NULL;
        const char *word = word_at(message, p);
        if (word == NULL) {
            out[used++] = *p++;
            continue;
        }
        const size_t number = (size_t)strtoull(p + strlen(word), &end, 10);
        const int n = put(out + used, size - used, word, number, groups);
        used = n > 0 && (size_t)n < size - used ? used + (size_t)n : size - 1;
        p = end;
    }
    out[used] = '\0';
}

const schema_instance *deck_numbers_body(const char *message, const schema_deck *groups)
{
    for (const char *p = message; *p != '\0'; p++) {
        const char *word = word_at(message, p);
        if (word == NULL || word[0] != 'b') continue;
        return schema_get(groups, "body", copies_find(groups, (size_t)strtoull(p + strlen(word), NULL, 10)).group);
    }
    return schema_get(groups, "body", 0);
}
