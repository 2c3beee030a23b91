/* SPDX-License-Identifier: BSD-3-Clause */
/* What the surfaces of bodies in contact with each other depend on beside their nodes: the boundary of their triangles,
 * and sums over each body. A rank that has a part of a lattice cannot see either in its part. What breaks changes that
 * boundary, whether bodies touch each other or not. */
#ifndef DEM_MODEL_TOUCHING_BODIES_H
#define DEM_MODEL_TOUCHING_BODIES_H

#include "base/ranks.h"
#include "domain/domain.h"
#include "model/mesh_boundary.h"

/** Sums over a body. */
typedef struct body_content {
    double springs; /* N m, of stiffness times rest length */
    double area;    /* m^2, of its triangles */
} body_content;

typedef struct touching_bodies {
    const domain *domain;   /* in which nodes and triangles have their numbers; NULL: the whole lattice */
    bool has_all;           /* whether all sides of the whole are in the domain, so that bodies may touch each other */
    mesh_boundary boundary; /* of all bodies, when all is whole */
    dem_index n_bodies;
    body_content *bodies; /* [n_bodies] */
} touching_bodies;

/** Finds them in a whole lattice with bodies, which is borrowed. Free with touching_bodies_free().
 *  \return DEM_ERROR_MEMORY */
dem_status touching_bodies_create(touching_bodies *out, const dem_lattice *lattice);

/** Fills in the sums of all ranks, which are exact: their bits depend neither on the order of springs and triangles nor
 *  on the shares. Collective.
 *  \param[in,out] o  with the domain, and without sums  \param l  the lattice of the domain
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status touching_bodies_sum_up(touching_bodies *o, const ranks *r, const dem_lattice *l, dem_index n_bodies);
void touching_bodies_free(touching_bodies *o);

/** The number in the whole lattice of node i of the lattice with these bodies; NULL stands for the whole. */
static inline dem_index touching_bodies_node(const touching_bodies *o, dem_index i)
{
    return o != NULL ? domain_number(o->domain, i) : i;
}

#endif
