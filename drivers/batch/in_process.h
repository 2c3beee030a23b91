/* SPDX-License-Identifier: BSD-3-Clause */
/* dem_batch as a function of another program, the library libdem_batch, for the Python package. It may change with any
 * version. */
#ifndef DEM_IN_PROCESS_H
#define DEM_IN_PROCESS_H

#include <dem/status.h>

#include "requests.h"

/** Does what dem_batch does with these words, in any thread, several at once; cases of one command in turn. Signals,
 *  standard streams, the locale and GSL's handler of errors stay those of the program.
 *  \param words     [n + 1] the name of the program first, NULL behind the last
 *  \param asked     may be changed by other threads meanwhile
 *  \param part      of a run what is done, 0 to 1, is written there for other threads
 *  \param printed   [2] to standard output and standard error, each to be freed with dem_private_batch_free(); NULL
 *                   where memory has run out
 *  \return dem_batch's exit code */
DEM_API int dem_private_batch(int n, char **words, requests *asked, volatile double *part, char **printed);
DEM_API void dem_private_batch_free(char *text);

#endif
