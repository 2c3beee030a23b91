/* SPDX-License-Identifier: BSD-3-Clause */
/* The frames of a run as a VTKHDF UnstructuredGrid with time steps (docs/output.md, /VTKHDF): which array is where.
 * Topology and constant arrays are stored once. An array that changes has the frames one behind the other in one
 * dataset, and a dataset of offsets says for each frame where its rows begin. With N nodes and T frames:
 *   Points                    [T N][3]  frame k has the rows k N to (k + 1) N - 1
 *   Steps/PointOffsets        [T]       0, N, 2 N, ...
 *   PointData/stress          [T N][6]  the same rows
 *   Steps/PointDataOffsets/stress       a link to Steps/PointOffsets: the numbers are the same
 *   PointData/id              [N]       constant: the offset is 0 in every frame
 *   Connectivity, Types, ...            constant: Steps/CellOffsets is 0 in every frame
 *   Steps/Values, NSteps      [T], T    the times, and how many frames count
 * The cells are M springs. A grid has one kind of data for all its cells, so that the K triangles are a second grid,
 * over the same points, data of these, and times, by links:
 *   CellData/vtkGhostType     [T M]     what is broken is hidden by it
 *   /bodies/Points, ...                 links to /VTKHDF/Points, ...
 *   /bodies/Connectivity, ...           constant
 *   /bodies/CellData/vtkGhostType [T K] frame k has the rows k K to (k + 1) K - 1
 *   /bodies/Steps/Values, ...           links, too, but for NSteps, and CellDataOffsets, which are of its own cells
 *   /fracture/triangles       [T K]     the flags 0 and 1, for all who do not draw: no grid, no offsets
 * The arrays of nodes, springs and triangles are in frame_arrays.c, cells and their types in vtk_grid.c; when a frame
 * is written is decided in trajectory.c. */
#include "output/frames.h"

#include "base/status.h"
#include "output/chunkwise.h"
#include "output/frame_stripes.h"
#include "output/frame_writer.h"
#include "output/hdf5_attribute.h"
#include "output/vtk_grid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The dataset of a row, and that of its offsets. */
#define IN(name) GRID "FieldData/" name, STEPS "/FieldDataOffsets/" name
#define ENERGY(name)                                                                                                   \
    {                                                                                                                  \
        IN(name "_energy")                                                                                             \
    }

/* One value a frame, in the order of append_energies(). */
static const struct energy {
    const char *name, *offset;
} energies[] = {
    ENERGY("kinetic"),    ENERGY("elastic"),  ENERGY("area"),     ENERGY("guard"),   ENERGY("contact"),
    ENERGY("gravity"),    ENERGY("impact"),   ENERGY("friction"), ENERGY("damping"), ENERGY("fracture"),
    ENERGY("projection"), ENERGY("boundary"), ENERGY("obstacle"), {IN("contacts")},
};
enum { N_ENERGIES = sizeof energies / sizeof energies[0] };

/* Where the data of frame k begin. Arrays of one size begin at the same places, so that they share a dataset under the
 * name of each (a hard link): a frame of a small body is written in half the time. The entries before the last stand in
 * the order of `frame_of`. */
static const struct offset {
    const char *name;
    int rank;
    frame_of of;
} offsets[] = {
    {STEPS "/PartOffsets", 1, FRAME_OF_NONE},
    {STEPS "/FieldDataOffsets/contacts", 1, FRAME_OF_ONE},
    {STEPS "/PointOffsets", 1, FRAME_OF_NODES},
    {STEPS "/CellDataOffsets/broken", 1, FRAME_OF_SPRINGS},
    {FRAMES_BODY_STEPS "/CellDataOffsets/" FRAMES_HIDDEN, 1, FRAME_OF_TRIANGLES},
    {STEPS "/CellOffsets", 2, FRAME_OF_NONE},
};
enum { N_OFFSETS = sizeof offsets / sizeof offsets[0] };

/* A dataset with one row for each frame. Chunks of several rows are stored plain: they are rewritten in place with the
 * same bytes, where deflated ones would move and leave holes. */
static hdf5_rows frame_rows(const char *name, hdf5_kind kind, int rank)
{
    return (hdf5_rows){name, kind, rank, {1}, 64, 0};
}

/* ---- creation ---- */

