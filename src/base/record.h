/* SPDX-License-Identifier: BSD-3-Clause */
/* Writing to a record and reading from one in the same lines of code, so that both agree on the entries. */
#ifndef DEM_BASE_RECORD_H
#define DEM_BASE_RECORD_H

#include <dem/record.h>

/** Puts all entries of a record into another.  \return DEM_ERROR_MEMORY */
dem_status record_copy(dem_record *into, const dem_record *from);

typedef struct record_way {
    dem_record *into;       /* one of both */
    const dem_record *from; /* the bytes it has been made of may be anything */
} record_way;

/** `size` bytes at `data`, under a name. */
static inline dem_status record_pass(const record_way *way, const char *name, void *data, size_t size)
{
    return way->into != NULL ? dem_record_put(way->into, name, data, size)
                             : dem_record_get(way->from, name, data, size);
}

#endif
