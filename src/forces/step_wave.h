/* SPDX-License-Identifier: BSD-3-Clause */
/* Several fused steps of Verlet's method in one pass, to the bits of one after the other: over the lattice rows of a
 * body (elastic/lattice_wave.h), or over the blocks of a layout, each of which takes them all while it is in the cache.
 * How blocks follow each other is in the .c file. */
#ifndef DEM_FORCES_STEP_WAVE_H
#define DEM_FORCES_STEP_WAVE_H

#include "forces/kernel.h"

enum { STEP_WAVE_MOST = 16 };

/** Steps of one length. Each begins where the one before ends. The arrays at the ends of steps may be the same at every
 *  other end, but none of them those at the start. By lattice rows those at the last end alone are filled. */
typedef struct step_wave_steps {
    int n;                                 /* 1 to STEP_WAVE_MOST */
    sweep_fused_step step[STEP_WAVE_MOST]; /* of the nodes */
    double *a[STEP_WAVE_MOST];             /* [n_nodes][2] accelerations at the ends of the steps */
    const dem_index *watched;              /* [n_watched] nodes, ascending */
    dem_index n_watched;                   /* >= 0 */
    double square[STEP_WAVE_MOST];         /* filled: of the highest speed of watched nodes at each end, m^2/s^2, */
    double sum[STEP_WAVE_MOST];            /* and the sum of sweep_term() of all accelerations there */
} step_wave_steps;

typedef struct step_wave step_wave;

/** Room for waves; borrows the kernel. NULL without memory, or if there are none: if nodes are numbered otherwise than
 *  in the layout, or without lattice rows are too few for the team. Free with step_wave_free(). */
step_wave *step_wave_create(const kernel *k);
void step_wave_free(step_wave *w);

/** Whether waves take less time than their steps in turn. */
bool step_wave_pays(const step_wave *w);

/** How many steps a wave takes at most. */
int step_wave_most(const step_wave *w);

/** Takes the steps, where kernel_can_fuse() and kernel_is_trimmed() hold and surfaces do not touch each other.
 *  \return false if something is not finite, or the guard acts somewhere at an end of a step: the arrays at the ends
 *  are undefined then */
bool step_wave_run(step_wave *w, const forces *f, step_wave_steps *steps);

#endif
