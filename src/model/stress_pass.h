/* SPDX-License-Identifier: BSD-3-Clause */
/* Passes over springs, coupled triangles, nodes and blocks of a layout from which the stresses of all nodes come, with
 * the bits of stress_of_node() for every instruction set. What the guard acts on, and what is not whole, is left to
 * forces/stress_field.c. */
#ifndef DEM_MODEL_STRESS_PASS_H
#define DEM_MODEL_STRESS_PASS_H

#include "elastic/layout.h"
#include "model/stress.h"

/** What the passes read and write; nodes have their own order, which is that of the layout, too. */
typedef struct stress_pass {
    const dem_lattice *lattice;
    const stress_map *map;
    const layout *layout;
    const double *x;  /* [n_nodes][2] */
    double *virial;   /* [n_springs][4] r x f, J: xx, yy, xy; and the strain. Aligned, as the next array is */
    double *coupled;  /* [couplings][4] r x f of coupled triangles, J: xx, yy, xy, 0 */
    double *stress;   /* [n_nodes][3] Pa: xx, yy, xy */
    uint8_t *guarded; /* [n_blocks] a bit for each node with a triangle on which the guard acts */
} stress_pass;

/** One of the passes over items `first` to `last` - 1. */
typedef void stress_pass_function(const stress_pass *p, dem_index first, dem_index last);

/** Springs: fills `virial`. */
stress_pass_function stress_pass_springs_portable, stress_pass_springs_avx2, stress_pass_springs_avx512;

/** Nodes: fills `stress` with what springs make of it. */
stress_pass_function stress_pass_nodes_portable, stress_pass_nodes_avx2, stress_pass_nodes_avx512;

/** Coupled triangles: fills `coupled`. */
stress_pass_function stress_pass_couplings_portable, stress_pass_couplings_avx2, stress_pass_couplings_avx512;

/** Nodes: adds to `stress` what couplings make of it. */
stress_pass_function stress_pass_corners_portable, stress_pass_corners_avx2, stress_pass_corners_avx512;

/** Blocks: fills `guarded`, and adds to `stress` what area terms make of the other nodes' in blocks. */
stress_pass_function stress_pass_areas_portable, stress_pass_areas_avx2, stress_pass_areas_avx512;

#endif
