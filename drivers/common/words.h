/* SPDX-License-Identifier: BSD-3-Clause */
/* Words and numbers of a text between blanks, with the line in which reading stands and the first fault. */
#ifndef DEM_WORDS_H
#define DEM_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WORDS_LONGEST = 63, WORDS_FAULT = 200 };

typedef struct words {
    const char *at, *end;    /* what is not yet read */
    size_t line;             /* of `at`, from 1 */
    size_t last;             /* line of the last word, which faults speak of */
    char comment;            /* begins one, which lasts to the end of its line; '\0': there are none */
    char fault[WORDS_FAULT]; /* "" while there is none */
} words;

words words_begin(const char *text, size_t size, char comment);

/* Notes a fault in the line of the last word, printf-like; false. Only the first one is kept. */
bool words_fail(words *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The next word, of at most WORDS_LONGEST bytes. False at the end of the text, without a fault, and for longer words.
 * \param[out] word  [WORDS_LONGEST + 1] */
bool words_next(words *w, char *word);

/* An integer in [least, most], a finite real; `what` names it in faults. */
bool words_integer(words *w, const char *what, int64_t least, int64_t most, int64_t *value);
bool words_real(words *w, const char *what, double *value);

/* Whether the next word is `word`; it is a fault if not. */
bool words_expect(words *w, const char *word);

/* Goes on behind the next line that begins with `text`; false, and a fault, if there is none. */
bool words_seek(words *w, const char *text);

/* Bytes that are left: no more numbers than these can follow, which is to be known before memory is asked for. */
size_t words_left(const words *w);

#endif
