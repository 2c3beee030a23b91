/* SPDX-License-Identifier: BSD-3-Clause */
/* Which springs and triangles have broken in one simulation. An element is whole or broken; the model, which has its
 * numbers, never changes and may belong to many simulations. A simulation without such a state has whole elements only.
 * Nothing breaks them yet: a law of fracture will, at events, and checkpoints will then have the flags. */
#ifndef DEM_ELASTIC_ELEMENT_STATE_H
#define DEM_ELASTIC_ELEMENT_STATE_H

#include <dem/dem.h>

typedef struct element_state {
    unsigned char *spring;   /* [n_springs] 1: broken */
    unsigned char *triangle; /* [n_triangles] 1: broken */
    unsigned char *node;     /* [n_nodes] 1: an element at the node is broken */
    dem_index n_damaged;
    dem_index *damaged; /* [n_damaged] these nodes, in the order in which elements broke */
} element_state;

/** Makes a state in which all elements are whole. Free with element_state_destroy(). */
dem_status element_state_create(element_state *out, const dem_lattice *lattice);
void element_state_destroy(element_state *s);

/** Breaks an element of the lattice, for good. */
void element_state_break_spring(element_state *s, const dem_lattice *lattice, dem_index spring);
void element_state_break_triangle(element_state *s, const dem_lattice *lattice, dem_index triangle);

/** Flags of springs, or of triangles, by the lattice's numbers; NULL: all are whole. */
static inline const unsigned char *element_state_springs(const element_state *s)
{
    return s != NULL ? s->spring : NULL;
}

static inline const unsigned char *element_state_triangles(const element_state *s)
{
    return s != NULL ? s->triangle : NULL;
}

/** The state to look at for the elements of node i: NULL where all of them are whole. */
static inline const element_state *element_state_at(const element_state *s, dem_index i)
{
    return s != NULL && s->node[i] ? s : NULL;
}

#endif
