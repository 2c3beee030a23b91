/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion of rigid bodies. Their nodes are integrated like all others, with accelerations that are those of a rigid
 * motion, so that a step leaves an error in the shape, which is taken from its end. */
#ifndef DEM_FORCES_RIGID_MOTION_H
#define DEM_FORCES_RIGID_MOTION_H

#include "model/rigid_bodies.h"

/** Which of its quantities keeps the spin of a body when the error of its shape is taken away. */
typedef enum rigid_invariant {
    RIGID_MOTION_SPIN,    /* angular velocity: Runge-Kutta steps enlarge places and velocities by the same factor */
    RIGID_MOTION_MOMENTUM /* angular momentum: Verlet's steps keep it */
} rigid_invariant;

/** Replaces the accelerations a [n][2] that forces give to the nodes by those of rigid motions, in the state of places
 *  x and velocities v: each body keeps the sum of its forces and that of their moments about its centre of mass. */
void rigid_motion_accelerate(const rigid_bodies *r, const double *x, const double *v, double *a);

/** The same of one body. */
void rigid_motion_accelerate_body(const rigid_body *b, const double *x, const double *v, double *a);

/** Gives all bodies their shapes back: changes places x and velocities v to the nearest rigid motion. */
void rigid_motion_put_back(const rigid_bodies *r, rigid_invariant kept, double *x, double *v);

/** The same of the end of a step and its derivative u, a. */
void rigid_motion_put_back_end(const rigid_bodies *r, rigid_invariant kept, double *const y[2], double *const f[2]);

#endif
