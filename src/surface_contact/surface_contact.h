/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of bodies with each other and with themselves, as a force that depends on positions alone, like that of a
 * spring: the negative gradient of the contact potential over all contact pairs. It has no state but its lists, which
 * change no result. Whole states are evaluated with all candidates, and those of the nodes near an event with the pairs
 * that are near in its step: which these are depends on the motion in the step and not on the list of candidates. */
#ifndef DEM_SURFACE_CONTACT_SURFACE_CONTACT_H
#define DEM_SURFACE_CONTACT_SURFACE_CONTACT_H

#include "surface_contact/pair_list.h"

typedef struct surface_contact_rule {
    bool within_bodies; /* whether a body touches itself */
    double thickness;   /* m; 0: that of contact_surface_compile() */
    double stiffness;   /* factor of the contact modulus */
    double margin;      /* of the list over the mean edge; 0: the usual one */
} surface_contact_rule;

typedef struct surface_contact {
    contact_surface surface;
    pair_list candidates;
    pair_rows near;         /* pairs that are near in the step in hand */
    unsigned char *is_near; /* [candidates] */
    dem_index near_capacity;
    const pair_rows *rows;    /* what single nodes are evaluated with: those of the candidates, or `near` */
    double near_margin;       /* m */
    dem_status status;        /* DEM_OK; else the last evaluation failed with this */
    dem_index n_pushed;       /* nodes on which something acted in the last evaluation */
    dem_index *pushed;        /* [n_pushed] in the order in which pairs come to them */
    double *force;            /* [n_nodes][2] N, on these */
    unsigned char *is_pushed; /* [n_nodes] */
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

/** Makes the lists fit the positions x [n][2] of a state; all candidates count from now on.
 *  \return what pair_list_follow() returns */
dem_status surface_contact_follow(surface_contact *c, const double *x);

/** Evaluates the forces on all nodes, into `pushed` and `force`, and follows the state.
 *  \return false if that fails: `status` says why */
bool surface_contact_evaluate(surface_contact *c, const double *x);

/** Force on node i, N, with the bits of surface_contact_evaluate().  \return whether anything acts */
bool surface_contact_force(const surface_contact *c, dem_index i, const double *x, vec2 *force);

/** Energy of all pairs, J, and of those of a node. */
double surface_contact_energy(const surface_contact *c, const double *x);
double surface_contact_node_energy(const surface_contact *c, dem_index i, const double *x);

/** The pairs that push each other at positions x. */
typedef struct surface_gaps {
    dem_index pushing;
    double least, least_share; /* m, and over the thickness; infinite if none pushes */
} surface_gaps;

surface_gaps surface_contact_gaps(const surface_contact *c, const double *x);

/** What contact adds at most to the square of the highest frequency, rad^2/s^2, by the bound of
 *  contact_pair_stiffness(). */
double surface_contact_stiffening(surface_contact *c, const double *inverse_mass, const double *x);

/** Prepares for events in a step from x0 to x1: from now on the pairs count that are near in it. */
dem_status surface_contact_begin_step(surface_contact *c, const double *x0, const double *x1);

/** Checks the step when its end x1 is known, with what events have changed. */
surface_contact_fault surface_contact_check_step(const surface_contact *c, const double *x0, const double *x1,
                                                 surface_crossing *crossing);

/** Goes through the nodes of the pairs of a node, itself included. */
typedef struct surface_neighbours {
    const pair_rows *rows; /* NULL: none */
    dem_index slot;        /* of the node; -1: no more */
    int which;             /* node of its pair that comes next */
} surface_neighbours;

static inline surface_neighbours surface_contact_neighbours(const surface_contact *c, dem_index i)
{
    return (surface_neighbours){.rows = c != NULL ? c->rows : NULL, .slot = c != NULL ? c->rows->first[i] : -1};
}

/** The next one, into `node`.  \return whether there is one */
static inline bool surface_contact_next_neighbour(surface_neighbours *n, dem_index *node)
{
    if (n->slot < 0) return false;
    *node = pair_rows_pair(n->rows, n->slot)->nodes[n->which++];
    if (n->which < CONTACT_PAIR_NODES) return true;
    n->which = 0;
    n->slot = n->rows->next[n->slot];
    return true;
}

/** Whether a node is in a pair. */
static inline bool surface_contact_has(const surface_contact *c, dem_index i)
{
    return c != NULL && c->rows->first[i] >= 0;
}

#endif
