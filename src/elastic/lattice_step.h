/* SPDX-License-Identifier: BSD-3-Clause */
/* A step of Verlet's method of one lattice row, whose state stands in an array for each component. */
#ifndef DEM_ELASTIC_LATTICE_STEP_H
#define DEM_ELASTIC_LATTICE_STEP_H

#include "base/vec2.h"
#include "elastic/lattice_reach.h"

/** An array for each component, from the first stored place of a lattice row on. A block behind the last one may be
 *  read, too. */
typedef struct lattice_planes {
    double *x[2], *v[2], *a[2];
    double *below[2]; /* N: what the springs from the lattice row below pull */
} lattice_planes;

typedef struct lattice_step {
    const lattice_rows *rows;
    dem_index row;       /* which has a next one */
    lattice_span blocks; /* that it evaluates; the others stay as they are */
    double h;            /* s */
    vec2 gravity;        /* m/s^2 */
    lattice_planes here, next;
    double sum;   /* filled: of sweep_term() of the accelerations at its end, not finite if one of them is not; */
    bool guarded; /* and whether the guard may act on a triangle between the two lattice rows at the end */
} lattice_step;

/** Takes the positions of the next lattice row through the step, and then the lattice row itself, which has its
 *  positions and what is pulled from below, as far as its blocks are evaluated. The velocities and accelerations of
 *  the next one stay, and its `below` is filled. The bits are those of a fused step of a sweep (elastic/sweep.h). */
typedef void lattice_step_function(lattice_step *s);

/** Of instruction sets by which lattice rows take less time than blocks of the layout (docs/performance.md, Waves of
 *  lattice rows). */
lattice_step_function lattice_step_portable, lattice_step_avx512_divider;

#endif
