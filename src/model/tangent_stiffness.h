/* SPDX-License-Identifier: BSD-3-Clause */
/* The tangent stiffness of a model: K, the second derivative of the energy of springs and their couplings, area term
 * and guard at any positions. */
#ifndef DEM_MODEL_TANGENT_STIFFNESS_H
#define DEM_MODEL_TANGENT_STIFFNESS_H

#include "model/model.h"

/** K u at node i, N: minus the change of its force when the nodes move from x [n][2] by u [n][2]. */
static inline vec2 tangent_row(const dem_model *model, dem_index i, const double *x, const double *u)
{
    const vec2 bonds =
        vec2_add(springs_tangent(&model->springs, i, x, u), couplings_tangent(&model->couplings, i, x, u));
    return vec2_add(bonds, triangles_tangent(&model->triangles, i, x, u));
}

/** out = K u, [n][2], N; all nodes, fixed ones included. */
void tangent_apply(const dem_model *model, const double *x, const double *u, double *out);

/** Solves K u = f for the nodes with held[i] == 0, where all others stay: conjugate gradients, until the norm of the
 *  residual is at most `residual`, N.  \param[in,out] u  [n][2]: f, N, then the displacements, 0 where held
 *  \return DEM_ERROR_MODEL if K is not positive definite there, or so nearly that there is no convergence */
dem_status tangent_solve(const dem_model *model, const double *x, const unsigned char *held, double residual,
                         double *u);

#endif
