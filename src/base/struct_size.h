/* SPDX-License-Identifier: BSD-3-Clause */
/* Public structs that may grow: their first member, size_t struct_size, is what sizeof gave in the caller's header,
 * which may be older or newer than this library. Nothing beyond it is read or written. */
#ifndef DEM_BASE_STRUCT_SIZE_H
#define DEM_BASE_STRUCT_SIZE_H

#include <stdbool.h>
#include <stddef.h>

#include <dem/status.h>

/** Bytes of a struct up to and with a member. */
#define STRUCT_SIZE_WITH(type, member) (offsetof(type, member) + sizeof(((type *)NULL)->member))

enum { STRUCT_SIZE_MOST = 4096 }; /* bytes: a struct that claims more has not been initialised */

typedef struct struct_kind {
    const char *name;
    size_t first; /* bytes of the first version, the shortest that is accepted */
    size_t own;   /* bytes of this library's version */
} struct_kind;

/** The kind of a struct that the library fills and never reads: the caller may have room for its first member alone. */
#define STRUCT_KIND(type) ((struct_kind){#type, sizeof(size_t) + sizeof(double), sizeof(type)})

/** Checks that a caller's struct can be read: not shorter than the first version, and, if it is longer than this
 *  library's, with zeros in all members that this library does not know.
 *  \return DEM_ERROR_ARGUMENT */
dem_status struct_size_check(const struct_kind *kind, const void *theirs);

/** Whether a caller's struct can be read, as struct_size_check() says, without a message. */
bool struct_size_fits(const struct_kind *kind, const void *theirs);

/** Reads a caller's struct.
 *  \param ours  holds the defaults of all members, and keeps those beyond the end of the caller's struct; its
 *  struct_size
 *               becomes this library's */
dem_status struct_size_read(const struct_kind *kind, void *ours, const void *theirs);

/** Reads an array of structs, which all have the size that the first one says.
 *  \param[out] ours  [n] of this library's size, all members 0 but those that are read; to be freed by the caller; NULL
 *                    for n = 0 and after a failure
 *  \return DEM_ERROR_ARGUMENT with the number of the struct, DEM_ERROR_MEMORY */
dem_status struct_size_read_array(const struct_kind *kind, void **ours, const void *theirs, dem_index n);

/** Writes the members that lie within a caller's struct; leaves struct_size and everything beyond alone. Every member
 *  is made of numbers of 8 bytes.
 *  \return DEM_ERROR_ARGUMENT if it is shorter than the first version; then nothing has been written */
dem_status struct_size_write(const struct_kind *kind, void *theirs, const void *ours);

#endif
