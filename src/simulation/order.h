/* SPDX-License-Identifier: BSD-3-Clause */
/* What the leader of a run, rank 0, asks its followers, the other ranks, to do with it: each order is one reduction. */
#ifndef DEM_SIMULATION_ORDER_H
#define DEM_SIMULATION_ORDER_H

#include "simulation/observers.h"

#include "base/ranks.h"

typedef enum order_kind {
    ORDER_GO_ON,   /* from an observer, with a status as `number` */
    ORDER_CREATE,  /* a simulation; number 1: it goes on from a checkpoint */
    ORDER_OBSERVE, /* it, with frames at these intervals; number 1: with events, too */
    ORDER_ADVANCE, /* to t */
    ORDER_GATHER,  /* positions and velocities */
    ORDER_ENERGY,
    ORDER_STRAIN,
    ORDER_COUNTS,
    ORDER_RESIDUAL,
    ORDER_BODY, /* of this number, as the next ones are */
    ORDER_BOUNDARY,
    ORDER_STRESS_AT,
    ORDER_FORCE_AT,
    ORDER_DROP, /* the simulation */
    ORDER_END   /* no more orders; `number` is for the program */
} order_kind;

typedef struct order {
    bool is_known; /* on rank 0 alone, at first */
    order_kind kind;
    double t; /* s */
    dem_index number;
    double intervals[OBSERVERS_MOST]; /* s */
} order;

/** Gives an order, on rank 0; takes it, on the others.  \return what it is */
order order_pass(const ranks *r, order given);

/** Measures what an order asks for.
 *  \param[out] out  the struct that the order's getter fills, or its numbers */
dem_status order_answer(const dem_simulation *part, const order *what, void *out);

#endif
