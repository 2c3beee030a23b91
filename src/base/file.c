/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static file_status refuse(char *why, const char *text)
{
    (void)snprintf(why, FILE_WHY, "%s", text);
    return FILE_REFUSED;
}

static file_status refuse_large(char *why, size_t most)
{
    (void)snprintf(why, FILE_WHY, "the file is larger than %zu MiB", most >> 20);
    return FILE_REFUSED;
}

/* One byte more than the file had at first shows that it has grown. */
static file_status read_bytes(char *bytes, size_t *size, size_t expected, int file, char *why)
{
    for (*size = 0; *size <= expected;) {
        const ssize_t n = read(file, bytes + *size, expected + 1 - *size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return refuse(why, strerror(errno));
        if (n == 0) break;
        *size += (size_t)n;
    }
    if (*size > expected) return refuse(why, "the file grows while it is read");
    return *size == 0 ? refuse(why, "the file is empty") : FILE_READ;
}

static file_status read_open(char **bytes, size_t *size, size_t most, int file, char *why)
{
    struct stat info;
    if (fstat(file, &info) != 0) return refuse(why, strerror(errno));
    if (!S_ISREG(info.st_mode)) return refuse(why, "not a regular file");
    if ((uintmax_t)info.st_size > most) return refuse_large(why, most);
    char *text = malloc((size_t)info.st_size + 2);
    if (text == NULL) return FILE_MEMORY;
    const file_status status = read_bytes(text, size, (size_t)info.st_size, file, why);
    if (status == FILE_READ) {
        text[*size] = '\0';
        *bytes = text;
    } else {
        free(text);
    }
    return status;
}

/* A pipe without writer must not hang. */
static int open_here(const char *path)
{
    return open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
}

file_status file_read(char **bytes, size_t *size, const char *path, size_t most, char *why)
{
    *bytes = NULL;
    const int file = open_here(path);
    if (file < 0) return refuse(why, strerror(errno));
    const file_status status = read_open(bytes, size, most, file, why);
    (void)close(file);
    return status;
}

size_t file_begin(char *bytes, size_t most, const char *path)
{
    const int file = open_here(path);
    struct stat info;
    ssize_t n = 0;
    if (file < 0) return 0;
    if (fstat(file, &info) == 0 && S_ISREG(info.st_mode)) n = read(file, bytes, most);
    (void)close(file);
    return n > 0 ? (size_t)n : 0;
}

double file_size(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode) ? (double)info.st_size : 0.0;
}
