/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/status.h -- what a call returns, the message of a failure, and which library this is. */
#ifndef DEM_STATUS_H
#define DEM_STATUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define DEM_API __attribute__((visibility("default")))
#else
#define DEM_API
#endif

typedef int64_t dem_index;

typedef enum dem_status {
    DEM_OK = 0,
    DEM_STOPPED = 1,           /**< an observer asked to stop; the state is valid */
    DEM_ERROR_MEMORY = -1,     /**< an allocation failed */
    DEM_ERROR_ARGUMENT = -2,   /**< a NULL, an unknown enum value, a number outside its range */
    DEM_ERROR_MODEL = -3,      /**< unphysical or inconsistent: mass <= 0, spring without length */
    DEM_ERROR_INTEGRATOR = -4, /**< the tolerance cannot be met; the state is the last good one */
    DEM_ERROR_CONTACT = -5,    /**< impacts accumulate faster than time advances */
    DEM_ERROR_IO = -6          /**< a file cannot be read or written */
} dem_status;

/** "DEM_OK", "DEM_STOPPED" ...; NULL for a number that is none of them. */
DEM_API const char *dem_status_name(dem_status status);

/** Text of the last failure in this thread; valid until the next failing call. Never NULL. */
DEM_API const char *dem_status_message(void);

/** Library version, "MAJOR.MINOR.PATCH". */
DEM_API const char *dem_version(void);

/** Version of the SUNDIALS library in use, "MAJOR.MINOR.PATCH". */
DEM_API const char *dem_version_sundials(void);

#ifdef __cplusplus
}
#endif

#endif
