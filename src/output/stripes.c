/* SPDX-License-Identifier: BSD-3-Clause */
#include "output/stripes.h"

#include "base/numbered_file.h"
#include "base/field_order.h"
#include "base/rank_order.h"
#include "base/status.h"
#include "lattice/lattice_arrays.h"
#include "output/frame_writer.h"
#include "output/stripe_file.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- names ---- */

/* Stripe k from 0 on, under its final name. */
static numbered_file name_of(const stripes *s, dem_index number, int k)
{
    return (numbered_file){.segment = number, .stripe = k + 1, .n = s->n};
}

/* Those of the whole have other names until they are. */
static numbered_file name_at_first(const stripes *s, dem_index number, int k)
{
    return (numbered_file){.segment = number, .stripe = k + 1, .n = s->n, .is_temporary = number == 0};
}

/* A hash, and the number of the array that comes next. */
typedef struct hashing {
    uint64_t hash;
    int array;
} hashing;

static dem_status add_chunk(void *context, dem_index first, dem_index n, const void *items)
{
    hashing *h = context;
    (void)first;
    h->hash = lattice_arrays_hash_next(h->hash, h->array, items, n);
    return DEM_OK;
}

dem_status stripes_run(int64_t *out, const lattice_source *lattice)
{
    hashing h = {.hash = lattice_arrays_hash_counts(lattice->lattice)};
    for (h.array = 0; h.array < LATTICE_ARRAYS; h.array++) {
        const size_t member = lattice_arrays[h.array].offset;
        if (dem_private_lattice_has(lattice, member))
            TRY(dem_private_lattice_visit(lattice, member, add_chunk, &h));
        else
            h.hash = lattice_arrays_hash_next(h.hash, h.array, NULL, 0);
    }
    *out = (int64_t)h.hash;
    return DEM_OK;
}

/* Whether a file is a stripe of this run, of which there is a hash where it writes stripes itself. */
static bool is_own(const stripes *s, const char *path)
{
    int64_t run = s->run;
    if (s->n == 0 && stripes_run(&run, &s->lattice) != DEM_OK) return false;
    return stripe_file_is_of(path, run);
}

/* ---- orders ---- */

/* To all writers at once. */
typedef struct orders {
    stripe_order *contents; /* [n] */
    rank_order *list;       /* [n] */
} orders;

static dem_status prepare(orders *o, const stripes *s, const frames *f, dem_index number, stripe_order_kind kind)
{
    const int ranks = rank_order_ranks(s->simulation);
    *o = (orders){calloc((size_t)s->n, sizeof *o->contents), calloc((size_t)s->n, sizeof *o->list)};
    CHECK(o->contents != NULL && o->list != NULL, DEM_ERROR_MEMORY, "out of memory for %d stripes", s->n);
    for (int k = 0; k < s->n; k++) {
        stripe_order *what = &o->contents[k];
        what->kind = kind;
        what->whole = *f;
        what->stripe = k;
        what->run = s->run;
        TRY(stripe_file_path(what->path, s->path, name_at_first(s, number, k)));
        o->list[k] = (rank_order){field_writer(ranks, s->n, k), sizeof *what, what};
    }
    return DEM_OK;
}

static dem_status give(const orders *o, const stripes *s, dem_status status)
{
    if (status == DEM_OK) status = rank_order_give(s->simulation, o->list, s->n);
    free(o->contents);
    free(o->list);
    return status;
}

/* A file that this run has not begun is not overwritten. */
static dem_status check_path(const char *path, int64_t run)
{
    CHECK(access(path, F_OK) != 0 || stripe_file_is_of(path, run), DEM_ERROR_IO,
          "%s is in the way of a stripe of that name", path);
    return DEM_OK;
}

static dem_status check_names(const stripes *s, dem_index number)
{
    char path[HDF5_PATH];
    for (int k = 0; k < s->n; k++) {
        TRY(stripe_file_path(path, s->path, name_of(s, number, k)));
        TRY(check_path(path, s->run));
        TRY(stripe_file_path(path, s->path, name_at_first(s, number, k)));
        TRY(check_path(path, s->run));
    }
    return DEM_OK;
}

/* What the whole will need is looked at early. */
dem_status stripes_create(const stripes *s, const frames *f, dem_index number)
{
    orders o;
    if (s->n == 0) return DEM_OK;
    TRY(check_names(s, number));
    if (number > 0) TRY(check_names(s, 0));
    return give(&o, s, prepare(&o, s, f, number, STRIPE_CREATE));
}

dem_status stripes_link(const stripes *s, const frames *f, dem_index number, hsize_t n)
{
    orders o;
    if (s->n == 0) return DEM_OK;
    TRY(check_names(s, 0));
    dem_status status = prepare(&o, s, f, 0, STRIPE_LINK);
    for (int k = 0; k < s->n && status == DEM_OK; k++) {
        o.contents[k].frames.count = n;
        status = stripe_file_path(o.contents[k].other, s->path, name_of(s, number, k));
    }
    return give(&o, s, status);
}

