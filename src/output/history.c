/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /history: a row of numbers of the whole at t = 0 and after accepted steps (docs/output.md). This file
 * has the list of columns and what fills them. The numbers themselves are computed in forces/diagnostics.c and
 * simulation/query.c, which it reaches through the public interface only; how rows reach the file is in table.c. */
#include "output/history.h"

#include <dem/trajectory.h>
#include <math.h>

#include "base/status.h"
#include "base/time_window.h"

/* RUN has one item in a row, the others as many as table.count says, in this order. */
enum { RUN, BODIES, OBSTACLES, BOUNDARIES }; /* what a column is about */

/* In the order in which history_record() fills a row. */
static const table_column columns[] = {
    {"/history/t", HDF5_F64, RUN, 1},
    {"/history/h", HDF5_F64, RUN, 1},
    /* The ledger, J, in the order of dem_energy, and its closure. */
    {"/history/kinetic", HDF5_F64, RUN, 1},
    {"/history/elastic", HDF5_F64, RUN, 1},
    {"/history/area", HDF5_F64, RUN, 1},
    {"/history/guard", HDF5_F64, RUN, 1},
    {"/history/contact", HDF5_F64, RUN, 1},
    {"/history/gravity", HDF5_F64, RUN, 1},
    {"/history/impact", HDF5_F64, RUN, 1},
    {"/history/friction", HDF5_F64, RUN, 1},
    {"/history/damping", HDF5_F64, RUN, 1},
    {"/history/fracture", HDF5_F64, RUN, 1},
    {"/history/projection", HDF5_F64, RUN, 1},
    {"/history/boundary", HDF5_F64, RUN, 1},
    {"/history/obstacle", HDF5_F64, RUN, 1},
    {"/history/closure", HDF5_F64, RUN, 1},
    /* Extremes over springs and triangles. */
    {"/history/strain_min", HDF5_F64, RUN, 1},
    {"/history/strain_max", HDF5_F64, RUN, 1},
    {"/history/area_min", HDF5_F64, RUN, 1},
    /* Contact of bodies with each other. */
    {"/history/gap_min", HDF5_F64, RUN, 1},
    /* What there is at the instant of the row. */
    {"/history/guarded", HDF5_I64, RUN, 1},
    {"/history/inverted", HDF5_I64, RUN, 1},
    {"/history/overlaps", HDF5_I64, RUN, 1},
    {"/history/contacts", HDF5_I64, RUN, 1},
    {"/history/pairs", HDF5_I64, RUN, 1},
    /* Counts since the start of the run, but for `behind`, which is that of the instant. */
    {"/history/impacts", HDF5_I64, RUN, 1},
    {"/history/vertex_impacts", HDF5_I64, RUN, 1},
    {"/history/early", HDF5_I64, RUN, 1},
    {"/history/closings", HDF5_I64, RUN, 1},
    {"/history/releases", HDF5_I64, RUN, 1},
    {"/history/slips", HDF5_I64, RUN, 1},
    {"/history/sticks", HDF5_I64, RUN, 1},
    {"/history/passings", HDF5_I64, RUN, 1},
    {"/history/late", HDF5_I64, RUN, 1},
    {"/history/behind", HDF5_I64, RUN, 1},
    {"/history/events", HDF5_I64, RUN, 1},
    {"/history/steps", HDF5_I64, RUN, 1},
    {"/history/rejected", HDF5_I64, RUN, 1},
    {"/history/retries", HDF5_I64, RUN, 1},
    {"/history/crossings", HDF5_I64, RUN, 1},
    {"/history/evaluations", HDF5_I64, RUN, 1},
    /* An item for each body, obstacle or boundary condition in every row. */
    {"/history/body_centre", HDF5_F64, BODIES, 2},
    {"/history/body_velocity", HDF5_F64, BODIES, 2},
    {"/history/body_angular_momentum", HDF5_F64, BODIES, 1},
    {"/history/obstacle_reaction", HDF5_F64, OBSTACLES, 2},
    {"/history/obstacle_point", HDF5_F64, OBSTACLES, 2},
    {"/history/obstacle_impulse", HDF5_F64, OBSTACLES, 2},
    {"/history/obstacle_friction_impulse", HDF5_F64, OBSTACLES, 2},
    {"/history/obstacle_contacts", HDF5_I64, OBSTACLES, 1},
    {"/history/obstacle_displacement", HDF5_F64, OBSTACLES, 2},
    {"/history/obstacle_angle", HDF5_F64, OBSTACLES, 1},
    {"/history/obstacle_power", HDF5_F64, OBSTACLES, 1},
    {"/history/boundary_force", HDF5_F64, BOUNDARIES, 2},
    {"/history/boundary_displacement", HDF5_F64, BOUNDARIES, 2},
    /* What is broken, and into what. These come last, since most runs do without them. */
    {"/history/largest_fragment", HDF5_F64, RUN, 1},
    {"/history/debris", HDF5_F64, RUN, 1},
    {"/history/median_fragment", HDF5_F64, RUN, 1},
    {"/history/crack_length", HDF5_F64, RUN, 1},
    {"/history/broken_triangles", HDF5_I64, RUN, 1},
    {"/history/broken_springs", HDF5_I64, RUN, 1},
    {"/history/fragments", HDF5_I64, RUN, 1},
};
enum { N_COLUMNS = sizeof columns / sizeof columns[0], OF_FRACTURE = 7 };

