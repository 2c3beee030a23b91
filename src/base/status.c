/* SPDX-License-Identifier: BSD-3-Clause */
/* The message of the last failure, one for each thread, and the names of statuses and of the version. The library never
 * prints: a function that fails stores its message here (CHECK in status.h) and returns a status; the program decides
 * what becomes of it. The texts themselves stand where a failure is found, not here. */
#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

/* It stays until the next failure of the thread. */
static _Thread_local char last_message[STATUS_MESSAGE_SIZE];

/* Who has to know of a lack of memory at once. */
static _Thread_local struct {
    void (*lacks_memory)(void *context);
    void *context;
} watcher;

const char *dem_version(void)
{
    return DEM_VERSION;
}

const char *dem_status_message(void)
{
    return last_message;
}

const char *dem_status_name(dem_status status)
{
    switch (status) {
    case DEM_OK:
        return "DEM_OK";
    case DEM_STOPPED:
        return "DEM_STOPPED";
    case DEM_ERROR_MEMORY:
        return "DEM_ERROR_MEMORY";
    case DEM_ERROR_ARGUMENT:
        return "DEM_ERROR_ARGUMENT";
    case DEM_ERROR_MODEL:
        return "DEM_ERROR_MODEL";
    case DEM_ERROR_INTEGRATOR:
        return "DEM_ERROR_INTEGRATOR";
    case DEM_ERROR_CONTACT:
        return "DEM_ERROR_CONTACT";
    case DEM_ERROR_IO:
        return "DEM_ERROR_IO";
    }
    return NULL; /* a callback may return any number */
}

dem_status status_check_number(const char *what, dem_index number, dem_index n)
{
    CHECK(number >= 0 && number < n, DEM_ERROR_ARGUMENT, "there is no %s %lld: there are %lld, from 0 on", what,
          (long long)number, (long long)n);
    return DEM_OK;
}

/* Allocates nothing, so that a lack of memory can be reported, too. */
dem_status status_fail(dem_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(last_message, sizeof last_message, format, arguments);
    va_end(arguments);
    if (status == DEM_ERROR_MEMORY && watcher.lacks_memory != NULL) watcher.lacks_memory(watcher.context);
    return status;
}

dem_status status_repeat(dem_status status, const char *message)
{
    (void)snprintf(last_message, sizeof last_message, "%s", message);
    return status;
}

void status_watch_memory(void (*lacks_memory)(void *context), void *context)
{
    watcher.lacks_memory = lacks_memory;
    watcher.context = context;
}

dem_status dem_private_fail(dem_status status, const char *message)
{
    return status_fail(status, "%s", message);
}
