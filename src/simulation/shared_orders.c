/* SPDX-License-Identifier: BSD-3-Clause */
/* Rank 0 says how long the order of each rank is, 0: it has none, and then sends what it is about. */
#include "simulation/shared_orders.h"

#include <stdint.h>
#include <stdlib.h>

#include "base/reduce.h"
#include "base/status.h"

typedef struct passing {
    const ranks *ranks;
    size_t *sizes;                 /* [ranks] on rank 0, else [1] of this one */
    const rank_order **orders;     /* [ranks] on rank 0, NULL: none */
    ranks_message *full, *nothing; /* [ranks] */
    void *what;                    /* on other ranks */
    void **kept;
} passing;

static dem_status allocate(passing *p)
{
    const size_t n = (size_t)p->ranks->size;
    p->sizes = calloc(n, sizeof *p->sizes);
    p->orders = calloc(n, sizeof *p->orders);
    p->full = calloc(n, sizeof *p->full);
    p->nothing = calloc(n, sizeof *p->nothing);
    CHECK(p->sizes && p->orders && p->full && p->nothing, DEM_ERROR_MEMORY, "out of memory for orders to %d ranks",
          p->ranks->size);
    return DEM_OK;
}

static void release(const passing *p)
{
    free(p->sizes);
    free((void *)p->orders);
    free(p->full);
    free(p->nothing);
    free(p->what);
}

/* By rank. */
static void sort(const passing *p, const rank_order *orders, int n)
{
    for (int k = 0; k < n && p->ranks->rank == 0; k++) {
        p->orders[orders[k].rank] = &orders[k];
        p->sizes[orders[k].rank] = orders[k].size;
    }
}

/* A message is only read where it is sent. */
static ranks_message message_of(const passing *p, bool is_size, int other)
{
    const bool is_first = p->ranks->rank == 0;
    size_t *size = &p->sizes[is_first ? other : 0];
    const rank_order *o = p->orders[is_first ? other : 0];
    if (is_size) return (ranks_message){other, sizeof *size, size};
    return (ranks_message){other, *size, o != NULL ? (void *)(uintptr_t)o->what : p->what};
}

static void send(const passing *p, bool is_size)
{
    const ranks *r = p->ranks;
    const int n = r->rank == 0 ? r->size - 1 : 1;
    for (int k = 0; k < n; k++) {
        const int other = r->rank == 0 ? k + 1 : 0;
        p->full[k] = message_of(p, is_size, other);
        p->nothing[k] = (ranks_message){other, 0, NULL};
    }
    r->exchange(r->self, n, r->rank == 0 ? p->full : p->nothing, r->rank == 0 ? p->nothing : p->full);
}

/* For what comes. */
static dem_status make_room(passing *p)
{
    if (p->ranks->rank == 0) return DEM_OK;
    p->what = malloc(*p->sizes + 1);
    CHECK(p->what, DEM_ERROR_MEMORY, "out of memory for an order of %zu bytes", *p->sizes);
    return DEM_OK;
}

static dem_status obey(const passing *p)
{
    const rank_order *own = p->orders[0];
    if (p->ranks->rank == 0) return own != NULL ? rank_order_obey(p->kept, own->what) : DEM_OK;
    return *p->sizes > 0 ? rank_order_obey(p->kept, p->what) : DEM_OK;
}

static dem_status pass(passing *p)
{
    send(p, true);
    TRY(reduce_status(p->ranks, make_room(p), 0.0));
    send(p, false);
    return reduce_status(p->ranks, obey(p), 0.0);
}

dem_status shared_orders_pass(const ranks *r, void **kept, const rank_order *orders, int n)
{
    passing p = {.ranks = r, .kept = kept};
    dem_status status = reduce_status(r, allocate(&p), 0.0);
    if (status == DEM_OK) {
        sort(&p, orders, n);
        status = pass(&p);
    }
    release(&p);
    return status;
}