static dem_status create_row(const hdf5_file *file, const char *name, hdf5_kind kind, int rank)
{
    const hdf5_rows rows = frame_rows(name, kind, rank);
    return hdf5_create(file, &rows);
}

/* Gives the offsets of its size the name that an array's offsets must have, unless it is their own name. */
static dem_status share_offset(const hdf5_file *file, const char *name, frame_of of)
{
    return strcmp(name, offsets[of].name) != 0 ? hdf5_link(file, name, offsets[of].name) : DEM_OK;
}

/* `id` and `body` are the same in all frames: their offset is always 0, as that of parts. */
static dem_status create_offsets(const frames *f, const hdf5_file *file)
{
    for (int o = 0; o < N_OFFSETS; o++)
        if (frame_arrays_has(f, offsets[o].of)) TRY(create_row(file, offsets[o].name, HDF5_I64, offsets[o].rank));
    TRY(share_offset(file, STEPS "/PointDataOffsets/id", FRAME_OF_NONE));
    TRY(share_offset(file, STEPS "/PointDataOffsets/body", FRAME_OF_NONE));
    return hdf5_link(file, STEPS "/ConnectivityIdOffsets", STEPS "/CellOffsets");
}

/* An array that is not wanted has no dataset, and no offsets. */
static dem_status create_arrays(const frames *f, const hdf5_file *file)
{
    for (int a = 0; a < FRAME_ARRAYS; a++) {
        const hdf5_rows rows = frame_arrays_rows(f, a);
        const char *offset = frame_arrays_offset(a);
        if (!frame_arrays_is_wanted(f, a)) continue;
        TRY(hdf5_create(file, &rows));
        if (offset != NULL) TRY(share_offset(file, offset, frame_arrays_of(a)));
    }
    return DEM_OK;
}

/* NSteps, the number of frames, is an attribute of each grid, and grows with them. It is written last: readers believe
 * it, so a frame that is not whole is not seen. */
static dem_status write_count(const frames *f, const hdf5_file *file, dem_index n)
{
    if (f->n_triangles > 0) TRY(hdf5_write_attribute(file, FRAMES_BODY_STEPS, "NSteps", HDF5_I64, 1, &n));
    return hdf5_write_attribute(file, STEPS, "NSteps", HDF5_I64, 1, &n);
}

static dem_status create_rows(const frames *f, const hdf5_file *file)
{
    for (int e = 0; e < N_ENERGIES; e++) {
        TRY(create_row(file, energies[e].name, HDF5_F64, 1));
        TRY(share_offset(file, energies[e].offset, FRAME_OF_ONE));
    }
    TRY(create_row(file, STEPS "/Values", HDF5_F64, 1));
    TRY(create_row(file, STEPS "/NumberOfParts", HDF5_I64, 1));
    return write_count(f, file, 0);
}

static void fill_numbers(const void *context, hsize_t first, hsize_t n, void *rows)
{
    dem_index *id = rows;
    (void)context;
    for (hsize_t k = 0; k < n; k++) id[k] = (dem_index)(first + k);
}

/* The number and the body of each node, for readers that select or reorder points. */
static dem_status write_nodes(const frames *f, const hdf5_file *file, const lattice_source *lattice)
{
    const hdf5_rows number = {GRID "PointData/id", HDF5_I64, 1, {0}, 0, f->deflate};
    const hdf5_rows body = {GRID "PointData/body", HDF5_I32, 1, {0}, 0, f->deflate};
    TRY(chunkwise_fill(file, number, (hsize_t)f->n_nodes, fill_numbers, NULL));
    return chunkwise_copy(file, body, lattice, offsetof(dem_lattice, body), f->n_nodes, 1);
}

/* What the grid of triangles has from that of springs. */
static dem_status link_bodies(const hdf5_file *file)
{
    static const char *const shared[] = {"Points",
                                         "PointData",
                                         "FieldData",
                                         "Steps/Values",
                                         "Steps/NumberOfParts",
                                         "Steps/PartOffsets",
                                         "Steps/PointOffsets",
                                         "Steps/CellOffsets",
                                         "Steps/ConnectivityIdOffsets",
                                         "Steps/PointDataOffsets",
                                         "Steps/FieldDataOffsets"};
    for (size_t k = 0; k < sizeof shared / sizeof *shared; k++) {
        char name[48], target[48];
        (void)snprintf(name, sizeof name, FRAMES_BODIES "/%s", shared[k]);
        (void)snprintf(target, sizeof target, GRID "%s", shared[k]);
        TRY(hdf5_link_name(file, name, target));
    }
    return DEM_OK;
}

