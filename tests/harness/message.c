/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/message.h"

#include <ctype.h>
#include <string.h>

enum { MESSAGE_LINE = 1024 };

/* Whether a word or a number goes on from one character to the next: "e-05", "0.5", "x_1". */
static bool are_of_one_word(char before, char after)
{
    if (isalnum((unsigned char)before) || before == '_') return isalnum((unsigned char)after) || after == '_';
    return (before == '.' || before == '-' || before == '+') && isalnum((unsigned char)after);
}

static bool ends_within_word(const char *end)
{
    return are_of_one_word(end[-1], end[0]) || (end[0] == '.' && isdigit((unsigned char)end[1]));
}

/* Behind the first n characters of the part where they are whole words; NULL where they are nowhere. */
static const char *find_part(const char *text, const char *part, size_t n)
{
    for (const char *at = text; *at != '\0'; at++) {
        if (strncmp(at, part, n) != 0) continue;
        if ((at == text || !are_of_one_word(at[-1], at[0])) && !ends_within_word(at + n)) return at + n;
    }
    return NULL;
}

bool message_has_parts(const char *text, const char *pattern)
{
    while (text != NULL && pattern != NULL) {
        const char *next = strstr(pattern, " * ");
        text = find_part(text, pattern, next != NULL ? (size_t)(next - pattern) : strlen(pattern));
        pattern = next != NULL ? next + strlen(" * ") : NULL;
    }
    return text != NULL;
}

/* Whether a line has the parts of a pattern; a pattern that begins with a place, a digit, stands at its beginning. */
static bool line_has_parts(const char *line, const char *pattern)
{
    const char *separator = strstr(pattern, " * ");
    const size_t n = separator != NULL ? (size_t)(separator - pattern) : strlen(pattern);
    if (isdigit((unsigned char)pattern[0]) && find_part(line, pattern, n) != line + n) return false;
    return message_has_parts(line, pattern);
}

/* Copies the next line; \returns what is behind it, NULL: nothing. */
static const char *take_line(const char *text, char line[MESSAGE_LINE])
{
    const size_t n = strcspn(text, "\n"), kept = n < MESSAGE_LINE ? n : MESSAGE_LINE - 1;
    memcpy(line, text, kept);
    line[kept] = '\0';
    return text[n] == '\n' && text[n + 1] != '\0' ? text + n + 1 : NULL;
}

bool message_lines_have_parts(const char *text, const char *patterns)
{
    char line[MESSAGE_LINE], pattern[MESSAGE_LINE];
    if (text[0] == '\0' || patterns[0] == '\0') return text[0] == patterns[0];
    while (text != NULL && patterns != NULL) {
        text = take_line(text, line);
        patterns = take_line(patterns, pattern);
        if (!line_has_parts(line, pattern)) return false;
    }
    return text == NULL && patterns == NULL;
}
