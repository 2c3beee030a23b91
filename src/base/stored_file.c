/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/stored_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/status.h"

struct stored_file {
    int number;           /* of the open file */
    atomic_int n_holders; /* which may be in several threads */
    char path[];          /* as it was called then */
};

dem_status stored_file_open(stored_file **out, FILE *stream, const char *path)
{
    stored_file *f = malloc(sizeof *f + strlen(path) + 1);
    CHECK_MEMORY(f);
    memcpy(f->path, path, strlen(path) + 1);
    atomic_init(&f->n_holders, 1);
    f->number = fcntl(fileno(stream), F_DUPFD_CLOEXEC, 0);
    if (f->number >= 0) {
        *out = f;
        return DEM_OK;
    }
    free(f);
    return status_fail(DEM_ERROR_IO, "%s: cannot be kept open (%s)", path, strerror(errno));
}

stored_file *stored_file_hold(stored_file *f)
{
    (void)atomic_fetch_add(&f->n_holders, 1);
    return f;
}

void stored_file_drop(stored_file *f)
{
    if (f == NULL || atomic_fetch_sub(&f->n_holders, 1) > 1) return;
    (void)close(f->number);
    free(f);
}

/* A read may bring less than is asked for. */
dem_status stored_file_read(const stored_file *f, uint64_t at, size_t size, void *to)
{
    unsigned char *next = to;
    while (size > 0) {
        const ssize_t n = pread(f->number, next, size, (off_t)at);
        if (n < 0 && errno == EINTR) continue;
        CHECK(n > 0, DEM_ERROR_IO, "%s: cannot be read any more (%s)", f->path,
              n < 0 ? strerror(errno) : "it has been cut short");
        next += n;
        at += (uint64_t)n;
        size -= (size_t)n;
    }
    return DEM_OK;
}
