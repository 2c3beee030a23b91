/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of bodies with each other and with themselves, as a force that depends on positions alone, like that of a
 * spring: the negative gradient of the contact potential over all contact pairs, and the springs of anchors where
 * bodies have friction. It has no state but the anchors, which move between steps only, and its lists, which change no
 * result. Whole states are evaluated with the close ones of all candidates, and those of the nodes near an event with
 * the pairs that are near in its step: which these are depends on the motion in the step and not on the list. */
#ifndef DEM_SURFACE_CONTACT_SURFACE_CONTACT_H
#define DEM_SURFACE_CONTACT_SURFACE_CONTACT_H

#include "base/exact_terms.h"
#include "surface_contact/anchor_set.h"
#include "surface_contact/approach_bound.h"
#include "surface_contact/close_pairs.h"
#include "surface_contact/contact_batch.h"
#include "surface_contact/pair_list.h"
#include "surface_contact/surface_stages.h"

typedef struct surface_contact_rule {
    bool within_bodies;          /* whether a body touches itself */
    double thickness;            /* m; 0: that of contact_surface_compile() */
    double stiffness;            /* factor of the contact modulus */
    double margin;               /* of the list over the mean edge; 0: the usual one */
    double friction;             /* coefficient of all bodies, */
    const double *body_friction; /* or [n_bodies] of each; NULL: that of all */
    const touching_bodies *part; /* of a lattice that is a part, borrowed; NULL: it is the whole */
} surface_contact_rule;

typedef struct surface_contact {
    contact_surface surface;
    contact_surface before; /* the last break, until surface_contact_keep() */
    dem_index left_out_before;
    pair_list candidates;
    anchor_set anchors;     /* of friction */
    close_pairs close;      /* those that whole states are evaluated with */
    pair_rows near;         /* pairs that are near in the step in hand */
    unsigned char *is_near; /* [candidates] */
    dem_index near_capacity;
    const pair_rows *rows; /* what single nodes are evaluated with: those of the candidates, or `near` */
    double near_margin;    /* m */
    dem_index n_left_out;  /* pairs that never touch: pair_list_count_left_out() */
    dem_index n_chosen;    /* close.n_chosen for which `unit` is */
    double unit;           /* rad^2/s^2, what close pairs add with contact_potential_stiffness() = 1, at most */
    dem_status status;     /* of the last evaluation; DEM_ERROR_MEMORY stays until it is set back */
    bool is_evaluated;     /* the lists fit the state of the last evaluation */
    double nearest;        /* distance over thickness, in that evaluation no pair was nearer than this */
    compact_pairs compact; /* the close pairs, and the forces of the last evaluation on their nodes, until
                              surface_contact_stiffening() puts its sums there */
    approach_bound bound;  /* of where no pair is close */
    surface_stages stages; /* of a step whose stages are evaluated band by band */
} surface_contact;

/** What a step has done that it must not. */
typedef enum surface_contact_fault {
    SURFACE_CONTACT_SOUND,
    SURFACE_CONTACT_CROSSED, /* a node has crossed an edge */
    SURFACE_CONTACT_OUTGROWN /* events have brought pairs into contact that were not near in the step */
} surface_contact_fault;

/** A crossing. */
typedef struct surface_crossing {
    contact_pair pair;
    double part; /* of the step */
} surface_crossing;

/** Borrows the lattice. Free with surface_contact_destroy().
 *  \return DEM_ERROR_MODEL as contact_surface_compile(), DEM_ERROR_MEMORY */
dem_status surface_contact_create(surface_contact **out, const dem_lattice *lattice, const surface_contact_rule *rule);
void surface_contact_destroy(surface_contact *c);

/** Forgets the lists: the next call that needs them makes them anew. */
void surface_contact_forget(surface_contact *c);

/** Goes on with the surface of the triangles within a boundary, as contact_surface_break() makes it. The lists are
 *  empty until surface_contact_follow(), and anchors of what has no surface any more go with
 *  surface_contact_settle(). Then it is kept, or, also after a failure, taken back; the lists are empty again then. */
dem_status surface_contact_break(surface_contact *c, const mesh_boundary *boundary, const unsigned char *broken,
                                 const double *x);
void surface_contact_keep(surface_contact *c);
void surface_contact_mend(surface_contact *c);

/** Makes the lists fit the positions x [n][2] of a state; all candidates count from now on.
 *  \return what pair_list_follow() returns */
dem_status surface_contact_follow(surface_contact *c, const double *x);

/** Begins a step from the state x, v [n][2], in which accelerations are bounded by what approach_bound_take() of
 *  `bound` gets: evaluations may do without a look at the surfaces then, to the same bits. Without this call none
 *  does. */
void surface_contact_bound_step(surface_contact *c, const double *x, const double *v);

/** Evaluates the forces on all nodes, into `compact`, and follows the state. Where the force is 0 nothing acts.
 *  \return false if that fails: `status` says why */
bool surface_contact_evaluate(surface_contact *c, const double *x);

