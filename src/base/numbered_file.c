/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/numbered_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char temporary[] = ".new";

enum { SEGMENT_DIGITS = 5 };

void numbered_file_print(char out[NUMBERED_FILE], numbered_file file)
{
    int at = 0;
    if (file.segment > 0) at = snprintf(out, NUMBERED_FILE, ".%0*lld", SEGMENT_DIGITS, file.segment);
    if (file.n > 0)
        (void)snprintf(out + at, NUMBERED_FILE - (size_t)at, ".%dof%d.h5%s", file.stripe, file.n,
                       file.is_temporary ? temporary : "");
    else
        (void)snprintf(out + at, NUMBERED_FILE - (size_t)at, ".vtkhdf");
}

/* Takes a number from 1 on off the beginning of a text; 0 if there is none, or it is too long. */
static int take_number(const char **text, size_t *digits)
{
    *digits = strspn(*text, "0123456789");
    const int number = *digits > 0 && *digits <= 9 ? (int)strtol(*text, NULL, 10) : 0;
    *text += *digits;
    return number;
}

static bool take(const char **text, const char *word)
{
    const bool is_there = strncmp(*text, word, strlen(word)) == 0;
    if (is_there) *text += strlen(word);
    return is_there;
}

/* ".1of4.h5" */
static bool read_stripe(numbered_file *out, const char *text)
{
    size_t digits;
    if (!take(&text, ".")) return false;
    out->stripe = take_number(&text, &digits);
    if (out->stripe < 1 || !take(&text, "of")) return false;
    out->n = take_number(&text, &digits);
    if (out->n < out->stripe || !take(&text, ".h5")) return false;
    out->is_temporary = take(&text, temporary);
    return *text == '\0';
}

bool numbered_file_read(numbered_file *out, const char *ending)
{
    size_t digits;
    *out = (numbered_file){0};
    if (read_stripe(out, ending)) return true;
    *out = (numbered_file){0};
    if (!take(&ending, ".")) return false;
    out->segment = take_number(&ending, &digits);
    if (out->segment < 1 || digits < SEGMENT_DIGITS) return false;
    return strcmp(ending, ".vtkhdf") == 0 || read_stripe(out, ending);
}
