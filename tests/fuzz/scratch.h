/* SPDX-License-Identifier: BSD-3-Clause */
/* Files for what reads files by name: in a folder of this process, under $TMPDIR or /tmp, gone at its end. */
#ifndef DEM_FUZZ_SCRATCH_H
#define DEM_FUZZ_SCRATCH_H

#include <stddef.h>

/** The path of the file of this name, valid until the process ends; at most 8 names. */
const char *scratch_path(const char *name);

void scratch_write(const char *path, const void *data, size_t size);

/** The bytes of a file, less than `most` of them. */
size_t scratch_read(const char *path, void *data, size_t most);

#endif
