/* SPDX-License-Identifier: BSD-3-Clause */
/* Which nodes events of obstacles may concern before the next checkpoints: ranks of a run that rank 0 leads have rings
 * of common nodes about these alone. That is an estimate, by gaps and speeds at a checkpoint, which no result depends
 * on. An event elsewhere stops all ranks at once (event_queue_lacks_nodes()): they go back to the checkpoint, and have
 * rings about whatever may touch until the next one. */
#ifndef DEM_CONTACT_NEAR_CONTACT_H
#define DEM_CONTACT_NEAR_CONTACT_H

#include "model/model.h"

typedef struct near_contact {
    const dem_model *model;    /* of the whole; NULL: whatever may touch counts as near */
    bool touching;             /* whether bodies touch each other, too */
    double window;             /* s, from one checkpoint to the next at most */
    double n_windows;          /* for which parts are made: more after each time that was too short */
    bool has_all;              /* parts have rings about whatever may touch */
    dem_index n_near, n_ahead; /* nodes in: */
    unsigned char *is_near;    /* [nodes] not 0: near when parts were made */
    unsigned char *ahead;      /* [nodes] not 0: near by the last look, bit 1: before the next checkpoint */
} near_contact;

/** A state of the whole. */
typedef struct near_contact_state {
    double t;            /* s */
    const double *x, *v; /* [nodes][2] */
} near_contact_state;

/** For a run of a whole model, whose options are all filled in. An empty one is {0}. Free with near_contact_free().
 *  \return DEM_ERROR_MEMORY */
dem_status near_contact_create(near_contact *out, const dem_model *whole, const dem_options *options);
void near_contact_free(near_contact *n);

/** Looks what is near in a state at a checkpoint. */
void near_contact_look(near_contact *n, const near_contact_state *state);

/** Whether parts are to be made anew for what the look has found: nodes have come near that were not, or most of those
 *  that were are not any more and that pays.
 *  \param worked  s, since parts were made, which took `price` */
bool near_contact_is_outdated(const near_contact *n, double worked, double price);

/** What the look has found is near from here on, and looks reach farther if it is so soon that making parts is more
 *  than a twentieth of all work. */
void near_contact_take(near_contact *n, double worked, double price);

/** The same of whatever may touch, up to the next checkpoint, after an event that was not foreseen. */
void near_contact_take_all(near_contact *n);

/** [nodes] not 0: near; NULL: whatever may touch is. */
static inline const unsigned char *near_contact_nodes(const near_contact *n)
{
    return n->model != NULL && !n->has_all ? n->is_near : NULL;
}

#endif
