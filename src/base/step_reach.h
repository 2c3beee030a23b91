/* SPDX-License-Identifier: BSD-3-Clause */
/* How far a step of x' = v, v' = a carries a point, by a bound A of the accelerations at all of its stages. With stages
 *   x_i = x_0 + h sum of a_ij v_j,   v_j = v_0 + h sum of a_jk a_k,
 * and c_i = sum of a_ij, a point is at each of them, and at the end of the step with b_j for a_ij, at
 *   x_i = x_0 + c_i h v_0 + r,   |r| <= h^2 A sum of |a_ij| |a_jk|. */
#ifndef DEM_BASE_STEP_REACH_H
#define DEM_BASE_STEP_REACH_H

/** The largest factors of a method, over its stages and the end. */
typedef struct step_reach {
    double time;     /* |c_i| */
    double position; /* sum over j and k of |a_ij| |a_jk| */
    double velocity; /* sum of |b_j| */
} step_reach;

#endif
