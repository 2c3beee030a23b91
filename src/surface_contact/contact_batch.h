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
    double share[CONTACT_BATCH_MOST], u[CONTACT_BATCH_MOST]; /* results, of the edges that push: edge_push */
    double pressure[CONTACT_BATCH_MOST], n_x[CONTACT_BATCH_MOST], n_y[CONTACT_BATCH_MOST];
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

/** Whether pair k of the batch is nearer to the first end of its edge than the thickness. */
static inline bool contact_batch_is_near_first(const contact_batch *b, int k)
{
    return b->radius[k] < b->thickness[k] * b->thickness[k];
}

/** Whether an end of the edge might push, too, or the pair fills a crack. Otherwise, found with the part 1, the edge
 *  does. */
static inline bool contact_batch_is_near_end(const contact_batch *b, int k)
{
    const contact_pair *p = &b->list[b->which[k]];
    return contact_batch_is_near_first(b, k) || p->ends_at_second || p->fills;
}

/** The forces of the edge of pair k of the batch, once it has been evaluated and if its edge pushes. */
static inline contact_push contact_batch_edge_push(const contact_batch *b, int k)
{
    const contact_pair *p = &b->list[b->which[k]];
    return (contact_push){.pair = p,
                          .share = b->share[k],
                          .by_edge = vec2_scale(p->weight * b->pressure[k], (vec2){b->n_x[k], b->n_y[k]})};
}

/** The forces of its edge and of its ends.  \return whether there are any */
bool contact_batch_push(const contact_batch *b, int k, const double *x, contact_push *out);

/** Its distance over the thickness, from the edge if that pushes, or from the first end if that is as near; 1 for what
 *  fills a crack, which has no bound that it comes near to. */
double contact_batch_nearness(const contact_batch *b, int k);

#endif
