/* SPDX-License-Identifier: BSD-3-Clause */
/* A place in the text of a namelist, and the words ahead of it. */
#ifndef DEM_SCAN_H
#define DEM_SCAN_H

#include <stdbool.h>
#include <stddef.h>

typedef struct scanner {
    const char *text; /* NUL-terminated */
    size_t size, at;
    int line, column; /* of text[at], from 1; columns count characters */
} scanner;

void scan_drop_broken(char *text); /* removes what is not UTF-8 */

bool scan_is_blank(char c); /* ends of lines too */
size_t scan_word_length(const char *s);
size_t scan_name_length(const char *s);
/* The spellings of logicals, and of reals that are not finite. */
bool scan_is_logical(const char *word, bool *logical);
bool scan_is_infinite(const char *word);
/* name(subscript)%name(subscript)..., without blanks outside the subscripts. */
size_t scan_designator_length(const char *s);
/* Length of a string with its quotes, 0 if it is not closed. One that leaves its line and runs into text without a
 * separator is not closed: there the opening quote of the next string was taken for its end. */
size_t scan_string_length(const char *s);

const char *scan_here(const scanner *scan);
bool scan_at_key(const scanner *scan);       /* designator = */
bool scan_at_group(const scanner *scan);     /* &name or $name */
bool scan_at_end_word(const scanner *scan);  /* &end or $end */
bool scan_at_line_name(const scanner *scan); /* a name, first in its line */
bool scan_at_stop(const scanner *scan);      /* the next key, group or end of the group, or the end of the text */

void scan_step(scanner *scan);
void scan_step_over(scanner *scan, size_t n);
void scan_skip_line(scanner *scan);
void scan_skip_blanks(scanner *scan); /* comments too */
void scan_skip_junk(scanner *scan);   /* up to scan_at_stop() */

#endif
