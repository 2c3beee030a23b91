/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /fragments. Frames have different numbers of rows, one behind the other; frame k has those from
 * frame_offset[k] on and before frame_offset[k + 1]. Where rows begin is read from the file when a frame is added, so
 * that after a failure, or in another file, nothing has to be set right. They are summed up over nodes in order. */
#include "output/fragment_table.h"

#include "base/grow.h"
#include "base/status.h"
#include "output/frames.h"

#include <math.h>
#include <stdlib.h>

/* In the order in which put_row() fills a row. */
static const table_column columns[] = {
    {"/fragments/t", HDF5_F64, 0, 1},
    {"/fragments/mass", HDF5_F64, 0, 1},
    {"/fragments/x", HDF5_F64, 0, 2},
    {"/fragments/v", HDF5_F64, 0, 2},
    {"/fragments/angular_momentum", HDF5_F64, 0, 1},
    {"/fragments/kinetic_centre", HDF5_F64, 0, 1},
    {"/fragments/kinetic_spin", HDF5_F64, 0, 1},
    {"/fragments/kinetic_internal", HDF5_F64, 0, 1},
    {"/fragments/size", HDF5_F64, 0, 2},
    {"/fragments/id", HDF5_I64, 0, 1},
    {"/fragments/nodes", HDF5_I64, 0, 1},
};

static const hdf5_rows offsets = {FRAMES_FRAGMENT_OFFSETS, HDF5_I64, 1, {0}, 64, 0};

dem_status fragment_table_init(fragment_table *out, const dem_model *model)
{
    dem_model_size size = {.struct_size = sizeof size};
    (void)dem_model_sizes(model, &size);
    fragment_table t = {.n_nodes = size.n_nodes};
    t.row_of = calloc((size_t)size.n_nodes, sizeof *t.row_of);
    CHECK_MEMORY(t.row_of);
    *out = t;
    return table_init(&out->table, columns, sizeof columns / sizeof columns[0], NULL);
}

void fragment_table_free(fragment_table *t)
{
    table_free(&t->table);
    free(t->row_of);
    free(t->rows);
    *t = (fragment_table){.n = 0};
}

dem_status fragment_table_create(const fragment_table *t, const hdf5_file *file)
{
    if (t->row_of == NULL) return DEM_OK;
    TRY(table_create(&t->table, file));
    TRY(hdf5_create(file, &offsets));
    return hdf5_append(file, &offsets, 0, 1, &(dem_index){0});
}

/* ---- a frame ---- */

/* From the lowest nodes of fragments to rows in their order: those of lower nodes are known already. */
static dem_status number_rows(fragment_table *t, dem_index n)
{
    CHECK(grow_array((void **)&t->rows, &t->capacity, n, sizeof *t->rows), DEM_ERROR_MEMORY,
          "out of memory for %lld fragments", (long long)n);
    t->n = 0;
    for (dem_index i = 0; i < t->n_nodes; i++) {
        if (t->row_of[i] < i) {
            t->row_of[i] = t->row_of[t->row_of[i]];
            continue;
        }
        t->rows[t->n] = (fragment_row){
            .id = i, .low = {(double)INFINITY, (double)INFINITY}, .high = {-(double)INFINITY, -(double)INFINITY}};
        t->row_of[i] = t->n++;
    }
    return DEM_OK;
}

static void add_node(fragment_row *row, double mass, const double *x, const double *v)
{
    row->nodes++;
    row->mass += mass;
    for (int d = 0; d < 2; d++) {
        row->x[d] += mass * x[d];
        row->v[d] += mass * v[d];
        row->low[d] = fmin(row->low[d], x[d]);
        row->high[d] = fmax(row->high[d], x[d]);
    }
}

static void add_spin(fragment_row *row, double mass, const double *x, const double *v)
{
    const double r[2] = {x[0] - row->x[0], x[1] - row->x[1]}, u[2] = {v[0] - row->v[0], v[1] - row->v[1]};
    row->angular_momentum += mass * (r[0] * u[1] - r[1] * u[0]);
    row->inertia += mass * (r[0] * r[0] + r[1] * r[1]);
}

/* What is left of a node's velocity without that of a rigid body with the same momenta. */
static void add_internal(fragment_row *row, double mass, const double *x, const double *v)
{
    const double turn = row->inertia > 0.0 ? row->angular_momentum / row->inertia : 0.0;
    const double u = v[0] - row->v[0] + turn * (x[1] - row->x[1]), w = v[1] - row->v[1] - turn * (x[0] - row->x[0]);
    row->internal += 0.5 * mass * (u * u + w * w);
}

static void sum_up(const fragment_table *t, const double *mass, const double *x, const double *v,
                   void (*add)(fragment_row *row, double mass, const double *x, const double *v))
{
    for (dem_index i = 0; i < t->n_nodes; i++) add(&t->rows[t->row_of[i]], mass[i], &x[2 * i], &v[2 * i]);
}

