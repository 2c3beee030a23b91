/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact pairs by the batch. Most close pairs do not push, which is seen at a small part of the cost of a force; what
 * is left of them lies side by side, so that several roots and divisions are taken at once. Every evaluation goes
 * through all close pairs this way, so it has vector instructions of its own, to the bits of contact_pair_push(). */
#ifndef DEM_SURFACE_CONTACT_CONTACT_BATCH_H
#define DEM_SURFACE_CONTACT_CONTACT_BATCH_H

#include "surface_contact/compact_pairs.h"

enum { CONTACT_BATCH_MOST = 32 };

/* What is known of a pair that has been found, in the two bits below its place in the list. */
enum { CONTACT_BATCH_BY_EDGE = 1, CONTACT_BATCH_NEAR_FIRST = 2 };

typedef struct contact_batch {
    const compact_pairs *of;             /* all pairs */
    dem_index next;                      /* which of them has not been looked at yet */
    double part;                         /* of the contact thickness */
    int n;                               /* pairs in the batch, and of these: */
    dem_index which[CONTACT_BATCH_MOST]; /* four times the place in the list, ascending, and what is known */
    double along[CONTACT_BATCH_MOST], front[CONTACT_BATCH_MOST], square[CONTACT_BATCH_MOST]; /* edge_terms */
    double t_x[CONTACT_BATCH_MOST], t_y[CONTACT_BATCH_MOST], thickness[CONTACT_BATCH_MOST];
    double share[CONTACT_BATCH_MOST], u[CONTACT_BATCH_MOST]; /* results, of the edges that push: edge_push */
    double pressure[CONTACT_BATCH_MOST], n_x[CONTACT_BATCH_MOST], n_y[CONTACT_BATCH_MOST];
} contact_batch;

/** Begins with all of some pairs; no batch as yet. Borrows them.
 *  \param part  of the contact thickness within which pairs are in reach, up to 1 */
void contact_batch_begin(contact_batch *b, const compact_pairs *of, double part);

/** Finds the next pairs in reach at the positions that compact_pairs_read() has read: their node is in front of the
 *  edge, beside it, and nearer than the part of the thickness, or as near to its first end. With the part 1 none is
 *  left out that pushes.
 *  \return whether there are any more */
bool contact_batch_next(contact_batch *b);

/** Evaluates what the edges of the batch push with, which has been found with the part 1. */
void contact_batch_evaluate(contact_batch *b);

/** Place in the list of pair k of the batch. */
static inline dem_index contact_batch_place(const contact_batch *b, int k)
{
    return b->which[k] >> 2;
}

static inline const compact_pair *contact_batch_compact(const contact_batch *b, int k)
{
    return &b->of->pairs[contact_batch_place(b, k)];
}

static inline const contact_pair *contact_batch_pair(const contact_batch *b, int k)
{
    return &b->of->list[contact_batch_place(b, k)];
}

/** Whether the inside of its edge pushes, found with the part 1. */
static inline bool contact_batch_is_by_edge(const contact_batch *b, int k)
{
    return (b->which[k] & CONTACT_BATCH_BY_EDGE) != 0;
}

/** Whether the inside of its edge alone pushes: its node is not near the first end, nor does it end at the second. */
static inline bool contact_batch_is_edge_alone(const contact_batch *b, int k)
{
    return (b->which[k] & CONTACT_BATCH_NEAR_FIRST) == 0 && contact_batch_compact(b, k)->is_plain;
}

/** The forces of the edge of pair k of the batch, once it has been evaluated and if its edge pushes. */
static inline contact_push contact_batch_edge_push(const contact_batch *b, int k)
{
    const contact_pair *p = contact_batch_pair(b, k);
    return (contact_push){.pair = p,
                          .share = b->share[k],
                          .by_edge = vec2_scale(p->weight * b->pressure[k], (vec2){b->n_x[k], b->n_y[k]})};
}

/** The forces of its edge and of its ends at positions x [n][2], those that have been read.
 *  \return whether there are any */
bool contact_batch_push(const contact_batch *b, int k, const double *x, contact_push *out);

/** Its distance over the thickness, from the edge if that pushes, or from the first end if that is as near; 1 for what
 *  fills a crack, which has no bound that it comes near to. */
double contact_batch_nearness(const contact_batch *b, int k, const double *x);

#endif
