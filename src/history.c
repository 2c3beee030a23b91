/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows are collected one after another and stored column by column. */
#include "history.h"

#include "status.h"

#include <stdlib.h>
#include <string.h>

enum of { RUN, BODIES, OBSTACLES };

/* In the order in which history_record() fills a row. */
static const struct column {
    const char *name;
    hdf5_kind kind;
    enum of of;
    hsize_t components;
} columns[] = {
    {"/history/t", HDF5_F64, RUN, 1},
    {"/history/h", HDF5_F64, RUN, 1},
    {"/history/kinetic", HDF5_F64, RUN, 1},
    {"/history/elastic", HDF5_F64, RUN, 1},
    {"/history/guard", HDF5_F64, RUN, 1},
    {"/history/gravity", HDF5_F64, RUN, 1},
    {"/history/impact", HDF5_F64, RUN, 1},
    {"/history/projection", HDF5_F64, RUN, 1},
    {"/history/strain_min", HDF5_F64, RUN, 1},
    {"/history/strain_max", HDF5_F64, RUN, 1},
    {"/history/area_min", HDF5_F64, RUN, 1},
    {"/history/guarded", HDF5_I64, RUN, 1},
    {"/history/contacts", HDF5_I64, RUN, 1},
    {"/history/impacts", HDF5_I64, RUN, 1},
    {"/history/steps", HDF5_I64, RUN, 1},
    {"/history/evaluations", HDF5_I64, RUN, 1},
    {"/history/events", HDF5_I64, RUN, 1},
    {"/history/late", HDF5_I64, RUN, 1},
    {"/history/body_centre", HDF5_F64, BODIES, 2},
    {"/history/body_velocity", HDF5_F64, BODIES, 2},
    {"/history/body_angular_momentum", HDF5_F64, BODIES, 1},
    {"/history/obstacle_reaction", HDF5_F64, OBSTACLES, 2},
    {"/history/obstacle_impulse", HDF5_F64, OBSTACLES, 2},
    {"/history/obstacle_contacts", HDF5_I64, OBSTACLES, 1},
};
enum { N_COLUMNS = sizeof columns / sizeof columns[0] };

static hsize_t column_width(const history *h, const struct column *c)
{
    return (hsize_t)h->count[c->of] * c->components;
}

/* Stored plain: the last chunk is rewritten at every frame, and a deflated one would move and leave a hole. */
static hdf5_rows layout(const history *h, const struct column *c)
{
    const hsize_t count = (hsize_t)h->count[c->of];
    const int rank = 1 + (c->of != RUN) + (c->components > 1);
    return (hdf5_rows){c->name, c->kind, rank, {count, c->components}, HISTORY_ROWS, 0};
}

static history_cell *put_reals(history_cell *cell, const double *values, size_t n)
{
    for (size_t k = 0; k < n; k++) cell[k].real = values[k];
    return cell + n;
}

static history_cell *put_counts(history_cell *cell, const dem_index *values, size_t n)
{
    for (size_t k = 0; k < n; k++) cell[k].whole = values[k];
    return cell + n;
}

static history_cell *put_run(history_cell *cell, const dem_simulation *simulation, const dem_state *state)
{
    const dem_energy *e = &state->energy;
    const dem_strain s = dem_simulation_strain(simulation);
    const dem_counts n = dem_simulation_counts(simulation);
    const double reals[] = {state->t,  state->step,   e->kinetic, e->elastic, e->guard,  e->gravity,
                            e->impact, e->projection, s.min,      s.max,      s.area_min};
    const dem_index counts[] = {s.guarded, state->n_contacts, n.impacts, n.steps, n.evaluations, n.events, n.late};
    cell = put_reals(cell, reals, sizeof reals / sizeof reals[0]);
    return put_counts(cell, counts, sizeof counts / sizeof counts[0]);
}

