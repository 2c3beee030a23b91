/* SPDX-License-Identifier: BSD-3-Clause */
/* Only bytes of numbers and of names are hashed, never of a structure that may have gaps: those which are added whole
 * have members of 8 bytes only. */
#include "trace.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <dem/reader.h>

#include "digest.h"
#include "harness/motion.h"
#include "verification/support.h"

static void add(trace *t, const void *bytes, size_t size)
{
    t->hash = digest_add(t->hash, bytes, size);
}

static void add_reals(trace *t, const double *x, dem_index n)
{
    add(t, x, (size_t)n * sizeof *x);
}

static void add_integer(trace *t, int64_t number)
{
    add(t, &number, sizeof number);
}

static void add_text(trace *t, const char *text)
{
    add(t, text, strlen(text) + 1);
}

trace trace_begin(void)
{
    return (trace){.hash = DIGEST_BEGIN};
}

/* ---- a simulation ---- */

static void add_contact(trace *t, const dem_contact *c)
{
    add_integer(t, c->state);
    for (int k = 0; k < c->n_nodes; k++) add_integer(t, c->nodes[k]);
    add_reals(t, c->weights, c->n_nodes);
    add_integer(t, c->obstacle);
    add_integer(t, c->segment);
    add_reals(t, c->x, 2);
    add_reals(t, c->normal, 2);
    add_reals(t, (const double[]){c->force, c->friction[0]}, 2);
}

static void add_motion(trace *t, const dem_simulation *simulation)
{
    const dem_index n = ask_sizes(dem_simulation_model(simulation)).n_nodes;
    motion s;
    motion_see(simulation, &s);
    add_reals(t, (const double[]){s.t, s.step}, 2);
    add_reals(t, s.x, 2 * n);
    add_reals(t, s.v, 2 * n);
    const dem_energy *e = &s.energy;
    add_reals(t, (const double[]){e->kinetic, e->elastic, e->area, e->guard, e->gravity}, 5);
    add_reals(t, (const double[]){e->impact, e->friction, e->damping, e->projection, e->boundary + e->obstacle}, 5);
    add_integer(t, s.n_contacts);
    for (dem_index k = 0; k < s.n_contacts; k++) add_contact(t, &s.contacts[k]);
}

/* What obstacles have given and boundaries give, and how bodies move. */
static void add_loads(trace *t, const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    const dem_index n_boundaries = ask_options(simulation).n_boundaries;
    for (dem_index k = 0; k < size.n_obstacles; k++) {
        const dem_obstacle_load load = ask_obstacle(simulation, k);
        add_reals(t, load.reaction, 2);
        add_reals(t, load.point, 2);
        add_reals(t, load.impulse, 2);
        add_reals(t, load.friction_impulse, 2);
        add_integer(t, load.n_contacts);
    }
    for (dem_index k = 0; k < n_boundaries; k++) {
        const dem_boundary_load load = ask_boundary(simulation, k);
        add_reals(t, load.force, 2);
        add_reals(t, load.displacement, 2);
    }
    for (dem_index k = 0; k < size.n_bodies; k++) {
        const dem_body_motion body = ask_body(simulation, k);
        add_reals(t, &body.mass, 1);
        add_reals(t, body.centre, 2);
        add_reals(t, body.velocity, 2);
        add_reals(t, &body.angular_momentum[2], 1);
    }
}

static void add_strains(trace *t, const dem_simulation *simulation)
{
    const dem_model_size size = ask_sizes(dem_simulation_model(simulation));
    const dem_strain strain = ask_strain(simulation);
    CLEANUP(free_memory) double *values = malloc((size_t)(size.n_springs + 3 * size.n_nodes) * sizeof *values);
    assert_non_null(values);
    add(t, &strain.min, sizeof strain - sizeof strain.struct_size);
    dem_simulation_strains(simulation, values);
    add_reals(t, values, size.n_springs);
    dem_simulation_forces(simulation, values);
    add_reals(t, values, size.n_springs);
    dem_simulation_stress(simulation, values);
    add_reals(t, values, 3 * size.n_nodes);
}

void trace_add_all(trace *t, const dem_simulation *simulation)
{
    const dem_counts counts = ask_counts(simulation);
    const dem_overlap overlap = ask_overlap(simulation);
    const double residual = dem_simulation_residual(simulation);
    add_motion(t, simulation);
    add_loads(t, simulation);
    add_strains(t, simulation);
    add(t, &counts.steps, offsetof(dem_counts, crossings) - offsetof(dem_counts, steps)); /* later ones are new */
    add(t, &overlap.now, 2 * sizeof overlap.now);
    add_reals(t, &overlap.t, 1);
    add_integer(t, overlap.node);
    add_integer(t, overlap.triangle);
    add_reals(t, overlap.x, 2);
    add_reals(t, &residual, 1);
}

