/* SPDX-License-Identifier: BSD-3-Clause */
#include "streams.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

void streams_begin(void)
{
    for (int k = 0; k <= STDERR_FILENO; k++)
        if (fcntl(k, F_GETFD) < 0) (void)open("/dev/null", O_RDONLY);
}

int streams_end(const char *program, exit_code code)
{
    if (fflush(stdout) == 0 && ferror(stdout) == 0) return (int)code;
    (void)fprintf(stderr, "%s: error: standard output cannot be written\n", program);
    return code != EXIT_DONE ? (int)code : (int)EXIT_IO;
}
