/* SPDX-License-Identifier: BSD-3-Clause */
/* Public structs that may grow: their first member, size_t struct_size, is what sizeof gave in the caller's header,
 * which may be older or newer than this library. Nothing beyond it is read or written. */
#ifndef DEM_BASE_STRUCT_SIZE_H
#define DEM_BASE_STRUCT_SIZE_H

#include <stddef.h>

#include <dem/status.h>

/** Bytes of a struct up to and with a member. */
#define STRUCT_SIZE_WITH(type, member) (offsetof(type, member) + sizeof(((type *)NULL)->member))

enum { STRUCT_SIZE_MOST = 4096 }; /* bytes: what says more has not been initialised */

typedef struct struct_kind {
    const char *name;
    size_t first; /* bytes of the shortest that is accepted: of the first version, whatever is added to it later */
    size_t own;   /* bytes of this library's */
} struct_kind;

/** Whether a caller's struct can be read: not shorter than the first version, and, if longer than this library's, with
 *  nothing but zeros in the members that this library does not know.  \return DEM_ERROR_ARGUMENT */
dem_status struct_size_check(const struct_kind *kind, const void *theirs);

/** Reads a caller's struct.
 *  \param ours  holds the defaults of all members, and keeps those of what the caller's struct is too short for; its
 *               struct_size becomes this library's */
dem_status struct_size_read(const struct_kind *kind, void *ours, const void *theirs);

/** Writes the members that lie within a caller's struct; leaves struct_size and everything beyond alone. Every member
 *  is made of numbers of 8 bytes.
 *  \return DEM_ERROR_ARGUMENT if it is shorter than the first version; then nothing has been written */
dem_status struct_size_write(const struct_kind *kind, void *theirs, const void *ours);

#endif
