/* SPDX-License-Identifier: BSD-3-Clause */
/* The message of the last failure, one per thread; the version. */
#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char last_message[512];

const char *dem_version(void)
{
    return DEM_VERSION;
}

const char *dem_status_message(void)
{
    return last_message;
}

dem_status status_fail(dem_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(last_message, sizeof last_message, format, arguments);
    va_end(arguments);
    return status;
}