/* Columns about the run: first all reals, then all counts, as `columns` lists them. Returns the cell behind, as the
 * others do. */
static table_cell *put_run(table_cell *cell, const dem_simulation *simulation, const dem_progress *now,
                           const dem_energy *e, double closure)
{
    dem_strain s = {.struct_size = sizeof s};
    dem_counts n = {.struct_size = sizeof n};
    dem_overlap overlap = {.struct_size = sizeof overlap};
    dem_surfaces surfaces = {.struct_size = sizeof surfaces};
    (void)dem_simulation_strain(simulation, &s);
    (void)dem_simulation_counts(simulation, &n);
    (void)dem_simulation_overlap(simulation, &overlap);
    (void)dem_simulation_surfaces(simulation, &surfaces);
    const double reals[] = {now->t,      now->step, e->kinetic,  e->elastic, e->area,     e->guard,        e->contact,
                            e->gravity,  e->impact, e->friction, e->damping, e->fracture, e->projection,   e->boundary,
                            e->obstacle, closure,   s.min,       s.max,      s.area_min,  surfaces.gap_min};
    const dem_index counts[] = {
        s.guarded, s.inverted, overlap.now, now->n_contacts, surfaces.pushing, n.impacts,   n.vertex_impacts,
        n.early,   n.closings, n.releases,  n.slips,         n.sticks,         n.passings,  n.late,
        n.behind,  n.events,   n.steps,     n.rejected,      n.retries,        n.crossings, n.evaluations};
    cell = table_put_reals(cell, reals, sizeof reals / sizeof reals[0]);
    return table_put_wholes(cell, counts, sizeof counts / sizeof counts[0]);
}

/* A column's items lie side by side, so each column has a pointer that advances body by body. */
static table_cell *put_bodies(table_cell *cell, const dem_simulation *simulation, dem_index n_bodies)
{
    /* Where the columns begin within the row. */
    table_cell *centre = cell, *velocity = centre + 2 * n_bodies, *momentum = velocity + 2 * n_bodies;
    for (dem_index b = 0; b < n_bodies; b++) {
        dem_body_motion motion = {.struct_size = sizeof motion};
        (void)dem_simulation_body(simulation, b, &motion);
        centre = table_put_reals(centre, motion.centre, 2);
        velocity = table_put_reals(velocity, motion.velocity, 2);
        momentum = table_put_reals(momentum, &motion.angular_momentum[2], 1);
    }
    return momentum;
}

/* Reaction and its point, impulses so far, the number of contacts, place and power, obstacle by obstacle. */
static table_cell *put_obstacles(table_cell *cell, const dem_simulation *simulation, dem_index n_obstacles)
{
    table_cell *reaction = cell, *point = reaction + 2 * n_obstacles, *impulse = point + 2 * n_obstacles;
    table_cell *friction = impulse + 2 * n_obstacles, *contacts = friction + 2 * n_obstacles;
    table_cell *way = contacts + n_obstacles, *angle = way + 2 * n_obstacles, *power = angle + n_obstacles;
    for (dem_index o = 0; o < n_obstacles; o++) {
        dem_obstacle_load load = {.struct_size = sizeof load};
        (void)dem_simulation_obstacle(simulation, o, &load);
        reaction = table_put_reals(reaction, load.reaction, 2);
        point = table_put_reals(point, load.point, 2);
        impulse = table_put_reals(impulse, load.impulse, 2);
        friction = table_put_reals(friction, load.friction_impulse, 2);
        contacts = table_put_wholes(contacts, &load.n_contacts, 1);
        way = table_put_reals(way, load.displacement, 2);
        angle = table_put_reals(angle, &load.angle, 1);
        power = table_put_reals(power, &load.power, 1);
    }
    return power;
}

