/* SPDX-License-Identifier: BSD-3-Clause */
/* What acts on triangles: the folding guard, which keeps a squeezed triangle from turning inside out. */
#ifndef DEM_TRIANGLES_H
#define DEM_TRIANGLES_H

#include "vec2.h"

/** The guard acts where J = area / rest area is below this. */
#define TRIANGLES_GUARD_ONSET 0.4

/** Triangles by node: slot p of row i is a triangle (i, next[p], last[p]), counter-clockwise. */
typedef struct triangles {
    dem_index n_nodes;
    dem_index *row; /* [n_nodes + 1]; every row empty where no triangle has a guard */
    dem_index *next, *last;
    double *rest_area; /* m^2 */
    double *strength;  /* guard strength g, N/m */
} triangles;

/** Compiles the guarded triangles of a lattice whose indices and areas are known to be valid. Free with
 *  triangles_free. */
dem_status triangles_compile(triangles *out, const dem_lattice *lattice);
void triangles_free(triangles *t);

/** Force of the guard on node i, N: minus the gradient of sum of A0 g w(J). */
vec2 triangles_force(const triangles *t, dem_index i, const double *x);

/** r x f of the triangle in slot p of row i, J: A dW/dA of its energy W, which depends on its area A alone, times the
 *  unit tensor. */
double triangles_virial(const triangles *t, dem_index i, dem_index p, const double *x);

/** Energy of the guard in the triangles at node i, J. */
double triangles_node_energy(const triangles *t, dem_index i, const double *x);

/** Energy of the guard, J. */
double triangles_energy(const triangles *t, const double *x);

/** Signed area of the triangle abc, m^2. */
static inline double triangles_area(vec2 a, vec2 b, vec2 c)
{
    return 0.5 * vec2_cross(vec2_sub(b, a), vec2_sub(c, a));
}

/** w(J) and w'(J): (-ln(J/Jc))^3 below the onset Jc = 0.4, twice continuously differentiable there; below J = 0.05 its
 *  Taylor polynomial of second degree, so that it is finite for every J, inverted triangles included. */
void triangles_guard_law(double area_ratio, double *energy, double *slope);

#endif
