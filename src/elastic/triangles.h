/* SPDX-License-Identifier: BSD-3-Clause */
/* What acts on triangles: the area term, which sets Poisson's ratio, and the folding guard, which keeps a squeezed
 * triangle from turning inside out. */
#ifndef DEM_ELASTIC_TRIANGLES_H
#define DEM_ELASTIC_TRIANGLES_H

#include <stdbool.h>

#include "base/vec2.h"

/** The guard acts where J = area / rest area is below this. */
#define TRIANGLES_GUARD_ONSET 0.4

/** Areas differ by rounding from corner to corner: who looks from one corner whether the guard may act at another takes
 *  an onset that is so many times as large. */
#define TRIANGLES_ROUNDED 1.001

/** What is left of triangles, by the lattice's numbers. */
typedef struct triangles_integrity {
    const unsigned char *broken; /* [n_triangles] 1: nothing; NULL: all are whole */
    const double *left;          /* [n_triangles] of others, in tension; NULL: all */
    const double *coupling;      /* [n_triangles][3] the lattice's; NULL: none */
} triangles_integrity;
#define TRIANGLES_WHOLE ((triangles_integrity){NULL, NULL, NULL})

/** Whether the springs of triangle k of a lattice are coupled.  \param coupling  the lattice's */
static inline bool triangles_are_coupled(const double *coupling, dem_index k)
{
    return coupling != NULL && (coupling[3 * k] != 0.0 || coupling[3 * k + 1] != 0.0 || coupling[3 * k + 2] != 0.0);
}

/** What is left of triangle k of a lattice in tension. */
static inline double triangles_left(triangles_integrity q, dem_index k)
{
    return q.left != NULL ? q.left[k] : 1.0;
}

/** Triangles by node: slot p of row i is a triangle (i, next[p], last[p]), counter-clockwise. Numbers have 32 bits, and
 *  what triangles have is the lattice's, which is borrowed. */
typedef struct triangles {
    dem_index n_nodes;
    int32_t *row; /* [n_nodes + 1]; every row empty where no triangle has area stiffness or guard */
    int32_t *next, *last;
    int32_t *triangle;               /* index in the lattice */
    const double *x;                 /* [n_nodes][2] rest positions, m */
    const double *guard_of;          /* [n_triangles] strength g, N/m; NULL: none */
    const double *area_stiffness_of; /* [n_triangles] kappa, N/m; NULL: none */
    double largest_onset;            /* m^2; no guard acts on a triangle that is larger */
} triangles;

/** Compiles the triangles that have area stiffness or guard. Node numbers and areas of the lattice are known to be
 *  valid; borrows its arrays. Free with triangles_free().  \return DEM_ERROR_MEMORY; DEM_ERROR_MODEL for 2^31/6
 *  triangles */
dem_status triangles_compile(triangles *out, const dem_lattice *lattice);
void triangles_free(triangles *t);

/** Signed area, m^2, of the triangle in slot p of row i. Each corner computes it from its own rotation of the
 *  corners. */
static inline double triangles_area(const triangles *t, dem_index i, dem_index p, const double *x)
{
    return vec2_triangle_area(vec2_at(x, i), vec2_at(x, t->next[p]), vec2_at(x, t->last[p]));
}

/** The same at rest: so at rest their ratio is exactly 1 from every corner. */
static inline double triangles_rest_area(const triangles *t, dem_index i, dem_index p)
{
    return triangles_area(t, i, p, t->x);
}

/** The guard's strength g, N/m, of the triangle in slot p. */
static inline double triangles_guard(const triangles *t, dem_index p)
{
    return t->guard_of != NULL ? t->guard_of[t->triangle[p]] : 0.0;
}

/** Whether it is known without the rest area that nothing resists a change of area of a triangle. */
static inline bool triangles_are_slack(const triangles *t, double area)
{
    return t->area_stiffness_of == NULL && area >= t->largest_onset;
}