static inline bool surface_contact_acts(vec2 force)
{
    return force.x != 0.0 || force.y != 0.0;
}

/** Begins a step from positions x [n][2] in which nothing is to push at any of so many stages. They come range by range
 *  of the nodes, as surface_stages_take() has them; surface_contact_stayed_apart() tells in the end whether nothing has
 *  pushed.
 *  \return false if something may push at the start already, or there is no memory */
bool surface_contact_begin_stages(surface_contact *c, const double *x, int n_stages);
void surface_contact_take_stage(surface_contact *c, int stage, const dem_index range[2], const double *x);
bool surface_contact_stayed_apart(const surface_contact *c, int n_stages);

/** Force on node i, N, with the bits of surface_contact_evaluate().  \return whether anything acts */
bool surface_contact_force(const surface_contact *c, dem_index i, const double *x, vec2 *force);

/** Whether any bodies have friction. */
static inline bool surface_contact_has_friction(const surface_contact *c)
{
    return c != NULL && anchor_set_has_friction(&c->anchors);
}

/** The part of friction in the force on node i, N. */
vec2 surface_contact_friction(const surface_contact *c, dem_index i, const double *x);

/** What friction has stored in springs, J, and the power that it takes from the motion, W, stored and lost. */
double surface_contact_stored(const surface_contact *c, const double *x);
double surface_contact_friction_power(const surface_contact *c, const double *x, const double *v);

/** That power at the positions of surface_contact_evaluate(), which has found the forces. */
double surface_contact_evaluated_power(const surface_contact *c, const double *v);

/** Renews the anchors for the state x that a step has reached.
 *  \return what pair_list_follow() returns */
dem_status surface_contact_settle(surface_contact *c, const double *x);

/** Puts n anchors as they were remembered in the place of all, for the state x in which they were.
 *  \return what anchor_set_restore() and pair_list_follow() return */
dem_status surface_contact_restore(surface_contact *c, const anchor_record *records, dem_index n, const double *x);

/** Energy of all pairs, J, and of those of a node, without what friction has stored. */
double surface_contact_energy(const surface_contact *c, const double *x);
double surface_contact_node_energy(const surface_contact *c, dem_index i, const double *x);

/** The pairs that push each other at positions x, but for what fills cracks. */
typedef struct surface_gaps {
    dem_index pushing;
    double least, least_share; /* m, and over the thickness; infinite if none pushes */
} surface_gaps;

surface_gaps surface_contact_gaps(const surface_contact *c, const double *x);

/** What contact adds at most to the square of the highest frequency, rad^2/s^2, by the bound of
 *  contact_pair_stiffness().
 *  \param is_known  x are the positions of the last evaluation
 *  \param harmless  rad^2/s^2; if it is no more than this the result may be 0 */
double surface_contact_stiffening(surface_contact *c, const double *inverse_mass, double harmless, const double *x,
                                  bool is_known);

/** Prepares for events in a step from x0 to x1: from now on the pairs count that are near in it. */
dem_status surface_contact_begin_step(surface_contact *c, const double *x0, const double *x1);

/** Checks the step when its end x1 is known, with what events have changed. */
surface_contact_fault surface_contact_check_step(const surface_contact *c, const double *x0, const double *x1,
                                                 surface_crossing *crossing);

/** Goes through the nodes of the pairs of a node, itself included. Where the node of a pair has an anchor come the
 *  nodes of all pairs of that node, whose forces limit friction. */
typedef struct surface_neighbours {
    const pair_rows *rows; /* NULL: none */
    dem_index slot;        /* of the node; -1: no more */
    int which;             /* node of its pair that comes next */
    const dem_index *of;   /* [nodes] anchors; NULL: there are none */
    dem_index held;        /* slot of the node of that pair; -1: no more */
} surface_neighbours;

static inline surface_neighbours surface_contact_neighbours(const surface_contact *c, dem_index i)
{
    return (surface_neighbours){.rows = c != NULL ? c->rows : NULL,
                                .slot = c != NULL ? c->rows->first[i] : -1,
                                .of = c != NULL && c->anchors.now.n > 0 ? c->anchors.of : NULL,
                                .held = -1};
}

/** The next one, into `node`.  \return whether there is one */
static inline bool surface_contact_next_neighbour(surface_neighbours *n, dem_index *node)
{
    if (n->slot < 0) return false;
    const contact_pair *p = pair_rows_pair(n->rows, n->held >= 0 ? n->held : n->slot);
    const dem_index of = p->nodes[CONTACT_PAIR_NODE];
    *node = p->nodes[n->which++];
    if (n->which < CONTACT_PAIR_NODES) return true;
    n->which = 0;
    if (n->held >= 0)
        n->held = n->rows->next[n->held];
    else if (n->of != NULL && n->of[of] >= 0)
        n->held = n->rows->first[of];
    if (n->held < 0) n->slot = n->rows->next[n->slot];
    return true;
}

/** Whether a node is in a pair. */
static inline bool surface_contact_has(const surface_contact *c, dem_index i)
{
    return c != NULL && pair_rows_has(c->rows, i);
}

#endif
