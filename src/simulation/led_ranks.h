/* SPDX-License-Identifier: BSD-3-Clause */
/* What each rank has of a run that rank 0 leads: its part, the time that it has worked, and which calls of observers it
 * has seen. */
#ifndef DEM_SIMULATION_LED_RANKS_H
#define DEM_SIMULATION_LED_RANKS_H

#include "contact/near_contact.h"
#include "domain/balance.h"
#include "simulation/private.h"
#include "simulation/shared_peaks.h"
#include "simulation/shared_slabs.h"
#include "simulation/slab_migration.h"

/* A frame of one of the whole's observers. */
typedef struct frame_relay {
    led_run *run;
    int observer;
} frame_relay;

/* Calls of observers. */
typedef struct calls {
    dem_index n;    /* for events, breaks and frames, */
    dem_index step; /* and the last step for which there was one; -1: there was none */
} calls;

/* What each rank has of it. */
struct led_run {
    ranks ranks;             /* which do not end with the model */
    dem_simulation *whole;   /* NULL: this rank follows */
    dem_model *model;        /* of the part, */
    bool is_of_slabs;        /* which lasts longer than the run, as it is of slabs; on rank 0 the whole owns it */
    const slab_maker *maker; /* of slabs. On rank 0: NULL */
    dem_simulation *part;    /* NULL: there is none */
    shared_peaks peaks;      /* of the part, and on rank 0 whose they are */
    void *kept;              /* for orders (base/rank_order.h, base/field_order.h) */
    bool is_observed;
    frame_relay frames[OBSERVERS_MOST];
    double busy, entered;       /* s of work since nodes were shared out, and in all at led_ranks_enter() */
    balance balance;            /* of them. On rank 0: */
    const dem_options *options; /* of the whole */
    near_contact near;          /* of its surfaces */
    bool weighs_anew;           /* nodes are about to be shared out by other weights */
    bool shares_anew;           /* the nodes, from the checkpoint that the run has just taken */
    bool migrates;              /* slabs are being made again, and this is kept of the last ones: */
    slab_migration migration;
    calls made, seen; /* since the last checkpoint, and before it was gone back to. On all ranks */
};

/** Whether there are parts to be asked: no more if they could not be made again when nodes were shared out anew, after
 *  which nothing is known of the run.
 *  \return DEM_ERROR_ARGUMENT */
dem_status led_ranks_check(const led_run *l);

/** From here to led_ranks_leave() all ranks work together: one that is out of memory cannot report it and go on. The
 *  time counts as work. */
void led_ranks_enter(led_run *l);
void led_ranks_leave(led_run *l);

/** Tells rank 0 how long all have worked since nodes were shared out.  \return false if nobody knows */
bool led_ranks_collect_busy(led_run *l);

/** A checkpoint is taken: observers are not called again for what is before it. */
void led_ranks_pass_checkpoint(led_run *l);

/** Whether an observer has been called before all went back to a checkpoint, from which the same steps bring the same
 *  events, breaks and frames. Counts the call. */
bool led_ranks_have_seen(led_run *l);
bool led_ranks_have_seen_step(led_run *l, const dem_simulation *part);

/** Whether an observer that is called before something touches has something to see: not behind such a step, nor what
 *  has been shown before all went back. */
bool led_ranks_are_before(const led_run *l, const dem_simulation *part);

/** All parts begin again from the checkpoint. */
void led_ranks_go_back(led_run *l);

#endif
