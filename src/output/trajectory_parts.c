/* SPDX-License-Identifier: BSD-3-Clause */
/* The files of a run and the steps by which rows move from one to another: the live part, the segments with the rows of
 * earlier checkpoints, and the whole that they become (trajectory_parts.h has the names). The rule is that a new file
 * is made under a temporary name, verified, published, and only then replaces what it was made of; so a kill at any
 * moment leaves, for each published checkpoint, files with all its rows (docs/reliability.md). With A the rows up to a
 * checkpoint, B those behind it, and the ending .vtkhdf left out, a cut is
 *   1. NAME.part has A B                     make_rest: NAME.part.new gets B
 *   2. the segment is made                   make_head: NAME.new gets A; or, without B, the part is marked as it is
 *   3. NAME.new, or the part -> NAME.00001   synced, read back, renamed: from now on the checkpoint may be written
 *   4. NAME.part.new -> NAME.part            the run goes on with B
 * and a kill between any two of them leaves A in the part or in the segment. A run that is resumed finds its segments
 * (trajectory_parts_find), removes younger ones and begins a new part. At the end all segments and the part are joined
 * into one file, which is published before they are removed. Rows are of several kinds (frames, history, events,
 * breaks, probes), and `spans` says for each kind which ones are meant. What rows are is in trajectory_rows.c. A
 * segment carries its number as an attribute, so that no file of another run is taken for one. */
#include "output/trajectory_parts.h"

#include "base/numbered_file.h"
#include "base/status.h"
#include "output/hdf5_attribute.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char mark[] = "segment"; /* attribute of the root */

/* Endings of the names of files. No run's name ends as the temporary ones do. */
static const char *const endings[PARTS_NAMES] = {[PARTS_WHOLE] = ".vtkhdf",
                                                 [PARTS_PART] = ".part.vtkhdf",
                                                 [PARTS_OBSTACLE] = ".obstacle.vtkhdf",
                                                 [PARTS_OBSTACLE_PART] = ".obstacle.part.vtkhdf",
                                                 [PARTS_BODY] = ".body.vtkhdf",
                                                 [PARTS_BODY_PART] = ".body.part.vtkhdf",
                                                 [PARTS_HEAD] = ".vtkhdf.new",
                                                 [PARTS_REST] = ".part.vtkhdf.new"};

/* ---- names ---- */

/* Length of a path without its suffix. */
static int stem_of(const char *path)
{
    return (int)(strlen(path) - (sizeof PARTS_SUFFIX - 1));
}

/* All names are one allocation, each with room for the longest ending and any number. */
dem_status trajectory_parts_init(segments *out, const char *path, trajectory_rows *r)
{
    const size_t size = strlen(path) + 32;
    char *text = malloc((PARTS_NAMES + 1) * size);
    out->names[0] = text;
    out->size = size;
    out->spans = calloc((size_t)r->n_kinds, sizeof *out->spans);
    CHECK(text != NULL && out->spans != NULL, DEM_ERROR_MEMORY, "out of memory");
    for (size_t k = 0; k < PARTS_NAMES; k++) {
        out->names[k] = text + k * size;
        (void)snprintf(out->names[k], size, "%.*s%s", stem_of(path), path, endings[k]);
    }
    out->segment = text + PARTS_NAMES * size;
    r->stripes.path = out->names[PARTS_WHOLE];
    return DEM_OK;
}

void trajectory_parts_free(segments *s)
{
    free(s->names[0]);
    free(s->spans);
    *s = (segments){0};
}

/* The name of a segment; it is valid until the next call. */
static const char *name_segment(segments *s, dem_index number)
{
    const char *whole = s->names[PARTS_WHOLE];
    char end[NUMBERED_FILE];
    numbered_file_print(end, (numbered_file){.segment = number});
    (void)snprintf(s->segment, s->size, "%.*s%s", stem_of(whole), whole, end);
    return s->segment;
}

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

/* Size of a file, 0 if there is none: a bound for what a copy of its rows takes. */
static hsize_t bytes_of(const char *path)
{
    struct stat about = {0};
    return stat(path, &about) == 0 ? (hsize_t)about.st_size : 0;
}

