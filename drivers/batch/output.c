/* SPDX-License-Identifier: BSD-3-Clause */
/* Outputs carry the hashes of their problem and of their run in /provenance. */
#include "output.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "base/numbered_file.h"
#include "decimal.h"
#include "difference.h"

static const char suffix[] = ".vtkhdf", part_suffix[] = ".part.vtkhdf";

enum { longest_suffix = 32 }; /* of a file beside it */

bool output_path(char *path, size_t size, const char *folder, const char *name)
{
    const int n = strcmp(folder, ".") == 0 ? snprintf(path, size, "%s%s", name, suffix)
                                           : snprintf(path, size, "%s/%s%s", folder, name, suffix);
    return n > 0 && (size_t)n + longest_suffix < size;
}

void output_beside(char out[OUTPUT_PATH], const char *path, const char *end)
{
    (void)snprintf(out, OUTPUT_PATH, "%.*s%s", (int)(strlen(path) - strlen(suffix)), path, end);
}

/* ---- the folder ---- */

/* Where it is none, errno says why. */
static bool is_folder(const char *path)
{
    struct stat found;
    if (stat(path, &found) != 0) return false;
    errno = ENOTDIR;
    return S_ISDIR(found.st_mode);
}

/* Another process may make it at the same time, and a system may refuse for another reason what is there already. */
static bool make_one(const char *path)
{
    if (is_folder(path)) return true;
    return mkdir(path, 0777) == 0 || (errno == EEXIST && is_folder(path));
}

/* The path down to its next folder, from the end of the one before; NULL behind the last. */
static const char *go_down(const char *folder, const char *end, char path[OUTPUT_PATH])
{
    if (*end == '\0') return NULL;
    end += strspn(end, "/");
    end += strcspn(end, "/");
    (void)snprintf(path, OUTPUT_PATH, "%.*s", (int)(end - folder), folder);
    return end;
}

static bool refuse_folder(char reason[OUTPUT_REASON], const char *what)
{
    (void)snprintf(reason, OUTPUT_REASON, "the folder cannot be %s (%s)", what, strerror(errno));
    return false;
}

bool output_make_folder(const char *folder, char path[OUTPUT_PATH], char reason[OUTPUT_REASON])
{
    const char *end = folder;
    while ((end = go_down(folder, end, path)) != NULL)
        if (!make_one(path)) return refuse_folder(reason, "made");
    return true;
}

static bool is_missing(const char *path)
{
    struct stat found;
    return lstat(path, &found) != 0 && errno == ENOENT;
}

/* Rights do not tell it for root, nor where the system has no place for new files, as in /proc: a folder is made, and
 * removed. Where not, errno says why. What a killed run has left the next one removes; of two runs at the same time
 * either may remove what the other has made. */
static bool takes_entries(const char *folder)
{
    char trial[OUTPUT_PATH + 64];
    (void)snprintf(trial, sizeof trial, "%s/.dem_batch.trial", folder);
    if (mkdir(trial, 0700) != 0 && errno != EEXIST) return false;
    return rmdir(trial) == 0 || errno == ENOENT;
}

bool output_check_folder(const char *folder, char path[OUTPUT_PATH], char reason[OUTPUT_REASON])
{
    char deepest[OUTPUT_PATH] = ".";
    const char *end = folder;
    while ((end = go_down(folder, end, path)) != NULL && is_folder(path)) memcpy(deepest, path, sizeof deepest);
    if (end != NULL && !is_missing(path)) {
        (void)is_folder(path); /* for its errno */
        return refuse_folder(reason, "made");
    }
    if (end == NULL) memcpy(path, deepest, sizeof deepest);
    return takes_entries(deepest) || refuse_folder(reason, end == NULL ? "written to" : "made");
}

/* ---- what is there ---- */

static bool same_hash(const char *path, const char *note, uint64_t hash)
{
    char stored[OUTPUT_HASH], wanted[OUTPUT_HASH];
    output_print_hash(wanted, hash);
    return dem_trajectory_read_note(path, note, stored, sizeof stored) == DEM_OK && strcmp(stored, wanted) == 0;
}

static bool same_problem(const char *path, const deck *d)
{
    return same_hash(path, "problem", d->hash);
}

/* A part that does not name its problem, or cannot be read, was cut off: what is in it is computed again. */
static bool is_part_of_another(const char *part, const deck *d)
{
    char stored[OUTPUT_HASH], ours[OUTPUT_HASH];
    output_print_hash(ours, d->hash);
    if (dem_trajectory_read_note(part, "problem", stored, sizeof stored) != DEM_OK) return false;
    const bool whole = strlen(stored) == strlen(ours) && strspn(stored, "0123456789abcdef") == strlen(ours);
    return whole && strcmp(stored, ours) != 0;
}

void output_print_hash(char text[OUTPUT_HASH], uint64_t hash)
{
    (void)snprintf(text, OUTPUT_HASH, "%016llx", (unsigned long long)hash);
}

static bool is_later(const char *path, double t_end)
{
    char stored[DECIMAL_SIZE];
    return dem_trajectory_read_note(path, "t_end", stored, sizeof stored) != DEM_OK || strtod(stored, NULL) > t_end;
}

/* In what the problem of a file is another. */
static void name_difference(const char *path, const deck *d, char difference[DIFFERENCE])
{
    enum { LONGEST = 1 << 20 };
    char *physics = malloc(LONGEST);
    (void)snprintf(difference, DIFFERENCE, "another problem");
    if (physics != NULL && dem_trajectory_read_note(path, "physics", physics, LONGEST) == DEM_OK)
        (void)difference_find(physics, d->physics, difference);
    free(physics);
}

