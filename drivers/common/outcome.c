/* SPDX-License-Identifier: BSD-3-Clause */
#include "outcome.h"

#include <stdarg.h>
#include <string.h>

static exit_code code_of(dem_status status)
{
    switch (status) {
    case DEM_OK:
    case DEM_STOPPED:
        return EXIT_DONE;
    case DEM_ERROR_MEMORY:
        return EXIT_MEMORY;
    case DEM_ERROR_IO:
        return EXIT_IO;
    case DEM_ERROR_INTEGRATOR:
    case DEM_ERROR_CONTACT:
        return EXIT_NUMERICS;
    case DEM_ERROR_ARGUMENT:
    case DEM_ERROR_MODEL:
        return EXIT_INVALID;
    }
    return EXIT_NUMERICS;
}

void outcome_fail(outcome *o, exit_code code, const char *where, const char *format, ...)
{
    char message[OUTCOME_MESSAGE];
    va_list arguments;
    va_start(arguments, format);
    const int n = snprintf(message, sizeof message, "%s: error: ", where);
    const size_t used = n > 0 && (size_t)n < sizeof message ? (size_t)n : 0;
    (void)vsnprintf(message + used, sizeof message - used, format, arguments);
    va_end(arguments);
    (void)fprintf(o->err != NULL ? o->err : stderr, "%s\n", message);
    if (o->code != EXIT_DONE) return;
    o->code = code;
    memcpy(o->message, message, sizeof message);
}

void outcome_fail_status(outcome *o, dem_status status, const char *where)
{
    outcome_fail(o, code_of(status), where, "%s", dem_status_message());
}

void outcome_set(outcome *o, exit_code code, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    o->code = code;
    (void)vsnprintf(o->message, sizeof o->message, format, arguments);
    va_end(arguments);
}
