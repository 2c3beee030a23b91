/* SPDX-License-Identifier: BSD-3-Clause */
/* The standard streams of a program, from its start to its exit code. */
#ifndef DEM_STREAMS_H
#define DEM_STREAMS_H

#include "outcome.h"

/** A file must not get the number of a closed standard stream: what is printed would go into it. */
void streams_begin(void);

/** The code to exit with: `code`, or EXIT_IO, said on standard error, where all was well but standard output cannot be
 *  written. */
int streams_end(const char *program, exit_code code);

#endif
