/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /history of a trajectory: numbers of the whole run at accepted steps. */
#ifndef DEM_OUTPUT_HISTORY_H
#define DEM_OUTPUT_HISTORY_H

#include <stdbool.h>

#include "output/table.h"

typedef struct history {
    table table;
    double interval; /**< s between rows, at least; 0 unless it is set: every accepted step has one */
    double last;     /**< t of the last row, s; -INFINITY: none yet */
    double start;    /**< J, of the ledger in the first row */
    double largest;  /**< J, energy of motion and strain so far */
    bool breaks;     /**< there are columns of what is broken: */
    bool stale;      /**< something has broken since it was measured */
    dem_fracture fracture;
} history;

/** Free with history_free().  \param breaks  whether there are columns of what is broken */
dem_status history_init(history *out, const dem_simulation *simulation, bool breaks);
void history_free(history *h);

/** To be called when something has broken. */
void history_forget(history *h);

/** Appends the state as a row, if one is due (dem_history_row_due()). The table's buffer must have room.
 *  \return DEM_ERROR_MEMORY, then there is no row */
dem_status history_record(history *h, const dem_simulation *simulation);

/** DEM_ERROR_IO unless this row of a file has the time h->last. */
dem_status history_expect_last(const history *h, const hdf5_file *file, hsize_t row);

#endif