/* The triangles as cells. */
static dem_status create_bodies(const frames *f, const hdf5_file *file, const lattice_source *lattice)
{
    const grid g = {FRAMES_BODIES, f->n_nodes, f->n_triangles, 3};
    const grid_corners corners = {lattice, offsetof(dem_lattice, triangles)};
    if (f->n_triangles == 0) return DEM_OK;
    TRY(vtk_grid_write(file, &g, corners, f->deflate));
    return link_bodies(file);
}

/* The grids, without their points: these move, and are an array of the frames. */
dem_status frames_create(const frames *f, const hdf5_file *file, const lattice_source *lattice)
{
    const grid g = {"/VTKHDF", f->n_nodes, f->n_springs, 2};
    const grid_corners corners = {lattice, offsetof(dem_lattice, ends)};
    TRY(vtk_grid_write(file, &g, corners, f->deflate));
    TRY(create_bodies(f, file, lattice));
    TRY(write_nodes(f, file, lattice));
    TRY(create_offsets(f, file));
    TRY(create_arrays(f, file));
    return create_rows(f, file);
}

void frames_init(frames *out, const dem_model *model, const dem_trajectory_options *options)
{
    dem_model_size size = {.struct_size = sizeof size};
    (void)dem_model_sizes(model, &size);
    *out = (frames){.n_nodes = size.n_nodes,
                    .n_springs = size.n_springs,
                    .n_triangles = size.n_triangles,
                    .fields = options->fields,
                    .real = options->double_precision ? HDF5_F64 : HDF5_F32,
                    .deflate = options->deflate,
                    .n_stripes = options->writers > 1 ? options->writers : 0};
}

/* ---- frames ---- */

/* One value as the row of the frame in hand. */
static dem_status append_row(const frames *f, const hdf5_file *file, hdf5_rows rows, const void *value)
{
    return hdf5_append(file, &rows, (hsize_t)f->n, 1, value);
}

/* The ledger of this frame, in the order of `energies`. The number of contacts is a real, as VTK's field data are
 * here. */
static dem_status append_energies(const frames *f, const hdf5_file *file, const dem_simulation *simulation,
                                  dem_index n_contacts)
{
    dem_energy e = {.struct_size = sizeof e};
    (void)dem_simulation_energy(simulation, &e);
    const double values[N_ENERGIES] = {e.kinetic,    e.elastic,  e.area,     e.guard,           e.contact,
                                       e.gravity,    e.impact,   e.friction, e.damping,         e.fracture,
                                       e.projection, e.boundary, e.obstacle, (double)n_contacts};
    for (int k = 0; k < N_ENERGIES; k++)
        TRY(append_row(f, file, frame_rows(energies[k].name, HDF5_F64, 1), &values[k]));
    return DEM_OK;
}

/* Frame n begins at row n times the rows of a frame; the topology at 0. */
static dem_status append_offsets(const frames *f, const hdf5_file *file, hsize_t n)
{
    for (int o = 0; o < N_OFFSETS; o++) {
        const hdf5_rows rows = frame_rows(offsets[o].name, HDF5_I64, offsets[o].rank);
        if (!frame_arrays_has(f, offsets[o].of)) continue;
        TRY(hdf5_append(file, &rows, n, 1, &(dem_index){(dem_index)n * frame_arrays_count(f, offsets[o].of)}));
    }
    return DEM_OK;
}

/* Each frame is one part of the grid, at time t. */
static dem_status append_steps(const frames *f, const hdf5_file *file, double t)
{
    TRY(append_offsets(f, file, (hsize_t)f->n));
    TRY(append_row(f, file, frame_rows(STEPS "/NumberOfParts", HDF5_I64, 1), &(dem_index){1}));
    return append_row(f, file, frame_rows(STEPS "/Values", HDF5_F64, 1), &t);
}

hsize_t frames_bytes(const frames *f)
{
    return f->n_stripes > 0 ? frame_stripes_map_bytes(f) : frame_arrays_bytes(f);
}

/* Positions are always written; the other arrays as the options say. The frame does not count itself: the caller raises
 * f->n once the file has been closed without an error. */