dem_status fragment_table_measure(fragment_table *t, const dem_simulation *simulation)
{
    dem_state state = {.struct_size = sizeof state};
    dem_index n;
    if (t->row_of == NULL) return DEM_OK;
    const double *mass = dem_model_lattice(dem_simulation_model(simulation))->mass;
    TRY(dem_simulation_state(simulation, &state));
    TRY(dem_simulation_fragments(simulation, &n, t->row_of));
    TRY(number_rows(t, n));
    t->t = state.t;
    sum_up(t, mass, state.x, state.v, add_node);
    for (fragment_row *row = t->rows; row < t->rows + t->n; row++)
        for (int d = 0; d < 2; d++) {
            row->x[d] /= row->mass;
            row->v[d] /= row->mass;
        }
    sum_up(t, mass, state.x, state.v, add_spin);
    sum_up(t, mass, state.x, state.v, add_internal);
    return DEM_OK;
}

hsize_t fragment_table_bytes(const fragment_table *t)
{
    return t->row_of == NULL ? 0 : table_bytes(&t->table) + (hsize_t)t->n * t->table.width * sizeof *t->table.buffer;
}

/* Reals first, then whole numbers, as the columns are listed. */
static void put_row(const fragment_table *t, table_cell *cell, const fragment_row *row)
{
    const double of_spin =
        row->inertia > 0.0 ? 0.5 * row->angular_momentum * row->angular_momentum / row->inertia : 0.0;
    const double reals[] = {t->t,
                            row->mass,
                            row->x[0],
                            row->x[1],
                            row->v[0],
                            row->v[1],
                            row->angular_momentum,
                            0.5 * row->mass * (row->v[0] * row->v[0] + row->v[1] * row->v[1]),
                            of_spin,
                            row->internal,
                            row->high[0] - row->low[0],
                            row->high[1] - row->low[1]};
    cell = table_put_reals(cell, reals, sizeof reals / sizeof reals[0]);
    (void)table_put_wholes(cell, (const dem_index[]){row->id, row->nodes}, 2);
}

dem_status fragment_table_append(fragment_table *t, const hdf5_file *file, dem_index n)
{
    dem_index first;
    if (t->row_of == NULL) return DEM_OK;
    TRY(hdf5_read(file, &offsets, (hsize_t)n, 1, &first));
    t->table.written = (hsize_t)first;
    t->table.buffered = 0;
    for (dem_index k = 0; k < t->n; k++) {
        if (t->table.buffered == TABLE_ROWS) TRY(table_flush(&t->table, file));
        put_row(t, table_add(&t->table), &t->rows[k]);
    }
    TRY(table_flush(&t->table, file));
    return hdf5_append(file, &offsets, (hsize_t)n + 1, 1, &(dem_index){first + t->n});
}

/* ---- frames of other files ---- */

/* [count + 1] offsets of frames from `first` on, to be freed, after a failure too. */
static dem_status read_offsets(const hdf5_file *file, hsize_t first, hsize_t count, dem_index **out)
{
    *out = malloc(((size_t)count + 1) * sizeof **out);
    CHECK_MEMORY(*out);
    TRY(hdf5_read(file, &offsets, first, count + 1, *out));
    for (hsize_t k = 0; k < count; k++)
        CHECK((*out)[k] >= 0 && (*out)[k] <= (*out)[k + 1], DEM_ERROR_IO,
              "%s: " FRAMES_FRAGMENT_OFFSETS ": is not ascending", file->path);
    return DEM_OK;
}

/* `row` [count + 1] has the first rows of the frames in the other file; it is changed to those in this one. */
static dem_status copy_rows(const fragment_table *t, const hdf5_file *from, const hdf5_file *to, hdf5_span span,
                            dem_index *row)
{
    const dem_index first = row[0];
    dem_index at;
    TRY(hdf5_read(to, &offsets, span.at, 1, &at));
    TRY(table_copy(&t->table, from, to, (hdf5_span){(hsize_t)first, (hsize_t)(row[span.count] - first), (hsize_t)at}));
    for (hsize_t k = 0; k <= span.count; k++) row[k] += at - first;
    return hdf5_append(to, &offsets, span.at + 1, span.count, row + 1);
}

dem_status fragment_table_copy(const fragment_table *t, const hdf5_file *from, const hdf5_file *to, hdf5_span span)
{
    dem_index *row = NULL;
    if (t->row_of == NULL || span.count == 0) return DEM_OK;
    dem_status status = read_offsets(from, span.first, span.count, &row);
    if (status == DEM_OK) status = copy_rows(t, from, to, span, row);
    free(row);
    return status;
}

dem_status fragment_table_verify(const fragment_table *t, const hdf5_file *file, hsize_t n)
{
    dem_index *row = NULL;
    if (t->row_of == NULL) return DEM_OK;
    TRY(hdf5_expect_rows(file, &offsets, n + 1));
    dem_status status = read_offsets(file, 0, n, &row);
    if (status == DEM_OK) status = table_verify(&t->table, file, (hsize_t)row[n]);
    free(row);
    return status;
}
