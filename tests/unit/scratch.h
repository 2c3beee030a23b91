/* SPDX-License-Identifier: BSD-3-Clause */
/* A folder for the files that a test writes, under TMPDIR or else /tmp. A file that is left in it under a name that was
 * not given to scratch_file() fails the group. */
#ifndef DEM_TEST_SCRATCH_H
#define DEM_TEST_SCRATCH_H

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { SCRATCH_FOLDER = 192, SCRATCH_PATH = 256, SCRATCH_FILES = 4 };

static char scratch_folder[SCRATCH_FOLDER], scratch_paths[SCRATCH_FILES][SCRATCH_PATH];
static int scratch_n;

/** For a group of tests. */
static inline int scratch_make(void **state)
{
    const char *parent = getenv("TMPDIR");
    (void)state;
    (void)snprintf(scratch_folder, sizeof scratch_folder, "%s/dem_test_XXXXXX", parent != NULL ? parent : "/tmp");
    return mkdtemp(scratch_folder) == NULL;
}

/** The path of a file that tests may leave in the folder. */
static inline char *scratch_file(const char *name)
{
    assert(scratch_n < SCRATCH_FILES);
    (void)snprintf(scratch_paths[scratch_n], SCRATCH_PATH, "%s/%s", scratch_folder, name);
    return scratch_paths[scratch_n++];
}

/** Removes the files: after one test. */
static inline int scratch_sweep(void **state)
{
    (void)state;
    for (int k = 0; k < scratch_n; k++) (void)unlink(scratch_paths[k]);
    return 0;
}

/** Removes the files and the folder: after a group. */
static inline int scratch_remove(void **state)
{
    (void)scratch_sweep(state);
    return rmdir(scratch_folder);
}

#endif
