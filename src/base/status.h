/* SPDX-License-Identifier: BSD-3-Clause */
/* How a failure travels: CHECK stores a message and returns a status, TRY passes a status up to the caller. No function
 * of the library prints or exits. */
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

/** The first of two statuses that is not DEM_OK: of an operation and of its clean-up. */
static inline dem_status status_first(dem_status status, dem_status next)
{
    return status != DEM_OK ? status : next;
}

/** Checks the number of one of n things, such as bodies.
 *  \param what  names one in the message
 *  \return DEM_ERROR_ARGUMENT */
dem_status status_check_number(const char *what, dem_index number, dem_index n);

/** A message with the zero at its end, bytes; a longer one is cut. */
enum { STATUS_MESSAGE_SIZE = 512 };

/** Stores a message for this thread, as printf would write it, and returns `status`. */
dem_status status_fail(dem_status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** The same of a failure that is not of this thread: another rank has reported it. */
dem_status status_repeat(dem_status status, const char *message);

/** From now on status_fail() calls this function for each lack of memory in this thread, its message stored. NULL: it
 *  calls none, as at first. */
void status_watch_memory(void (*lacks_memory)(void *context), void *context);

/** As status_fail(), of a message that is there, for libdem_mpi: a library of its own, which has the same version.
 *  No program may call this. */
DEM_API dem_status dem_private_fail(dem_status status, const char *message);

#endif
