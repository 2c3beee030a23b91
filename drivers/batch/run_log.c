/* SPDX-License-Identifier: BSD-3-Clause */
#include "run_log.h"

#include <stdarg.h>
#include <string.h>

void run_log_begin(run_log *l)
{
    if (l->inside) (void)fputc('\n', l->out);
    l->inside = false;
}

void run_log_tell(run_log *l, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    run_log_begin(l);
    (void)vfprintf(l->out, format, arguments);
    (void)fflush(l->out);
    va_end(arguments);
}

void run_log_warn(run_log *l, const char *format, ...)
{
    char text[RUN_LOG_TEXT];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (!l->quiet) run_log_tell(l, "warning    %s\n", text);
    if (l->n_warnings < RUN_LOG_WARNINGS) memcpy(l->warnings[l->n_warnings++], text, sizeof text);
}
