/* SPDX-License-Identifier: BSD-3-Clause */
/* One pass over the blocks of a layout: the accelerations of their nodes, free of contact. The arithmetic is the same
 * for every instruction set and rounds as IEEE operations do, so that every sweep gives the bits of
 * forces_acceleration(). Nodes outside of blocks, and what is rare, are evaluated in forces/kernel.c. */
#ifndef DEM_ELASTIC_SWEEP_H
#define DEM_ELASTIC_SWEEP_H

#include <math.h>

#include "elastic/layout.h"

/** A step of Verlet, (5), from x0, v0 with accelerations a0 to x1, v1; arrays [n_nodes][2]. */
typedef struct sweep_fused_step {
    double h; /* s */
    const double *x0, *v0, *a0;
    double *x1, *v1;
} sweep_fused_step;

/** Strains from none to these do not count, > 0; infinity: none does. */
typedef struct sweep_limits {
    float stretch, squeeze; /* in tension, and under pressure */
    double shortest,
        longest; /* m: lengths with these strains of a block's springs, if all are as long at rest, to 1e-9;
                                 longest < 0: they are not */
} sweep_limits;

/** What an acceleration, m/s^2, adds to the sum over all, from which sweep_largest() bounds each of them. */
static inline double sweep_term(vec2 a)
{
    const double x = a.x * a.x, y = a.y * a.y;
    return x * x + y * y;
}

/** No acceleration in a sum is larger, m/s^2:  |a|^4 = (x^2 + y^2)^2 <= 2 (x^4 + y^4). */
static inline double sweep_largest(double sum)
{
    return sqrt(sqrt(2.0 * sum));
}

/** What a sweep reads and writes; nodes in the order of the layout. */
typedef struct sweep {
    const layout *layout;
    bool goes_on;               /* whether the ring is that of a sweep of the same positions up to the first block */
    const double *inverse_mass; /* [n_nodes] 1/kg; 0: fixed */
    vec2 gravity;               /* m/s^2 */
    double mass_damping;        /* 1/s */
    const double *x, *v;        /* [n_nodes][2] */
    double *a;                  /* [n_nodes][2] accelerations */
    double *u;                  /* [n_nodes][2] velocities, as v; NULL: not wanted */
    uint8_t *guarded;           /* [n_blocks] a bit for each node with a triangle on which the guard acts: its
                                   acceleration is without triangles; NULL, without an area term: not asked for */
    bool looks_at_lowest;       /* where there is no area term: whether `guarded` has, instead, a bit for the lowest
                                   corner of each triangle on which the guard acts, and for some others of its block */
    const sweep_limits *limit; /* [n_blocks] strains that are not asked after. Of a sweep that fills accelerations NULL:
                                   none are */
    uint8_t *strained;         /* [n_blocks] a bit for each node with a spring, of those that it evaluates, strained
                                   more */
    const sweep_fused_step
        *fused_step;        /* NULL: none. Else x is its x1, which the sweep fills before it reads it, from the block
                               layout->ahead behind its first one on; and its v1, after the accelerations */
    dem_index drift_end;    /* of a fused step, the block that ends where the sweep fills x: x is there from this one
                               on, and */
    const uint8_t *drifted; /* [n_blocks] 1: in this block; NULL: in no other */
} sweep;

/** Sweeps the blocks `first` to `last` - 1. Strains may be asked after in a fused step.
 *  \param ring  [layout->ring_length][2], twice that where springs are damped: scratch of one thread
 *  \return the sum of sweep_term() of the accelerations: not finite if one of them is not, or one of the velocities, if
 *  these are wanted */
typedef double sweep_function(const sweep *s, dem_index first, dem_index last, double *ring);

sweep_function sweep_portable, sweep_avx2, sweep_avx512, sweep_avx512_divider;

/** Fills `guarded` and nothing else. */
typedef void sweep_guard_function(const sweep *s, dem_index first, dem_index last);

sweep_guard_function sweep_guard_portable, sweep_guard_avx2, sweep_guard_avx512, sweep_guard_avx512_divider;

/** Fills `strained` and nothing else. In either sweep a spring whose strain is within 1e-12 of a limit may count or
 *  not. */
typedef void sweep_strain_function(const sweep *s, dem_index first, dem_index last);

sweep_strain_function sweep_strain_portable, sweep_strain_avx2, sweep_strain_avx512, sweep_strain_avx512_divider;

#endif
