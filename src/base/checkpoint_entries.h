/* SPDX-License-Identifier: BSD-3-Clause */
/* Writing to a checkpoint and reading from one in the same lines of code, so that both agree on the entries. */
#ifndef DEM_BASE_CHECKPOINT_ENTRIES_H
#define DEM_BASE_CHECKPOINT_ENTRIES_H

#include <stdbool.h>

#include <dem/checkpoint.h>

#include "base/checkpoint_rows.h"
#include "base/ranks.h"

/** Puts all entries of a checkpoint into another; those in a file stay there.  \return DEM_ERROR_MEMORY */
dem_status checkpoint_entries_copy(dem_checkpoint *into, const dem_checkpoint *from);

/** The same with those of some names.
 *  \param takes  whether an entry of this name is wanted; NULL: all are */
typedef bool checkpoint_entries_choice(const char *name);
dem_status checkpoint_entries_choose(dem_checkpoint *into, const dem_checkpoint *from,
                                     checkpoint_entries_choice *takes);

/** Moves entries of a checkpoint into another, in place of those of the same names.
 *  \param takes  NULL: all are wanted
 *  \return DEM_ERROR_MEMORY, with some of them moved, which are empty in the first */
dem_status checkpoint_entries_move(dem_checkpoint *into, dem_checkpoint *from, checkpoint_entries_choice *takes);

/** Frees all entries. */
void checkpoint_entries_free(dem_checkpoint *checkpoint);

/** Makes an entry of so many bytes, or gives that of this name as many, for the caller to write: no copy of them is
 *  needed elsewhere.
 *  \param name       1 to 31 characters
 *  \param[out] data  its bytes, of any values, until the entry is put again
 *  \return DEM_ERROR_MEMORY, then the entry is as it was */
dem_status checkpoint_entries_make(dem_checkpoint *checkpoint, const char *name, size_t size, void **data);

/** Makes an entry of rows that are elsewhere, in place of one of its name. A file gets them as they are handed over;
 *  who looks at the entry makes a copy of it here.
 *  \return DEM_ERROR_MEMORY */
dem_status checkpoint_entries_refer(dem_checkpoint *checkpoint, const char *name, const checkpoint_rows *rows);

/** Copies all that ranks have, which is about to end.  \return DEM_ERROR_MEMORY */
dem_status checkpoint_entries_bring(dem_checkpoint *checkpoint);

/** Whether there is an entry of so many bytes, wherever they are.  \return DEM_ERROR_IO */
dem_status checkpoint_entries_check(const dem_checkpoint *checkpoint, const char *name, size_t size);

/** Copies some bytes of an entry, from byte `from` on. What is in a file stays there.
 *  \return DEM_ERROR_IO if it does not have them, DEM_ERROR_MEMORY */
dem_status checkpoint_entries_read(const dem_checkpoint *checkpoint, const char *name, size_t from, size_t size,
                                   void *to);

/** Rows of an entry, from a byte of it on, as checkpoint_entries_row_reader() reads them. */
typedef struct checkpoint_row_source {
    const dem_checkpoint *from;
    const char *name;
    size_t offset, size; /* bytes: where they begin, and of a row */
} checkpoint_row_source;

/** A rows_reader.  \param source  checkpoint_row_source */
dem_status checkpoint_entries_row_reader(void *source, dem_index first, dem_index n, void *rows);

/** Puts all entries of rank 0's checkpoint, of which other ranks have none, into that of every other rank. Collective.
 *  \return DEM_ERROR_MEMORY, DEM_ERROR_IO, on all ranks */
dem_status checkpoint_entries_share(const ranks *r, dem_checkpoint *checkpoint);

typedef struct checkpoint_entries_way {
    dem_checkpoint *into;       /* where to write; NULL: read from `from` */
    const dem_checkpoint *from; /* may come from any file: what is read has to be checked */
} checkpoint_entries_way;

/** `size` bytes at `data`, under a name. */
static inline dem_status checkpoint_entries_pass(const checkpoint_entries_way *way, const char *name, void *data,
                                                 size_t size)
{
    return way->into != NULL ? dem_checkpoint_put(way->into, name, data, size)
                             : dem_checkpoint_get(way->from, name, data, size);
}

#endif
