/* SPDX-License-Identifier: BSD-3-Clause */
/* One pass over the blocks of a layout that measures what springs and triangles are strained by: their energies, the
 * extreme strains, the smallest area. Terms are those of springs_energy_of(), triangles_energy_of() and
 * couplings_energy_term(), to the bit, and every instruction set gives the same bits. Nodes outside of blocks, elements
 * that are not whole and the guard are left to forces/survey.c. */
#ifndef DEM_ELASTIC_ENERGY_PASS_H
#define DEM_ELASTIC_ENERGY_PASS_H

#include "base/exact_sum.h"
#include "elastic/layout.h"

enum { ENERGY_PASS_GROUP = 4 }; /* blocks that have extremes in common */

/** What a pass reads and writes; nodes in the order of the layout. Springs and couplings are those of their lowest node
 *  in this order, and triangles that of their lowest number. */
typedef struct energy_pass {
    const layout *layout;
    const double *x;         /* [n_nodes][2] */
    const uint8_t *skipped;  /* [n_blocks] a bit for each node whose elements are left out; NULL: none are */
    uint8_t *folded;         /* [n_blocks] a bit for each node that has a triangle of less than TRIANGLES_GUARD_ONSET of
                                its area */
    double *least, *largest; /* [n_blocks/ENERGY_PASS_GROUP, rounded up] strain of springs; infinity, -infinity: none */
} energy_pass;

typedef struct energy_sums {
    exact_sum elastic, area; /* J, of springs with their couplings, and of area terms */
    double area_min;         /* area over rest area; infinity: there are no triangles */
} energy_sums;

/** Measures the blocks `first` to `last` - 1, and adds their energies; `first` is a multiple of ENERGY_PASS_GROUP. */
typedef void energy_pass_function(const energy_pass *p, dem_index first, dem_index last, energy_sums *out);

energy_pass_function energy_pass_portable, energy_pass_avx2, energy_pass_avx512;

#endif
