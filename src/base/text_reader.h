/* SPDX-License-Identifier: BSD-3-Clause */
/* Words and numbers of a text between blanks, with the line in which reading stands and the first fault. */
#ifndef DEM_BASE_TEXT_READER_H
#define DEM_BASE_TEXT_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TEXT_READER_LONGEST = 63, TEXT_READER_FAULT = 200 };

typedef struct text_reader {
    const char *at, *end;          /* what is not yet read */
    size_t line;                   /* of `at`, from 1 */
    size_t last;                   /* line of the last word, which faults speak of */
    char comment;                  /* begins one, which lasts to the end of its line; '\0': there are none */
    char fault[TEXT_READER_FAULT]; /* "" while there is none */
} text_reader;

text_reader text_reader_begin(const char *text, size_t size, char comment);

/* Keeps a fault in the line of the last word, printf-like; false. A later one does not replace it. */
bool text_reader_fail(text_reader *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The next word, of at most TEXT_READER_LONGEST bytes. False at the end of the text, without a fault, and for longer
 * words.
 * \param[out] word  [TEXT_READER_LONGEST + 1] */
bool text_reader_next(text_reader *w, char *word);

/* An integer in [least, most], a finite real; `what` names it in faults. */
bool text_reader_integer(text_reader *w, const char *what, int64_t least, int64_t most, int64_t *value);
bool text_reader_real(text_reader *w, const char *what, double *value);

/* Whether the next word is `word`; it is a fault if not. */
bool text_reader_expect(text_reader *w, const char *word);

/* Goes on behind the next line that begins with `text`; false, and a fault, if there is none. */
bool text_reader_seek(text_reader *w, const char *text);

/* Bytes that are left: no more numbers than these can follow, which is to be known before memory is asked for. */
size_t text_reader_left(const text_reader *w);

#endif
