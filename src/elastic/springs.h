/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs in CSR and the bond force (1). The only place that divides by a rest length. */
#ifndef DEM_ELASTIC_SPRINGS_H
#define DEM_ELASTIC_SPRINGS_H

#include <stdbool.h>

#include "base/exact_terms.h"
#include "base/row_pair.h"
#include "base/vec2.h"

/** Numbers have 32 bits, and what springs have is the lattice's, which is borrowed: rows are a good part of a model. */
typedef struct springs {
    dem_index n_nodes, n_springs;
    int32_t *row;                 /* [n_nodes + 1] */
    int32_t *neighbour;           /* [row[n_nodes]] ascending within a row */
    int32_t *spring;              /* [row[n_nodes]] index in the lattice */
    const double *stiffness_of;   /* [n_springs] E_ij, N */
    const double *rest_length_of; /* [n_springs] d0_ij, m */
    const double *viscosity_of;   /* [n_springs] N s; NULL: undamped */
} springs;

/** Compiles the springs of a lattice whose node numbers are known to be valid; those of rigid bodies are left out. A
 *  pair of nodes joined twice is an error that names both springs, and so are 2^30 springs or nodes. Borrows the arrays
 *  of the lattice. Free with springs_free(). */
dem_status springs_compile(springs *out, const dem_lattice *lattice);
void springs_free(springs *s);

/** What is left of the stiffness of springs, by the lattice's numbers: 1 of one that is whole, 0 of one that is broken,
 *  whose ends may be anywhere. A spring that softens has less in tension, its viscosity too. */
typedef struct springs_integrity {
    const double *pushed; /* [n_springs] what is left under pressure; NULL: all are whole */
    const double *pulled; /* [n_springs] and in tension; NULL: the same */
} springs_integrity;
#define SPRINGS_WHOLE ((springs_integrity){NULL, NULL})

/** What is left of spring k of a lattice at a stretch, m, or a strain. */
static inline double springs_left(springs_integrity q, dem_index k, double stretch)
{
    if (q.pushed == NULL) return 1.0;
    return q.pulled != NULL && stretch > 0.0 ? q.pulled[k] : q.pushed[k];
}

/** Whether spring k of a lattice is broken. */
static inline bool springs_is_broken(springs_integrity q, dem_index k)
{
    return q.pushed != NULL && q.pushed[k] == 0.0;
}

/** The spring between two nodes, as a number of the lattice; -1: none. */
static inline dem_index springs_between(const springs *s, dem_index i, dem_index j)
{
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++)
        if (s->neighbour[p] == j) return s->spring[p];
    return -1;
}

/** E_ij/d0 of spring k of a lattice, N/m: tension per change of length. */
static inline double springs_rate(const dem_lattice *lattice, dem_index k)
{
    return lattice->stiffness[k] / lattice->rest_length[k];
}

/** Tension over length of a spring, E_ij (d - d0)/(d0 d), N/m: times the vector between its ends it is the force
 *  (1). */
static inline double springs_pull(double stiffness, double rest_length, double length)
{
    return stiffness * (length - rest_length) / (rest_length * length);
}

/** The same of two springs. */
INLINE row_pair springs_pull_two(row_pair stiffness, row_pair rest_length, row_pair length)
{
    return stiffness * (length - rest_length) / (rest_length * length);
}

/** Adds to a force on node i, N, those of the springs in slots p and q of its row, which are whole, one after the
 *  other; p = q: of this one. */
INLINE row_pair springs_add_two(const springs *s, dem_index i, dem_index p, dem_index q, const double *x,
                                row_pair force)
{
    const dem_index k = s->spring[p], m = s->spring[q];
    const row_pair xi = row_pair_at(x + 2 * i, 0);
    const row_pair one = row_pair_at(x + 2 * (dem_index)s->neighbour[p], 0) - xi,
                   two = row_pair_at(x + 2 * (dem_index)s->neighbour[q], 0) - xi;
    const row_pair stiffness = {s->stiffness_of[k], s->stiffness_of[m]};
    const row_pair rest = {s->rest_length_of[k], s->rest_length_of[m]};
    const row_pair factor = springs_pull_two(stiffness, rest, row_pair_lengths(one, two));
    force += factor[0] * one;
    return p == q ? force : force + factor[1] * two;
}

/** The sum of (1) over the row of node i, of springs that are whole. */
static inline vec2 springs_whole_force(const springs *s, dem_index i, const double *x)
{
    const dem_index end = s->row[i + 1];
    row_pair force = {0.0, 0.0};
    dem_index p = s->row[i];
    for (; p + 1 < end; p += 2) force = springs_add_two(s, i, p, p + 1, x, force);
    if (p < end) force = springs_add_two(s, i, p, p, x, force);
    return (vec2){force[0], force[1]};
}

/** Force on node i, N: the sum of (1) over its row. Not finite where two neighbours coincide. */
static inline vec2 springs_force(const springs *s, springs_integrity integrity, dem_index i, const double *x)
{
    if (integrity.pushed == NULL) return springs_whole_force(s, i, x);
    const vec2 xi = vec2_at(x, i);
    vec2 force = {0.0, 0.0};
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        if (springs_is_broken(integrity, s->spring[p])) continue;
        const vec2 d = vec2_sub(vec2_at(x, s->neighbour[p]), xi);
        const dem_index k = s->spring[p];
        const double length = vec2_norm(d), left = springs_left(integrity, k, length - s->rest_length_of[k]);
        force = vec2_along(force, springs_pull(left * s->stiffness_of[k], s->rest_length_of[k], length), d);
    }
    return force;
}

