/* SPDX-License-Identifier: BSD-3-Clause */
/* A checkpoint as named entries of bytes, in memory and as a file (simulation/checkpoint.c says which entries there
 * are; this file knows names and sizes only). The file has a header of 64 bytes, then for each
 * entry a head of 40 bytes and its bytes, filled up with zeros to a multiple of 8. The checksum is the CRC-32 of the
 * whole file with the checksum itself taken as 0. Numbers are in the byte order of the machine, which the header
 * states. A file that is read may be damaged or hostile: no size in it is trusted beyond the bytes that the file has. A
 * file that is written is synced and read back before it takes its name (publish.c), and the file that had this name is
 * kept as NAME.prev. */
#include "base/checkpoint_entries.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <zlib.h>

#include "base/grow.h"
#include "base/publish.h"
#include "base/reduce.h"
#include "base/status.h"

enum { FORMAT = 1, NAME = 32, UNIT = 8 };

/* The end of a line in it shows a transfer that converted line ends. */
static const char magic[8] = "demrec\r\n";
static const uint32_t byte_order = 0x01020304;

/* An entry in memory. `capacity` is at least size + 1, so that an entry of no bytes has its memory, too; or 0, if its
 * rows are elsewhere. */
typedef struct entry {
    char name[NAME];
    size_t size, capacity; /* bytes */
    unsigned char *data;
    checkpoint_rows away; /* without `visit`: they are in `data` */
} entry;

struct dem_checkpoint {
    dem_index n, capacity;
    entry *entries;
};

/* The first bytes of a file, as they are on the disk. No member needs padding. */
typedef struct header {
    char magic[8];
    uint32_t byte_order, format;
    uint64_t size; /* bytes of the file */
    uint64_t n;    /* entries */
    uint64_t checksum;
    uint64_t unused[3];
} header;

/* Stands in the file before the bytes of each entry. */
typedef struct head {
    char name[NAME];
    uint64_t size; /* bytes */
} head;

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
    for (dem_index k = 0; k < checkpoint->n; k++) free(checkpoint->entries[k].data);
    free(checkpoint->entries);
    *checkpoint = (dem_checkpoint){0};
}

void dem_checkpoint_destroy(dem_checkpoint *checkpoint)
{
    if (checkpoint == NULL) return;
    checkpoint_entries_free(checkpoint);
    free(checkpoint);
}

/* A checkpoint has few entries: a search from the first to the last is fast enough. */
static entry *find(const dem_checkpoint *checkpoint, const char *name)
{
    for (dem_index k = 0; k < checkpoint->n; k++)
        if (strcmp(checkpoint->entries[k].name, name) == 0) return &checkpoint->entries[k];
    return NULL;
}

/* Makes room for `size` bytes in an entry. If memory is short, the entry keeps what it has. */
static dem_status reserve(entry *e, size_t size)
{
    if (size < e->capacity) return DEM_OK;
    unsigned char *data = realloc(e->data, size + 1);
    CHECK(data != NULL, DEM_ERROR_MEMORY, "out of memory for %zu bytes of a checkpoint", size);
    e->data = data;
    e->capacity = size + 1;
    return DEM_OK;
}

/* Appends an entry with room for `size` bytes. The checkpoint counts it only when the room is there, so a failure
 * leaves the checkpoint as it was. The name is shorter than NAME, as callers have checked. */
static dem_status make(dem_checkpoint *checkpoint, const char *name, size_t size, entry **out)
{
    CHECK(grow_array((void **)&checkpoint->entries, &checkpoint->capacity, checkpoint->n + 1,
                     sizeof *checkpoint->entries),
          DEM_ERROR_MEMORY, "out of memory for a checkpoint");
    entry *e = &checkpoint->entries[checkpoint->n];
    *e = (entry){.size = 0};
    memcpy(e->name, name, strlen(name));
    TRY(reserve(e, size));
    checkpoint->n++;
    *out = e;
    return DEM_OK;
}

/* Copies what is elsewhere. */
static dem_status bring(entry *e)
{
    if (e->away.visit == NULL) return DEM_OK;
    TRY(reserve(e, e->size));
    rows_copy all = {e->away.size, e->data};
    TRY(e->away.visit(e->away.context, rows_taker_copy, &all));
    e->away.visit = NULL;
    return DEM_OK;
}

dem_status checkpoint_entries_bring(dem_checkpoint *checkpoint)
{
    for (dem_index k = 0; k < checkpoint->n; k++) TRY(bring(&checkpoint->entries[k]));
    return DEM_OK;
}

