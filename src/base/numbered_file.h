/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of a run NAME with numbers in their names: segments, NAME.00001.vtkhdf, and the stripes of a segment,
 * NAME.00001.1of4.h5 to NAME.00001.4of4.h5, and of the whole, NAME.1of4.h5 to NAME.4of4.h5. Programs know them by it,
 * too. */
#ifndef DEM_BASE_NUMBERED_FILE_H
#define DEM_BASE_NUMBERED_FILE_H

#include <stdbool.h>

typedef struct numbered_file {
    long long segment; /**< from 1 on; 0: the whole */
    int stripe, n;     /**< 1 to n; 0 of 0: a segment itself */
    bool is_temporary; /**< a stripe in the making: NAME.1of4.h5.new */
} numbered_file;

enum { NUMBERED_FILE = 64 /**< bytes */ };

/** What is behind NAME. */
void numbered_file_print(char out[NUMBERED_FILE], numbered_file file);

/** \param ending  what is behind NAME
 *  \return false if it is not that of such a file */
bool numbered_file_read(numbered_file *out, const char *ending);

#endif