/** Kelvin-Voigt damping of node i, N: in every spring of its row c e' n, with e' = d.v/(d0 |d|) the strain rate. */
static inline vec2 springs_damping(const springs *s, springs_integrity integrity, dem_index i, const double *x,
                                   const double *v)
{
    const vec2 xi = vec2_at(x, i), vi = vec2_at(v, i);
    vec2 force = {0.0, 0.0};
    for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) {
        const dem_index k = s->spring[p];
        const double left = springs_left(integrity, k, 1.0);
        if (left == 0.0) continue;
        const vec2 d = vec2_sub(vec2_at(x, s->neighbour[p]), xi), dv = vec2_sub(vec2_at(v, s->neighbour[p]), vi);
        force =
            vec2_along(force, left * s->viscosity_of[k] * vec2_dot(d, dv) / (s->rest_length_of[k] * vec2_dot(d, d)), d);
    }
    return force;
}

/** Strain (d - d0)/d0 of a spring of length d. */
static inline double springs_strain_at(double rest_length, double length)
{
    return (length - rest_length) / rest_length;
}

/** Strain of the spring in slot p of row i. */
static inline double springs_strain(const springs *s, dem_index i, dem_index p, const double *x)
{
    const double length = vec2_norm(vec2_sub(vec2_at(x, s->neighbour[p]), vec2_at(x, i)));
    return springs_strain_at(s->rest_length_of[s->spring[p]], length);
}

/** Strain of spring k of a lattice. */
static inline double springs_strain_of(const dem_lattice *lattice, dem_index k, const double *x)
{
    const vec2 d = vec2_sub(vec2_at(x, lattice->ends[2 * k + 1]), vec2_at(x, lattice->ends[2 * k]));
    return springs_strain_at(lattice->rest_length[k], vec2_norm(d));
}

/** E d0 e^2/2: the work of (1) from the rest length to the strain e, J. */
static inline double springs_energy_of(double stiffness, double rest_length, double strain)
{
    return 0.5 * stiffness * rest_length * strain * strain;
}

/** The strains of n springs from `first` on, broken or not, into `strain` [n], with vector instructions. */
void springs_strain_block(const dem_lattice *lattice, dem_index first, int n, const double *x, double *strain);

/** r x f of spring k of a lattice, N m: xx, yy, xy of E_ij (d - d0)/d0 d n n^T, symmetric; the damping left out. Not
 *  finite where its ends coincide. */
static inline void springs_virial(const dem_lattice *lattice, dem_index k, const double *x, double virial[3])
{
    const vec2 d = vec2_sub(vec2_at(x, lattice->ends[2 * k + 1]), vec2_at(x, lattice->ends[2 * k]));
    const double length = vec2_norm(d), rest = lattice->rest_length[k];
    const double tension = lattice->stiffness[k] * (length - rest) / (rest * length); /* N/m, as in springs_force() */
    virial[0] = tension * d.x * d.x;
    virial[1] = tension * d.y * d.y;
    virial[2] = tension * d.x * d.y;
}

/** Adds r x f of the n springs of a list, times a share of each, one after the other: in this order sums have the same
 *  bits wherever they are made. */
static inline void springs_add_virials(const dem_lattice *lattice, dem_index n, const int32_t *list,
                                       const double *share, const double *x, double sum[3])
{
    double xx = sum[0], yy = sum[1], xy = sum[2];
    for (dem_index p = 0; p < n; p++) {
        double virial[3];
        springs_virial(lattice, list[p], x, virial);
        xx += share[p] * virial[0];
        yy += share[p] * virial[1];
        xy += share[p] * virial[2];
    }
    sum[0] = xx;
    sum[1] = yy;
    sum[2] = xy;
}

/** (K u)_i, N: minus the change of the force on node i when the nodes move from x by u. K has the stiffness of
 *  stretching, and that of turning under tension. */
vec2 springs_tangent(const springs *s, dem_index i, const double *x, const double *u);

/** Energy of the springs at node i, J: sum over its row of E_ij (d - d0)^2/(2 d0). */
double springs_node_energy(const springs *s, springs_integrity integrity, dem_index i, const double *x);

/** Strain of every spring of a lattice; 0 of one that is broken.  \param[out] strain  [n_springs] */
void springs_strains(const dem_lattice *lattice, springs_integrity integrity, const double *x, double *strain);

/** Force (1) along every spring, > 0 in tension; 0 of one that is broken.  \param[out] force  [n_springs] N */
void springs_forces(const dem_lattice *lattice, springs_integrity integrity, const double *x, double *force);

/** Adds the powers that the damping of springs takes, W, >= 0: viscosity * strain rate^2 * rest length; none undamped.
 *  Springs are those from the nodes range[0] to range[1] - 1 to higher ones. */
void springs_add_damping_power(const springs *s, springs_integrity integrity, const dem_index range[2], const double *x,
                               const double *v, exact_terms *power);

/** S_i = sum of c/d0 n n^T over the springs of node i, with n their directions at x and c their `strength`, stiffness
 *  or viscosity. It bounds the matrix A of the springs: u.A u = sum of c/d0 (n.(u_j - u_i))^2 <= 2 sum of u_i.S_i
 *  u_i. */
sym2 springs_block(const springs *s, const double *strength, dem_index i, const double *x);

/** Upper bound, 1/s, of the eigenvalues of M^-1 C at positions x, with C the damping matrix of the springs: the largest
 *  2 |S_i|/m_i of the nodes that move; 0 without damping. The eigenvalues of the damped motion have a modulus of at
 *  most max(omega_max, this + alpha), with alpha the mass damping. */
double springs_damping_bound(const springs *s, const double *x, const double *inverse_mass);

#endif