dem_status checkpoint_entries_refer(dem_checkpoint *checkpoint, const char *name, const checkpoint_rows *rows)
{
    entry *e = find(checkpoint, name);
    if (e == NULL) TRY(make(checkpoint, name, 0, &e));
    free(e->data);
    e->data = NULL;
    e->capacity = 0;
    e->size = (size_t)rows->n * rows->size;
    e->away = *rows;
    return DEM_OK;
}

/* Memory is asked for before the old bytes are touched. */
dem_status checkpoint_entries_make(dem_checkpoint *checkpoint, const char *name, size_t size, void **data)
{
    entry *e = find(checkpoint, name);
    if (e == NULL)
        TRY(make(checkpoint, name, size, &e));
    else
        TRY(reserve(e, size));
    e->away.visit = NULL;
    e->size = size;
    *data = e->data;
    return DEM_OK;
}

dem_status dem_checkpoint_put(dem_checkpoint *checkpoint, const char *name, const void *data, size_t size)
{
    CHECK(checkpoint != NULL && name != NULL && (data != NULL || size == 0), DEM_ERROR_ARGUMENT,
          "dem_checkpoint_put: an argument is NULL");
    CHECK(*name != '\0' && strlen(name) < NAME, DEM_ERROR_ARGUMENT, "\"%s\" cannot name an entry: 1 to %d characters",
          name, NAME - 1);
    void *to;
    TRY(checkpoint_entries_make(checkpoint, name, size, &to));
    if (size > 0) memcpy(to, data, size);
    return DEM_OK;
}

const void *dem_checkpoint_find(const dem_checkpoint *checkpoint, const char *name, size_t *size)
{
    entry *e = find(checkpoint, name);
    const bool is_here = e != NULL && bring(e) == DEM_OK;
    *size = is_here ? e->size : 0;
    return is_here ? e->data : NULL;
}

/* The size must be exactly what the reader expects: a file of another version is noticed here. */
dem_status dem_checkpoint_get(const dem_checkpoint *checkpoint, const char *name, void *data, size_t size)
{
    CHECK(checkpoint != NULL && name != NULL && (data != NULL || size == 0), DEM_ERROR_ARGUMENT,
          "dem_checkpoint_get: an argument is NULL");
    entry *e = find(checkpoint, name);
    CHECK(e != NULL, DEM_ERROR_IO, "the checkpoint has no %s", name);
    TRY(bring(e));
    CHECK(e->size == size, DEM_ERROR_IO, "the checkpoint has %zu bytes of %s, %zu are expected", e->size, name, size);
    if (size > 0) memcpy(data, e->data, size);
    return DEM_OK;
}

dem_status checkpoint_entries_choose(dem_checkpoint *into, const dem_checkpoint *from, checkpoint_entries_choice *takes)
{
    for (dem_index k = 0; k < from->n; k++) {
        entry *e = &from->entries[k];
        if (takes != NULL && !takes(e->name)) continue;
        TRY(bring(e));
        TRY(dem_checkpoint_put(into, e->name, e->data, e->size));
    }
    return DEM_OK;
}

dem_status checkpoint_entries_copy(dem_checkpoint *into, const dem_checkpoint *from)
{
    return checkpoint_entries_choose(into, from, NULL);
}

dem_status checkpoint_entries_move(dem_checkpoint *into, dem_checkpoint *from, checkpoint_entries_choice *takes)
{
    dem_index n_left = 0;
    for (dem_index k = 0; k < from->n; k++) {
        entry *moved = &from->entries[k], *e = find(into, moved->name);
        if (takes != NULL && !takes(moved->name)) {
            from->entries[n_left++] = *moved;
            continue;
        }
        if (e == NULL) TRY(make(into, moved->name, 0, &e));
        free(e->data);
        *e = *moved;
        moved->data = NULL;
        moved->size = moved->capacity = 0;
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
    char name[NAME];
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
    memcpy(own.name, from->entries[k].name, NAME);
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
        TRY(share_entry(r, &next, r->rank == 0 ? checkpoint->entries[k].data : NULL, checkpoint));
    }
}

/* ---- the file ---- */

/* Bytes of zeros that follow `size` bytes, so that the next head begins at a multiple of 8. */
static size_t padding(uint64_t size)
{
    return (size_t)((UNIT - size % UNIT) % UNIT);
}

/* A file that is written or read from its beginning to its end. */
typedef struct stream {
    FILE *file;
    const char *path;
    uint64_t left; /* bytes to come */
    uLong checksum;
} stream;

/* Where rows of an entry go that are handed over. */
typedef struct rows_stream {
    stream *to;
    size_t size; /* bytes of a row */
} rows_stream;

