/* SPDX-License-Identifier: BSD-3-Clause */
/* A checkpoint as named entries of bytes (simulation/checkpoint.c says which entries there are; this file knows names
 * and sizes only). Their file is in checkpoint_format.c. */
#include "base/checkpoint_entries.h"

#include <stdlib.h>
#include <string.h>

#include "base/checkpoint_entry.h"
#include "base/reduce.h"
#include "base/status.h"

/* ---- entries ---- */

dem_status dem_checkpoint_create(dem_checkpoint **out)
{
    CHECK(out != NULL, DEM_ERROR_ARGUMENT, "dem_checkpoint_create: out is NULL");
    dem_checkpoint *checkpoint = calloc(1, sizeof *checkpoint);
    CHECK_MEMORY(checkpoint);
    *out = checkpoint;
    return DEM_OK;
}

void checkpoint_entries_free(dem_checkpoint *checkpoint)
{
    for (dem_index k = 0; k < checkpoint->n; k++) checkpoint_entry_drop(&checkpoint->entries[k]);
    free(checkpoint->entries);
    *checkpoint = (dem_checkpoint){0};
}

void dem_checkpoint_destroy(dem_checkpoint *checkpoint)
{
    if (checkpoint == NULL) return;
    checkpoint_entries_free(checkpoint);
    free(checkpoint);
}

dem_status checkpoint_entries_bring(dem_checkpoint *checkpoint)
{
    for (dem_index k = 0; k < checkpoint->n; k++) TRY(checkpoint_entry_bring_rows(&checkpoint->entries[k]));
    return DEM_OK;
}

dem_status checkpoint_entries_refer(dem_checkpoint *checkpoint, const char *name, const checkpoint_rows *rows)
{
    checkpoint_entry *e;
    TRY(checkpoint_entry_make_empty(checkpoint, name, &e));
    e->size = (size_t)rows->n * rows->size;
    e->away = *rows;
    return DEM_OK;
}

/* Memory is asked for before the old bytes are touched. */
dem_status checkpoint_entries_make(dem_checkpoint *checkpoint, const char *name, size_t size, void **data)
{
    checkpoint_entry *e = checkpoint_entry_find(checkpoint, name);
    if (e == NULL)
        TRY(checkpoint_entry_make(checkpoint, name, size, &e));
    else
        TRY(checkpoint_entry_reserve(e, size));
    stored_file_drop(e->file);
    e->file = NULL;
    e->away.visit = NULL;
    e->size = size;
    *data = e->data;
    return DEM_OK;
}

dem_status dem_checkpoint_put(dem_checkpoint *checkpoint, const char *name, const void *data, size_t size)
{
    CHECK(checkpoint != NULL && name != NULL && (data != NULL || size == 0), DEM_ERROR_ARGUMENT,
          "dem_checkpoint_put: an argument is NULL");
    CHECK(*name != '\0' && strlen(name) < CHECKPOINT_NAME, DEM_ERROR_ARGUMENT,
          "\"%s\" cannot name an entry: 1 to %d characters", name, CHECKPOINT_NAME - 1);
    void *to;
    TRY(checkpoint_entries_make(checkpoint, name, size, &to));
    if (size > 0) memcpy(to, data, size);
    return DEM_OK;
}

const void *dem_checkpoint_find(const dem_checkpoint *checkpoint, const char *name, size_t *size)
{
    checkpoint_entry *e = checkpoint_entry_find(checkpoint, name);
    const bool is_here = e != NULL && checkpoint_entry_bring(e) == DEM_OK;
    *size = is_here ? e->size : 0;
    return is_here ? e->data : NULL;
}

/* The size must be exactly what the reader expects: a file of another version is noticed here. */
dem_status checkpoint_entries_check(const dem_checkpoint *checkpoint, const char *name, size_t size)
{
    const checkpoint_entry *e = checkpoint_entry_find(checkpoint, name);
    CHECK(e != NULL, DEM_ERROR_IO, "the checkpoint has no %s", name);
    CHECK(e->size == size, DEM_ERROR_IO, "the checkpoint has %zu bytes of %s, %zu are expected", e->size, name, size);
    return DEM_OK;
}

dem_status dem_checkpoint_get(const dem_checkpoint *checkpoint, const char *name, void *data, size_t size)
{
    CHECK(checkpoint != NULL && name != NULL && (data != NULL || size == 0), DEM_ERROR_ARGUMENT,
          "dem_checkpoint_get: an argument is NULL");
    TRY(checkpoint_entries_check(checkpoint, name, size));
    return checkpoint_entries_read(checkpoint, name, 0, size, data);
}

dem_status checkpoint_entries_read(const dem_checkpoint *checkpoint, const char *name, size_t from, size_t size,
                                   void *to)
{
    checkpoint_entry *e = checkpoint_entry_find(checkpoint, name);
    CHECK(e != NULL && from <= e->size && size <= e->size - from, DEM_ERROR_IO,
          "the checkpoint has no %zu bytes of %s from byte %zu on", size, name, from);
    if (e->file != NULL) return stored_file_read(e->file, e->at + from, size, to);
    TRY(checkpoint_entry_bring_rows(e));
    if (size > 0) memcpy(to, e->data + from, size);
    return DEM_OK;
}