/* ---- the observer ---- */

static dem_status on_frame(void *context, const dem_simulation *simulation)
{
    trace_add_all(context, simulation);
    return DEM_OK;
}

static dem_status on_step(void *context, const dem_simulation *simulation)
{
    motion s;
    motion_see(simulation, &s);
    add_reals(context, (const double[]){s.t, s.step}, 2);
    return DEM_OK;
}

static dem_status on_event(void *context, const dem_simulation *simulation, const dem_event *e)
{
    trace *t = context;
    (void)simulation;
    t->n_events++;
    add_integer(t, e->kind);
    add_integer(t, e->state);
    add_integer(t, e->node);
    add_integer(t, e->other);
    add_integer(t, e->obstacle);
    add_integer(t, e->segment);
    add_reals(t, (const double[]){e->t, e->weight, e->energy}, 3);
    add_reals(t, e->x, 2);
    add_reals(t, e->normal, 2);
    add_reals(t, e->impulse, 2);
    add_reals(t, e->before, 2);
    add_reals(t, e->after, 2);
    return DEM_OK;
}

dem_observer trace_observer(trace *t, double interval)
{
    return (dem_observer){.struct_size = sizeof(dem_observer),
                          .interval = interval,
                          .frame = on_frame,
                          .step = on_step,
                          .event = on_event,
                          .context = t};
}

/* ---- a file ---- */

static double *room(dem_index n)
{
    double *values = malloc(((size_t)n + 1) * sizeof *values);
    assert_non_null(values);
    return values;
}

static void add_frame(trace *t, const dem_reader *reader, dem_index frame)
{
    const dem_lattice *lattice = dem_reader_lattice(reader);
    dem_index n;
    const dem_reader_array *arrays = dem_reader_arrays(reader, &n);
    CLEANUP(free_memory) double *values = room(9 * (lattice->n_nodes + lattice->n_springs));
    assert_ok(dem_reader_positions(reader, frame, values));
    add_reals(t, values, 2 * lattice->n_nodes);
    for (dem_index k = 0; k < n; k++) {
        assert_ok(dem_reader_read(reader, &arrays[k], frame, values));
        add_text(t, arrays[k].name);
        add_reals(t, values, arrays[k].components * (arrays[k].of_springs ? lattice->n_springs : lattice->n_nodes));
    }
}

/* Whether a column came after the first hashes: entries of the ledger that are 0 in the decks of those, where obstacles
 * are, which follows from the input, and what contact of bodies shows. */
static bool is_new(const dem_reader_column *column)
{
    static const char *const names[][2] = {{"history", "contact"},
                                           {"history", "fracture"},
                                           {"history", "obstacle"},
                                           {"frames", "contact_energy"},
                                           {"frames", "fracture_energy"},
                                           {"frames", "obstacle_energy"},
                                           {"history", "obstacle_displacement"},
                                           {"history", "obstacle_angle"},
                                           {"history", "obstacle_power"},
                                           {"history", "gap_min"},
                                           {"history", "pairs"},
                                           {"history", "crossings"}};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++)
        if (strcmp(column->table, names[k][0]) == 0 && strcmp(column->name, names[k][1]) == 0) return true;
    return false;
}

static void add_tables(trace *t, const dem_reader *reader)
{
    dem_index n;
    const dem_reader_column *columns = dem_reader_columns(reader, &n);
    for (dem_index k = 0; k < n; k++) {
        if (is_new(&columns[k])) continue;
        const dem_index size = columns[k].n_rows * columns[k].width;
        CLEANUP(free_memory) double *values = room(size);
        assert_ok(dem_reader_read_column(reader, &columns[k], values));
        add_text(t, columns[k].table);
        add_text(t, columns[k].name);
        add_reals(t, values, size);
    }
}

void trace_add_frames(trace *t, const char *path)
{
    CLEANUP(free_reader) dem_reader *reader;
    dem_index n;
    assert_ok(dem_reader_open(&reader, path));
    const double *times = dem_reader_times(reader, &n);
    const dem_lattice *lattice = dem_reader_lattice(reader);
    add_reals(t, lattice->x, 2 * lattice->n_nodes);
    add_reals(t, lattice->mass, lattice->n_nodes);
    add_reals(t, lattice->stiffness, lattice->n_springs);
    add_reals(t, times, n);
    for (dem_index k = 0; k < n; k++) add_frame(t, reader, k);
    add_tables(t, reader);
}
