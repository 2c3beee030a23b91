/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/checkpoint_entry.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"

/* Its bytes, wherever they are. */
void checkpoint_entry_drop(checkpoint_entry *e)
{
    free(e->data);
    stored_file_drop(e->file);
    e->data = NULL;
    e->file = NULL;
    e->away.visit = NULL;
    e->size = e->capacity = 0;
}

/* A checkpoint has few entries: a search from the first to the last is fast enough. */
checkpoint_entry *checkpoint_entry_find(const dem_checkpoint *checkpoint, const char *name)
{
    for (dem_index k = 0; k < checkpoint->n; k++)
        if (strcmp(checkpoint->entries[k].name, name) == 0) return &checkpoint->entries[k];
    return NULL;
}

/* Makes room for `size` bytes in an entry. If memory is short, the entry keeps what it has. */
dem_status checkpoint_entry_reserve(checkpoint_entry *e, size_t size)
{
    if (size < e->capacity) return DEM_OK;
    unsigned char *data = realloc(e->data, size + 1);
    CHECK(data != NULL, DEM_ERROR_MEMORY, "out of memory for %zu bytes of a checkpoint", size);
    e->data = data;
    e->capacity = size + 1;
    return DEM_OK;
}

/* The checkpoint counts it only when the room is there, so a failure leaves the checkpoint as it was. */
dem_status checkpoint_entry_make(dem_checkpoint *checkpoint, const char *name, size_t size, checkpoint_entry **out)
{
    CHECK(grow_array((void **)&checkpoint->entries, &checkpoint->capacity, checkpoint->n + 1,
                     sizeof *checkpoint->entries),
          DEM_ERROR_MEMORY, "out of memory for a checkpoint");
    checkpoint_entry *e = &checkpoint->entries[checkpoint->n];
    *e = (checkpoint_entry){.size = 0};
    memcpy(e->name, name, strlen(name));
    TRY(checkpoint_entry_reserve(e, size));
    checkpoint->n++;
    *out = e;
    return DEM_OK;
}

/* The entry of a name, without bytes. */
dem_status checkpoint_entry_make_empty(dem_checkpoint *checkpoint, const char *name, checkpoint_entry **out)
{
    *out = checkpoint_entry_find(checkpoint, name);
    if (*out == NULL) TRY(checkpoint_entry_make(checkpoint, name, 0, out));
    checkpoint_entry_drop(*out);
    return DEM_OK;
}

/* Copies what other ranks have. */
dem_status checkpoint_entry_bring_rows(checkpoint_entry *e)
{
    if (e->away.visit == NULL) return DEM_OK;
    TRY(checkpoint_entry_reserve(e, e->size));
    rows_copy all = {e->away.size, e->data};
    TRY(e->away.visit(e->away.context, rows_taker_copy, &all));
    e->away.visit = NULL;
    return DEM_OK;
}

/* Copies what is elsewhere. */
dem_status checkpoint_entry_bring(checkpoint_entry *e)
{
    if (e->file == NULL) return checkpoint_entry_bring_rows(e);
    TRY(checkpoint_entry_reserve(e, e->size));
    TRY(stored_file_read(e->file, e->at, e->size, e->data));
    stored_file_drop(e->file);
    e->file = NULL;
    return DEM_OK;
}

/* What is in a file is in that of both then. */
dem_status checkpoint_entry_copy(dem_checkpoint *into, checkpoint_entry *e)
{
    checkpoint_entry *to;
    TRY(checkpoint_entry_bring_rows(e));
    if (e->file == NULL) return dem_checkpoint_put(into, e->name, e->data, e->size);
    TRY(checkpoint_entry_make_empty(into, e->name, &to));
    to->size = e->size;
    to->file = stored_file_hold(e->file);
    to->at = e->at;
    return DEM_OK;
}