dem_status frames_append(const frames *f, const hdf5_file *file, const dem_simulation *simulation)
{
    dem_progress now = {.struct_size = sizeof now};
    TRY(dem_simulation_progress(simulation, &now));
    if (f->n_stripes == 0) TRY(frame_writer_append(f, file, simulation));
    TRY(append_energies(f, file, simulation, now.n_contacts));
    TRY(append_steps(f, file, now.t));
    return write_count(f, file, f->n + 1);
}

/* ---- the end ---- */

/* The array is written once; all frames have the offset 0. */
dem_status frames_create_constant(const frames *f, const hdf5_file *file, const frames_constant *constant,
                                  hdf5_rows *rows, char name[FRAMES_NAME])
{
    char offset[FRAMES_NAME];
    const hsize_t width = (hsize_t)constant->components;
    const dem_index count = strcmp(constant->set, "PointData") == 0 ? f->n_nodes : f->n_springs;
    (void)snprintf(name, FRAMES_NAME, GRID "%s/%s", constant->set, constant->name);
    (void)snprintf(offset, sizeof offset, STEPS "/%sOffsets/%s", constant->set, constant->name);
    *rows = (hdf5_rows){name, constant->kind, width > 1 ? 2 : 1, {width}, ROWS_CHUNK, f->deflate};
    TRY(hdf5_create_for(file, rows, (hsize_t)count));
    return share_offset(file, offset, FRAME_OF_NONE);
}

/* ---- frames of other files ---- */

/* The k-th dataset with one row for each frame, offsets left out: energies, NumberOfParts, Values. */
static hdf5_rows row_of(int k)
{
    if (k < N_ENERGIES) return frame_rows(energies[k].name, HDF5_F64, 1);
    if (k == N_ENERGIES) return frame_rows(STEPS "/NumberOfParts", HDF5_I64, 1);
    return frame_rows(STEPS "/Values", HDF5_F64, 1);
}
enum { N_ROWS = N_ENERGIES + 2 };

/* Data are copied, offsets are computed anew, since the frames begin elsewhere here. */
dem_status frames_copy(const frames *f, const hdf5_file *from, const hdf5_file *to, hdf5_span span)
{
    if (span.count == 0) return DEM_OK;
    const frame_arrays_copying all = {.whole = f, .target = f, .from = from, .to = to};
    if (f->n_stripes == 0) TRY(frame_arrays_copy(&all, span));
    for (int k = 0; k < N_ROWS; k++) {
        const hdf5_rows rows = row_of(k);
        TRY(hdf5_copy(from, to, &rows, span));
    }
    /* The offsets of frames that come from another file. */
    for (hsize_t n = span.at; n < span.at + span.count; n++) TRY(append_offsets(f, to, n));
    return write_count(f, to, (dem_index)(span.at + span.count));
}

/* Checks the shape of every dataset that the frames need, by the same tables by which they are written.
 * \param older  the file may be of a version before some of them, which frames_copy() makes from others */
static dem_status check(const frames *f, const hdf5_file *file, hsize_t n, bool older)
{
    TRY(frame_arrays_check(f, file, n, older));
    for (int k = 0; k < N_ROWS; k++) {
        const hdf5_rows rows = row_of(k);
        TRY(hdf5_expect_rows(file, &rows, n));
    }
    for (int o = 0; o < N_OFFSETS; o++) {
        const hdf5_rows rows = frame_rows(offsets[o].name, HDF5_I64, offsets[o].rank);
        const bool needed = frame_arrays_has(f, offsets[o].of) && !(older && !hdf5_has(file, rows.name));
        if (needed) TRY(hdf5_expect_rows(file, &rows, n));
    }
    if (!older && f->n_triangles > 0) TRY(hdf5_expect_attribute(file, FRAMES_BODY_STEPS, "NSteps", (dem_index)n));
    return hdf5_expect_attribute(file, STEPS, "NSteps", (dem_index)n);
}

/* Values has the number of frames; every other dataset must agree. */
dem_status frames_count(const frames *f, const hdf5_file *file, hsize_t *n)
{
    TRY(hdf5_count_rows(file, STEPS "/Values", n));
    return check(f, file, *n, true);
}

dem_status frames_verify(const frames *f, const hdf5_file *file, hsize_t n)
{
    return check(f, file, n, false);
}
