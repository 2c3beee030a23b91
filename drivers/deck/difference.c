/* SPDX-License-Identifier: BSD-3-Clause */
/* Lines of two texts, side by side. Both have the keys of a group in one order, but one may lack keys that the other
 * has. */
#include "difference.h"

#include <stdio.h>
#include <string.h>

static size_t line_length(const char *text)
{
    return strcspn(text, "\n");
}

static const char *next_line(const char *text)
{
    return text + line_length(text) + (text[line_length(text)] != '\0');
}

/* The key of a line has n characters from its first that is not a blank on; 0: the line has none. */
static size_t key_length(const char *line)
{
    const size_t n = strcspn(line, "=\n");
    return line[n] == '=' ? strcspn(line + strspn(line, " "), " =") : 0;
}

static void show_line(char out[64], const char *line)
{
    const size_t blank = strspn(line, " ");
    const int n = (int)(line_length(line) - (blank < line_length(line) ? blank : 0));
    (void)snprintf(out, 64, "%.*s", n > 0 ? n : (int)strlen("nothing"), n > 0 ? line + blank : "nothing");
}

static void show_lack(char out[64], const char *line)
{
    (void)snprintf(out, 64, "no %.*s", (int)key_length(line), line + strspn(line, " "));
}

/* Whether the group has no line with the key of `line` from `text` on. */
static bool lacks(const char *text, const char *line)
{
    const size_t n = key_length(line) + strspn(line, " ");
    if (key_length(line) == 0) return false;
    for (; *text != '\0' && *text != '/' && *text != '&'; text = next_line(text))
        if (key_length(text) == key_length(line) && strncmp(text, line, n) == 0) return false;
    return true;
}

bool difference_find(const char *then, const char *now, char text[DIFFERENCE])
{
    const char *group = now;
    while (line_length(then) == line_length(now) && strncmp(then, now, line_length(now)) == 0) {
        if (*now == '\0') return false;
        if (*now == '&') group = now;
        then = next_line(then);
        now = next_line(now);
    }
    char was[64], is[64];
    const bool added = lacks(then, now), dropped = !added && lacks(now, then);
    (added ? show_lack : show_line)(was, added ? now : then);
    (dropped ? show_lack : show_line)(is, dropped ? then : now);
    (void)snprintf(text, DIFFERENCE, "%s in %.*s, this one has %s", was, (int)line_length(group), group, is);
    return true;
}
