/* SPDX-License-Identifier: BSD-3-Clause */
/* How a failure travels: CHECK makes a status with its message, TRY passes one up. */
#ifndef DEM_BASE_STATUS_H
#define DEM_BASE_STATUS_H

#include <dem/dem.h>

#define TRY(expression)                                                                                                \
    do {                                                                                                               \
        const dem_status try_status_ = (expression);                                                                   \
        if (try_status_ != DEM_OK) return try_status_;                                                                 \
    } while (0)

#define CHECK(condition, status, ...)                                                                                  \
    do {                                                                                                               \
        if (!(condition)) return status_fail((status), __VA_ARGS__);                                                   \
    } while (0)

#define CHECK_MEMORY(pointer) CHECK((pointer) != NULL, DEM_ERROR_MEMORY, "out of memory")

/** Of two statuses in a row the first that is not DEM_OK. */
static inline dem_status status_first(dem_status status, dem_status next)
{
    return status != DEM_OK ? status : next;
}

/** Stores the message, printf-like, and returns `status`. */
dem_status status_fail(dem_status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