/* Writes bytes and adds them to the checksum. Empty data is left out, since it may come with a null pointer. */
static dem_status put(stream *s, const void *data, size_t size)
{
    CHECK(size == 0 || fwrite(data, 1, size, s->file) == size, DEM_ERROR_IO, "%s: cannot be written (%s)", s->path,
          strerror(errno));
    s->checksum = size > 0 ? crc32_z(s->checksum, data, size) : s->checksum;
    return DEM_OK;
}

/* Reads bytes and adds them to the checksum. `left` keeps a damaged size from reading beyond the file. */
static dem_status get(stream *s, void *data, size_t size)
{
    CHECK(size <= s->left && (size == 0 || fread(data, 1, size, s->file) == size), DEM_ERROR_IO, "%s: is damaged",
          s->path);
    s->left -= size;
    s->checksum = size > 0 ? crc32_z(s->checksum, data, size) : s->checksum;
    return DEM_OK;
}

/* The header of a checkpoint, its checksum still 0. */
static header header_of(const dem_checkpoint *checkpoint)
{
    header h = {.byte_order = byte_order, .format = FORMAT, .size = sizeof h, .n = (uint64_t)checkpoint->n};
    memcpy(h.magic, magic, sizeof magic);
    for (dem_index k = 0; k < checkpoint->n; k++)
        h.size += sizeof(head) + checkpoint->entries[k].size + padding(checkpoint->entries[k].size);
    return h;
}

static dem_status put_rows(void *context, dem_index first, dem_index n, const void *rows)
{
    const rows_stream *s = context;
    (void)first;
    return put(s->to, rows, (size_t)n * s->size);
}

static dem_status put_data(stream *s, const entry *e)
{
    rows_stream to = {s, e->away.size};
    return e->away.visit != NULL ? e->away.visit(e->away.context, put_rows, &to) : put(s, e->data, e->size);
}

/* Padding is written as zeros, so that equal checkpoints are equal files. */
static dem_status put_entries(stream *s, const dem_checkpoint *checkpoint)
{
    static const unsigned char zeros[UNIT];
    for (dem_index k = 0; k < checkpoint->n; k++) {
        const entry *e = &checkpoint->entries[k];
        head first = {.size = e->size};
        memcpy(first.name, e->name, NAME);
        TRY(put(s, &first, sizeof first));
        TRY(put_data(s, e));
        TRY(put(s, zeros, padding(e->size)));
    }
    return DEM_OK;
}

/* The checksum stands in the header, ahead of what it sums: the header is written with 0, and again when the checksum
 * is known. */
static dem_status put_file(stream *s, const dem_checkpoint *checkpoint)
{
    header h = header_of(checkpoint);
    TRY(put(s, &h, sizeof h));
    TRY(put_entries(s, checkpoint));
    h.checksum = s->checksum;
    CHECK(fseek(s->file, 0, SEEK_SET) == 0, DEM_ERROR_IO, "%s: cannot be written (%s)", s->path, strerror(errno));
    return put(s, &h, sizeof h);
}

/* Checks what can be checked before the entries are read, the most telling message first. The checksum starts anew from
 * the header with its own field taken as 0, as it was when the file was written. */
static dem_status get_header(stream *s, header *h)
{
    CHECK(s->left >= sizeof *h, DEM_ERROR_IO, "%s: is no checkpoint, or has been cut short", s->path);
    TRY(get(s, h, sizeof *h));
    CHECK(memcmp(h->magic, magic, sizeof magic) == 0, DEM_ERROR_IO, "%s: is no checkpoint", s->path);
    CHECK(h->byte_order == byte_order, DEM_ERROR_IO, "%s: was written on a machine of another byte order", s->path);
    CHECK(h->format == FORMAT, DEM_ERROR_IO, "%s: has format %u, this version reads %d", s->path, h->format, FORMAT);
    CHECK(h->size == s->left + sizeof *h, DEM_ERROR_IO, "%s: has %llu bytes, %llu were written", s->path,
          (unsigned long long)(s->left + sizeof *h), (unsigned long long)h->size);
    header as_summed = *h;
    as_summed.checksum = 0;
    s->checksum = crc32_z(crc32_z(0, NULL, 0), (const void *)&as_summed, sizeof as_summed);
    return DEM_OK;
}

/* An entry is refused if its name does not end within its field or has been there before, or if its size exceeds the
 * rest of the file. The last check comes before memory is asked for, so a damaged size cannot exhaust it. */
static dem_status get_entry(stream *s, dem_checkpoint *checkpoint)
{
    unsigned char filling[UNIT];
    head first;
    entry *e;
    TRY(get(s, &first, sizeof first));
    const bool named = first.name[0] != '\0' && memchr(first.name, '\0', NAME) != NULL;
    CHECK(named && first.size <= s->left && find(checkpoint, first.name) == NULL, DEM_ERROR_IO, "%s: is damaged",
          s->path);
    TRY(make(checkpoint, first.name, (size_t)first.size, &e));
    TRY(get(s, e->data, (size_t)first.size));
    e->size = (size_t)first.size;
    return get(s, filling, padding(first.size));
}

