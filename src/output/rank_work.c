/* SPDX-License-Identifier: BSD-3-Clause */
/* What a rank does of orders (base/rank_order.h, base/field_order.h), of which the simulation that passes them on knows
 * nothing. */
#include <stdlib.h>

#include "base/field_order.h"
#include "base/rank_order.h"
#include "base/status.h"
#include "output/frame_writer.h"

/* What it keeps from one order to the next. */
typedef struct rank_work {
    open_stripe *stripe;
    frame_packer packer;
} rank_work;

/* NULL without memory. */
static rank_work *work_of(void **kept)
{
    if (*kept == NULL) *kept = calloc(1, sizeof(rank_work));
    return *kept;
}

/* On the disk is a whole file, whatever closing says. */
void rank_order_forget(void **kept)
{
    rank_work *w = *kept;
    if (w == NULL) return;
    (void)stripe_file_close(&w->stripe);
    frame_packer_free(&w->packer);
    free(w);
    *kept = NULL;
}

dem_status rank_order_obey(void **kept, const void *what)
{
    rank_work *w = work_of(kept);
    CHECK_MEMORY(w);
    return stripe_file_obey(&w->stripe, what);
}

/* ---- frames ---- */

/* The arrays, as the file of a stripe has them, or that of rank 0. */
static field_arrays arrays_of(const frame_order *o, int stripe)
{
    return (field_arrays){.frames = o->whole.n_stripes > 0 ? frame_stripes_get(&o->whole, stripe) : o->whole,
                          .first = o->first,
                          .end = o->end};
}

/* That of rank 0 is open. A stripe's is open while something is written to it: one thread at a time may have files open
 * (hdf5_file.h), and ranks may be threads. */
static dem_status enter(rank_work *w, const field_order *order, int stripe, const field_arrays *a,
                        const hdf5_file **out)
{
    const frame_order *o = order->what;
    *out = order->target;
    if (o->whole.n_stripes == 0) return DEM_OK;
    TRY(stripe_file_enter(&w->stripe, &o->stripes, stripe, frame_packer_bytes(a)));
    *out = stripe_file_entered(w->stripe);
    return DEM_OK;
}

static dem_status leave(rank_work *w, const frame_order *o, dem_status status)
{
    return o->whole.n_stripes > 0 ? stripe_file_leave(&w->stripe, o->stays_open, status) : status;
}

dem_status field_order_begin(const field_order *order, int stripe, int n_shares)
{
    const field_arrays a = arrays_of(order->what, stripe);
    rank_work *w = work_of(order->kept);
    const hdf5_file *file;
    CHECK_MEMORY(w);
    if (frame_packer_packs(&a)) return frame_packer_begin(&w->packer, &a, n_shares);
    TRY(enter(w, order, stripe, &a, &file));
    return leave(w, order->what, frame_packer_extend(&a, file));
}

dem_status field_order_make(const field_order *order, const void *rows, field_portion *portion)
{
    const field_arrays a = arrays_of(order->what, portion->stripe);
    rank_work *w = work_of(order->kept);
    CHECK_MEMORY(w);
    return frame_packer_make(&w->packer, &a, rows, portion, order->team);
}

dem_status field_order_take(const field_order *order, const field_portion *portion)
{
    const field_arrays a = arrays_of(order->what, portion->stripe);
    rank_work *w = *order->kept;
    const hdf5_file *file;
    if (frame_packer_packs(&a)) return frame_packer_take(&w->packer, &a, portion);
    TRY(enter(w, order, portion->stripe, &a, &file));
    return leave(w, order->what, frame_packer_put(&a, file, portion));
}

/* Of a small frame the file of a stripe gets all arrays at once: to open it takes longer than to write them. */
static bool waits(const frame_order *o, const field_arrays *a)
{
    enum { FEW = 1 << 20 }; /* bytes */
    return o->whole.n_stripes > 0 && !o->ends_frame && frame_arrays_bytes(&a->frames) <= FEW;
}

dem_status field_order_end(const field_order *order, int stripe)
{
    field_arrays a = arrays_of(order->what, stripe);
    rank_work *w = *order->kept;
    const hdf5_file *file;
    if (!frame_packer_packs(&a) || waits(order->what, &a)) return DEM_OK;
    a.first = 0;
    TRY(enter(w, order, stripe, &a, &file));
    return leave(w, order->what, frame_packer_end(&w->packer, &a, file));
}
