/* SPDX-License-Identifier: BSD-3-Clause */
/* Characters of UTF-8. */
#ifndef DEM_UTF8_H
#define DEM_UTF8_H

#include <stddef.h>

/** Bytes of the character at `text`, 0 if there is none. */
size_t utf8_length(const char *text);

/** The same, and 0 if it has no place in a text file: control characters other than tab and end of line. */
size_t utf8_plain_length(const char *text);

#endif
