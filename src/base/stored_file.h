/* SPDX-License-Identifier: BSD-3-Clause */
/* An open file of which bytes are read when they are wanted, by several who hold it. It stays what it was when it is
 * renamed, or replaced by another one of its name. */
#ifndef DEM_BASE_STORED_FILE_H
#define DEM_BASE_STORED_FILE_H

#include <stdint.h>
#include <stdio.h>

#include <dem/dem.h>

typedef struct stored_file stored_file;

/** Opens the file of a stream once more, for one holder.
 *  \param path  for messages, copied  \return DEM_ERROR_MEMORY, DEM_ERROR_IO */
dem_status stored_file_open(stored_file **out, FILE *stream, const char *path);

/** One holder more, or one less: the last one closes it. Drop accepts NULL. */
stored_file *stored_file_hold(stored_file *f);
void stored_file_drop(stored_file *f);

/** \return DEM_ERROR_IO with the name of the file if it does not have so many bytes there */
dem_status stored_file_read(const stored_file *f, uint64_t at, size_t size, void *to);

#endif
