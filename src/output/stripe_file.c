/* SPDX-License-Identifier: BSD-3-Clause */
/* A file that is to be made is removed first: what a rank of a run that has just been killed may still write goes to
 * the file that had the name before. */
#include "output/stripe_file.h"

#include "base/publish.h"
#include "base/status.h"
#include "output/hdf5_attribute.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The attribute of its root that says of which run it is. */
static const char mark[] = "stripe_of";

struct open_stripe {
    hdf5_file file;
    char path[HDF5_PATH];
};

int stripe_file_stem(const char *whole)
{
    enum { SUFFIX = sizeof ".vtkhdf" - 1 };
    return (int)strlen(whole) - SUFFIX;
}

dem_status stripe_file_path(char out[HDF5_PATH], const char *whole, numbered_file file)
{
    char end[NUMBERED_FILE];
    numbered_file_print(end, file);
    const int n = snprintf(out, HDF5_PATH, "%.*s%s", stripe_file_stem(whole), whole, end);
    CHECK(n > 0 && n < HDF5_PATH, DEM_ERROR_IO, "%s: the name of a stripe is too long", whole);
    return DEM_OK;
}

/* ---- a file that stays open ---- */

dem_status stripe_file_close(open_stripe **kept)
{
    open_stripe *s = *kept;
    *kept = NULL;
    if (s == NULL) return DEM_OK;
    const dem_status status = hdf5_close_paused(&s->file);
    free(s);
    return status;
}

static dem_status open_anew(open_stripe **kept, const char *path, hsize_t bytes)
{
    TRY(stripe_file_close(kept));
    open_stripe *s = calloc(1, sizeof *s);
    CHECK_MEMORY(s);
    memcpy(s->path, path, sizeof s->path);
    const dem_status status = hdf5_open_write(&s->file, s->path, bytes);
    if (status != DEM_OK) {
        free(s);
        return status;
    }
    hdf5_keep(&s->file);
    *kept = s;
    return DEM_OK;
}

dem_status stripe_file_enter(open_stripe **kept, const stripe_name *name, int stripe, hsize_t bytes)
{
    open_stripe *s = *kept;
    char path[HDF5_PATH];
    const numbered_file file = {.segment = name->number, .stripe = stripe + 1, .n = name->n};
    TRY(stripe_file_path(path, name->path, file));
    if (s == NULL || strcmp(s->path, path) != 0) return open_anew(kept, path, bytes);
    return hdf5_resume(&s->file, bytes);
}

const hdf5_file *stripe_file_entered(const open_stripe *s)
{
    return &s->file;
}

/* After a failure it is opened anew the next time. */
dem_status stripe_file_leave(open_stripe **kept, bool stays_open, dem_status status)
{
    open_stripe *s = *kept;
    status = stays_open ? hdf5_pause(&s->file, status) : hdf5_close(&s->file, status);
    if (stays_open && status == DEM_OK) return DEM_OK;
    free(s);
    *kept = NULL;
    return status;
}

/* ---- orders ---- */

/* It is marked before there is anything else in it, and on the disk. */
static dem_status create(const stripe_order *o, const frames *stripe)
{
    hdf5_file file;
    (void)unlink(o->path);
    TRY(hdf5_open_small(&file, o->path));
    dem_status status = hdf5_write_attribute(&file, "/", mark, HDF5_I64, 1, &o->run);
    if (status == DEM_OK) status = frame_stripes_create(stripe, &file);
    TRY(hdf5_close(&file, status));
    return publish_sync(o->path);
}

static bool contains(const unsigned char *bytes, size_t n, const void *what, size_t size)
{
    for (size_t k = 0; k + size <= n; k++)
        if (memcmp(bytes + k, what, size) == 0) return true;
    return false;
}

/* Where HDF5 has put the mark when the file was made it stays. */
static bool begins_with_mark(const char *path, int64_t run)
{
    enum { HEAD = 8192 };
    unsigned char head[HEAD], little[sizeof run];
    FILE *file = fopen(path, "rb");
    if (file == NULL) return false;
    const size_t n = fread(head, 1, HEAD, file);
    const bool is_read = ferror(file) == 0;
    (void)fclose(file);
    for (size_t k = 0; k < sizeof little; k++) little[k] = (unsigned char)((uint64_t)run >> 8 * k);
    const bool is_marked = contains(head, n, mark, sizeof mark - 1) && contains(head, n, little, sizeof little);
    return is_read && (n == 0 || is_marked);
}

bool stripe_file_is_of(const char *path, int64_t run)
{
    hdf5_file file;
    const dem_status status = hdf5_open_read(&file, path);
    if (status == DEM_ERROR_IO) return begins_with_mark(path, run);
    return status == DEM_OK && hdf5_close(&file, hdf5_expect_attribute(&file, "/", mark, run)) == DEM_OK;
}

static dem_status link_file(const stripe_order *o, const frames *stripe)
{
    hdf5_file file;
    TRY(hdf5_open_read(&file, o->other));
    TRY(hdf5_close(&file, frame_arrays_check(stripe, &file, o->frames.count, false)));
    (void)unlink(o->path);
    CHECK(link(o->other, o->path) == 0, DEM_ERROR_IO, "%s: cannot be linked to %s (%s)", o->other, o->path,
          strerror(errno));
    return DEM_OK;
}

static dem_status copy(const stripe_order *o, const frames *stripe)
{
    hdf5_file from, to;
    TRY(hdf5_open_write(&to, o->path, o->frames.count * frame_arrays_bytes(stripe)));
    hdf5_keep(&to);
    dem_status status = hdf5_open_read(&from, o->other);
    if (status == DEM_OK) hdf5_keep(&from);
    if (status == DEM_OK) status = hdf5_close(&from, frame_stripes_copy(&o->whole, o->stripe, &from, &to, o->frames));
    return hdf5_close(&to, status);
}

dem_status stripe_file_obey(open_stripe **kept, const stripe_order *o)
{
    const frames stripe = frame_stripes_get(&o->whole, o->stripe);
    TRY(stripe_file_close(kept));
    switch (o->kind) {
    case STRIPE_CREATE:
        return create(o, &stripe);
    case STRIPE_CLOSE:
        return DEM_OK;
    case STRIPE_LINK:
        return link_file(o, &stripe);
    case STRIPE_COPY:
        return copy(o, &stripe);
    default:
        return hdf5_publish(o->path, o->other);
    }
}
