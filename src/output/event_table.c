/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /events: one row for each contact event, with the columns of docs/output.md. Impulses are stored along the
 * normal and along the tangent, as the laws of impact and friction speak of them (docs/method.md, The impact). How rows
 * reach the file is in table.c; which events there are is decided in contact/. */
#include "output/event_table.h"

#include "base/status.h"
#include "base/vec2.h"
#include "output/hdf5_attribute.h"

/* In the order in which event_table_record() fills a row. */
static const table_column columns[] = {
    {"/events/t", HDF5_F64, 0, 1},
    {"/events/weight", HDF5_F64, 0, 1},
    {"/events/x", HDF5_F64, 0, 2},
    {"/events/normal", HDF5_F64, 0, 2},
    {"/events/normal_impulse", HDF5_F64, 0, 1},
    {"/events/tangential_impulse", HDF5_F64, 0, 1},
    {"/events/before", HDF5_F64, 0, 2},
    {"/events/after", HDF5_F64, 0, 2},
    {"/events/energy", HDF5_F64, 0, 1},
    {"/events/kind", HDF5_I8, 0, 1},
    {"/events/state", HDF5_I8, 0, 1},
    {"/events/node", HDF5_I64, 0, 1},
    {"/events/other", HDF5_I64, 0, 1},
    {"/events/obstacle", HDF5_I64, 0, 1},
    {"/events/segment", HDF5_I64, 0, 1},
};

/* The k-th word is the name of code k, of `kind` and of `state`; they are stored as attributes for readers. */
static const char kinds[] = "impact close release slip stick pass", states[] = "free slip stick";

/* A row has one item in every column, so there are no counts. */
dem_status event_table_init(table *out)
{
    return table_init(out, columns, sizeof columns / sizeof columns[0], NULL);
}

dem_status event_table_create(const table *t, const hdf5_file *file)
{
    TRY(table_create(t, file));
    TRY(hdf5_write_attribute_text(file, "/events/kind", "names", kinds));
    return hdf5_write_attribute_text(file, "/events/state", "names", states);
}

/* Reals first, then whole numbers, as the columns are listed. The tangent is (n_y, -n_x): positive impulses along it
 * push the body to the right of the normal. */
void event_table_record(table *t, const dem_event *event)
{
    const vec2 n = vec2_at(event->normal, 0), p = vec2_at(event->impulse, 0), tangent = {n.y, -n.x};
    const double reals[] = {event->t,
                            event->weight,
                            event->x[0],
                            event->x[1],
                            n.x,
                            n.y,
                            vec2_dot(p, n),
                            vec2_dot(p, tangent),
                            event->before[0],
                            event->before[1],
                            event->after[0],
                            event->after[1],
                            event->energy};
    const dem_index wholes[] = {event->kind, event->state, event->node, event->other, event->obstacle, event->segment};
    table_cell *cell = table_put_reals(table_add(t), reals, sizeof reals / sizeof reals[0]);
    (void)table_put_wholes(cell, wholes, sizeof wholes / sizeof wholes[0]);
}