/* ---- a file from another ---- */

/* Makes the file the segment of this number. */
static dem_status mark_segment(const hdf5_file *file, dem_index number)
{
    return hdf5_write_attribute(file, "/", mark, HDF5_I64, 1, &number);
}

/* Copies the rows of another file that the spans say. */
static dem_status copy_from(const segments *s, const trajectory_rows *r, const char *source, const hdf5_file *to)
{
    hdf5_file from;
    TRY(hdf5_open_read(&from, source));
    return hdf5_close(&from, trajectory_rows_copy(r, &from, to, s->spans));
}

/* A copy must have all rows that it was to have, before its source may go. */
static dem_status verify(const segments *s, const trajectory_rows *r, const char *path)
{
    hdf5_file file;
    TRY(hdf5_open_read(&file, path));
    return hdf5_close(&file, trajectory_rows_verify(r, &file, s->spans));
}

/* A file to be made from another one. */
typedef struct extract {
    const char *source; /* NULL: no rows */
    const char *path;
    dem_index number;  /* of the segment that it becomes; 0: none */
    dem_index stripes; /* number of the segment whose stripes have its frames, where there are any */
    bool has_first;    /* of these frames only as many as are copied */
} extract;

/* Lattice, obstacles and notes first, as every file has them, then the rows, then the mark. */
static dem_status write_extract(const segments *s, const trajectory_rows *r, const hdf5_file *file, const extract *e)
{
    TRY(trajectory_rows_create(r, file));
    if (e->source != NULL) TRY(copy_from(s, r, e->source, file));
    const frame_stripes_mapped mapped = {!e->has_first, e->has_first ? s->spans[ROWS_FRAMES].count : 0};
    TRY(stripes_map(&r->stripes, &r->frames, e->stripes, file, mapped));
    return e->number > 0 ? mark_segment(file, e->number) : DEM_OK;
}

/* Makes a file with the rows of the source that the spans say; after a failure there is none. */
static dem_status make(const segments *s, const trajectory_rows *r, extract e)
{
    hdf5_file file;
    const hsize_t bytes = trajectory_rows_create_bytes(r) + (e.source != NULL ? bytes_of(e.source) : 0);
    dem_status status = hdf5_open_new(&file, e.path, bytes);
    file.team = r->team;
    if (status == DEM_OK) status = hdf5_close(&file, write_extract(s, r, &file, &e));
    /* After closing, as the next reader will see it. */
    if (status == DEM_OK && e.source != NULL) status = verify(s, r, e.path);
    if (status != DEM_OK) (void)unlink(e.path);
    return status;
}

/* The temporary files of a killed run hold nothing that is needed, nor do the stripes of its part and of segments that
 * are to be removed. */
dem_status trajectory_parts_open(const segments *s, const trajectory_rows *r)
{
    (void)unlink(s->names[PARTS_HEAD]);
    (void)unlink(s->names[PARTS_REST]);
    stripes_prune(&r->stripes, s->n);
    TRY(stripes_create(&r->stripes, &r->frames, s->n + 1));
    return make(s, r, (extract){NULL, s->names[PARTS_PART], 0, s->n + 1, false});
}

dem_status trajectory_parts_append(const segments *s, const trajectory_rows *r, const dem_simulation *simulation)
{
    return stripes_append(&r->stripes, &r->frames, s->n + 1, simulation);
}

/* ---- cutting ---- */

/* The part is marked to become a segment. Until that has happened it is soiled: if it fails, the part must not be used
 * under another name as it is. */
static dem_status mark_part(segments *s)
{
    hdf5_file file;
    s->soiled = true;
    TRY(hdf5_open_write(&file, s->names[PARTS_PART], 0));
    return hdf5_close(&file, mark_segment(&file, s->n + 1));
}

/* Copies the rows of the part up to `upto` into a new file. `upto` counts from the start of the run; the rows before
 * the part, total - written, are taken off. */