dem_status checkpoint_entries_row_reader(void *source, dem_index first, dem_index n, void *rows)
{
    const checkpoint_row_source *s = source;
    return checkpoint_entries_read(s->from, s->name, s->offset + (size_t)first * s->size, (size_t)n * s->size, rows);
}

dem_status checkpoint_entries_choose(dem_checkpoint *into, const dem_checkpoint *from, checkpoint_entries_choice *takes)
{
    for (dem_index k = 0; k < from->n; k++)
        if (takes == NULL || takes(from->entries[k].name)) TRY(checkpoint_entry_copy(into, &from->entries[k]));
    return DEM_OK;
}

dem_status checkpoint_entries_copy(dem_checkpoint *into, const dem_checkpoint *from)
{
    return checkpoint_entries_choose(into, from, NULL);
}

/* The first is empty then, but for its name. */
static void hand_on(checkpoint_entry *from, checkpoint_entry *to)
{
    if (from == to) return;
    *to = *from;
    from->data = NULL;
    from->file = NULL;
    from->away.visit = NULL;
    from->size = from->capacity = 0;
}

dem_status checkpoint_entries_move(dem_checkpoint *into, dem_checkpoint *from, checkpoint_entries_choice *takes)
{
    dem_index n_left = 0;
    for (dem_index k = 0; k < from->n; k++) {
        checkpoint_entry *moved = &from->entries[k], *e;
        if (takes != NULL && !takes(moved->name)) {
            hand_on(moved, &from->entries[n_left++]);
            continue;
        }
        TRY(checkpoint_entry_make_empty(into, moved->name, &e));
        hand_on(moved, e);
    }
    from->n = n_left;
    return DEM_OK;
}

/* ---- ranks ---- */

/* What rank 0 says of its next entry. */
typedef struct notice {
    bool is_known; /* by rank 0 alone, at first */
    bool is_last;  /* there is none */
    size_t size;
    char name[CHECKPOINT_NAME];
} notice;

static void join_notices(void *packet, const void *other)
{
    if (!((const notice *)packet)->is_known) *(notice *)packet = *(const notice *)other;
}

static notice notice_of(const dem_checkpoint *from, dem_index k)
{
    notice own = {.is_known = true, .is_last = k == from->n};
    if (own.is_last) return own;
    own.size = from->entries[k].size;
    memcpy(own.name, from->entries[k].name, CHECKPOINT_NAME);
    return own;
}

/* Sends bytes from rank 0 to each of the others. */
static dem_status send_bytes(const ranks *r, void *bytes, size_t size)
{
    const int n = r->rank == 0 ? r->size - 1 : 1;
    ranks_message *sent = calloc((size_t)n + 1, sizeof *sent), *received = calloc((size_t)n + 1, sizeof *received);
    const bool has_memory = sent != NULL && received != NULL && bytes != NULL;
    dem_status status = has_memory ? DEM_OK : status_fail(DEM_ERROR_MEMORY, "out of memory for %zu bytes", size);
    status = reduce_status(r, status, 0.0);
    for (int k = 0; k < n && status == DEM_OK; k++) {
        const int other = r->rank == 0 ? k + 1 : 0;
        sent[k] = (ranks_message){other, r->rank == 0 ? size : 0, bytes};
        received[k] = (ranks_message){other, r->rank == 0 ? 0 : size, bytes};
    }
    if (status == DEM_OK) r->exchange(r->self, n, sent, received);
    free(sent);
    free(received);
    return status;
}

/* What rank 0 has may be empty; then there is nothing to send. */
static dem_status share_entry(const ranks *r, const notice *of, void *data, dem_checkpoint *into)
{
    unsigned char *const bytes = r->rank == 0 ? data : malloc(of->size + 1);
    dem_status status = send_bytes(r, bytes, of->size);
    if (status == DEM_OK && r->rank != 0) status = dem_checkpoint_put(into, of->name, bytes, of->size);
    if (r->rank != 0) free(bytes);
    return reduce_status(r, status, 0.0);
}

dem_status checkpoint_entries_share(const ranks *r, dem_checkpoint *checkpoint)
{
    if (r->size == 1) return DEM_OK;
    for (dem_index k = 0;; k++) {
        notice next = r->rank == 0 ? notice_of(checkpoint, k) : (notice){.is_known = false};
        r->reduce(r->self, &next, sizeof next, join_notices);
        if (next.is_last) return DEM_OK;
        checkpoint_entry *e = r->rank == 0 ? &checkpoint->entries[k] : NULL;
        TRY(reduce_status(r, e != NULL ? checkpoint_entry_bring(e) : DEM_OK, 0.0));
        TRY(share_entry(r, &next, e != NULL ? e->data : NULL, checkpoint));
    }
}
