/* SPDX-License-Identifier: BSD-3-Clause */
/* Fragments: the connected pieces of what is whole. */
#ifndef DEM_MODEL_FRAGMENTS_H
#define DEM_MODEL_FRAGMENTS_H

#include "lattice/lattice_source.h"
#include "model/element_state.h"

/** Nodes joined by springs that are not broken are of one fragment, whatever else breaks or broke before. A node
 *  without such a spring is one of its own.
 *  \param integrity      [n_springs] 0: broken, as an element state has it; NULL: all are whole
 *  \param[out] fragment  [n_nodes] the lowest node of the fragment of each
 *  \return their number */
dem_index fragments_find(const dem_lattice *lattice, const double *integrity, dem_index *fragment);

/** Fragments as sets that can be made one again (base/union_find.h), of a lattice that may be a part of another, with
 *  all that may break.
 *  \param d             its domain; NULL: it is the whole
 *  \param[out] parent  [n_nodes] sets of nodes
 *  \param[out] lowest  [n_nodes] of a root: the lowest node of the fragment, by the numbers of the whole */
void fragments_begin(const dem_lattice *lattice, const domain *d, const double *integrity, dem_index *parent,
                     dem_index *lowest);

/** Makes the fragments of two nodes one.
 *  \return the lowest node of the one that goes, that of the higher number; -1: they are one already */
dem_index fragments_unite(dem_index *parent, dem_index *lowest, dem_index i, dem_index j);

/** How much is broken, and into what.  \param elements  NULL: all are whole  \return DEM_ERROR_MEMORY */
dem_status fragments_measure(const dem_lattice *lattice, const element_state *elements, dem_fracture *out);

/** The same of a lattice of which all is whole, where arrays come chunk by chunk: it takes 8 bytes for a node, and 600
 *  for a fragment.  \return DEM_ERROR_MEMORY */
dem_status fragments_measure_source(const lattice_source *from, dem_fracture *out);

#endif
