/* SPDX-License-Identifier: BSD-3-Clause */
/* A pass over the blocks of a layout that finds how far their triangles are from the onset of the folding guard. The
 * result bounds what may happen, and is not the same to the last bit for every instruction set. */
#ifndef DEM_ELASTIC_FOLD_PASS_H
#define DEM_ELASTIC_FOLD_PASS_H

#include "elastic/layout.h"
#include "elastic/triangles.h"

/** Of the triangles with their lowest corner in a block. Nodes have the order of the layout.
 *  \param x, v  [n_nodes][2] */
typedef triangles_room fold_pass_function(const layout *l, const double *x, const double *v);

fold_pass_function fold_pass_portable, fold_pass_avx2, fold_pass_avx512;

#endif
