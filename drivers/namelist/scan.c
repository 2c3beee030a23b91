/* SPDX-License-Identifier: BSD-3-Clause */
/* The places of a namelist's text: what stands ahead, and how to move on. Keeps nothing and reports nothing. */
#include "scan.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "utf8.h"

enum { MAX_SUBSCRIPT = 64 }; /* characters between ( and ): bounds the looking ahead */

static bool ends_word(char c)
{
    return scan_is_blank(c) || strchr(",;/!='\"&$", c) != NULL; /* the terminating NUL too */
}

static size_t subscript_length(const char *s)
{
    if (s[0] != '(') return 0;
    const size_t n = strspn(s + 1, "0123456789:,+- \t");
    return n > 0 && n <= MAX_SUBSCRIPT && s[n + 1] == ')' ? n + 2 : 0;
}

const char *scan_here(const scanner *scan)
{
    return scan->text + scan->at;
}

void scan_drop_broken(char *text)
{
    char *to = text;
    for (const char *from = text; *from != '\0';) {
        const size_t n = utf8_length(from);
        memmove(to, from, n);
        to += n;
        from += n > 0 ? n : 1;
    }
    *to = '\0';
}

bool scan_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

size_t scan_word_length(const char *s)
{
    size_t n = 0;
    while (!ends_word(s[n])) n++;
    return n;
}

size_t scan_name_length(const char *s)
{
    size_t n = 0;
    if (!isalpha((unsigned char)s[0])) return 0;
    while (isalnum((unsigned char)s[n]) || s[n] == '_') n++;
    return n;
}

bool scan_is_logical(const char *word, bool *logical)
{
    static const char *const spellings[] = {".true.", "true", "t", ".false.", "false", "f"};
    for (int k = 0; k < 6; k++) {
        *logical = k < 3;
        if (strcasecmp(word, spellings[k]) == 0) return true;
    }
    return false;
}

bool scan_is_infinite(const char *word)
{
    word += *word == '+' || *word == '-';
    return strcasecmp(word, "inf") == 0 || strcasecmp(word, "infinity") == 0 || strncasecmp(word, "nan", 3) == 0;
}

size_t scan_designator_length(const char *s)
{
    size_t n = scan_name_length(s);
    if (n == 0) return 0;
    for (;;) {
        n += subscript_length(s + n);
        const size_t component = s[n] == '%' ? scan_name_length(s + n + 1) : 0;
        if (component == 0) return n;
        n += 1 + component;
    }
}

bool scan_at_key(const scanner *scan)
{
    const char *s = scan_here(scan);
    size_t n = scan_designator_length(s);
    if (n == 0) return false;
    while (scan_is_blank(s[n])) n++;
    return s[n] == '=';
}

bool scan_at_group(const scanner *scan)
{
    const char *s = scan_here(scan);
    return (s[0] == '&' || s[0] == '$') && scan_name_length(s + 1) > 0;
}

bool scan_at_end_word(const scanner *scan)
{
    const char *s = scan_here(scan);
    return scan_at_group(scan) && scan_name_length(s + 1) == 3 && strncasecmp(s + 1, "end", 3) == 0;
}

size_t scan_string_length(const char *s)
{
    bool left_line = false;
    size_t n = 1;
    for (; s[n] != s[0] || s[n + 1] == s[0]; n++) {
        if (s[n] == '\0') return 0;
        if (s[n] == s[0]) n++;
        left_line = left_line || s[n] == '\n';
    }
    const char next = s[n + 1];
    const bool separated = scan_is_blank(next) || strchr(",;/!", next) != NULL;
    return left_line && !separated ? 0 : n + 1;
}

bool scan_at_line_name(const scanner *scan)
{
    const char *s = scan_here(scan), *before = s;
    while (before > scan->text && (before[-1] == ' ' || before[-1] == '\t')) before--;
    const size_t n = scan_name_length(s);
    return n > 0 && n == scan_word_length(s) && (before == scan->text || before[-1] == '\n');
}

bool scan_at_stop(const scanner *scan)
{
    return *scan_here(scan) == '\0' || *scan_here(scan) == '/' || scan_at_group(scan) || scan_at_key(scan);
}

void scan_step(scanner *scan)
{
    const char c = *scan_here(scan);
    if (c == '\0') return;
    scan->at++;
    if (c == '\n') {
        scan->line++;
        scan->column = 1;
    } else if (((unsigned char)c & 0xC0) != 0x80) {
        scan->column++;
    }
}

void scan_step_over(scanner *scan, size_t n)
{
    for (size_t k = 0; k < n; k++) scan_step(scan);
}

void scan_skip_line(scanner *scan)
{
    while (*scan_here(scan) != '\n' && *scan_here(scan) != '\0') scan_step(scan);
}

void scan_skip_blanks(scanner *scan)
{
    for (;;) {
        while (scan_is_blank(*scan_here(scan))) scan_step(scan);
        if (*scan_here(scan) != '!') return;
        scan_skip_line(scan);
    }
}

void scan_skip_junk(scanner *scan)
{
    for (scan_skip_blanks(scan); !scan_at_stop(scan); scan_skip_blanks(scan)) {
        const char *s = scan_here(scan);
        const size_t string = *s == '\'' || *s == '"' ? scan_string_length(s) : 0;
        const size_t word = scan_word_length(s);
        scan_step_over(scan, string > 0 ? string : word > 0 ? word : 1);
    }
}
