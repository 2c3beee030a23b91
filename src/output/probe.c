/* SPDX-License-Identifier: BSD-3-Clause */
/* Probes: a node, a spring or a gauge (the distance of two nodes) over time, in the groups /probes/NAME
 * (docs/output.md). A row is written at t = 0 and at every `every`-th accepted step, never interpolated. This file has
 * the columns of each kind, when a row is due, and what a checkpoint keeps of a probe. How rows reach the file is in
 * table.c. */
#include "output/probe.h"

#include "base/status.h"
#include "elastic/springs.h"
#include "output/hdf5_attribute.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { most_letters = 63 };

/* In the order in which probe_record() fills a row; the columns of a kind end with one without a name. */
static const struct column {
    const char *name, *unit;
    hsize_t components;
} columns[][PROBE_COLUMNS + 1] = {
    [DEM_PROBE_NODE] = {{"t", "s", 1}, {"x", "m", 2}, {"v", "m/s", 2}, {"stress", "Pa", 3}, {"von_mises", "Pa", 1}},
    [DEM_PROBE_SPRING] = {{"t", "s", 1}, {"strain", "1", 1}, {"force", "N", 1}},
    [DEM_PROBE_GAUGE] = {{"t", "s", 1}, {"length", "m", 1}, {"strain", "1", 1}},
};

/* The names of kinds in the file. */
static const char *const kinds[] = {
    [DEM_PROBE_NODE] = "node", [DEM_PROBE_SPRING] = "spring", [DEM_PROBE_GAUGE] = "gauge"};

/* The list of a kind ends with a column without a name. */
static int count_columns(const dem_probe *what)
{
    int n = 0;
    while (columns[what->kind][n].name != NULL) n++;
    return n;
}

/* How many numbers say what is probed: a gauge has two nodes. */
static int count_numbers(const dem_probe *what)
{
    return what->kind == DEM_PROBE_GAUGE ? 2 : 1;
}

/* ---- checks ---- */

/* A name becomes a group of the file, and part of file names of exports: only plain characters are accepted. */
static dem_status check_name(const char *name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    CHECK(name != NULL, DEM_ERROR_ARGUMENT, "a probe has no name");
    const size_t n = strlen(name);
    CHECK(n >= 1 && n <= most_letters && strspn(name, letters) == n, DEM_ERROR_ARGUMENT,
          "\"%s\" cannot name a probe: 1 to %d letters, digits, _ and -", name, (int)most_letters);
    return DEM_OK;
}

/* Whether the lattice has what is to be probed. */
static dem_status check_probe(const dem_probe *what, const dem_lattice *l)
{
    TRY(check_name(what->name));
    CHECK(what->kind >= DEM_PROBE_NODE && what->kind <= DEM_PROBE_GAUGE, DEM_ERROR_ARGUMENT,
          "probe %s: kind %d is unknown", what->name, (int)what->kind);
    CHECK(what->every >= 1, DEM_ERROR_ARGUMENT, "probe %s: a row every %lld steps; it must be 1 or more", what->name,
          (long long)what->every);
    const bool spring = what->kind == DEM_PROBE_SPRING;
    const dem_index n = spring ? l->n_springs : l->n_nodes;
    for (int k = 0; k < count_numbers(what); k++)
        CHECK(what->number[k] >= 0 && what->number[k] < n, DEM_ERROR_ARGUMENT,
              "probe %s: there is no %s %lld; they are 0 to %lld", what->name, spring ? "spring" : "node",
              (long long)what->number[k], (long long)(n - 1));
    return DEM_OK;
}

/* ---- creation ---- */

/* One allocation for the probe's own copy of its name and the paths of its columns, each of the same size. */
static dem_status name_columns(probe *p, const char *name)
{
    const int n = count_columns(&p->what);
    /* von_mises is the longest name of a column. */
    const size_t size = strlen(name) + sizeof "/probes//von_mises";
    p->text = malloc((size_t)(n + 1) * size);
    CHECK_MEMORY(p->text);
    (void)snprintf(p->text, size, "%s", name);
    p->what.name = p->text;
    for (int c = 0; c < n; c++) {
        const struct column *column = &columns[p->what.kind][c];
        char *path = p->text + (size_t)(c + 1) * size;
        (void)snprintf(path, size, "/probes/%s/%s", name, column->name);
        p->columns[c] = (table_column){path, HDF5_F64, 0, column->components};
    }
    return DEM_OK;
}

/* Of two nodes at the positions x, m. */
static double distance(const double *x, dem_index i, dem_index j)
{
    return vec2_norm(vec2_sub(vec2_at(x, j), vec2_at(x, i)));
}

/* The strain of a gauge refers to its distance in the rest shape. */
static dem_status measure_gauge(probe *p, const lattice_source *lattice)
{
    double x[4];
    TRY(dem_private_lattice_pick(lattice, offsetof(dem_lattice, x), p->what.number, 2, x));
    p->initial = distance(x, 0, 1);
    CHECK(p->initial > 0.0, DEM_ERROR_ARGUMENT, "probe %s: a gauge from node %lld to node %lld has no length",
          p->what.name, (long long)p->what.number[0], (long long)p->what.number[1]);
    return DEM_OK;
}

static dem_status find_spring(probe *p, const lattice_source *lattice)
{
    TRY(dem_private_lattice_pick(lattice, offsetof(dem_lattice, ends), p->what.number, 1, p->ends));
    return dem_private_lattice_pick(lattice, offsetof(dem_lattice, rest_length), p->what.number, 1, &p->initial);
}

