/* SPDX-License-Identifier: BSD-3-Clause */
/* A model that ranks share, from the lattice that each of them has: what libdem_mpi, which is a library of its own and
 * has the same version, asks of libdem. */
#ifndef DEM_MODEL_SHARED_MODEL_H
#define DEM_MODEL_SHARED_MODEL_H

#include "domain/ring_use.h"
#include "model/model.h"

/** Whether bodies touch each other, or themselves, in simulations of a model: all ranks have their surfaces then. */
typedef enum dem_private_touching {
    DEM_PRIVATE_TOUCHING_UNKNOWN, /* they may if there are several, or obstacles, or limits of elements, for which all
                                     ranks have most of the surfaces anyway; else one body in free space does not touch
                                     itself */
    DEM_PRIVATE_TOUCHING_NONE,
    DEM_PRIVATE_TOUCHING_SOME
} dem_private_touching;

/** A lattice and obstacles, as dem_model_create() takes them. */
typedef struct dem_private_whole {
    const dem_lattice *lattice;
    dem_slab *slab;                /* of a lattice that nobody has, taken over; NULL: all have `lattice` */
    const dem_obstacle *obstacles; /* [n_obstacles] */
    dem_index n_obstacles;
    dem_private_touching touching;
    const double *weights;        /* [nodes] >= 0, what they weigh in the partition; NULL: all the same */
    const unsigned char *is_near; /* [nodes] as domain_model_shares has them */
    ring_use use;                 /* of rings of ghosts; of 0 rings: not known */
    dem_status refused;           /* not DEM_OK: what this rank has been given already has failed, with a message */
} dem_private_whole;

/** Shares the nodes out among ranks, each of which gets the model of its part. Collective: whatever fails on one rank
 *  is the failure of all. The model takes the ranks over and ends them when it is destroyed; after a failure they are
 *  the caller's as before. No program may call this.
 *  \param whole  the same on all ranks
 *  \return as dem_model_create() and domain_model_create(); DEM_ERROR_ARGUMENT if the ranks' lattices or obstacles
 *  differ; DEM_ERROR_MODEL for more ranks than nodes */
DEM_API dem_status dem_private_share_model(dem_model **out, const dem_private_whole *whole, const ranks *r);

/** The same of a model that rank 0 alone has.
 *  \param whole  on rank 0; not looked at elsewhere
 *  \param about  without a lattice, and with `touching` known; the same on all ranks */
dem_status shared_model_distribute(dem_model **out, const dem_model *whole, const dem_private_whole *about,
                                   const ranks *r);

#endif
