/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/text_reader.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

static void skip_blanks(text_reader *w)
{
    bool comment = false;
    for (; w->at < w->end; w->at++) {
        if (*w->at == '\n') {
            w->line++;
            comment = false;
        } else if (w->comment != '\0' && *w->at == w->comment) {
            comment = true;
        }
        if (!comment && !is_blank(*w->at)) return;
    }
}

/* What a message may show of a word of unknown bytes. */
static void make_plain(char *word)
{
    for (; *word != '\0'; word++)
        if (*word < ' ' || *word > '~') *word = '?';
}

text_reader text_reader_begin(const char *text, size_t size, char comment)
{
    return (text_reader){.at = text, .end = text + size, .line = 1, .last = 1, .comment = comment};
}

bool text_reader_fail(text_reader *w, const char *format, ...)
{
    va_list arguments;
    if (w->fault[0] != '\0') return false;
    va_start(arguments, format);
    (void)vsnprintf(w->fault, sizeof w->fault, format, arguments);
    va_end(arguments);
    return false;
}

bool text_reader_next(text_reader *w, char *word)
{
    size_t n = 0;
    skip_blanks(w);
    w->last = w->line;
    for (; w->at < w->end && !is_blank(*w->at) && (w->comment == '\0' || *w->at != w->comment); w->at++) {
        if (n == TEXT_READER_LONGEST) return text_reader_fail(w, "a word of more than %d bytes", TEXT_READER_LONGEST);
        word[n++] = *w->at;
    }
    word[n] = '\0';
    return n > 0;
}

/* The next word, for a value that must be there. */
static bool take(text_reader *w, const char *what, char *word)
{
    if (text_reader_next(w, word)) return true;
    return text_reader_fail(w, "the text ends where %s is expected", what);
}

bool text_reader_integer(text_reader *w, const char *what, int64_t least, int64_t most, int64_t *value)
{
    char word[TEXT_READER_LONGEST + 1], *end;
    if (!take(w, what, word)) return false;
    errno = 0;
    const long long n = strtoll(word, &end, 10);
    const bool good = *end == '\0' && errno == 0;
    make_plain(word);
    if (!good) return text_reader_fail(w, "%s must be an integer, got '%.40s'", what, word);
    if (n < least || n > most)
        return text_reader_fail(w, "%s must be in [%lld, %lld], got %lld", what, (long long)least, (long long)most, n);
    *value = n;
    return true;
}

bool text_reader_real(text_reader *w, const char *what, double *value)
{
    char word[TEXT_READER_LONGEST + 1], *end;
    if (!take(w, what, word)) return false;
    const double x = strtod(word, &end);
    const bool plain = word[strspn(word, "+-.0123456789eE")] == '\0'; /* neither hexadecimal nor a name */
    const bool good = plain && *end == '\0' && isfinite(x);
    make_plain(word);
    if (!good) return text_reader_fail(w, "%s must be a finite number, got '%.40s'", what, word);
    *value = x;
    return true;
}

bool text_reader_expect(text_reader *w, const char *word)
{
    char found[TEXT_READER_LONGEST + 1];
    if (!take(w, word, found)) return false;
    if (strcmp(found, word) == 0) return true;
    make_plain(found);
    return text_reader_fail(w, "'%s' is expected, got '%.40s'", word, found);
}

bool text_reader_seek(text_reader *w, const char *text)
{
    const size_t length = strlen(text);
    while (w->at < w->end) {
        const char *next = memchr(w->at, '\n', (size_t)(w->end - w->at));
        if (next == NULL) next = w->end - 1;
        w->at = next + 1;
        w->last = ++w->line;
        if ((size_t)(w->end - w->at) < length || memcmp(w->at, text, length) != 0) continue;
        w->at += length;
        return true;
    }
    return text_reader_fail(w, "the text ends where a line '%s' is expected", text);
}

size_t text_reader_left(const text_reader *w)
{
    return (size_t)(w->end - w->at);
}