static dem_status prepare(probe *p, const lattice_source *lattice)
{
    if (p->what.kind == DEM_PROBE_GAUGE) TRY(measure_gauge(p, lattice));
    if (p->what.kind == DEM_PROBE_SPRING) TRY(find_spring(p, lattice));
    TRY(name_columns(p, p->what.name));
    return table_init(&p->table, p->columns, count_columns(&p->what), NULL);
}

/* The columns are part of the probe, and the table refers to them: *out must not be moved afterwards. */
dem_status probe_init(probe *out, const dem_probe *what, const lattice_source *lattice)
{
    *out = (probe){0};
    TRY(check_probe(what, lattice->lattice));
    out->what = *what;
    const dem_status status = prepare(out, lattice);
    if (status != DEM_OK) probe_free(out);
    return status;
}

void probe_free(probe *p)
{
    table_free(&p->table);
    free(p->text);
    *p = (probe){0};
}

/* Datasets, their units, and attributes that say what is probed. */
dem_status probe_create(const probe *p, const hdf5_file *file)
{
    char group[sizeof "/probes/" + most_letters];
    (void)snprintf(group, sizeof group, "/probes/%s", p->what.name);
    TRY(table_create(&p->table, file));
    for (int c = 0; c < p->table.n_columns; c++)
        TRY(hdf5_write_attribute_text(file, p->columns[c].name, "unit", columns[p->what.kind][c].unit));
    TRY(hdf5_write_attribute_text(file, group, "kind", kinds[p->what.kind]));
    const hsize_t n = (hsize_t)count_numbers(&p->what);
    TRY(hdf5_write_attribute(file, group, "number", HDF5_I64, n, p->what.number));
    return hdf5_write_attribute(file, group, "every", HDF5_I64, 1, &p->what.every);
}

/* ---- rows ---- */

/* In the order of the columns: t, x, v, stress, von Mises stress. */
static dem_status record_node(probe *p, const dem_simulation *simulation, const dem_state *state)
{
    const dem_index i = p->what.number[0];
    double stress[3];
    TRY(dem_simulation_stress_at(simulation, i, stress));
    const double von_mises = dem_stress_von_mises(stress);
    table_cell *cell = table_put_reals(table_add(&p->table), &state->t, 1);
    cell = table_put_reals(cell, state->x + 2 * i, 2);
    cell = table_put_reals(cell, state->v + 2 * i, 2);
    cell = table_put_reals(cell, stress, 3);
    (void)table_put_reals(cell, &von_mises, 1);
    return DEM_OK;
}

/* In the order of the columns: t, strain, force. */
static void record_spring(probe *p, const dem_simulation *simulation, const dem_state *state)
{
    const double length = distance(state->x, p->ends[0], p->ends[1]);
    double row[3] = {state->t, springs_strain_at(p->initial, length), 0.0};
    (void)dem_simulation_force_at(simulation, p->what.number[0], &row[2]);
    (void)table_put_reals(table_add(&p->table), row, 3);
}

/* The strain is the length over that at rest, less 1. */
static void record_gauge(probe *p, const dem_state *state)
{
    const double length = distance(state->x, p->what.number[0], p->what.number[1]),
                 row[3] = {state->t, length, length / p->initial - 1.0};
    (void)table_put_reals(table_add(&p->table), row, 3);
}

/* Called after every accepted step; a row is due at the first call and at every `every`-th one. A call at the same
 * instant again, as a resumed run makes it, is no step. */
dem_status probe_record(probe *p, const dem_simulation *simulation)
{
    dem_progress now = {.struct_size = sizeof now};
    dem_state state = {.struct_size = sizeof state};
    (void)dem_simulation_progress(simulation, &now);
    if (p->seen && now.t == p->last) return DEM_OK;
    p->seen = true;
    p->last = now.t;
    /* `left` is the number of steps to pass over before the next row. */
    if (p->left-- > 0) return DEM_OK;
    p->left = p->what.every - 1;
    TRY(dem_simulation_state(simulation, &state));
    if (p->what.kind == DEM_PROBE_NODE) return record_node(p, simulation, &state);
    if (p->what.kind == DEM_PROBE_SPRING)
        record_spring(p, simulation, &state);
    else
        record_gauge(p, &state);
    return DEM_OK;
}

/* Unused bytes are 0, since the checkpoint is made of bytes. */
probe_progress probe_progress_of(const probe *p)
{
    probe_progress m = {.kind = (int64_t)p->what.kind,
                        .every = p->what.every,
                        .rows = (int64_t)table_total(&p->table),
                        .left = p->left,
                        .seen = p->seen,
                        .last = p->last};
    (void)snprintf(m.name, sizeof m.name, "%s", p->what.name);
    for (int k = 0; k < count_numbers(&p->what); k++) m.number[k] = p->what.number[k];
    return m;
}

/* The probe must be the one that the checkpoint was written with; otherwise its rows would not fit together. */
dem_status probe_restore(probe *p, const probe_progress *memory)
{
    const probe_progress own = probe_progress_of(p);
    CHECK(strncmp(own.name, memory->name, sizeof own.name) == 0 && own.kind == memory->kind &&
              own.number[0] == memory->number[0] && own.number[1] == memory->number[1] && own.every == memory->every,
          DEM_ERROR_ARGUMENT, "probe %s is none of those of the run that is to go on", own.name);
    CHECK(memory->left >= 0 && memory->left < p->what.every, DEM_ERROR_IO,
          "probe %s: the checkpoint has %lld steps until its next row, of %lld", own.name, (long long)memory->left,
          (long long)p->what.every);
    p->left = memory->left;
    p->seen = memory->seen != 0;
    p->last = memory->last;
    return DEM_OK;
}
