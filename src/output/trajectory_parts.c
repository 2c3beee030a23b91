/* SPDX-License-Identifier: BSD-3-Clause */
/* A segment carries its number, so that no file of another run is taken for one. */
#include "output/trajectory_parts.h"

#include "base/status.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char mark[] = "segment"; /* attribute of the root */

/* No run's name ends as the temporary ones do. */
static const char *const endings[SEGMENTS_NAMES] = {[SEGMENTS_WHOLE] = ".vtkhdf",
                                                    [SEGMENTS_PART] = ".part.vtkhdf",
                                                    [SEGMENTS_OBSTACLE] = ".obstacle.vtkhdf",
                                                    [SEGMENTS_OBSTACLE_PART] = ".obstacle.part.vtkhdf",
                                                    [SEGMENTS_HEAD] = ".vtkhdf.new",
                                                    [SEGMENTS_REST] = ".part.vtkhdf.new"};

/* ---- names ---- */

static int stem_of(const char *path)
{
    return (int)(strlen(path) - (sizeof SEGMENTS_SUFFIX - 1));
}

dem_status segments_init(segments *out, const char *path, const reel *r)
{
    const size_t size = strlen(path) + 32; /* the longest ending and every number */
    char *text = malloc((SEGMENTS_NAMES + 1) * size);
    out->names[0] = text;
    out->size = size;
    out->spans = calloc((size_t)r->n_kinds, sizeof *out->spans);
    CHECK(text != NULL && out->spans != NULL, DEM_ERROR_MEMORY, "out of memory");
    for (size_t k = 0; k < SEGMENTS_NAMES; k++) {
        out->names[k] = text + k * size;
        (void)snprintf(out->names[k], size, "%.*s%s", stem_of(path), path, endings[k]);
    }
    out->segment = text + SEGMENTS_NAMES * size;
    return DEM_OK;
}

void segments_free(segments *s)
{
    free(s->names[0]);
    free(s->spans);
    *s = (segments){0};
}

static const char *name_segment(segments *s, dem_index number)
{
    const char *whole = s->names[SEGMENTS_WHOLE];
    (void)snprintf(s->segment, s->size, "%.*s.%05lld" SEGMENTS_SUFFIX, stem_of(whole), whole, (long long)number);
    return s->segment;
}

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

static hsize_t bytes_of(const char *path)
{
    struct stat about = {0};
    return stat(path, &about) == 0 ? (hsize_t)about.st_size : 0;
}

/* ---- a file from another ---- */

static dem_status mark_segment(const hdf5_file *file, dem_index number)
{
    return hdf5_write_attribute(file, "/", mark, HDF5_I64, 1, &number);
}

static dem_status copy_from(const segments *s, const reel *r, const char *source, const hdf5_file *to)
{
    hdf5_file from;
    TRY(hdf5_open_read(&from, source));
    return hdf5_close(&from, reel_copy(r, &from, to, s->spans));
}

static dem_status verify(const segments *s, const reel *r, const char *path)
{
    hdf5_file file;
    TRY(hdf5_open_read(&file, path));
    return hdf5_close(&file, reel_verify(r, &file, s->spans));
}

typedef struct extract {
    const char *source; /* NULL: no rows */
    const char *path;
    dem_index number; /* of the segment that it becomes; 0: none */
} extract;

static dem_status write_extract(const segments *s, const reel *r, const hdf5_file *file, const extract *e)
{
    TRY(reel_create(r, file));
    if (e->source != NULL) TRY(copy_from(s, r, e->source, file));
    return e->number > 0 ? mark_segment(file, e->number) : DEM_OK;
}

/* Makes a file with the rows of the source that the spans say; after a failure there is none. */
static dem_status make(const segments *s, const reel *r, extract e)
{
    hdf5_file file;
    const hsize_t bytes = reel_create_bytes(r) + (e.source != NULL ? bytes_of(e.source) : 0);
    dem_status status = hdf5_open_new(&file, e.path, bytes);
    if (status == DEM_OK) status = hdf5_close(&file, write_extract(s, r, &file, &e));
    if (status == DEM_OK && e.source != NULL) status = verify(s, r, e.path);
    if (status != DEM_OK) (void)unlink(e.path);
    return status;
}

dem_status segments_open(const segments *s, const reel *r)
{
    (void)unlink(s->names[SEGMENTS_HEAD]); /* a killed run may have left them */
    (void)unlink(s->names[SEGMENTS_REST]);
    return make(s, r, (extract){NULL, s->names[SEGMENTS_PART], 0});
}

/* ---- cutting ---- */

static dem_status mark_part(segments *s)
{
    hdf5_file file;
    s->soiled = true;
    TRY(hdf5_open_write(&file, s->names[SEGMENTS_PART], 0));
    return hdf5_close(&file, mark_segment(&file, s->n + 1));
}

static dem_status make_head(const segments *s, const reel *r, const hsize_t *upto)
{
    for (int k = 0; k < r->n_kinds; k++)
        s->spans[k] = (hdf5_span){0, upto[k] - (reel_total(r, k) - reel_written(r, k)), 0};
    return make(s, r, (extract){s->names[SEGMENTS_PART], s->names[SEGMENTS_HEAD], s->n + 1});
}