/* What each boundary condition does to its nodes. */
static table_cell *put_boundaries(table_cell *cell, const dem_simulation *simulation, dem_index n_boundaries)
{
    table_cell *force = cell, *displacement = force + 2 * n_boundaries;
    for (dem_index b = 0; b < n_boundaries; b++) {
        dem_boundary_load load = {.struct_size = sizeof load};
        (void)dem_simulation_boundary(simulation, b, &load);
        force = table_put_reals(force, load.force, 2);
        displacement = table_put_reals(displacement, load.displacement, 2);
    }
    return displacement;
}

static void put_fracture(table_cell *cell, const dem_fracture *f)
{
    const double reals[] = {f->largest, f->debris, f->median, f->crack_length};
    const dem_index counts[] = {f->triangles, f->springs, f->fragments};
    cell = table_put_reals(cell, reals, sizeof reals / sizeof reals[0]);
    (void)table_put_wholes(cell, counts, sizeof counts / sizeof counts[0]);
}

/* All nodes are looked at, so only where something has broken since the last row. */
static dem_status measure_fracture(history *h, const dem_simulation *simulation)
{
    if (!h->breaks || !h->stale) return DEM_OK;
    h->fracture = (dem_fracture){.struct_size = sizeof h->fracture};
    TRY(dem_simulation_fracture(simulation, &h->fracture));
    h->stale = false;
    return DEM_OK;
}

void history_forget(history *h)
{
    h->stale = true;
}

/* The closure: by what the ledger has changed since the first row, over the largest energy of motion and strain so far.
 * The ledger is constant but for the error of integration. */
static double close_ledger(history *h, const dem_energy *e)
{
    if (table_total(&h->table) == 0) h->start = e->ledger;
    h->largest = e->motion > h->largest ? e->motion : h->largest;
    return h->largest > 0.0 ? (e->ledger - h->start) / h->largest : 0.0;
}

/* How many bodies, obstacles and boundary conditions the model and the options have decides the width of a row. */
dem_status history_init(history *out, const dem_simulation *simulation, bool breaks)
{
    dem_model_size size = {.struct_size = sizeof size};
    dem_options options = dem_options_default();
    (void)dem_model_sizes(dem_simulation_model(simulation), &size);
    (void)dem_simulation_options(simulation, &options);
    const dem_index count[] = {size.n_bodies, size.n_obstacles, options.n_boundaries};
    *out = (history){.last = -(double)INFINITY, .breaks = breaks, .stale = true};
    return table_init(&out->table, columns, breaks ? N_COLUMNS : N_COLUMNS - OF_FRACTURE, count);
}

void history_free(history *h)
{
    table_free(&h->table);
}

/* The step that a run is resumed at comes twice: a row of the same instant is not added again. Whether one is due
 * follows from the last row alone, so that a resumed run has the same rows. */
bool dem_history_row_due(double interval, double before, double t)
{
    return t != before && (!(interval > 0.0) || time_window_begins(interval, before, t));
}

dem_status history_record(history *h, const dem_simulation *simulation)
{
    dem_progress now = {.struct_size = sizeof now};
    (void)dem_simulation_progress(simulation, &now);
    if (!dem_history_row_due(h->interval, h->last, now.t)) return DEM_OK;
    TRY(measure_fracture(h, simulation));
    dem_energy energy = {.struct_size = sizeof energy};
    (void)dem_simulation_energy(simulation, &energy);
    const double closure = close_ledger(h, &energy);
    table_cell *cell = table_add(&h->table);
    cell = put_run(cell, simulation, &now, &energy, closure);
    cell = put_bodies(cell, simulation, (dem_index)h->table.count[BODIES]);
    cell = put_obstacles(cell, simulation, (dem_index)h->table.count[OBSTACLES]);
    cell = put_boundaries(cell, simulation, (dem_index)h->table.count[BOUNDARIES]);
    if (h->breaks) put_fracture(cell, &h->fracture);
    h->last = now.t;
    return DEM_OK;
}

/* A file whose history does not have this instant in this row belongs to another run. */
dem_status history_expect_last(const history *h, const hdf5_file *file, hsize_t row)
{
    const hdf5_rows time = {columns[0].name, columns[0].kind, 1, {0}, 0, 0};
    double t;
    TRY(hdf5_read(file, &time, row, 1, &t));
    CHECK(t == h->last, DEM_ERROR_IO, "%s: is of another run: row %llu of its history is at t = %.17g s, not %.17g s",
          file->path, (unsigned long long)row, t, h->last);
    return DEM_OK;
}
