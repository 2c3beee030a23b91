/* SPDX-License-Identifier: BSD-3-Clause */
/* A file that is to be made is removed first: what a rank of a run that has just been killed may still write goes to
 * the file that had the name before. */
#include "output/stripe_file.h"

#include "base/rank_order.h"
#include "base/status.h"
#include "output/hdf5_attribute.h"

#include <unistd.h>

static dem_status create(const stripe_order *o, const frames *stripe)
{
    hdf5_file file;
    (void)unlink(o->path);
    TRY(hdf5_open_new(&file, o->path, 0));
    dem_status status = hdf5_write_attribute(&file, "/", STRIPE_MARK, HDF5_I64, 1, &o->number);
    if (status == DEM_OK) status = frame_stripes_create(stripe, &file);
    return hdf5_close(&file, status);
}

static dem_status write_array(const stripe_order *o, const frames *stripe, const void *data)
{
    hdf5_file file;
    TRY(hdf5_open_write(&file, o->path, frame_arrays_bytes(stripe)));
    return hdf5_close(&file, frame_arrays_append(stripe, &file, o->array, o->frames.first, data));
}

static dem_status copy(const stripe_order *o, const frames *stripe)
{
    hdf5_file from, to;
    TRY(hdf5_open_write(&to, o->path, o->frames.count * frame_arrays_bytes(stripe)));
    dem_status status = hdf5_open_read(&from, o->other);
    if (status == DEM_OK) status = hdf5_close(&from, frame_stripes_copy(&o->whole, o->stripe, &from, &to, o->frames));
    return hdf5_close(&to, status);
}

dem_status rank_order_obey(const void *what, const void *data)
{
    const stripe_order *o = what;
    const frames stripe = frame_stripes_get(&o->whole, o->stripe);
    switch (o->kind) {
    case STRIPE_CREATE:
        return create(o, &stripe);
    case STRIPE_WRITE:
        return write_array(o, &stripe, data);
    case STRIPE_COPY:
        return copy(o, &stripe);
    default:
        return hdf5_publish(o->path, o->other);
    }
}