static dem_status make_head(const segments *s, const trajectory_rows *r, const hsize_t *upto)
{
    for (int k = 0; k < r->n_kinds; k++)
        s->spans[k] = (hdf5_span){0, upto[k] - (trajectory_rows_total(r, k) - trajectory_rows_written(r, k)), 0};
    return make(s, r, (extract){s->names[PARTS_PART], s->names[PARTS_HEAD], s->n + 1, s->n + 1, true});
}

/* Copies the rows of the part behind `upto` into the file that will be the next part; without such rows it is empty.
 * Its stripes are those of the segment that it will be. */
static dem_status make_rest(const segments *s, const trajectory_rows *r, const hsize_t *upto, bool later)
{
    for (int k = 0; k < r->n_kinds; k++) {
        const hsize_t count = trajectory_rows_total(r, k) - upto[k];
        s->spans[k] = (hdf5_span){trajectory_rows_written(r, k) - count, count, 0};
    }
    TRY(stripes_create(&r->stripes, &r->frames, s->n + 2));
    if (later) TRY(stripes_copy(&r->stripes, &r->frames, s->n + 2, s->names[PARTS_PART], s->spans[ROWS_FRAMES]));
    return make(s, r, (extract){later ? s->names[PARTS_PART] : NULL, s->names[PARTS_REST], 0, s->n + 2, false});
}

/* A rename: the old part is gone, or has become the segment. */
static dem_status replace_part(const segments *s)
{
    const char *rest = s->names[PARTS_REST], *part = s->names[PARTS_PART];
    CHECK(rename(rest, part) == 0, DEM_ERROR_IO, "%s: cannot be renamed to %s (%s)", rest, part, strerror(errno));
    return DEM_OK;
}

/* A file that stands under the name of the next segment is not overwritten. */
static dem_status check_free(segments *s)
{
    CHECK(!exists(name_segment(s, s->n + 1)), DEM_ERROR_IO, "%s is in the way of a segment of that name", s->segment);
    return DEM_OK;
}

/* Publishes the segment, then puts the rest in the place of the part. Stripes keep their names; a head has the frames
 * that it needs of them.
 * \param whole  the part becomes the segment as it is */
static dem_status publish_cut(segments *s, const trajectory_rows *r, const hsize_t *upto, bool whole)
{
    TRY(stripes_publish(&r->stripes, &r->frames, s->n + 1));
    TRY(whole ? mark_part(s) : make_head(s, r, upto));
    TRY(hdf5_publish(s->names[whole ? PARTS_PART : PARTS_HEAD], s->segment));
    return replace_part(s);
}

/* Brings back the part, and removes what was made. */
static void undo_cut(const segments *s, const trajectory_rows *r, bool whole)
{
    (void)(whole ? rename(s->segment, s->names[PARTS_PART]) : unlink(s->segment));
    (void)unlink(s->names[PARTS_HEAD]);
    (void)unlink(s->names[PARTS_REST]);
    stripes_prune(&r->stripes, s->n + 1);
}

/* `later`: the part has rows behind `upto`, which stay in a part. If there are none, and the part is not soiled, it
 * becomes the segment by a rename, without copying. The rest is made first, so that it is ready when the segment is
 * published. */
dem_status trajectory_parts_cut(segments *s, trajectory_rows *r, const hsize_t *upto)
{
    bool later = false, any = false;
    for (int k = 0; k < r->n_kinds; k++) {
        const hsize_t total = trajectory_rows_total(r, k), before = total - trajectory_rows_written(r, k);
        /* Only rows of the part can be cut off: those before it are in segments already. */
        CHECK(upto[k] >= before && upto[k] <= total, DEM_ERROR_ARGUMENT,
              "%s: the checkpoint is at row %llu of %s, rows %llu to %llu are here", s->names[PARTS_PART],
              (unsigned long long)upto[k], trajectory_rows_name(r, k), (unsigned long long)before,
              (unsigned long long)total);
        later = later || upto[k] < total;
        any = any || upto[k] > before;
    }
    /* A segment without rows is not made. */
    if (!any) return DEM_OK;
    /* The part has nothing but the rows of the segment. */
    const bool whole = !later && !s->soiled;
    TRY(check_free(s));
    dem_status status = make_rest(s, r, upto, later);
    if (status == DEM_OK) status = publish_cut(s, r, upto, whole);
    if (status != DEM_OK) {
        undo_cut(s, r, whole);
        return status;
    }
    /* What was the rest is the part now, with its rows from 0 on. */
    for (int k = 0; k < r->n_kinds; k++) trajectory_rows_place(r, k, upto[k], trajectory_rows_total(r, k) - upto[k]);
    s->n++;
    s->soiled = false;
    return DEM_OK;
}

