/* SPDX-License-Identifier: BSD-3-Clause */
/* Writing to a checkpoint and reading from one in the same lines of code, so that both agree on the entries. */
#ifndef DEM_BASE_CHECKPOINT_ENTRIES_H
#define DEM_BASE_CHECKPOINT_ENTRIES_H

#include <stdbool.h>

#include <dem/checkpoint.h>

#include "base/ranks.h"
#include "base/rows_taker.h"

/** Puts all entries of a checkpoint into another.  \return DEM_ERROR_MEMORY */
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

/** What makes up an entry that others have until somebody asks for it. */
typedef struct checkpoint_rows {
    dem_status (*visit)(void *context, rows_taker *take, void *taker); /**< hands all over */
    void *context;
    size_t size; /**< bytes of a row */
    dem_index n;
} checkpoint_rows;

/** Makes an entry of rows that are elsewhere, in place of one of its name. A file gets them as they are handed over;
 *  who looks at the entry makes a copy of it here.
 *  \return DEM_ERROR_MEMORY */
dem_status checkpoint_entries_refer(dem_checkpoint *checkpoint, const char *name, const checkpoint_rows *rows);

/** Copies all that is elsewhere, which is about to end.  \return DEM_ERROR_MEMORY */
dem_status checkpoint_entries_bring(dem_checkpoint *checkpoint);

/** Puts all entries of rank 0's checkpoint, of which none is elsewhere, into that of every other rank. Collective.
 *  \return DEM_ERROR_MEMORY, on all ranks */
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