static dem_status make_rest(const segments *s, const reel *r, const hsize_t *upto, bool later)
{
    for (int k = 0; k < r->n_kinds; k++) {
        const hsize_t count = reel_total(r, k) - upto[k];
        s->spans[k] = (hdf5_span){reel_written(r, k) - count, count, 0};
    }
    return make(s, r, (extract){later ? s->names[SEGMENTS_PART] : NULL, s->names[SEGMENTS_REST], 0});
}

static dem_status replace_part(const segments *s)
{
    const char *rest = s->names[SEGMENTS_REST], *part = s->names[SEGMENTS_PART];
    CHECK(rename(rest, part) == 0, DEM_ERROR_IO, "%s: cannot be renamed to %s (%s)", rest, part, strerror(errno));
    return DEM_OK;
}

static dem_status check_free(segments *s)
{
    CHECK(!exists(name_segment(s, s->n + 1)), DEM_ERROR_IO, "%s is in the way of a segment of that name", s->segment);
    return DEM_OK;
}

/* \param whole  the part becomes the segment as it is */
static dem_status publish_cut(segments *s, const reel *r, const hsize_t *upto, bool whole)
{
    TRY(whole ? mark_part(s) : make_head(s, r, upto));
    TRY(hdf5_publish(s->names[whole ? SEGMENTS_PART : SEGMENTS_HEAD], s->segment));
    return replace_part(s);
}

static void undo_cut(const segments *s, bool whole)
{
    (void)(whole ? rename(s->segment, s->names[SEGMENTS_PART]) : unlink(s->segment));
    (void)unlink(s->names[SEGMENTS_HEAD]);
    (void)unlink(s->names[SEGMENTS_REST]);
}

dem_status segments_cut(segments *s, reel *r, const hsize_t *upto)
{
    bool later = false, any = false;
    for (int k = 0; k < r->n_kinds; k++) {
        const hsize_t total = reel_total(r, k), before = total - reel_written(r, k);
        CHECK(upto[k] >= before && upto[k] <= total, DEM_ERROR_ARGUMENT,
              "%s: the record is at row %llu of %s, rows %llu to %llu are here", s->names[SEGMENTS_PART],
              (unsigned long long)upto[k], reel_name(r, k), (unsigned long long)before, (unsigned long long)total);
        later = later || upto[k] < total;
        any = any || upto[k] > before;
    }
    if (!any) return DEM_OK;
    const bool whole = !later && !s->soiled;
    TRY(check_free(s));
    TRY(make_rest(s, r, upto, later));
    const dem_status status = publish_cut(s, r, upto, whole);
    if (status != DEM_OK) {
        undo_cut(s, whole);
        return status;
    }
    for (int k = 0; k < r->n_kinds; k++) reel_place(r, k, upto[k], reel_total(r, k) - upto[k]);
    s->n++;
    s->soiled = false;
    return DEM_OK;
}

/* ---- finding ---- */

static bool is_segment(segments *s, dem_index number)
{
    hdf5_file file;
    if (!exists(name_segment(s, number)) || hdf5_open_read(&file, s->segment) != DEM_OK) return false;
    return hdf5_close(&file, hdf5_expect_attribute(&file, "/", mark, number)) == DEM_OK;
}

/* The youngest first: what is left after a kill is found again. */
dem_status segments_prune(segments *s)
{
    dem_index last = s->n;
    while (is_segment(s, last + 1)) last++;
    for (; last > s->n; last--)
        CHECK(unlink(name_segment(s, last)) == 0, DEM_ERROR_IO, "%s: cannot be removed (%s)", s->segment,
              strerror(errno));
    return DEM_OK;
}

/* Adds up the rows: in the end the spans stand at `upto`. */
static dem_status look_at_segment(const segments *s, const reel *r, const hdf5_file *file, const hsize_t *upto)
{
    TRY(hdf5_expect_attribute(file, "/", mark, s->n + 1));
    TRY(reel_count(r, file, s->spans));
    for (int k = 0; k < r->n_kinds; k++) {
        s->spans[k].at += s->spans[k].count;
        CHECK(s->spans[k].at <= upto[k], DEM_ERROR_IO, "%s: has %s beyond row %llu, where the run is to go on",
              file->path, reel_name(r, k), (unsigned long long)upto[k]);
    }
    const hdf5_span *rows = &s->spans[REEL_HISTORY];
    if (rows->count == 0 || rows->at < upto[REEL_HISTORY]) return DEM_OK;
    return history_expect_last(&r->history, file, rows->count - 1);
}

static dem_status add_segment(segments *s, const reel *r, const hsize_t *upto)
{
    hdf5_file file;
    TRY(hdf5_open_read(&file, s->segment));
    TRY(hdf5_close(&file, look_at_segment(s, r, &file, upto)));
    s->n++;
    return DEM_OK;
}

static bool reaches(const segments *s, const reel *r, const hsize_t *upto)
{
    for (int k = 0; k < r->n_kinds; k++)
        if (s->spans[k].at < upto[k]) return false;
    return true;
}

