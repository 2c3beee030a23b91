/* SPDX-License-Identifier: BSD-3-Clause */
/* What rank 0 has other ranks do that is no part of a simulation: to write to files. Who gives an order knows no ranks
 * but their numbers, and who passes it on does not know what it is about. */
#ifndef DEM_BASE_RANK_ORDER_H
#define DEM_BASE_RANK_ORDER_H

#include <stddef.h>

#include <dem/dem.h>

typedef struct rank_order {
    int rank;         /**< who is to do it */
    size_t size;      /**< bytes */
    const void *what; /**< [size] */
} rank_order;

/** How many ranks the run has that a simulation leads; 1 where it leads no others. Defined in simulation/led_run.c. */
int rank_order_ranks(const dem_simulation *simulation);

/** Has n orders carried out at once, by as many ranks, of which rank 0 may be one, and waits for all of them. Defined
 *  in simulation/led_run.c, as those who write files see no more of a simulation than its public headers.
 *  \return the first failure, by the numbers of ranks */
dem_status rank_order_give(const dem_simulation *simulation, const rank_order *orders, int n);

/** Carries an order out, on the rank that it was given to. Defined in output/rank_work.c.
 *  \param kept  what this rank keeps from one order to the next, NULL at first; to be freed by rank_order_forget()
 *  \param what  aligned as memory of malloc() */
dem_status rank_order_obey(void **kept, const void *what);

/** Gives up what a rank has kept. No order depends on it: they only take longer without. */
void rank_order_forget(void **kept);

#endif
