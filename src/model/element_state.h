/* SPDX-License-Identifier: BSD-3-Clause */
/* Which triangles and springs have broken or softened in one simulation. A triangle is whole, or has softened in
 * tension a number of times (elastic/softening.h), or is broken. A spring keeps the shares of those of its triangles
 * that are not broken, and in tension what is left of these; one that no triangle holds is whole or broken. The model,
 * which has their numbers, never changes and may belong to many simulations. A simulation without such a state has
 * whole elements only. What breaks them is src/simulation/breaking.c. */
#ifndef DEM_MODEL_ELEMENT_STATE_H
#define DEM_MODEL_ELEMENT_STATE_H

#include "domain/domain.h"
#include "elastic/softening.h"
#include "elastic/springs.h"
#include "elastic/triangles.h"

typedef struct element_state {
    const dem_lattice *lattice;
    const springs *springs;
    double *integrity;       /* [n_springs] what is left of its stiffness: 1: whole, 0: broken; NULL: all are whole, and
                                there is nothing yet of what is called prepared below */
    double *tension;         /* prepared: [n_springs] the same in tension; NULL: no triangle softens, as of the next
                                two */
    unsigned char *level;    /* prepared: [n_triangles] how many times it has softened */
    double *left;            /* prepared: [n_triangles] what this leaves of it in tension */
    unsigned char *triangle; /* [n_triangles] 1: broken */
    unsigned char *node;     /* [n_nodes] 1: an element at the node is not whole */
    dem_index n_broken;      /* triangles, and springs that no triangle holds */
    dem_index n_softenings;  /* of all triangles together, broken or not */
    dem_index n_damaged;
    dem_index *damaged;  /* prepared: [n_damaged] these nodes, in the order in which elements broke */
    int32_t *row;        /* prepared: [n_triangles + 1] slots row[t] .. row[t + 1] - 1 of a triangle: */
    int32_t *spring;     /* a spring that it holds, */
    double *share;       /* and what part of that spring's stiffness is the triangle's */
    unsigned char *held; /* prepared: [n_springs] 1: a triangle holds it, or has held it */
    int32_t *at_row;     /* [n_nodes + 1] slots at_row[i] .. at_row[i + 1] - 1 of a node: */
    int32_t *at;         /* triangles at it, ascending */
} element_state;

/** Makes a state in which all elements are whole, and for as long as they are. Borrows the lattice.
 *  \param s  its springs, which it borrows, too
 *  \return DEM_ERROR_MEMORY; DEM_ERROR_MODEL for more than the library takes. Free with element_state_destroy(). */
dem_status element_state_begin(element_state *out, const dem_lattice *lattice, const springs *s);

/** Makes it ready for elements that break or soften, if it is not yet.
 *  \return DEM_ERROR_MEMORY: it is as it was */
dem_status element_state_prepare(element_state *s);

/** Both. */
dem_status element_state_create(element_state *out, const dem_lattice *lattice, const springs *s);
void element_state_destroy(element_state *s);

/** Breaks an element of the lattice, of a state that is ready, for good; one that is broken stays so. The integrity of
 *  springs depends on which elements are broken, not on their order: with all of its triangles a spring is broken,
 *  too. */
void element_state_break_spring(element_state *s, dem_index spring);
void element_state_break_triangle(element_state *s, dem_index triangle);

/** The same by the element's number: triangles come first, then springs. */
void element_state_break(element_state *s, dem_index element);

/** Softens a triangle that is not broken once more. What is left of springs depends on the levels, not on the order. */
void element_state_soften(element_state *s, dem_index triangle);

/** Takes the last break or softening of an element back, to the bit; then the nodes that have become damaged since
 *  there were n. */
void element_state_mend(element_state *s, dem_index element);
void element_state_forget_nodes(element_state *s, dem_index n);

/** Makes a state that is ready that of a part of its lattice, in which all is that is not whole.
 *  \param part  ready, too
 *  \param d     the numbers that the part's elements and nodes have in the lattice */
void element_state_follow_part(element_state *s, const element_state *part, const domain *d);

/** What is left of springs and of triangles, by the lattice's numbers.  \param s  NULL: all are whole */
static inline springs_integrity element_state_springs(const element_state *s)
{
    return s != NULL ? (springs_integrity){s->integrity, s->tension} : SPRINGS_WHOLE;
}

static inline triangles_integrity element_state_triangles(const element_state *s)
{
    return s != NULL ? (triangles_integrity){s->triangle, s->left, s->lattice->coupling} : TRIANGLES_WHOLE;
}

/** What a triangle that is not broken gives to the spring in its slot p, over the stiffness of that, as it has
 *  softened. */
double element_state_share(const element_state *s, dem_index triangle, dem_index p, bool pulled);

/** How many times a triangle has softened. */
static inline int element_state_level(const element_state *s, dem_index triangle)
{
    return s->level != NULL ? s->level[triangle] : 0;
}

/** Whether what drives it next to its limit breaks a triangle, and does not soften it. */
static inline bool element_state_is_last(const element_state *s, dem_index triangle)
{
    const double *softening = s->lattice->softening;
    return softening == NULL || element_state_level(s, triangle) == softening_levels(softening[triangle]);
}

/** How many times elements have broken or softened, all together. */
static inline dem_index element_state_n_failures(const element_state *s)
{
    return s->n_broken + s->n_softenings;
}

static inline bool element_state_is_corner(const element_state *s, dem_index triangle, dem_index node)
{
    const dem_index *corner = &s->lattice->triangles[3 * triangle];
    return corner[0] == node || corner[1] == node || corner[2] == node;
}

/** What is gone of a triangle in tension, 1 of one that is broken; and of a node, the mean of its triangles by rest
 *  volume, 0 without triangles.  \param s  NULL: nothing */
double element_state_damage(const element_state *s, dem_index triangle);
double element_state_node_damage(const element_state *s, dem_index node);

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