/* ---- finding ---- */

/* Whether there is a segment of this number. A file that cannot be read is none, and is left alone. */
static bool is_segment(segments *s, dem_index number)
{
    hdf5_file file;
    if (!exists(name_segment(s, number)) || hdf5_open_read(&file, s->segment) != DEM_OK) return false;
    return hdf5_close(&file, hdf5_expect_attribute(&file, "/", mark, number)) == DEM_OK;
}

/* Removes segments that a resumed run will write anew, the youngest first: if it is killed in between, those left are
 * still numbered without a gap and are found again. */
dem_status trajectory_parts_prune(segments *s)
{
    dem_index last = s->n;
    while (is_segment(s, last + 1)) last++;
    for (; last > s->n; last--)
        CHECK(unlink(name_segment(s, last)) == 0, DEM_ERROR_IO, "%s: cannot be removed (%s)", s->segment,
              strerror(errno));
    return DEM_OK;
}

/* Adds up the rows of segments in spans[k].at: in the end they must stand at `upto` for all kinds. A segment that ends
 * at the checkpoint's row of the history must have its instant there. */
static dem_status look_at_segment(const segments *s, const trajectory_rows *r, const hdf5_file *file,
                                  const hsize_t *upto)
{
    TRY(hdf5_expect_attribute(file, "/", mark, s->n + 1));
    TRY(trajectory_rows_count(r, file, s->spans));
    for (int k = 0; k < r->n_kinds; k++) {
        /* Counted from the start of the run. */
        s->spans[k].at += s->spans[k].count;
        CHECK(s->spans[k].at <= upto[k], DEM_ERROR_IO, "%s: has %s beyond row %llu, where the run is to go on",
              file->path, trajectory_rows_name(r, k), (unsigned long long)upto[k]);
    }
    /* Rows of equal number could still be another run's: the last instant tells. */
    const hdf5_span *rows = &s->spans[ROWS_HISTORY];
    if (rows->count == 0 || rows->at < upto[ROWS_HISTORY]) return DEM_OK;
    return history_expect_last(&r->history, file, rows->count - 1);
}

/* Takes the next segment, if it is one of this run. */
static dem_status add_segment(segments *s, const trajectory_rows *r, const hsize_t *upto)
{
    hdf5_file file;
    TRY(hdf5_open_read(&file, s->segment));
    TRY(hdf5_close(&file, look_at_segment(s, r, &file, upto)));
    s->n++;
    return DEM_OK;
}

/* Whether the segments so far have all rows up to `upto`. */
static bool reaches(const segments *s, const trajectory_rows *r, const hsize_t *upto)
{
    for (int k = 0; k < r->n_kinds; k++)
        if (s->spans[k].at < upto[k]) return false;
    return true;
}

/* Whether the finished file has at least these rows, with the checkpoint's instant at the last one. */
static dem_status look_at_whole(const segments *s, const trajectory_rows *r, const hdf5_file *file, const hsize_t *upto)
{
    TRY(trajectory_rows_count(r, file, s->spans));
    for (int k = 0; k < r->n_kinds; k++) {
        CHECK(s->spans[k].count >= upto[k], DEM_ERROR_IO, "%s: has %llu rows of %s, %llu are needed", file->path,
              (unsigned long long)s->spans[k].count, trajectory_rows_name(r, k), (unsigned long long)upto[k]);
        /* What make() is to copy. */
        s->spans[k] = (hdf5_span){0, upto[k], 0};
    }
    return upto[ROWS_HISTORY] > 0 ? history_expect_last(&r->history, file, upto[ROWS_HISTORY] - 1) : DEM_OK;
}

