/* SPDX-License-Identifier: BSD-3-Clause */
/* An entry of a checkpoint: a name, and bytes that are here, or elsewhere until somebody looks at them. For the files
 * that make checkpoints of them. */
#ifndef DEM_BASE_CHECKPOINT_ENTRY_H
#define DEM_BASE_CHECKPOINT_ENTRY_H

#include <dem/checkpoint.h>

#include "base/checkpoint_rows.h"
#include "base/stored_file.h"

enum { CHECKPOINT_NAME = 32 };

/* Its bytes are here, or in a file, or other ranks have them. `capacity` is at least size + 1, so that an entry of no
 * bytes has its memory, too; or 0, if they are elsewhere. */
typedef struct checkpoint_entry {
    char name[CHECKPOINT_NAME];
    size_t size, capacity; /* bytes */
    unsigned char *data;
    stored_file *file;    /* NULL: they are in none, */
    uint64_t at;          /* or where they begin there */
    checkpoint_rows away; /* without `visit`: no rank has them */
} checkpoint_entry;

struct dem_checkpoint {
    dem_index n, capacity;
    checkpoint_entry *entries;
};

/** NULL: there is none of this name. */
checkpoint_entry *checkpoint_entry_find(const dem_checkpoint *checkpoint, const char *name);

/** Appends an entry with room for `size` bytes, of a name that there is not, shorter than CHECKPOINT_NAME.
 *  \return DEM_ERROR_MEMORY; then the checkpoint is as it was */
dem_status checkpoint_entry_make(dem_checkpoint *checkpoint, const char *name, size_t size, checkpoint_entry **out);

/** The entry of a name, which there may be, without bytes.  \return DEM_ERROR_MEMORY */
dem_status checkpoint_entry_make_empty(dem_checkpoint *checkpoint, const char *name, checkpoint_entry **out);

/** Makes room for `size` bytes.  \return DEM_ERROR_MEMORY; then it keeps what it has */
dem_status checkpoint_entry_reserve(checkpoint_entry *e, size_t size);

/** Has no bytes any more, wherever they are. */
void checkpoint_entry_drop(checkpoint_entry *e);

/** Copies what ranks have; and what is in a file, too.  \return DEM_ERROR_MEMORY, DEM_ERROR_IO */
dem_status checkpoint_entry_bring_rows(checkpoint_entry *e);
dem_status checkpoint_entry_bring(checkpoint_entry *e);

/** Puts it into another checkpoint. What is in a file stays there.  \return DEM_ERROR_MEMORY */
dem_status checkpoint_entry_copy(dem_checkpoint *into, checkpoint_entry *e);

#endif