static dem_status look_at_whole(const segments *s, const reel *r, const hdf5_file *file, const hsize_t *upto)
{
    TRY(reel_count(r, file, s->spans));
    for (int k = 0; k < r->n_kinds; k++) {
        CHECK(s->spans[k].count >= upto[k], DEM_ERROR_IO, "%s: has %llu rows of %s, %llu are needed", file->path,
              (unsigned long long)s->spans[k].count, reel_name(r, k), (unsigned long long)upto[k]);
        s->spans[k] = (hdf5_span){0, upto[k], 0};
    }
    return upto[REEL_HISTORY] > 0 ? history_expect_last(&r->history, file, upto[REEL_HISTORY] - 1) : DEM_OK;
}

/* Segments that are there as well have been made of it, or it of them. */
static dem_status take_whole(segments *s, const reel *r, const hsize_t *upto)
{
    const char *whole = s->names[SEGMENTS_WHOLE], *head = s->names[SEGMENTS_HEAD];
    hdf5_file file;
    CHECK(exists(whole), DEM_ERROR_IO, "%s is missing", s->segment);
    TRY(hdf5_open_read(&file, whole));
    dem_status status = hdf5_close(&file, look_at_whole(s, r, &file, upto));
    CHECK(status != DEM_ERROR_IO, DEM_ERROR_IO, "%s is missing, and %s does not hold its rows", s->segment, whole);
    TRY(status);
    s->n = 0;
    TRY(segments_prune(s));
    TRY(check_free(s));
    TRY(make(s, r, (extract){whole, head, 1}));
    status = hdf5_publish(head, s->segment);
    if (status != DEM_OK) (void)unlink(head);
    return status;
}

dem_status segments_find(segments *s, reel *r, const hsize_t *upto)
{
    memset(s->spans, 0, (size_t)r->n_kinds * sizeof *s->spans);
    while (!reaches(s, r, upto) && exists(name_segment(s, s->n + 1))) TRY(add_segment(s, r, upto));
    if (!reaches(s, r, upto)) {
        TRY(take_whole(s, r, upto));
        s->n = 1;
    }
    for (int k = 0; k < r->n_kinds; k++) reel_place(r, k, upto[k], 0);
    return DEM_OK;
}

/* ---- joining ---- */

static const char *source_of(segments *s, dem_index k)
{
    return k < s->n ? name_segment(s, k + 1) : s->names[SEGMENTS_PART];
}

static dem_status append_all(const segments *s, const reel *r, const hdf5_file *from, const hdf5_file *to)
{
    for (int k = 0; k < r->n_kinds; k++) s->spans[k].at += s->spans[k].count;
    TRY(reel_count(r, from, s->spans));
    return reel_copy(r, from, to, s->spans);
}

static dem_status write_whole(segments *s, const reel *r, const hdf5_file *file)
{
    TRY(reel_create(r, file));
    memset(s->spans, 0, (size_t)r->n_kinds * sizeof *s->spans);
    for (dem_index k = 0; k <= s->n; k++) {
        hdf5_file from;
        TRY(hdf5_open_read(&from, source_of(s, k)));
        TRY(hdf5_close(&from, append_all(s, r, &from, file)));
    }
    return reel_write_peaks(r, file, reel_total(r, REEL_FRAMES));
}

static dem_status make_whole(segments *s, const reel *r)
{
    hdf5_file file;
    hsize_t bytes = reel_create_bytes(r) + reel_peaks_bytes(r, reel_total(r, REEL_FRAMES));
    for (dem_index k = 0; k <= s->n; k++) bytes += bytes_of(source_of(s, k));
    TRY(hdf5_open_new(&file, s->names[SEGMENTS_HEAD], bytes));
    return hdf5_close(&file, write_whole(s, r, &file));
}

static dem_status add_peaks(segments *s, const reel *r)
{
    hdf5_file file;
    if (r->options.peaks == NULL) return DEM_OK;
    s->soiled = true;
    TRY(hdf5_open_write(&file, s->names[SEGMENTS_PART], reel_peaks_bytes(r, reel_total(r, REEL_FRAMES))));
    return hdf5_close(&file, reel_write_peaks(r, &file, reel_total(r, REEL_FRAMES)));
}

/* The only part becomes the whole as it is. */
dem_status segments_join(segments *s, const reel *r)
{
    const bool only = s->n == 0 && !s->soiled;
    const char *made = s->names[only ? SEGMENTS_PART : SEGMENTS_HEAD];
    dem_status status = only ? add_peaks(s, r) : make_whole(s, r);
    for (int k = 0; k < r->n_kinds; k++) s->spans[k] = (hdf5_span){0, reel_total(r, k), 0};
    if (status == DEM_OK) status = verify(s, r, made);
    if (status == DEM_OK) status = hdf5_publish(made, s->names[SEGMENTS_WHOLE]);
    (void)unlink(s->names[SEGMENTS_HEAD]);
    if (status != DEM_OK) return status;
    (void)unlink(s->names[SEGMENTS_PART]);
    for (; s->n > 0; s->n--) (void)unlink(name_segment(s, s->n)); /* one that stays does no harm */
    return DEM_OK;
}
