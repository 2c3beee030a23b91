/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls that the leader of a run, rank 0, makes on all ranks, of which the others are its followers: what each is to do
 * with its part. A call is one reduction, which takes along what is asked of the others by signals. */
#ifndef DEM_SIMULATION_RANK_CALL_H
#define DEM_SIMULATION_RANK_CALL_H

#include "simulation/observers.h"

#include "base/ranks.h"

typedef enum rank_call_kind {
    RANK_CALL_GO_ON,   /* from an observer, with a status as `number` */
    RANK_CALL_SLABS,   /* a model of slabs that ranks make (simulation/shared_slabs.h), or the same again, */
    RANK_CALL_MIGRATE, /* after they have kept what is to go to others (simulation/slab_migration.h) */
    RANK_CALL_CREATE,  /* a simulation, as the number says */
    RANK_CALL_OBSERVE, /* it, with frames at these intervals, and what the number says */
    RANK_CALL_ADVANCE, /* to t */
    RANK_CALL_GATHER,  /* positions and velocities, */
    RANK_CALL_STATE,   /* those of the last checkpoint (simulation/leader_checkpoint.h), */
    RANK_CALL_ARRAY,   /* or an array of the lattice, of this number in lattice_arrays */
    RANK_CALL_ENERGY,
    RANK_CALL_STRAIN,
    RANK_CALL_COUNTS,
    RANK_CALL_FASTEST,
    RANK_CALL_RESIDUAL,
    RANK_CALL_BODY, /* of this number, as the next ones are */
    RANK_CALL_INERTIA,
    RANK_CALL_BOUNDARY,
    RANK_CALL_STRESS_AT,
    RANK_CALL_FORCE_AT,
    RANK_CALL_FIELD,         /* a field_kind as `number`, */
    RANK_CALL_ORDER,         /* or an order about one, for so many stripes, of so many bytes (base/field_order.h) */
    RANK_CALL_PEAKS_TAKE,    /* of this number, from rank 0 (simulation/shared_peaks.h); */
    RANK_CALL_PEAKS_NODES,   /* the other way round, those of nodes */
    RANK_CALL_PEAKS_SPRINGS, /* or of springs; */
    RANK_CALL_PEAKS_KEEP,    /* for the checkpoint that is being taken, of which then are asked */
    RANK_CALL_PEAKS_KEPT_NODES,
    RANK_CALL_PEAKS_KEPT_SPRINGS,
    RANK_CALL_PEAKS_LOOK, /* or look for larger ones */
    RANK_CALL_SHARES,     /* of the model (simulation/rank_shares.h) */
    RANK_CALL_OBEY,       /* orders of rank 0 (simulation/shared_orders.h) */
    RANK_CALL_DROP,       /* the simulation */
    RANK_CALL_END         /* no more calls; `number` is for the program */
} rank_call_kind;

/* Bits: whether a simulation goes on from a checkpoint, and whether it is of the model of slabs that there is. */
enum { RANK_CALL_RESUMED = 1, RANK_CALL_OF_SLABS = 2 };

/* Whether rank 0 has a model of the whole already. */
enum { RANK_CALL_SLABS_AGAIN = 1 };

/* Bits: what observers want beside steps and frames. */
enum { RANK_CALL_WITH_EVENTS = 1, RANK_CALL_WITH_BREAKS = 2, RANK_CALL_WITH_TOUCHING = 4 };

typedef struct rank_call {
    rank_call_kind kind;
    double t; /* s */
    dem_index number;
    int n_stripes;
    size_t size;
    double intervals[OBSERVERS_MOST]; /* s */
} rank_call;

/** Makes a call, on rank 0; waits for the next one, on the others.  \return the call */
rank_call rank_call_send(const ranks *r, rank_call given);

/** Measures what a call asks for.
 *  \param[out] out  the struct that its getter fills, or its numbers */
dem_status rank_call_answer(const dem_simulation *part, const rank_call *what, void *out);

#endif
