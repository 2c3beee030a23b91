/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of a checkpoint that other ranks have. */
#ifndef DEM_BASE_CHECKPOINT_ROWS_H
#define DEM_BASE_CHECKPOINT_ROWS_H

#include "base/rows_taker.h"

/** What makes up an entry that others have until somebody asks for it. */
typedef struct checkpoint_rows {
    dem_status (*visit)(void *context, rows_taker *take, void *taker); /**< hands all over */
    void *context;
    size_t size; /**< bytes of a row */
    dem_index n;
} checkpoint_rows;

#endif