static output_state look_at_whole(const char *path, const deck *d, char reason[OUTPUT_REASON])
{
    char difference[DIFFERENCE];
    if (!same_problem(path, d)) {
        name_difference(path, d, difference);
        (void)snprintf(reason, OUTPUT_REASON, "the file exists, and its run has %s; " OUTPUT_WAY_OUT, difference);
        return OUTPUT_TAKEN;
    }
    if (same_hash(path, "run", d->run_hash)) {
        (void)snprintf(reason, OUTPUT_REASON, "this run's result is there");
        return OUTPUT_DONE;
    }
    const bool later = is_later(path, d->t_end);
    if (later)
        (void)snprintf(reason, OUTPUT_REASON, "the file exists, and its run goes beyond t_end = %g s; " OUTPUT_WAY_OUT,
                       d->t_end);
    else
        (void)snprintf(reason, OUTPUT_REASON,
                       "the file exists, and there is no checkpoint from which its run could go on; " OUTPUT_WAY_OUT);
    return later ? OUTPUT_TAKEN : OUTPUT_SHORTER;
}

output_state output_claim(const char *path, const deck *d, char reason[OUTPUT_REASON])
{
    char part[OUTPUT_PATH], difference[DIFFERENCE];
    output_beside(part, path, part_suffix);
    if (access(path, F_OK) == 0) return look_at_whole(path, d, reason);
    if (access(part, F_OK) == 0 && is_part_of_another(part, d)) {
        name_difference(part, d, difference);
        (void)snprintf(reason, OUTPUT_REASON, "the unfinished run in %s has %s; " OUTPUT_WAY_OUT, part, difference);
        return OUTPUT_TAKEN;
    }
    return OUTPUT_FREE;
}

/* ---- setting aside ---- */

static bool is_segment(const char *end)
{
    numbered_file file;
    return numbered_file_read(&file, end) && file.n == 0;
}

/* What is left of the name of a file of this output behind the output's name; NULL if it is none. */
static const char *end_of(const char *file, const char *name)
{
    static const char *const ends[] = {
        suffix,  part_suffix,   ".obstacle.vtkhdf", ".obstacle.part.vtkhdf", ".body.vtkhdf", ".body.part.vtkhdf",
        ".json", ".checkpoint", ".checkpoint.prev", ".checkpoint.damaged"};
    const size_t n = strlen(name);
    if (strncmp(file, name, n) != 0) return NULL;
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++)
        if (strcmp(file + n, ends[k]) == 0) return file + n;
    return is_segment(file + n) ? file + n : NULL;
}

static bool is_stripe(const char *end)
{
    numbered_file file;
    return numbered_file_read(&file, end) && file.n > 0 && !file.is_temporary;
}

/* Other files have their rows under these names, which they would go on to look for. */
static bool has_no_stripes(DIR *folder, const char *name, char reason[OUTPUT_REASON])
{
    const size_t n = strlen(name);
    const struct dirent *entry;
    rewinddir(folder);
    while ((entry = readdir(folder)) != NULL) {
        if (strncmp(entry->d_name, name, n) != 0 || !is_stripe(entry->d_name + n)) continue;
        (void)snprintf(reason, OUTPUT_REASON,
                       "the output cannot be renamed, as its files name %s: move all of them into another folder",
                       entry->d_name);
        return false;
    }
    return true;
}

static bool is_used(DIR *folder, const char *name)
{
    const struct dirent *entry;
    rewinddir(folder);
    while ((entry = readdir(folder)) != NULL)
        if (end_of(entry->d_name, name) != NULL) return true;
    return false;
}

static bool rename_all(DIR *folder, const char *from, const char *to, char reason[OUTPUT_REASON])
{
    char name[OUTPUT_PATH + 64];
    const struct dirent *entry;
    const int at = dirfd(folder);
    rewinddir(folder);
    while ((entry = readdir(folder)) != NULL) {
        const char *end = end_of(entry->d_name, from);
        if (end == NULL) continue;
        (void)snprintf(name, sizeof name, "%s%s", to, end);
        if (renameat(at, entry->d_name, at, name) == 0) continue;
        (void)snprintf(reason, OUTPUT_REASON, "%s cannot be renamed to %s (%s)", entry->d_name, name, strerror(errno));
        return false;
    }
    return true;
}

bool output_set_aside(const char *path, char reason[OUTPUT_REASON])
{
    char stem[OUTPUT_PATH], folder[OUTPUT_PATH] = ".", aside[OUTPUT_PATH + 32];
    output_beside(stem, path, "");
    const char *slash = strrchr(stem, '/'), *name = slash == NULL ? stem : slash + 1;
    if (slash != NULL) (void)snprintf(folder, sizeof folder, "%.*s", (int)(slash - stem) + 1, stem);
    DIR *files = opendir(folder);
    if (files == NULL) {
        (void)snprintf(reason, OUTPUT_REASON, "%s: %s", folder, strerror(errno));
        return false;
    }
    (void)snprintf(aside, sizeof aside, "%s.old", name);
    for (int k = 2; is_used(files, aside); k++) (void)snprintf(aside, sizeof aside, "%s.old%d", name, k);
    bool good = has_no_stripes(files, name, reason);
    if (good) (void)snprintf(reason, OUTPUT_REASON, "%s%s", aside, suffix);
    good = good && rename_all(files, name, aside, reason);
    (void)closedir(files);
    return good;
}
