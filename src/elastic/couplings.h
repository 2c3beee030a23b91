/* SPDX-License-Identifier: BSD-3-Clause */
/* What couples the three springs of a triangle: the tension of an edge depends on how much the other two are stretched,
 * too, so that a triangle of any shape resists a strain as Hooke's law asks. */
#ifndef DEM_ELASTIC_COUPLINGS_H
#define DEM_ELASTIC_COUPLINGS_H

#include <stdbool.h>

#include "elastic/springs.h"
#include "elastic/triangles.h"

/** A triangle whose springs are coupled. Edge c goes from corner c to the next one, counter-clockwise. */
typedef struct coupled_triangle {
    dem_index triangle;    /* index in the lattice */
    dem_index corner[3];   /* nodes */
    dem_index spring[3];   /* of the edges, indices in the lattice */
    double rest_length[3]; /* of these, m */
    double coupling[3];    /* at corner c, of edge c and the last one: tension per stretch, N/m */
} coupled_triangle;

/** Those with a coupling other than 0, as a list, and by node: slots row[i] to row[i + 1] - 1. */
typedef struct couplings {
    dem_index n_nodes, n;
    coupled_triangle *list; /* [n] */
    int32_t *row;           /* [n_nodes + 1] */
    int32_t *slot;          /* [3 n] 3 k + c: the node is corner c of triangle k of the list */
} couplings;

/** Compiles the triangles that have a coupling. Node numbers are known to be valid.
 *  \return DEM_ERROR_MODEL where an edge of such a triangle has no spring. Free with couplings_free(). */
dem_status couplings_compile(couplings *out, const dem_lattice *lattice, const springs *s);
void couplings_free(couplings *c);

/** Whether triangle k of the list is broken. */
static inline bool couplings_broken(const couplings *c, triangles_integrity integrity, dem_index k)
{
    return integrity.broken != NULL && integrity.broken[c->list[k].triangle];
}

/** What is left of the couplings of triangle k of the list, whether it is pulled or pushed: their energy has no part of
 *  each edge that could have its own. */
static inline double couplings_left(const couplings *c, triangles_integrity integrity, dem_index k)
{
    return triangles_left(integrity, c->list[k].triangle);
}

/** The edges of a triangle, m, their lengths, how much longer than at rest they are, m, and what couplings add to their
 *  tensions, N. */
typedef struct coupled_edges {
    vec2 edge[3];
    double length[3], stretch[3], tension[3];
} coupled_edges;

/** Sums have two terms, so that no bit depends on which corner is the first. */
static inline coupled_edges couplings_edges(const coupled_triangle *t, const double *x)
{
    coupled_edges e;
    for (int c = 0; c < 3; c++) {
        e.edge[c] = vec2_sub(vec2_at(x, t->corner[(c + 1) % 3]), vec2_at(x, t->corner[c]));
        e.length[c] = vec2_norm(e.edge[c]);
        e.stretch[c] = e.length[c] - t->rest_length[c];
    }
    for (int c = 0; c < 3; c++) {
        const int next = (c + 1) % 3, last = (c + 2) % 3;
        e.tension[c] = t->coupling[c] * e.stretch[last] + t->coupling[next] * e.stretch[next];
    }
    return e;
}

/** Energy, J, of the edges at corner c: the sum of these over the corners is the triangle's. */
static inline double couplings_energy_term(const coupled_triangle *t, const coupled_edges *e, int c)
{
    return t->coupling[c] * e->stretch[c] * e->stretch[(c + 2) % 3];
}

/** The force on corner q, N, along the edges at it, of which this is left: edge q begins there, and the last one ends
 *  there. Not finite where two corners coincide. */
static inline vec2 couplings_force_at(const coupled_edges *e, double left, int q)
{
    const int last = (q + 2) % 3;
    const vec2 ahead = vec2_scale(left * e->tension[q] / e->length[q], e->edge[q]);
    const vec2 behind = vec2_scale(left * e->tension[last] / e->length[last], e->edge[last]);
    return vec2_sub(ahead, behind);
}

/** Adds the forces on node i, N, along the edges at it, in the order of its row. Not finite where two corners
 *  coincide. */
vec2 couplings_add_force(const couplings *c, triangles_integrity integrity, dem_index i, const double *x, vec2 force);

/** r x f of a triangle, J: xx, yy, xy; symmetric. */
void couplings_virial_of(const coupled_triangle *t, const double *x, double virial[3]);

/** The same of the triangle in slot p. */
void couplings_virial(const couplings *c, dem_index p, const double *x, double virial[3]);

/** (K u)_i, N: minus the change of the force on node i when the nodes move from x by u. */
vec2 couplings_tangent(const couplings *c, dem_index i, const double *x, const double *u);

/** Energy of the couplings at node i, J, of any sign: of the triangles there, stretch times coupling times stretch of
 *  every pair of edges. */
double couplings_node_energy(const couplings *c, triangles_integrity integrity, dem_index i, const double *x);

/** Adds to the tension of one spring, N, what the couplings do.  \param i  one of its nodes */
double couplings_add_tension(const couplings *c, triangles_integrity integrity, dem_index i, dem_index spring,
                             const double *x, double tension);

/** Adds to the tension of every spring of the lattice what the couplings do.  \param[in,out] force  [n_springs] N */
void couplings_add_tensions(const couplings *c, triangles_integrity integrity, const double *x, double *force);

#endif