dem_status stripes_copy(const stripes *s, const frames *f, dem_index number, const char *source, hdf5_span span)
{
    orders o;
    if (s->n == 0 || span.count == 0) return DEM_OK;
    dem_status status = prepare(&o, s, f, number, STRIPE_COPY);
    for (int k = 0; k < s->n && status == DEM_OK; k++) {
        o.contents[k].frames = span;
        const int n = snprintf(o.contents[k].other, HDF5_PATH, "%s", source);
        if (n < 0 || n >= HDF5_PATH) status = status_fail(DEM_ERROR_IO, "%s: the name is too long", source);
    }
    return give(&o, s, status);
}

dem_status stripes_close(const stripes *s, const frames *f)
{
    orders o;
    return s->n > 0 && s->stay_open ? give(&o, s, prepare(&o, s, f, 0, STRIPE_CLOSE)) : DEM_OK;
}

dem_status stripes_publish(const stripes *s, const frames *f, dem_index number)
{
    orders o;
    if (s->n == 0) return DEM_OK;
    dem_status status = prepare(&o, s, f, number, STRIPE_PUBLISH);
    for (int k = 0; k < s->n && status == DEM_OK; k++)
        status = stripe_file_path(o.contents[k].other, s->path, name_of(s, number, k));
    return give(&o, s, status);
}

/* ---- frames ---- */

dem_status stripes_append(const stripes *s, const frames *f, dem_index number, const dem_simulation *simulation)
{
    stripe_name name = {.number = number, .n = s->n};
    if (s->n == 0) return DEM_OK;
    const int n = snprintf(name.path, sizeof name.path, "%s", s->path);
    CHECK(n >= 0 && (size_t)n < sizeof name.path, DEM_ERROR_IO, "%s: the name is too long", s->path);
    return frame_writer_append_stripes(f, &name, s->stay_open, simulation);
}

dem_status stripes_map(const stripes *s, const frames *f, dem_index number, const hdf5_file *file,
                       frame_stripes_mapped n)
{
    const char *slash = strrchr(s->path, '/'), *name = slash != NULL ? slash + 1 : s->path;
    char(*names)[HDF5_STRIPES_NAME];
    dem_status status = DEM_OK;
    if (s->n == 0) return DEM_OK;
    names = calloc((size_t)s->n, sizeof *names);
    CHECK_MEMORY(names);
    for (int k = 0; k < s->n && status == DEM_OK; k++) {
        char end[NUMBERED_FILE];
        numbered_file_print(end, name_of(s, number, k));
        const int length = stripe_file_stem(s->path) - (int)(name - s->path);
        const int written = snprintf(names[k], sizeof names[k], "%.*s%s", length, name, end);
        if (written < 0 || (size_t)written >= sizeof names[k])
            status = status_fail(DEM_ERROR_IO, "%s: the name of a stripe is too long", s->path);
    }
    if (status == DEM_OK) status = frame_stripes_map(f, file, n, (const char(*)[HDF5_STRIPES_NAME])names);
    free(names);
    return status;
}

/* ---- removing ---- */

/* Whether a file is to stay. */
typedef bool keeps(const stripes *s, const numbered_file *e, dem_index above);

static bool keeps_up_to(const stripes *s, const numbered_file *e, dem_index above)
{
    (void)s;
    return !e->is_temporary && e->segment <= above;
}

static bool keeps_whole(const stripes *s, const numbered_file *e, dem_index above)
{
    (void)above;
    return !e->is_temporary && e->segment == 0 && e->n == s->n;
}

static bool read_name(numbered_file *out, const char *ending)
{
    return numbered_file_read(out, ending) && out->n > 0;
}

/* A folder that cannot be listed is left as it is. */
static void remove_others(const stripes *s, keeps *stays, dem_index above)
{
    const char *slash = strrchr(s->path, '/'), *name = slash != NULL ? slash + 1 : s->path;
    const int of_folder = (int)(name - s->path);
    const size_t length = (size_t)(stripe_file_stem(s->path) - of_folder);
    char path[HDF5_PATH];
    const struct dirent *entry;
    numbered_file e;
    (void)snprintf(path, sizeof path, "%.*s.", of_folder, s->path);
    DIR *files = opendir(path);
    while (files != NULL && (entry = readdir(files)) != NULL) {
        if (strncmp(entry->d_name, name, length) != 0 || !read_name(&e, entry->d_name + length)) continue;
        const int n = snprintf(path, sizeof path, "%.*s%s", of_folder, s->path, entry->d_name);
        if (n > 0 && n < HDF5_PATH && !stays(s, &e, above) && is_own(s, path)) (void)unlink(path);
    }
    if (files != NULL) (void)closedir(files);
}

/* What has failed before is still to be reported. */
static void prune(const stripes *s, keeps *stays, dem_index above)
{
    char message[STATUS_MESSAGE_SIZE];
    (void)snprintf(message, sizeof message, "%s", dem_status_message());
    remove_others(s, stays, above);
    (void)status_repeat(DEM_OK, message);
}

void stripes_prune(const stripes *s, dem_index above)
{
    prune(s, keeps_up_to, above);
}

void stripes_prune_to_whole(const stripes *s)
{
    prune(s, keeps_whole, 0);
}
