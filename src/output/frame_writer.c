/* SPDX-License-Identifier: BSD-3-Clause */
#include "output/frame_writer.h"

#include "base/status.h"

/* The next array from k on that frames have. */
static int next_wanted(const frames *f, int k)
{
    while (k < FRAME_ARRAYS && !frame_arrays_is_wanted(f, k)) k++;
    return k;
}

/* Behind the last array of the same field. */
static int end_of_field(int first)
{
    int end = first + 1;
    while (end < FRAME_ARRAYS && frame_arrays_field(end) == frame_arrays_field(first)) end++;
    return end;
}

static dem_status give(frame_order *o, const hdf5_file *file, const dem_simulation *simulation)
{
    const frames *f = &o->whole;
    field_order order = {.n_stripes = f->n_stripes > 0 ? f->n_stripes : 1,
                         .size = sizeof *o,
                         .what = o,
                         .target = (void *)(uintptr_t)file,
                         .team = file != NULL ? file->team : NULL};
    for (int k = next_wanted(f, 0); k < FRAME_ARRAYS; k = next_wanted(f, o->end)) {
        o->first = k;
        o->end = end_of_field(k);
        o->ends_frame = next_wanted(f, o->end) == FRAME_ARRAYS;
        order.field = frame_arrays_field(k);
        TRY(field_order_give(simulation, &order));
    }
    return DEM_OK;
}

dem_status frame_writer_append(const frames *f, const hdf5_file *file, const dem_simulation *simulation)
{
    frame_order o = {.whole = *f};
    return give(&o, file, simulation);
}

dem_status frame_writer_append_stripes(const frames *f, const stripe_name *name, bool stays_open,
                                       const dem_simulation *simulation)
{
    frame_order o = {.whole = *f, .stripes = *name, .stays_open = stays_open};
    return give(&o, NULL, simulation);
}
