/* SPDX-License-Identifier: BSD-3-Clause */
/* Which triangles and springs have broken in one simulation. A triangle is whole or broken. A spring keeps the shares
 * of those of its triangles that are whole; one that no triangle holds is whole or broken, too. The model, which has
 * their numbers, never changes and may belong to many simulations. A simulation without such a state has whole elements
 * only. What breaks them is src/simulation/breaking.c. */
#ifndef DEM_MODEL_ELEMENT_STATE_H
#define DEM_MODEL_ELEMENT_STATE_H

#include "elastic/springs.h"

typedef struct element_state {
    const dem_lattice *lattice;
    double *integrity;       /* [n_springs] what is left of its stiffness: 1: whole, 0: broken */
    unsigned char *triangle; /* [n_triangles] 1: broken */
    unsigned char *node;     /* [n_nodes] 1: an element at the node is not whole */
    dem_index n_damaged;
    dem_index *damaged;  /* [n_damaged] these nodes, in the order in which elements broke */
    dem_index *row;      /* [n_triangles + 1] slots row[t] .. row[t + 1] - 1 of a triangle: */
    dem_index *spring;   /* a spring that it holds, */
    double *share;       /* and what part of that spring's stiffness is the triangle's */
    unsigned char *held; /* [n_springs] 1: a triangle holds it, or has held it */
    dem_index *at_row;   /* [n_nodes + 1] slots at_row[i] .. at_row[i + 1] - 1 of a node: */
    dem_index *at;       /* triangles at it, ascending */
} element_state;

/** Makes a state in which all elements are whole. Borrows the lattice.  \param s  its springs
 *  \return DEM_ERROR_MEMORY. Free with element_state_destroy(). */
dem_status element_state_create(element_state *out, const dem_lattice *lattice, const springs *s);
void element_state_destroy(element_state *s);

/** Breaks an element of the lattice, for good; one that is broken stays so. The integrity of springs depends on which
 *  elements are broken, not on their order: with all of its triangles a spring is broken, too. */
void element_state_break_spring(element_state *s, dem_index spring);
void element_state_break_triangle(element_state *s, dem_index triangle);

/** The same by the element's number: triangles come first, then springs. */
void element_state_break(element_state *s, dem_index element);

/** Takes the break of an element back, to the bit; then the nodes that have become damaged since there were n. */
void element_state_mend(element_state *s, dem_index element);
void element_state_forget_nodes(element_state *s, dem_index n);

/** Integrities of springs, or flags of triangles, by the lattice's numbers; NULL: all are whole. */
static inline const double *element_state_springs(const element_state *s)
{
    return s != NULL ? s->integrity : NULL;
}

static inline const unsigned char *element_state_triangles(const element_state *s)
{
    return s != NULL ? s->triangle : NULL;
}

/** Whether a triangle is whole and holds a spring. */
static inline bool element_state_holds(const element_state *s, dem_index triangle, dem_index spring)
{
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++)
        if (s->spring[p] == spring) return !s->triangle[triangle];
    return false;
}

/** The state to look at for the elements of node i: NULL where all of them are whole. */
static inline const element_state *element_state_at(const element_state *s, dem_index i)
{
    return s != NULL && s->node[i] ? s : NULL;
}

#endif
