/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /breaks of a trajectory: what has broken, one row for each break. Only with the option `breaks`. */
#ifndef DEM_OUTPUT_BREAK_TABLE_H
#define DEM_OUTPUT_BREAK_TABLE_H

#include "output/table.h"

/** Free with table_free(). */
dem_status break_table_init(table *out);

/** Appends the break as a row. The table's buffer must have room. */
void break_table_record(table *t, const dem_break *what);

#endif
