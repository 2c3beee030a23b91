/* SPDX-License-Identifier: BSD-3-Clause */
#include "namelist_errors.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "scan.h"

enum { MAX_ERRORS = 1000 };

static char *format_text(const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (text == NULL) return NULL;
    (void)vsnprintf(text, (size_t)length + 1, format, arguments);
    scan_drop_broken(text);
    return text;
}

/* Makes room for one more fault; false when memory runs out. */
static bool has_room(namelist_errors *errors)
{
    if (errors->n < errors->capacity) return true;
    const size_t capacity = errors->capacity == 0 ? 1 : 2 * errors->capacity;
    namelist_error *list = realloc(errors->list, capacity * sizeof *list);
    if (list == NULL) return false;
    errors->list = list;
    errors->capacity = capacity;
    return true;
}

void namelist_errors_add(namelist_errors *errors, namelist_place place, const char *format, ...)
{
    if (errors->n >= MAX_ERRORS) return;
    va_list arguments;
    va_start(arguments, format);
    char *text =
        has_room(errors) ? format_text(errors->n + 1 < MAX_ERRORS ? format : "too many errors", arguments) : NULL;
    va_end(arguments);
    if (text == NULL)
        errors->out_of_memory = true;
    else
        errors->list[errors->n++] = (namelist_error){place, text};
}

void namelist_errors_sort(namelist_errors *errors)
{
    for (size_t k = 1; k < errors->n; k++) {
        const namelist_error error = errors->list[k];
        size_t to = k;
        for (; to > 0; to--) {
            const namelist_place before = errors->list[to - 1].place;
            const bool later =
                before.line != error.place.line ? before.line > error.place.line : before.column > error.place.column;
            if (!later) break;
            errors->list[to] = errors->list[to - 1];
        }
        errors->list[to] = error;
    }
}

void namelist_errors_free(namelist_errors *errors)
{
    for (size_t k = 0; k < errors->n; k++) free(errors->list[k].text);
    free(errors->list);
    *errors = (namelist_errors){0};
}
