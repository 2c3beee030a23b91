/* SPDX-License-Identifier: BSD-3-Clause */
/* Lines of two texts, side by side. */
#include "difference.h"

#include <stdio.h>
#include <string.h>

static size_t line_length(const char *text)
{
    return strcspn(text, "\n");
}

static void show_line(char out[64], const char *line)
{
    const size_t blank = strspn(line, " ");
    const int n = (int)(line_length(line) - (blank < line_length(line) ? blank : 0));
    (void)snprintf(out, 64, "%.*s", n > 0 ? n : (int)strlen("nothing"), n > 0 ? line + blank : "nothing");
}

bool difference_find(const char *then, const char *now, char text[DIFFERENCE])
{
    const char *group = now;
    while (line_length(then) == line_length(now) && strncmp(then, now, line_length(now)) == 0) {
        if (*now == '\0') return false;
        if (*now == '&') group = now;
        then += line_length(then) + (then[line_length(then)] != '\0');
        now += line_length(now) + (now[line_length(now)] != '\0');
    }
    char was[64], is[64];
    show_line(was, then);
    show_line(is, now);
    (void)snprintf(text, DIFFERENCE, "%s in %.*s, this one has %s", was, (int)line_length(group), group, is);
    return true;
}
