/* SPDX-License-Identifier: BSD-3-Clause */
#include "part_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const char end_of_part[] = ".part";

static bool refuse(outcome *o, const char *path, const char *fault)
{
    outcome_fail(o, EXIT_IO, "dem_plot", "%s: cannot be written (%s)", path, errno != 0 ? strerror(errno) : fault);
    return false;
}

static void forget(part_file *p)
{
    free(p->part);
    *p = (part_file){0};
}

bool part_file_open(part_file *p, const char *path, outcome *o)
{
    const size_t size = strlen(path) + sizeof end_of_part;
    *p = (part_file){.path = path, .part = malloc(size)};
    if (p->part == NULL) return outcome_fail(o, EXIT_MEMORY, "dem_plot", "out of memory"), false;
    (void)snprintf(p->part, size, "%s%s", path, end_of_part);
    p->file = fopen(p->part, "wb");
    if (p->file != NULL) return true;
    (void)refuse(o, path, "");
    forget(p);
    return false;
}

bool part_file_close(part_file *p, bool good, const char *fault, outcome *o)
{
    const bool closed = fclose(p->file) == 0;
    const bool written = closed && good && rename(p->part, p->path) == 0;
    if (!written) {
        (void)refuse(o, p->path, fault);
        (void)remove(p->part);
    }
    forget(p);
    return written;
}

void part_file_drop(part_file *p)
{
    (void)fclose(p->file);
    (void)remove(p->part);
    forget(p);
}
