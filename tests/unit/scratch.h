/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders for the files that tests write, under TMPDIR or else /tmp: one of a fixture, and one of a group of tests. A
 * file that is left in a folder and was not named to it is a failure. */
#ifndef DEM_TEST_SCRATCH_H
#define DEM_TEST_SCRATCH_H

#include "harness/test.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SCRATCH_FOLDER = 192, SCRATCH_PATH = 256, SCRATCH_FILES = 6 };

/* ---- a folder ---- */

typedef struct scratch_folder {
    char path[SCRATCH_FOLDER];
    char *files[SCRATCH_FILES]; /* [n] paths, which stay where they are when a folder is copied */
    int n;
} scratch_folder;

/** \returns whether it is there */
static inline bool folder_make(scratch_folder *f)
{
    const char *parent = getenv("TMPDIR");
    *f = (scratch_folder){.n = 0};
    (void)snprintf(f->path, sizeof f->path, "%s/dem_test_XXXXXX", parent != NULL ? parent : "/tmp");
    return mkdtemp(f->path) != NULL;
}

/** A new folder, or the test fails. */
static inline void folder_open(scratch_folder *f)
{
    assert_true(folder_make(f));
}

/** The path of a file that may be left in the folder. */
static inline char *folder_file(scratch_folder *f, const char *name)
{
    assert(f->n < SCRATCH_FILES);
    char *path = malloc(SCRATCH_PATH);
    assert(path != NULL);
    (void)snprintf(path, SCRATCH_PATH, "%s/%s", f->path, name);
    return f->files[f->n++] = path;
}

/** The path of any file in the folder, for the next four calls. */
static inline char *folder_at(const scratch_folder *f, const char *name)
{
    static char paths[4][SCRATCH_PATH];
    static int next;
    assert(f->path[0] != '\0'); /* without it, names would be those of files in / */
    char *path = paths[next++ % 4];
    (void)snprintf(path, SCRATCH_PATH, "%s/%s", f->path, name);
    return path;
}

/** Removes the files that may be left. */
static inline void folder_sweep(const scratch_folder *f)
{
    for (int k = 0; k < f->n; k++) (void)unlink(f->files[k]);
}

/** \returns whether nothing else was left */
static inline bool folder_remove(scratch_folder *f)
{
    folder_sweep(f);
    for (int k = 0; k < f->n; k++) free(f->files[k]);
    f->n = 0;
    return rmdir(f->path) == 0;
}

/** Removes the folder; the test fails where anything else was left. */
static inline void folder_close(scratch_folder *f)
{
    assert_true(folder_remove(f));
}

/** Writes a file, or the test fails. */
static inline void file_put(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* ---- the folder of a group ---- */

static scratch_folder scratch;

static inline int scratch_make(__attribute__((unused)) void **state)
{
    return folder_make(&scratch) ? 0 : 1;
}

static inline char *scratch_file(const char *name)
{
    return folder_file(&scratch, name);
}

/** After one test. */
static inline int scratch_sweep(__attribute__((unused)) void **state)
{
    folder_sweep(&scratch);
    return 0;
}

/** After a group. */
static inline int scratch_remove(__attribute__((unused)) void **state)
{
    return folder_remove(&scratch) ? 0 : 1;
}

/** A variable of a group, and the file whose path it is. */
typedef struct scratch_name {
    const char **path;
    const char *name;
} scratch_name;

/** A group of tests in a folder with the files of a list of scratch_name. */
#define SCRATCH_GROUP(...)                                                                                             \
    static int scratch_begin(void **state)                                                                             \
    {                                                                                                                  \
        const scratch_name names[] = {__VA_ARGS__};                                                                    \
        if (scratch_make(state) != 0) return 1;                                                                        \
        for (size_t k = 0; k < sizeof names / sizeof *names; k++) *names[k].path = scratch_file(names[k].name);        \
        return 0;                                                                                                      \
    }                                                                                                                  \
    TEST_GROUP(scratch_begin, scratch_remove)

#endif