/* Of the whole, for the one segment. */
static dem_status take_stripes(const segments *s, const trajectory_rows *r)
{
    stripes_prune(&r->stripes, 0);
    TRY(stripes_create(&r->stripes, &r->frames, 1));
    TRY(stripes_copy(&r->stripes, &r->frames, 1, s->names[PARTS_WHOLE], s->spans[ROWS_FRAMES]));
    return stripes_publish(&r->stripes, &r->frames, 1);
}

/* A run that was finished has no segments any more: its first rows are made the one segment again. Segments that are
 * there as well have been made of the whole, or it of them, and may go. The whole itself stays until it is replaced. */
static dem_status take_whole(segments *s, const trajectory_rows *r, const hsize_t *upto)
{
    const char *whole = s->names[PARTS_WHOLE], *head = s->names[PARTS_HEAD];
    hdf5_file file;
    CHECK(exists(whole), DEM_ERROR_IO, "%s is missing", s->segment);
    TRY(hdf5_open_read(&file, whole));
    dem_status status = hdf5_close(&file, look_at_whole(s, r, &file, upto));
    /* The message names the missing segment first, then the whole that cannot stand in for it. */
    CHECK(status != DEM_ERROR_IO, DEM_ERROR_IO, "%s is missing, and %s does not hold its rows", s->segment, whole);
    TRY(status);
    s->n = 0;
    TRY(trajectory_parts_prune(s));
    TRY(check_free(s));
    TRY(take_stripes(s, r));
    TRY(make(s, r, (extract){whole, head, 1, 1, false}));
    status = hdf5_publish(head, s->segment);
    if (status != DEM_OK) (void)unlink(head);
    return status;
}

/* Segments first, in their order; the whole only if they do not reach. The new part then begins behind `upto`. */
dem_status trajectory_parts_find(segments *s, trajectory_rows *r, const hsize_t *upto)
{
    memset(s->spans, 0, (size_t)r->n_kinds * sizeof *s->spans);
    /* A segment with rows beyond `upto` is refused by look_at_segment(). */
    while (!reaches(s, r, upto) && exists(name_segment(s, s->n + 1))) TRY(add_segment(s, r, upto));
    if (!reaches(s, r, upto)) {
        TRY(take_whole(s, r, upto));
        s->n = 1;
    }
    /* The part is empty when the run goes on. */
    for (int k = 0; k < r->n_kinds; k++) trajectory_rows_place(r, k, upto[k], 0);
    return DEM_OK;
}

/* ---- joining ---- */

/* The k-th file of the run: the segments, then the part. */
static const char *source_of(segments *s, dem_index k)
{
    return k < s->n ? name_segment(s, k + 1) : s->names[PARTS_PART];
}

/* The rows of a file go behind those of the files before it. */
static dem_status append_all(const segments *s, const trajectory_rows *r, const hdf5_file *from, const hdf5_file *to)
{
    for (int k = 0; k < r->n_kinds; k++) s->spans[k].at += s->spans[k].count;
    TRY(trajectory_rows_count(r, from, s->spans));
    return trajectory_rows_copy(r, from, to, s->spans);
}

/* Those of the whole, of all files; those of a part alone, where they have all of it, get a second name. The names are
 * new, or they replace those of a shorter run, which has their first frames: so its whole, which may still be there,
 * has what it had. */
