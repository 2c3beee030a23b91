/* SPDX-License-Identifier: BSD-3-Clause */
/* The file of a checkpoint. It has a header of 64 bytes, then for each entry a head of 40 bytes and its bytes, filled
 * up with zeros to a multiple of 8. The checksum is the CRC-32 of the whole file with the checksum itself taken as 0.
 * Numbers are in the byte order of the machine, which the header states. A file that is read may be damaged or
 * hostile: no size in it is trusted beyond the bytes that the file has. Entries with rows of all nodes or springs are
 * read for the checksum, and stay in the file until somebody looks at them. A file that is written is synced and read
 * back before it takes its name (publish.c), and the file that had this name is kept as NAME.prev. */
#include "base/checkpoint_entry.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <zlib.h>

#include "base/publish.h"
#include "base/status.h"

enum { FORMAT = 1, UNIT = 8, BLOCK = 1 << 14 };

enum { LARGE = 1 << 16 }; /* bytes of an entry that stays in the file, if its name is one of */
/* Who reads these asks for rows, and takes failures; of others that are not there checkpoints may have none. */
static const char *const of_rows[] = {"state", "peaks.nodes", "peaks.springs"};

/* The end of a line in it shows a transfer that converted line ends. */
static const char magic[8] = "demrec\r\n";
static const uint32_t byte_order = 0x01020304;

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
    char name[CHECKPOINT_NAME];
    uint64_t size; /* bytes */
} head;

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
    stored_file *stored; /* where large entries that are read are left; NULL: none are */
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

/* From one file into the other. */
static dem_status put_stored(stream *s, const checkpoint_entry *e)
{
    unsigned char block[BLOCK];
    for (size_t at = 0, n; at < e->size; at += n) {
        n = e->size - at < sizeof block ? e->size - at : sizeof block;
        TRY(stored_file_read(e->file, e->at + at, n, block));
        TRY(put(s, block, n));
    }
    return DEM_OK;
}

static dem_status put_data(stream *s, const checkpoint_entry *e)
{
    rows_stream to = {s, e->away.size};
    if (e->file != NULL) return put_stored(s, e);
    return e->away.visit != NULL ? e->away.visit(e->away.context, put_rows, &to) : put(s, e->data, e->size);
}

/* Padding is written as zeros, so that equal checkpoints are equal files. */
static dem_status put_entries(stream *s, const dem_checkpoint *checkpoint)
{
    static const unsigned char zeros[UNIT];
    for (dem_index k = 0; k < checkpoint->n; k++) {
        const checkpoint_entry *e = &checkpoint->entries[k];
        head first = {.size = e->size};
        memcpy(first.name, e->name, CHECKPOINT_NAME);
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

/* Adds the next bytes to the checksum alone. */
static dem_status skip(stream *s, size_t size)
{
    unsigned char block[BLOCK];
    for (size_t n; size > 0; size -= n) {
        n = size < sizeof block ? size : sizeof block;
        TRY(get(s, block, n));
    }
    return DEM_OK;
}

static dem_status leave(stream *s, checkpoint_entry *e, size_t size)
{
    const off_t at = ftello(s->file);
    CHECK(at >= 0, DEM_ERROR_IO, "%s: cannot be read (%s)", s->path, strerror(errno));
    e->file = stored_file_hold(s->stored);
    e->at = (uint64_t)at;
    e->size = size;
    return skip(s, size);
}

static bool stays(const head *first)
{
    bool is_named = false;
    for (size_t k = 0; k < sizeof of_rows / sizeof *of_rows; k++)
        is_named = is_named || strcmp(first->name, of_rows[k]) == 0;
    return is_named && first->size >= LARGE;
}

static dem_status get_data(stream *s, dem_checkpoint *checkpoint, const head *first)
{
    const size_t size = (size_t)first->size;
    checkpoint_entry *e;
    TRY(checkpoint_entry_make(checkpoint, first->name, stays(first) ? 0 : size, &e));
    if (stays(first)) return leave(s, e, size);
    TRY(get(s, e->data, size));
    e->size = size;
    return DEM_OK;
}

/* An entry is refused if its name does not end within its field or has been there before, or if its size exceeds the
 * rest of the file: that is found before memory is asked for, so a damaged size cannot exhaust it. */
static dem_status get_entry(stream *s, dem_checkpoint *checkpoint)
{
    unsigned char filling[UNIT];
    head first;
    TRY(get(s, &first, sizeof first));
    const bool named = first.name[0] != '\0' && memchr(first.name, '\0', CHECKPOINT_NAME) != NULL;
    CHECK(named && first.size <= s->left && checkpoint_entry_find(checkpoint, first.name) == NULL, DEM_ERROR_IO,
          "%s: is damaged", s->path);
    TRY(get_data(s, checkpoint, &first));
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
    *out = (stream){file, path, (uint64_t)about.st_size, crc32_z(0, NULL, 0), NULL};
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
        status = stored_file_open(&s.stored, s.file, path);
        if (status == DEM_OK) status = get_file(&s, checkpoint);
        stored_file_drop(s.stored);
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
    stream s;
    header stored;
    TRY(open_stream(&s, path));
    dem_status status = get_header(&s, &stored);
    if (status == DEM_OK) status = skip(&s, s.left);
    if (status == DEM_OK && (stored.size != h->size || s.checksum != stored.checksum))
        status = status_fail(DEM_ERROR_IO, "%s: does not read back as it was written", path);
    (void)fclose(s.file);
    return status;
}

/* Writes, syncs and reads back a file under a provisional name. fclose() may be the first to report a failed write. */
static dem_status write_part(const dem_checkpoint *checkpoint, const char *part)
{
    const header h = header_of(checkpoint);
    stream s = {fopen(part, "wbe"), part, 0, crc32_z(0, NULL, 0), NULL};
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
