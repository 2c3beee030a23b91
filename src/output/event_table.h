/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /events of a trajectory: what happened to contacts, one row for each event. Only with the option
 * `events`. */
#ifndef DEM_OUTPUT_EVENT_TABLE_H
#define DEM_OUTPUT_EVENT_TABLE_H

#include "output/table.h"

/** Free with table_free(). */
dem_status event_table_init(table *out);

/** Makes the empty datasets, with the names of the codes as attributes. */
dem_status event_table_create(const table *t, const hdf5_file *file);

/** Appends the event as a row. The table's buffer must have room. */
void event_table_record(table *t, const dem_event *event);

#endif
