/* SPDX-License-Identifier: BSD-3-Clause */
/* Outputs carry the hashes of their problem and of their run in /provenance. */
#include "output.h"

#include <stdio.h>
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

void output_print_hash(char text[OUTPUT_HASH], uint64_t hash)
{
    (void)snprintf(text, OUTPUT_HASH, "%016llx", (unsigned long long)hash);
}

output_state output_claim(const char *path, const deck *d, char *reason, size_t size)
{
    char part[4096], problem[32];
    (void)snprintf(part, sizeof part, "%.*s%s", (int)(strlen(path) - strlen(suffix)), path, part_suffix);
    if (access(path, F_OK) == 0) {
        const bool same = same_problem(path, d);
        if (same && same_hash(path, "run", d->run_hash)) {
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
