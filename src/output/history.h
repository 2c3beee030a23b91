/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /history of a trajectory: numbers of the whole run at accepted steps. */
#ifndef DEM_OUTPUT_HISTORY_H
#define DEM_OUTPUT_HISTORY_H

#include "output/table.h"

typedef struct history {
    table table;
    double last;    /**< t of the last row, s */
    double start;   /**< J, of the ledger in the first row */
    double largest; /**< J, energy of motion and strain so far */
} history;

/** Free with history_free(). */
dem_status history_init(history *out, const dem_simulation *simulation);
void history_free(history *h);

/** Appends the state as a row, unless the last row is of the same instant. The table's buffer must have room. */
void history_record(history *h, const dem_simulation *simulation);

/** DEM_ERROR_IO unless this row of a file has the time h->last. */
dem_status history_expect_last(const history *h, const hdf5_file *file, hsize_t row);

#endif