static dem_status make_stripes(segments *s, const trajectory_rows *r)
{
    hsize_t *at = &s->spans[ROWS_FRAMES].at;
    const hsize_t all = trajectory_rows_total(r, ROWS_FRAMES);
    if (s->n == 0 && stripes_link(&r->stripes, &r->frames, 1, all) == DEM_OK)
        return stripes_publish(&r->stripes, &r->frames, 0);
    TRY(stripes_create(&r->stripes, &r->frames, 0));
    *at = 0;
    for (dem_index k = 0; k <= s->n && r->stripes.n > 0; k++) {
        hdf5_file from;
        TRY(hdf5_open_read(&from, source_of(s, k)));
        TRY(hdf5_close(&from, trajectory_rows_count(r, &from, s->spans)));
        s->spans[ROWS_FRAMES].first = 0;
        TRY(stripes_copy(&r->stripes, &r->frames, 0, source_of(s, k), s->spans[ROWS_FRAMES]));
        *at += s->spans[ROWS_FRAMES].count;
    }
    return stripes_publish(&r->stripes, &r->frames, 0);
}

/* Peaks come last, since their arrays are the same in all frames and are written once. */
static dem_status write_whole(segments *s, const trajectory_rows *r, const hdf5_file *file)
{
    TRY(trajectory_rows_create(r, file));
    memset(s->spans, 0, (size_t)r->n_kinds * sizeof *s->spans);
    for (dem_index k = 0; k <= s->n; k++) {
        hdf5_file from;
        TRY(hdf5_open_read(&from, source_of(s, k)));
        TRY(hdf5_close(&from, append_all(s, r, &from, file)));
    }
    TRY(stripes_map(&r->stripes, &r->frames, 0, file, (frame_stripes_mapped){true, 0}));
    return trajectory_rows_write_peaks(r, file, trajectory_rows_total(r, ROWS_FRAMES));
}

/* Makes the whole under a temporary name. Each source counts with its whole size for the room that is reserved. */
static dem_status make_whole(segments *s, const trajectory_rows *r)
{
    hdf5_file file;
    hsize_t bytes =
        trajectory_rows_create_bytes(r) + trajectory_rows_peaks_bytes(r, trajectory_rows_total(r, ROWS_FRAMES));
    TRY(make_stripes(s, r));
    for (dem_index k = 0; k <= s->n; k++) bytes += bytes_of(source_of(s, k));
    TRY(hdf5_open_new(&file, s->names[PARTS_HEAD], bytes));
    file.team = r->team;
    return hdf5_close(&file, write_whole(s, r, &file));
}

/* A part with peaks is soiled: if publishing fails, it must not become a segment as it is. */
static dem_status add_peaks(segments *s, const trajectory_rows *r)
{
    hdf5_file file;
    if (r->options.peaks == NULL) return DEM_OK;
    s->soiled = true;
    TRY(hdf5_open_write(&file, s->names[PARTS_PART],
                        trajectory_rows_peaks_bytes(r, trajectory_rows_total(r, ROWS_FRAMES))));
    file.team = r->team;
    return hdf5_close(&file, trajectory_rows_write_peaks(r, &file, trajectory_rows_total(r, ROWS_FRAMES)));
}

/* The only part becomes the whole as it is, but for one with stripes; otherwise all files are copied into one. Parts,
 * segments and their stripes are removed when the whole is published, as are stripes of another number of writers. */
dem_status trajectory_parts_join(segments *s, const trajectory_rows *r)
{
    const bool only = s->n == 0 && !s->soiled && r->stripes.n == 0;
    const char *made = s->names[only ? PARTS_PART : PARTS_HEAD];
    dem_status status = only ? add_peaks(s, r) : make_whole(s, r);
    for (int k = 0; k < r->n_kinds; k++) s->spans[k] = (hdf5_span){0, trajectory_rows_total(r, k), 0};
    if (status == DEM_OK) status = verify(s, r, made);
    if (status == DEM_OK) status = hdf5_publish(made, s->names[PARTS_WHOLE]);
    /* After success it has been renamed, and nothing is there. */
    (void)unlink(s->names[PARTS_HEAD]);
    if (status != DEM_OK) stripes_prune(&r->stripes, s->n + 1);
    if (status != DEM_OK) return status;
    (void)unlink(s->names[PARTS_PART]);
    for (; s->n > 0; s->n--) (void)unlink(name_segment(s, s->n)); /* one that stays does no harm */
    stripes_prune_to_whole(&r->stripes);
    return DEM_OK;
}