/* The number of entries need not be bounded: each takes at least its head from the file, so the loop ends with the
 * file. */
static dem_status get_file(stream *s, dem_checkpoint *checkpoint)
{
    header h;
    TRY(get_header(s, &h));
    for (uint64_t k = 0; k < h.n; k++) TRY(get_entry(s, checkpoint));
    CHECK(s->left == 0 && s->checksum == h.checksum, DEM_ERROR_IO, "%s: is damaged", s->path);
    return DEM_OK;
}

/* Opens a file for reading. A pipe or a device is refused, because its size is unknown and reading it may never end. */
static dem_status open_stream(stream *out, const char *path)
{
    struct stat about;
    FILE *file = fopen(path, "rbe");
    CHECK(file != NULL, DEM_ERROR_IO, "%s: cannot be opened (%s)", path, strerror(errno));
    if (fstat(fileno(file), &about) != 0 || !S_ISREG(about.st_mode)) {
        (void)fclose(file);
        return status_fail(DEM_ERROR_IO, "%s: is not a regular file", path);
    }
    *out = (stream){file, path, (uint64_t)about.st_size, crc32_z(0, NULL, 0)};
    return DEM_OK;
}

/* *out is set only if the whole file is in order. */
dem_status dem_checkpoint_read(dem_checkpoint **out, const char *path)
{
    stream s;
    dem_checkpoint *checkpoint;
    CHECK(out != NULL && path != NULL, DEM_ERROR_ARGUMENT, "dem_checkpoint_read: %s is NULL",
          out == NULL ? "out" : "path");
    TRY(dem_checkpoint_create(&checkpoint));
    dem_status status = open_stream(&s, path);
    if (status == DEM_OK) {
        status = get_file(&s, checkpoint);
        (void)fclose(s.file);
    }
    if (status == DEM_OK)
        *out = checkpoint;
    else
        dem_checkpoint_destroy(checkpoint);
    return status;
}

/* Reads the written file and compares its size and checksum. A full disk may be found out by nothing else: some file
 * systems report it neither on write nor on close. */
static dem_status read_back(const char *path, const header *h)
{
    unsigned char block[1 << 14];
    stream s;
    header stored;
    TRY(open_stream(&s, path));
    dem_status status = get_header(&s, &stored);
    while (status == DEM_OK && s.left > 0) status = get(&s, block, s.left < sizeof block ? s.left : sizeof block);
    if (status == DEM_OK && (stored.size != h->size || s.checksum != stored.checksum))
        status = status_fail(DEM_ERROR_IO, "%s: does not read back as it was written", path);
    (void)fclose(s.file);
    return status;
}

/* Writes, syncs and reads back a file under a provisional name. fclose() may be the first to report a failed write. */
static dem_status write_part(const dem_checkpoint *checkpoint, const char *part)
{
    const header h = header_of(checkpoint);
    stream s = {fopen(part, "wbe"), part, 0, crc32_z(0, NULL, 0)};
    CHECK(s.file != NULL, DEM_ERROR_IO, "%s: cannot be opened for writing (%s)", part, strerror(errno));
    dem_status status = put_file(&s, checkpoint);
    if (fclose(s.file) != 0 && status == DEM_OK)
        status = status_fail(DEM_ERROR_IO, "%s: cannot be written (%s)", part, strerror(errno));
    TRY(status);
    TRY(publish_sync(part));
    return read_back(part, &h);
}

/* The previous file steps aside before the new one takes its name. If the machine stops between the two renames, it is
 * found as NAME.prev. One allocation holds both derived names. */
dem_status dem_checkpoint_write(const dem_checkpoint *checkpoint, const char *path)
{
    CHECK(checkpoint != NULL && path != NULL, DEM_ERROR_ARGUMENT, "dem_checkpoint_write: %s is NULL",
          checkpoint == NULL ? "checkpoint" : "path");
    const size_t size = strlen(path) + sizeof ".part";
    char *part = malloc(2 * size);
    CHECK_MEMORY(part);
    char *previous = part + size;
    (void)snprintf(part, size, "%s.part", path);
    (void)snprintf(previous, size, "%s.prev", path);
    dem_status status = write_part(checkpoint, part);
    if (status == DEM_OK && access(path, F_OK) == 0) status = publish_rename(path, previous);
    if (status == DEM_OK) status = publish_rename(part, path);
    if (status != DEM_OK) (void)unlink(part);
    free(part);
    return status;
}