/** Whether the triangle in slot p is broken. */
static inline bool triangles_broken(const triangles *t, triangles_integrity q, dem_index p)
{
    return q.broken != NULL && q.broken[t->triangle[p]];
}

/** What is left of kappa of the triangle in slot p, which is not broken, where it is larger than at rest or not. There
 *  is an area term. A negative kappa takes from springs; of coupled triangles, whose springs soften under pressure,
 *  too, it goes along. */
static inline double triangles_area_left(const triangles *t, triangles_integrity q, dem_index p, bool larger)
{
    const dem_index k = t->triangle[p];
    const bool goes_along = t->area_stiffness_of[k] < 0.0 && triangles_are_coupled(q.coupling, k);
    return larger || goes_along ? triangles_left(q, k) : 1.0;
}

/** Force of the triangles on node i, N: minus the gradient of the sum of A0 (kappa/2 (J - 1)^2 + g w(J)). */
vec2 triangles_force(const triangles *t, triangles_integrity integrity, dem_index i, const double *x);

/** Adds to a force, N, that of the triangle in slot p, which is not broken, whose corners are at these places: first
 *  that of the row's node, on which it is, then the next and the last one.
 *  \param rest_area  that of triangles_rest_area() */
vec2 triangles_add_force(const triangles *t, triangles_integrity integrity, dem_index p, double rest_area,
                         const vec2 corner[3], vec2 force);

/** r x f of the triangle in slot p of row i, J, which is not broken: A dW/dA of its energy W, which depends on its area
 *  A alone, times the unit tensor. */
double triangles_virial(const triangles *t, triangles_integrity integrity, dem_index i, dem_index p, const double *x);

/** The same of triangle k of a lattice, whose area at rest, m^2, is known. */
double triangles_virial_of(const dem_lattice *lattice, dem_index k, double rest_area, const double *x);

/** The sum of that over the row of node i, of triangles that are whole, each over the divisor. */
double triangles_node_virial(const triangles *t, dem_index i, const double *x, double divisor);

/** (K u)_i, N: minus the change of the force on node i when the nodes move from x by u; K is the second derivative of
 *  the energy. */
vec2 triangles_tangent(const triangles *t, dem_index i, const double *x, const double *u);

/** Energy of the triangles at node i, J. */
double triangles_node_energy(const triangles *t, triangles_integrity integrity, dem_index i, const double *x);

/** Area over rest area, and energies, J, of the area term and of the guard. */
typedef struct triangles_energies {
    double ratio, area, guard;
} triangles_energies;

/** Of the triangle in slot p of row i, which is not broken. */
triangles_energies triangles_energies_at(const triangles *t, triangles_integrity integrity, dem_index i, dem_index p,
                                         const double *x);

/** T_i = sum of max(kappa, 0)/A0 g g^T over the triangles at node i, with g = dA/dx_i at x. The matrix of the area term
 *  is at most three times the sum of these blocks. */
sym2 triangles_block(const triangles *t, dem_index i, const double *x);

/** A bound of what the guard adds to the stiffness at node i, N/m: the second variation of its energy at x is at most
 *  the sum of this times u_i^2. 0 where it does not act. */
double triangles_guard_bound(const triangles *t, triangles_integrity integrity, dem_index i, const double *x);

/** How far triangles are from the onset of the guard. */
typedef struct triangles_room {
    double way; /* m: it acts on none of them whose corners move relative to each other by less; infinity: no matter */
    double speed; /* m/s: no corners of one are faster relative to each other */
} triangles_room;

/** Of those at the nodes from `first` on. */
triangles_room triangles_room_to_fold(const triangles *t, dem_index first, const double *x, const double *v);

/** A function of J = area / rest area and its derivatives. */
typedef struct triangles_law {
    double energy, slope, curvature;
} triangles_law;

/** w(J) = (-ln(J/Jc))^3 below the onset Jc = 0.4, twice continuously differentiable there; below J = 0.05 its Taylor
 *  polynomial of second degree, so that it is finite for every J, inverted triangles included. */
triangles_law triangles_guard_law(double area_ratio);

#endif
