/* SPDX-License-Identifier: BSD-3-Clause */
/* Copies public structs to and from a caller whose header is of another version of the library. `struct_size`, the
 * first member, says how long the caller's struct is. A shorter one is older: its missing members have their defaults.
 * A longer one is newer: it is accepted as long as it asks for nothing that this library does not know. Defaults and
 * the meaning of members are the business of those who own a struct. */
#include "base/struct_size.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

/* The struct is read as bytes, since it may end before what its type has in this library. */
static size_t size_of(const void *theirs)
{
    size_t size;
    memcpy(&size, theirs, sizeof size);
    return size;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* A size below that of the first version cannot come from any header of the library. */
static dem_status check_least(const struct_kind *kind, size_t size)
{
    CHECK(size >= kind->first, DEM_ERROR_ARGUMENT, "%s: struct_size is %zu, at least %zu expected", kind->name, size,
          kind->first);
    return DEM_OK;
}

static bool is_possible(const struct_kind *kind, size_t size)
{
    return size >= kind->first && size <= STRUCT_SIZE_MOST;
}

/* The first byte beyond this library's struct that is not 0; the end of the caller's struct if there is none. */
static size_t first_unknown(const struct_kind *kind, const void *theirs)
{
    const size_t size = size_of(theirs);
    const unsigned char *bytes = theirs;
    size_t k = kind->own;
    while (k < size && bytes[k] == 0) k++;
    return k;
}

/* A member unknown to this library must be 0, which stands for its default. Otherwise the caller would get a run
 * without what it asked for. A size beyond STRUCT_SIZE_MOST is that of a struct that was never initialised. */
dem_status struct_size_check(const struct_kind *kind, const void *theirs)
{
    const size_t size = size_of(theirs);
    TRY(check_least(kind, size));
    CHECK(is_possible(kind, size), DEM_ERROR_ARGUMENT, "%s: struct_size is %zu, at most %d expected", kind->name, size,
          STRUCT_SIZE_MOST);
    const size_t unknown = first_unknown(kind, theirs);
    CHECK(unknown >= size, DEM_ERROR_ARGUMENT,
          "%s: struct_size is %zu, and what is set at byte %zu is unknown to this library, whose own has %zu",
          kind->name, size, unknown, kind->own);
    return DEM_OK;
}

bool struct_size_fits(const struct_kind *kind, const void *theirs)
{
    const size_t size = size_of(theirs);
    return is_possible(kind, size) && first_unknown(kind, theirs) >= size;
}

/* Copies the members that both sides have; the rest of `ours` keeps its defaults. */
dem_status struct_size_read(const struct_kind *kind, void *ours, const void *theirs)
{
    TRY(struct_size_check(kind, theirs));
    memcpy(ours, theirs, smaller(size_of(theirs), kind->own));
    memcpy(ours, &kind->own, sizeof kind->own);
    return DEM_OK;
}

static dem_status read_each(const struct_kind *kind, char *ours, const char *theirs, dem_index n)
{
    const size_t stride = size_of(theirs);
    TRY(struct_size_read(kind, ours, theirs));
    for (dem_index k = 1; k < n; k++) {
        const size_t size = size_of(theirs + (size_t)k * stride);
        CHECK(size == stride, DEM_ERROR_ARGUMENT, "%s %lld of %lld: struct_size is %zu, that of the first is %zu",
              kind->name, (long long)k, (long long)n, size, stride);
        TRY(struct_size_read(kind, ours + (size_t)k * kind->own, theirs + (size_t)k * stride));
    }
    return DEM_OK;
}

/* The size in the first struct is the distance from each to the next. It is checked before the second is looked at. */
dem_status struct_size_read_array(const struct_kind *kind, void **ours, const void *theirs, dem_index n)
{
    *ours = NULL;
    if (n == 0) return DEM_OK;
    char *list = calloc((size_t)n, kind->own);
    CHECK(list != NULL, DEM_ERROR_MEMORY, "out of memory for %lld of %s", (long long)n, kind->name);
    const dem_status status = read_each(kind, list, theirs, n);
    if (status == DEM_OK)
        *ours = list;
    else
        free(list);
    return status;
}

/* A size that is not a multiple of 8 ends within a member: such a member is not written at all. */
dem_status struct_size_write(const struct_kind *kind, void *theirs, const void *ours)
{
    const size_t size = size_of(theirs), head = sizeof size;
    TRY(check_least(kind, size));
    memcpy((char *)theirs + head, (const char *)ours + head, smaller(size - size % sizeof(double), kind->own) - head);
    return DEM_OK;
}
