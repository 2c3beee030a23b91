/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of fields (base/field_order.h) that a simulation has: of all nodes, springs or triangles, or of those of a
 * part. */
#ifndef DEM_SIMULATION_FIELD_ROWS_H
#define DEM_SIMULATION_FIELD_ROWS_H

#include "base/field_order.h"
#include "domain/gather.h"

/** Bytes of a row. */
size_t field_rows_size(field_kind field);

/** Whether each rank of a led run has the rows of what it owns. Otherwise the leader has all: fragments are found by a
 *  search of all bodies. */
bool field_rows_are_shared(field_kind field);

/** How many there are. */
dem_index field_rows_count(const dem_simulation *s, field_kind field);

/** Which they are, of a part. */
gather_items field_rows_items(const dem_simulation *part, field_kind field);

/** Allocates and fills them. Collective where ranks share the model.
 *  \param[out] out  to be freed with free(), after a failure, too
 *  \return DEM_ERROR_MEMORY; as the getter of the field */
dem_status field_rows_make(const dem_simulation *s, field_kind field, void **out);

#endif
