/* SPDX-License-Identifier: BSD-3-Clause */
/* The model of a whole of which ranks have the parts, and nobody the arrays: what rank 0 leads their run with. It has
 * the counts, the scales and the obstacles of the whole; of its lattice one array after the other can be gathered
 * (lattice/lattice_source.h). */
#ifndef DEM_MODEL_WHOLE_OF_PARTS_H
#define DEM_MODEL_WHOLE_OF_PARTS_H

#include "model/model.h"

/** Counts what the whole has. Collective; on rank 0 it makes the model, which takes the part over.
 *  \param out   on rank 0; NULL elsewhere
 *  \param part  of each rank
 *  \param ask   see dem_model
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status whole_of_parts_create(dem_model **out, dem_model *part, model_array_asker *ask);

/** A number that hardly any two wholes have which differ in some array, whatever the shares of the ranks. Collective.
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status whole_of_parts_hash(const dem_model *part, dem_index *out);

/** Hands array number `array` of lattice_arrays to a function of rank 0, chunk by chunk. Collective.
 *  \param take  on rank 0; NULL elsewhere
 *  \return as gather_chunks() */
dem_status whole_of_parts_visit(const dem_model *part, int array, rows_taker *take, void *context);

#endif