static history_cell *put_bodies(history_cell *cell, const dem_simulation *simulation, dem_index n_bodies)
{
    history_cell *centre = cell, *velocity = centre + 2 * n_bodies, *momentum = velocity + 2 * n_bodies;
    for (dem_index b = 0; b < n_bodies; b++) {
        const dem_body_motion motion = dem_simulation_body(simulation, b);
        centre = put_reals(centre, motion.centre, 2);
        velocity = put_reals(velocity, motion.velocity, 2);
        momentum = put_reals(momentum, &motion.angular_momentum, 1);
    }
    return momentum;
}

static history_cell *put_obstacles(history_cell *cell, const dem_simulation *simulation, dem_index n_obstacles)
{
    history_cell *reaction = cell, *impulse = reaction + 2 * n_obstacles, *contacts = impulse + 2 * n_obstacles;
    for (dem_index o = 0; o < n_obstacles; o++) {
        const dem_obstacle_load load = dem_simulation_obstacle(simulation, o);
        reaction = put_reals(reaction, load.reaction, 2);
        impulse = put_reals(impulse, load.impulse, 2);
        contacts = put_counts(contacts, &load.contacts, 1);
    }
    return contacts;
}

dem_status history_init(history *out, const dem_model *model)
{
    const dem_model_size size = dem_model_sizes(model);
    history h = {.count = {1, size.n_bodies, size.n_obstacles}};
    hsize_t widest = 1;
    for (int c = 0; c < N_COLUMNS; c++) {
        const hsize_t width = column_width(&h, &columns[c]);
        h.width += width;
        if (width > widest) widest = width;
    }
    h.buffer = calloc((size_t)(h.width + widest), HISTORY_ROWS * sizeof *h.buffer);
    CHECK_MEMORY(h.buffer);
    h.column = h.buffer + HISTORY_ROWS * h.width;
    *out = h;
    return DEM_OK;
}

void history_free(history *h)
{
    free(h->buffer);
}

dem_status history_create(const history *h, const hdf5_file *file)
{
    for (int c = 0; c < N_COLUMNS; c++) {
        const hdf5_rows rows = layout(h, &columns[c]);
        if (h->count[columns[c].of] > 0) TRY(hdf5_create(file, &rows));
    }
    return DEM_OK;
}

void history_record(history *h, const dem_simulation *simulation)
{
    dem_state state = {.struct_size = sizeof state};
    dem_simulation_state(simulation, &state);
    if (h->written + h->buffered > 0 && state.t == h->last) return;
    history_cell *cell = h->buffer + h->buffered * h->width;
    cell = put_run(cell, simulation, &state);
    cell = put_bodies(cell, simulation, h->count[BODIES]);
    (void)put_obstacles(cell, simulation, h->count[OBSTACLES]);
    h->last = state.t;
    h->buffered++;
}

hsize_t history_bytes(const history *h)
{
    return 2 * HISTORY_ROWS * h->width * sizeof *h->buffer; /* the rows may begin two chunks */
}

dem_status history_flush(history *h, const hdf5_file *file)
{
    hsize_t offset = 0;
    for (int c = 0; c < N_COLUMNS && h->buffered > 0; c++) {
        const hdf5_rows rows = layout(h, &columns[c]);
        const hsize_t width = column_width(h, &columns[c]);
        for (hsize_t r = 0; r < h->buffered; r++)
            memcpy(h->column + r * width, h->buffer + r * h->width + offset, (size_t)width * sizeof *h->buffer);
        if (width > 0) TRY(hdf5_append(file, &rows, h->written, h->buffered, h->column));
        offset += width;
    }
    h->written += h->buffered;
    h->buffered = 0;
    return DEM_OK;
}

dem_status history_verify(const history *h, const hdf5_file *file)
{
    for (int c = 0; c < N_COLUMNS; c++)
        if (h->count[columns[c].of] > 0) TRY(hdf5_expect_rows(file, columns[c].name, h->written));
    return DEM_OK;
}
