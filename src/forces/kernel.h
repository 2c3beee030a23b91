/* SPDX-License-Identifier: BSD-3-Clause */
/* The accelerations of all nodes at once, with the vector instructions that the machine has, in threads. Every kernel
 * and every number of threads gives the bits of forces_acceleration(). */
#ifndef DEM_FORCES_KERNEL_H
#define DEM_FORCES_KERNEL_H

#include <stdbool.h>

#include "base/array_ops.h"
#include "base/team.h"
#include "elastic/fold_pass.h"
#include "elastic/sweep.h"
#include "elastic/trimmed_layout.h"
#include "forces/border_blocks.h"
#include "forces/forces.h"

typedef struct kernel {
    const dem_model *model;
    sweep_function *sweep;
    sweep_guard_function *sweep_guard;
    sweep_strain_function *sweep_strain;
    fold_pass_function *fold_pass;
    const array_ops *ops;
    dem_kernel kind; /* not DEM_KERNEL_AUTO */
    team *team;
    int n_shares;          /* of its loops */
    double *rings;         /* [threads of the team][ring_size] */
    size_t ring_size;      /* doubles */
    uint8_t *guarded;      /* [n_blocks + 8], zeros behind the blocks */
    double *sums;          /* [n_shares] */
    sweep_limits *limit;   /* [n_blocks + 1] the least of the thresholds that are watched, last that of the nodes behind
                               all blocks; NULL: none are */
    uint8_t *strained;     /* [n_blocks] nodes with springs strained more, */
    const double *watched; /* at these positions, of a fused step; NULL: to be found */
    trimmed_layout trimmed; /* what sweeps read where something has broken or softened, */
    dem_index n_trimmed;    /* if elements have done so as often; -1: there is none */
    dem_index n_beside, beside_capacity;
    dem_index *beside;    /* [n_beside] scratch: nodes beside elements, some more than once */
    border_blocks border; /* of a model that ranks share */
    double *packed;       /* [7 n_nodes] inverse masses, x, v and a in the layout's order; NULL: that of the nodes */
} kernel;

/** Borrows the model, and the team that its loops run in.  \return DEM_ERROR_ARGUMENT for a kernel that this machine
 *  does not have; DEM_ERROR_MEMORY. Free with kernel_destroy(). */
dem_status kernel_create(kernel *out, const dem_model *model, dem_kernel kind, team *t);
void kernel_destroy(kernel *k);

/** Makes the sweep fit a state of elements, of which the n of `list` have broken or softened since the last call, some
 *  of them more than once; NULL: any have. It holds until more fail, or are mended. Without memory for it, and as long
 *  as it does not hold, nodes beside elements that are not whole are evaluated one by one, to the same bits. */
void kernel_follow(kernel *k, const element_state *elements, const dem_index *list, dem_index n);

/** Strains of a spring that are not asked after, > 0, in tension and under pressure; infinity: none is. */
typedef struct kernel_threshold {
    float stretch, squeeze;
} kernel_threshold;

/** From now on strains are watched.  \param threshold  [n_springs] by the lattice's numbers
 *  \return DEM_ERROR_MEMORY */
dem_status kernel_watch(kernel *k, const kernel_threshold *threshold);

/** The spring in a slot of a node's row. */
typedef void kernel_visitor(void *context, dem_index node, dem_index slot);

/** Visits each spring that is not broken and, at positions x [n][2], strained by more than its threshold, at one end or
 *  at both; and others that are strained by more than those near them may be, in some order. Strains are watched. If x
 *  is where a fused step has just ended, the step itself has found them: no other positions may stand there by now. */
void kernel_visit_strained(kernel *k, const element_state *elements, const double *x, kernel_visitor *visit,
                           void *context);

/** A state and its derivative, [n_nodes][2] each. */
typedef struct kernel_state {
    const double *x, *v;
    double *u;                          /* velocities, as v; NULL: not wanted */
    double *a;                          /* accelerations, free of contact */
    const sweep_fused_step *fused_step; /* NULL: none. Else x and v are its x1 and v1, which are filled as well, and
                                           kernel_begin_step() has begun it */
    bool is_unfolded;                   /* whether it is known that the guard acts on no triangle */
} kernel_state;

/** Whether the sweep evaluates all blocks as their elements are, so that no nodes are evaluated one by one since an
 *  element beside them is not whole; and the layout that it reads. */
bool kernel_is_trimmed(kernel *k, const element_state *elements);
const layout *kernel_layout(const kernel *k, const element_state *elements);

/** Whether accelerations depend on nothing but positions, so that a fused step is possible. */
bool kernel_can_fuse(const kernel *k, const forces *f);

/** Begins a fused step: fills x1 where more than one share of the sweep reads it, and at the border with other ranks.
 *  Ghosts get their places from these then, before kernel_accelerate(). */
void kernel_begin_step(const kernel *k, const sweep_fused_step *step);

/** Fills u and a. With a fused step it also fills x1 and v1, with the bits of a drift before and a kick after.
 *  \return a sum that is not finite if a component of u or a is not; where no body is rigid it bounds the accelerations
 *  a by sweep_largest() */
double kernel_accelerate(kernel *k, const forces *f, const kernel_state *y);

/** Drifts the nodes `first` to `last` - 1 of a fused step. */
void kernel_drift(const kernel *k, const sweep_fused_step *p, dem_index first, dem_index last);

/** Fills a of one node, and its v1 with a fused step, as kernel_accelerate() does; the node has been drifted.
 *  \return what it adds to the sum */
double kernel_accelerate_row(const kernel *k, const forces *f, const kernel_state *y, dem_index i);

/** How far the triangles of a state are from the onset of their guard, where nodes are not renumbered. */
triangles_room kernel_room_to_fold(const kernel *k, const double *x, const double *v);

/** What the guard adds at most to omega^2 at the node at place q, 1/s^2. */
double kernel_guard_bound(const kernel *k, const forces *f, const double *x, dem_index q);

/** Bound of the highest frequency at positions x in units of that about the rest shape, >= 1: omega_max^2 and the most
 *  that the folding guard adds to it. */
double kernel_stiffening(kernel *k, const forces *f, const double *x);

#endif
