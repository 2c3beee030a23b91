/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact pairs by the batch. Most close pairs do not push, which is seen at a small part of the cost of a force; what
 * is left of them lies side by side, so that several roots and divisions are taken at once. Every evaluation goes
 * through all close pairs this way, so it has vector instructions of its own, to the bits of contact_pair_push(). */
#ifndef DEM_SURFACE_CONTACT_CONTACT_BATCH_H
#define DEM_SURFACE_CONTACT_CONTACT_BATCH_H

#include "surface_contact/contact_pair.h"

enum { CONTACT_BATCH_MOST = 64 };

typedef struct contact_batch {
    const contact_pair *list;            /* all pairs */
    dem_index n_pairs, next;             /* of the list: how many, and which has not been looked at yet */
    double part;                         /* of the contact thickness */
    int n;                               /* pairs in the batch, and of these: */
    dem_index which[CONTACT_BATCH_MOST]; /* place in the list, ascending */
    double by_edge[CONTACT_BATCH_MOST];  /* not 0: the edge pushes */
    double along[CONTACT_BATCH_MOST], front[CONTACT_BATCH_MOST], square[CONTACT_BATCH_MOST]; /* edge_terms */
    double t_x[CONTACT_BATCH_MOST], t_y[CONTACT_BATCH_MOST], radius[CONTACT_BATCH_MOST];
    double thickness[CONTACT_BATCH_MOST];
    double share[CONTACT_BATCH_MOST], pressure[CONTACT_BATCH_MOST]; /* results, of the edges that push */
    double n_x[CONTACT_BATCH_MOST], n_y[CONTACT_BATCH_MOST];
} contact_batch;

/** Begins with a list of pairs; no batch as yet. Borrows the list.
 *  \param part  of the contact thickness within which pairs are in reach, up to 1 */
void contact_batch_begin(contact_batch *b, const contact_pair *list, dem_index n_pairs, double part);

/** Finds the next pairs in reach at positions x [n][2]: their node is in front of the edge, beside it, and nearer than
 *  the part of the thickness, or as near to its first end. With the part 1 none is left out that pushes.
 *  \return whether there are any more */
bool contact_batch_next(contact_batch *b, const double *x);

/** Evaluates what the edges of the batch push with, which has been found with the part 1. */
void contact_batch_evaluate(contact_batch *b);

/** The largest pressure of edge or first end of pair k of the batch, once it has been evaluated, over the contact
 *  modulus. */
static inline double contact_batch_pressure(const contact_batch *b, int k)
{
    const double edge = b->by_edge[k] != 0.0 ? b->pressure[k] : 0.0;
    const double u = b->radius[k] < b->thickness[k] * b->thickness[k] ? sqrt(b->radius[k]) / b->thickness[k] : 1.0;
    const double first = u < 1.0 ? contact_potential_pressure(u) : 0.0;
    return edge > first ? edge : first;
}

/** The forces of pair k of the batch, once it has been evaluated.  \return whether there are any */
static inline bool contact_batch_push(const contact_batch *b, int k, const double *x, contact_push *out)
{
    const contact_pair *p = &b->list[b->which[k]];
    const bool by_edge = b->by_edge[k] != 0.0, near_first = b->radius[k] < b->thickness[k] * b->thickness[k];
    *out = (contact_push){.pair = p};
    if (by_edge) {
        out->share = b->share[k];
        out->by_edge = vec2_scale(p->weight * b->pressure[k], (vec2){b->n_x[k], b->n_y[k]});
    }
    if (!near_first && !p->ends_at_second) return by_edge;
    return contact_pair_push_ends(p, near_first, x, out) || by_edge;
}

#endif
