/* SPDX-License-Identifier: BSD-3-Clause */
/* A file as bytes in memory. */
#ifndef DEM_BASE_FILE_H
#define DEM_BASE_FILE_H

#include <stddef.h>

typedef enum file_status { FILE_READ, FILE_REFUSED, FILE_MEMORY } file_status;

enum { FILE_WHY = 128 }; /* bytes of a reason */

/* Reads a regular file of 1 to `most` bytes, a multiple of 1 MiB.
 * \param[out] bytes  malloc'ed, with a NUL behind the last one; NULL unless FILE_READ is returned
 * \param[out] why    [FILE_WHY] what is wrong, where FILE_REFUSED is returned */
file_status file_read(char **bytes, size_t *size, const char *path, size_t most, char *why);

/* Reads the first bytes of a regular file, at most `most`.
 * \return how many; 0 also where there is none to read */
size_t file_begin(char *bytes, size_t most, const char *path);

/* Of a regular file, bytes; 0 where there is none. */
double file_size(const char *path);

#endif
