/* SPDX-License-Identifier: BSD-3-Clause */
/* Outputs carry the hash of their problem and their resolved deck in /provenance. */
#include "output.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <dem/trajectory.h>

static const char suffix[] = ".vtkhdf", part_suffix[] = ".part.vtkhdf";

bool output_path(char *path, size_t size, const char *folder, const char *name)
{
    const int n = strcmp(folder, ".") == 0 ? snprintf(path, size, "%s%s", name, suffix)
                                           : snprintf(path, size, "%s/%s%s", folder, name, suffix);
    return n > 0 && (size_t)n + sizeof part_suffix < size;
}

static bool same_problem(const char *path, const deck *d)
{
    char stored[32], hash[32];
    (void)snprintf(hash, sizeof hash, "%016llx", (unsigned long long)d->hash);
    return dem_trajectory_read_note(path, "problem", stored, sizeof stored) == DEM_OK && strcmp(stored, hash) == 0;
}

static bool same_run(const char *path, const deck *d)
{
    const size_t size = strlen(d->echo) + 2;
    char *stored = malloc(size);
    const bool same = stored != NULL && dem_trajectory_read_note(path, "resolved", stored, size) == DEM_OK &&
                      strcmp(stored, d->echo) == 0;
    free(stored);
    return same;
}

output_state output_claim(const char *path, const deck *d, char *reason, size_t size)
{
    char part[4096], problem[32];
    (void)snprintf(part, sizeof part, "%.*s%s", (int)(strlen(path) - strlen(suffix)), path, part_suffix);
    if (access(path, F_OK) == 0) {
        const bool same = same_problem(path, d);
        if (same && same_run(path, d)) {
            (void)snprintf(reason, size, "this run's result is there");
            return OUTPUT_DONE;
        }
        (void)snprintf(reason, size,
                       "the file exists and belongs to another %s; move it away or change 'name' in &output",
                       same ? "run of the same problem, with other t_end, title or frames" : "problem");
        return OUTPUT_TAKEN;
    }
    /* A part that cannot be read was cut off while it was begun: there is nothing in it. */
    if (access(part, F_OK) == 0 && dem_trajectory_read_note(part, "problem", problem, sizeof problem) == DEM_OK &&
        !same_problem(part, d)) {
        (void)snprintf(reason, size,
                       "an unfinished run of another problem is in %s; move it away or change 'name' in &output", part);
        return OUTPUT_TAKEN;
    }
    return OUTPUT_FREE;
}
