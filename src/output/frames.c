/* SPDX-License-Identifier: BSD-3-Clause */
/* The frames of a run as a VTKHDF UnstructuredGrid with time steps (docs/output.md, /VTKHDF): which array is where, and
 * what fills it. Topology and constant arrays are stored once. An array that changes has the frames one behind the
 * other in one dataset, and a dataset of offsets says for each frame where its rows begin. With N nodes and T frames:
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
 * All are written in every frame, as other arrays are: a segment has those of its own frames, whatever is in others,
 * and zeros deflate to a 200th.
 * The table `arrays` is the one list of arrays: writing, copying and checking go through it. Cells and their types are
 * in vtk_grid.c; when a frame is written is decided in trajectory.c. */
#include "output/frames.h"

#include "base/status.h"
#include "base/team.h"
#include "output/hdf5_attribute.h"
#include "output/vtk_grid.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The dataset of an array, and that of its offsets. */
#define IN(set, name) GRID set "/" name, STEPS "/" set "Offsets/" name
#define ENERGY(name)                                                                                                   \
    {                                                                                                                  \
        IN("FieldData", name "_energy")                                                                                \
    }

#define BODY_STEPS FRAMES_BODIES "/Steps"

/* Fields for which the stresses of all nodes are needed. */
enum { ANY_STRESS = DEM_FIELD_STRESS | DEM_FIELD_VON_MISES | DEM_FIELD_PRINCIPAL };

/* What an array has a row of: nothing, each frame, each node, spring or triangle of a frame. It indexes `offsets`. */
enum of { NONE, ONE, NODES, SPRINGS, TRIANGLES };

/* What is looked at while a frame is written. */
typedef struct view {
    const dem_simulation *simulation;
    const dem_lattice *lattice;
    dem_state state;
} view;

/* ---- arrays: what fills f->scratch ---- */

/* From two components to VTK's three: the plane lies at z = 0 of space. */
static void spread(double *out, dem_index n, const double *values, const double *less)
{
    for (dem_index i = 0; i < n; i++)
        for (int d = 0; d < 3; d++)
            out[3 * i + d] = d == 2 ? 0.0 : values[2 * i + d] - (less != NULL ? less[2 * i + d] : 0.0);
}

static dem_status fill_points(const frames *f, const view *v)
{
    spread(f->scratch, f->n_nodes, v->state.x, NULL);
    return DEM_OK;
}

/* From the rest position, which need not be where the motion started. */
static dem_status fill_displacement(const frames *f, const view *v)
{
    spread(f->scratch, f->n_nodes, v->state.x, v->lattice->x);
    return DEM_OK;
}

static dem_status fill_velocity(const frames *f, const view *v)
{
    spread(f->scratch, f->n_nodes, v->state.v, NULL);
    return DEM_OK;
}

/* The stresses have been computed before (append_arrays), since several arrays are made of them. */
static dem_status fill_stress(const frames *f, const view *v)
{
    (void)v;
    frames_spread_stress(f->scratch, f->n_nodes, f->stress);
    return DEM_OK;
}

static dem_status fill_von_mises(const frames *f, const view *v)
{
    (void)v;
    for (dem_index i = 0; i < f->n_nodes; i++) f->scratch[i] = dem_stress_von_mises(f->stress + 3 * i);
    return DEM_OK;
}

/* The values only; directions are not written. */
static dem_status fill_principal(const frames *f, const view *v)
{
    double direction[2];
    (void)v;
    for (dem_index i = 0; i < f->n_nodes; i++) dem_stress_principal(f->stress + 3 * i, f->scratch + 2 * i, direction);
    return DEM_OK;
}

/* Two components of each node behind the room of three. */
static dem_status fill_contact_force(const frames *f, const view *v)
{
    double *plane = f->scratch + 3 * f->n_nodes;
    TRY(dem_simulation_contact_forces(v->simulation, plane));
    spread(f->scratch, f->n_nodes, plane, NULL);
    return DEM_OK;
}

/* They have been computed before, as stresses. */
static dem_status fill_contact_pressure(const frames *f, const view *v)
{
    (void)v;
    memcpy(f->scratch, f->pressure, (size_t)f->n_nodes * sizeof *f->scratch);
    return DEM_OK;
}

/* The simulation computes strains and forces of all springs, straight into the scratch. */
static dem_status fill_strain(const frames *f, const view *v)
{
    return dem_simulation_strains(v->simulation, f->scratch);
}

static dem_status fill_force(const frames *f, const view *v)
{
    return dem_simulation_forces(v->simulation, f->scratch);
}

/* Numbers of 8 bytes, in the room of reals. */
static dem_status fill_fragment(const frames *f, const view *v)
{
    dem_index n_fragments;
    return dem_simulation_fragments(v->simulation, &n_fragments, (dem_index *)(void *)f->scratch);
}

static dem_status fill_damage(const frames *f, const view *v)
{
    return dem_simulation_damage(v->simulation, NULL, f->scratch);
}

static dem_status fill_broken(const frames *f, const view *v)
{
    return dem_simulation_broken(v->simulation, NULL, (unsigned char *)f->scratch);
}

static dem_status fill_broken_triangles(const frames *f, const view *v)
{
    return dem_simulation_broken(v->simulation, (unsigned char *)f->scratch, NULL);
}

/* From what is broken, in the scratch, to what VTK does not draw. */
static void hide(const frames *f, dem_index n)
{
    enum { VTK_HIDDEN_CELL = 32 };
    unsigned char *hidden = (unsigned char *)f->scratch;
    for (dem_index k = 0; k < n; k++) hidden[k] = hidden[k] != 0 ? VTK_HIDDEN_CELL : 0;
}

static dem_status fill_hidden(const frames *f, const view *v)
{
    TRY(fill_broken(f, v));
    hide(f, f->n_springs);
    return DEM_OK;
}

static dem_status fill_hidden_triangles(const frames *f, const view *v)
{
    TRY(fill_broken_triangles(f, v));
    hide(f, f->n_triangles);
    return DEM_OK;
}

/* All arrays that change from frame to frame. `field` is the option that asks for one. */
static const struct array {
    const char *name, *offset; /* offset NULL: outside of the grids */
    uint32_t field;            /* 0: always there */
    hdf5_kind kind;            /* HDF5_F32: as the options say */
    enum of of;
    int components;
    dem_status (*fill)(const frames *f, const view *v);
} arrays[] = {
    {GRID "Points", STEPS "/PointOffsets", 0, HDF5_F64, NODES, 3, fill_points},
    /* Nodes: what the options choose, in single precision unless they say otherwise. */
    {IN("PointData", "displacement"), DEM_FIELD_DISPLACEMENT, HDF5_F32, NODES, 3, fill_displacement},
    {IN("PointData", "velocity"), DEM_FIELD_VELOCITY, HDF5_F32, NODES, 3, fill_velocity},
    {IN("PointData", "stress"), DEM_FIELD_STRESS, HDF5_F32, NODES, 6, fill_stress},
    {IN("PointData", "von_mises"), DEM_FIELD_VON_MISES, HDF5_F32, NODES, 1, fill_von_mises},
    {IN("PointData", "principal_stress"), DEM_FIELD_PRINCIPAL, HDF5_F32, NODES, 2, fill_principal},
    {IN("PointData", "contact_force"), DEM_FIELD_CONTACT, HDF5_F32, NODES, 3, fill_contact_force},
    {IN("PointData", "contact_pressure"), DEM_FIELD_CONTACT, HDF5_F32, NODES, 1, fill_contact_pressure},
    {IN("PointData", "fragment"), DEM_FIELD_FRAGMENT, HDF5_I64, NODES, 1, fill_fragment},
    {IN("PointData", "damage"), DEM_FIELD_DAMAGE, HDF5_F32, NODES, 1, fill_damage},
    /* Springs. */
    {IN("CellData", "strain"), DEM_FIELD_STRAIN, HDF5_F32, SPRINGS, 1, fill_strain},
    {IN("CellData", "force"), DEM_FIELD_FORCE, HDF5_F32, SPRINGS, 1, fill_force},
    {IN("CellData", "broken"), 0, HDF5_U8, SPRINGS, 1, fill_broken},
    {IN("CellData", FRAMES_HIDDEN), 0, HDF5_U8, SPRINGS, 1, fill_hidden},
    /* Triangles. */
    {FRAMES_BROKEN_TRIANGLES, NULL, 0, HDF5_U8, TRIANGLES, 1, fill_broken_triangles},
    {FRAMES_BODIES "/CellData/" FRAMES_HIDDEN, BODY_STEPS "/CellDataOffsets/" FRAMES_HIDDEN, 0, HDF5_U8, TRIANGLES, 1,
     fill_hidden_triangles},
};
enum { N_ARRAYS = sizeof arrays / sizeof arrays[0] };

/* One value a frame, in the order of append_energies(). */
static const struct energy {
    const char *name, *offset;
} energies[] = {
    ENERGY("kinetic"),    ENERGY("elastic"),
    ENERGY("area"),       ENERGY("guard"),
    ENERGY("contact"),    ENERGY("gravity"),
    ENERGY("impact"),     ENERGY("friction"),
    ENERGY("damping"),    ENERGY("fracture"),
    ENERGY("projection"), ENERGY("boundary"),
    ENERGY("obstacle"),   {IN("FieldData", "contacts")},
};
enum { N_ENERGIES = sizeof energies / sizeof energies[0] };

/* Where the data of frame k begin. Arrays of one size begin at the same places, so that they share a dataset under the
 * name of each (a hard link): a frame of a small body is written in half the time. The entries before the last stand in
 * the order of `enum of`. */
static const struct offset {
    const char *name;
    int rank;
    enum of of;
} offsets[] = {
    {STEPS "/PartOffsets", 1, NONE},
    {STEPS "/FieldDataOffsets/contacts", 1, ONE},
    {STEPS "/PointOffsets", 1, NODES},
    {STEPS "/CellDataOffsets/broken", 1, SPRINGS},
    {BODY_STEPS "/CellDataOffsets/" FRAMES_HIDDEN, 1, TRIANGLES},
    {STEPS "/CellOffsets", 2, NONE},
};
enum { N_OFFSETS = sizeof offsets / sizeof offsets[0] };

/* Whether the lattice has what an array is of: VTK wants springs as cells even if there are none. */
static bool is_there(const frames *f, enum of of)
{
    return of != TRIANGLES || f->n_triangles > 0;
}

/* Whether the options ask for this array, too. */
static bool is_wanted(const frames *f, const struct array *a)
{
    return (a->field == 0 || (f->fields & a->field) != 0) && is_there(f, a->of);
}

/* Rows of one frame. */
static dem_index count_of(const frames *f, enum of of)
{
    const dem_index count[] = {
        [NONE] = 0, [ONE] = 1, [NODES] = f->n_nodes, [SPRINGS] = f->n_springs, [TRIANGLES] = f->n_triangles};
    return count[of];
}

/* The dataset of an array. A chunk is a frame, so that no frame touches another's. */
static hdf5_rows array_rows(const frames *f, const struct array *a)
{
    /* HDF5_F32 in the table stands for the precision that the options choose. */
    const hdf5_kind kind = a->kind == HDF5_F32 ? f->real : a->kind;
    return (hdf5_rows){
        a->name, kind, a->components > 1 ? 2 : 1, {(hsize_t)a->components}, (hsize_t)count_of(f, a->of), f->deflate};
}

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
static dem_status share_offset(const hdf5_file *file, const char *name, enum of of)
{
    return strcmp(name, offsets[of].name) != 0 ? hdf5_link(file, name, offsets[of].name) : DEM_OK;
}

/* `id` and `body` are the same in all frames: their offset is always 0, as that of parts. */
static dem_status create_offsets(const frames *f, const hdf5_file *file)
{
    for (int o = 0; o < N_OFFSETS; o++)
        if (is_there(f, offsets[o].of)) TRY(create_row(file, offsets[o].name, HDF5_I64, offsets[o].rank));
    TRY(share_offset(file, STEPS "/PointDataOffsets/id", NONE));
    TRY(share_offset(file, STEPS "/PointDataOffsets/body", NONE));
    return hdf5_link(file, STEPS "/ConnectivityIdOffsets", STEPS "/CellOffsets");
}

/* An array that is not wanted has no dataset, and no offsets. */
static dem_status create_arrays(const frames *f, const hdf5_file *file)
{
    for (int a = 0; a < N_ARRAYS; a++) {
        const hdf5_rows rows = array_rows(f, &arrays[a]);
        if (!is_wanted(f, &arrays[a])) continue;
        TRY(hdf5_create(file, &rows));
        if (arrays[a].offset != NULL) TRY(share_offset(file, arrays[a].offset, arrays[a].of));
    }
    return DEM_OK;
}

/* NSteps, the number of frames, is an attribute of each grid, and grows with them. It is written last: readers believe
 * it, so a frame that is not whole is not seen. */
static dem_status write_count(const frames *f, const hdf5_file *file, dem_index n)
{
    if (f->n_triangles > 0) TRY(hdf5_write_attribute(file, BODY_STEPS, "NSteps", HDF5_I64, 1, &n));
    return hdf5_write_attribute(file, STEPS, "NSteps", HDF5_I64, 1, &n);
}

static dem_status create_rows(const frames *f, const hdf5_file *file)
{
    for (int e = 0; e < N_ENERGIES; e++) {
        TRY(create_row(file, energies[e].name, HDF5_F64, 1));
        TRY(share_offset(file, energies[e].offset, ONE));
    }
    TRY(create_row(file, STEPS "/Values", HDF5_F64, 1));
    TRY(create_row(file, STEPS "/NumberOfParts", HDF5_I64, 1));
    return write_count(f, file, 0);
}

/* The number and the body of each node, for readers that select or reorder points. */
static dem_status write_nodes(const frames *f, const hdf5_file *file, const dem_lattice *lattice)
{
    const size_t n = (size_t)f->n_nodes;
    const hdf5_rows body = {GRID "PointData/body", HDF5_I32, 1, {0}, 0, f->deflate};
    const hdf5_rows number = {GRID "PointData/id", HDF5_I64, 1, {0}, 0, f->deflate};
    dem_index *id = malloc(n * sizeof *id);
    CHECK_MEMORY(id);
    for (dem_index i = 0; i < f->n_nodes; i++) id[i] = i;
    const dem_status status = hdf5_write(file, number, n, id);
    free(id);
    TRY(status);
    return hdf5_write(file, body, n, lattice->body);
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
static dem_status create_bodies(const frames *f, const hdf5_file *file, const dem_lattice *lattice)
{
    const grid g = {FRAMES_BODIES, f->n_nodes, f->n_triangles, 3, lattice->triangles};
    if (f->n_triangles == 0) return DEM_OK;
    TRY(vtk_grid_write(file, &g, f->deflate));
    return link_bodies(file);
}

/* The grids, without their points: these move, and are an array of the frames. */
dem_status frames_create(const frames *f, const hdf5_file *file, const dem_lattice *lattice)
{
    const grid g = {"/VTKHDF", f->n_nodes, f->n_springs, 2, lattice->ends};
    TRY(vtk_grid_write(file, &g, f->deflate));
    TRY(create_bodies(f, file, lattice));
    TRY(write_nodes(f, file, lattice));
    TRY(create_offsets(f, file));
    TRY(create_arrays(f, file));
    return create_rows(f, file);
}

/* It holds the largest array: six components of each node, or one number of each spring or triangle. */
static dem_status make_scratch(frames *f)
{
    const size_t n = (size_t)f->n_nodes, m = (size_t)f->n_springs, k = (size_t)f->n_triangles;
    const size_t cells = m > k ? m : k;
    f->scratch = calloc((6 * n > cells ? 6 * n : cells) + 1, sizeof *f->scratch);
    CHECK(f->scratch != NULL, DEM_ERROR_MEMORY, "out of memory for the frames of %lld nodes", (long long)f->n_nodes);
    return DEM_OK;
}

dem_status frames_init(frames *out, const dem_model *model, const dem_trajectory_options *options)
{
    dem_model_size size = {.struct_size = sizeof size};
    (void)dem_model_sizes(model, &size);
    frames f = {.n_nodes = size.n_nodes,
                .n_springs = size.n_springs,
                .n_triangles = size.n_triangles,
                .fields = options->fields,
                .real = options->double_precision ? HDF5_F64 : HDF5_F32,
                .deflate = options->deflate,
                .n_stripes = options->writers > 1 ? options->writers : 0};
    const size_t n = (size_t)size.n_nodes;
    TRY(make_scratch(&f));
    f.stress = calloc(n, 3 * sizeof *f.stress);
    if (f.fields & DEM_FIELD_CONTACT) f.pressure = calloc(n, sizeof *f.pressure);
    if (f.stress == NULL || (f.pressure == NULL && (f.fields & DEM_FIELD_CONTACT))) {
        frames_free(&f);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for the frames of %lld nodes", (long long)size.n_nodes);
    }
    *out = f;
    return DEM_OK;
}

void frames_free(frames *f)
{
    free(f->scratch);
    free(f->stress);
    free(f->pressure);
    *f = (frames){0};
}

/* ---- frames ---- */

/* One value as the row of the frame in hand. */
static dem_status append_row(const frames *f, const hdf5_file *file, hdf5_rows rows, const void *value)
{
    return hdf5_append(file, &rows, (hsize_t)f->n, 1, value);
}

static view view_of(const dem_simulation *simulation)
{
    view v = {simulation, dem_model_lattice(dem_simulation_model(simulation)), {.struct_size = sizeof v.state}};
    return v;
}

dem_status frames_hand_out(const frames *f, const dem_simulation *simulation, frames_taker *take, void *context)
{
    view v = view_of(simulation);
    TRY(dem_simulation_state(simulation, &v.state));
    /* Stresses are computed once for all arrays made of them. */
    if (f->fields & ANY_STRESS) TRY(dem_simulation_stress(simulation, f->stress));
    if (f->fields & DEM_FIELD_CONTACT) TRY(dem_simulation_contact_pressures(simulation, f->pressure));
    for (int k = 0; k < N_ARRAYS; k++) {
        if (!is_wanted(f, &arrays[k])) continue;
        TRY(arrays[k].fill(f, &v));
        TRY(take(context, k, f->scratch));
    }
    return DEM_OK;
}

/* Frames that are being written. */
typedef struct writing {
    const frames *frames;
    const hdf5_file *file;
} writing;

static dem_status append_array(void *context, int array, const void *data)
{
    const writing *w = context;
    return frames_write_stripe(w->frames, w->file, array, (hsize_t)w->frames->n, data);
}

/* The ledger of this frame, in the order of `energies`. The number of contacts is a real, as VTK's field data are
 * here. */
static dem_status append_energies(const frames *f, const hdf5_file *file, const view *v)
{
    dem_energy e = {.struct_size = sizeof e};
    (void)dem_simulation_energy(v->simulation, &e);
    const double values[N_ENERGIES] = {
        e.kinetic,  e.elastic, e.area,     e.guard,      e.contact,  e.gravity,  e.impact,
        e.friction, e.damping, e.fracture, e.projection, e.boundary, e.obstacle, (double)v->state.n_contacts};
    for (int k = 0; k < N_ENERGIES; k++)
        TRY(append_row(f, file, frame_rows(energies[k].name, HDF5_F64, 1), &values[k]));
    return DEM_OK;
}

/* Frame n begins at row n times the rows of a frame; the topology at 0. */
static dem_status append_offsets(const frames *f, const hdf5_file *file, hsize_t n)
{
    for (int o = 0; o < N_OFFSETS; o++) {
        const hdf5_rows rows = frame_rows(offsets[o].name, HDF5_I64, offsets[o].rank);
        if (!is_there(f, offsets[o].of)) continue;
        TRY(hdf5_append(file, &rows, n, 1, &(dem_index){(dem_index)n * count_of(f, offsets[o].of)}));
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
    enum { OF_STRIPE = N_ARRAYS * 1024 }; /* where an array has its rows */
    if (f->n_stripes > 0) return (hsize_t)f->n_stripes * OF_STRIPE;
    /* All arrays in double. */
    return 200 * (hsize_t)f->n_nodes + 18 * (hsize_t)f->n_springs + 2 * (hsize_t)f->n_triangles;
}

/* Positions are always written; the other arrays as the options say. The frame does not count itself: the caller raises
 * f->n once the file has been closed without an error. */
dem_status frames_append(const frames *f, const hdf5_file *file, const dem_simulation *simulation)
{
    view v = view_of(simulation);
    writing w = {f, file};
    TRY(dem_simulation_state(simulation, &v.state));
    if (f->n_stripes == 0) TRY(frames_hand_out(f, simulation, append_array, &w));
    TRY(append_energies(f, file, &v));
    TRY(append_steps(f, file, v.state.t));
    return write_count(f, file, f->n + 1);
}

/* ---- the end ---- */

/* VTK's order of a symmetric tensor: xx, yy, zz, xy, yz, xz. */
void frames_spread_stress(double *out, dem_index n, const double *stress)
{
    for (dem_index i = 0; i < n; i++) {
        const double *s = stress + 3 * i, six[6] = {s[0], s[1], 0.0, s[2], 0.0, 0.0};
        memcpy(out + 6 * i, six, sizeof six);
    }
}

/* The array is written once; all frames have the offset 0. */
dem_status frames_write_constant(const frames *f, const hdf5_file *file, const frames_constant *constant,
                                 const double *values)
{
    char name[96], offset[96];
    const hsize_t width = (hsize_t)constant->components;
    const dem_index count = strcmp(constant->set, "PointData") == 0 ? f->n_nodes : f->n_springs;
    (void)snprintf(name, sizeof name, GRID "%s/%s", constant->set, constant->name);
    (void)snprintf(offset, sizeof offset, STEPS "/%sOffsets/%s", constant->set, constant->name);
    const hdf5_rows rows = {name, constant->kind, width > 1 ? 2 : 1, {width}, 0, f->deflate};
    TRY(hdf5_write(file, rows, (hsize_t)count, values));
    return share_offset(file, offset, NONE);
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

/* The flags of what is broken from which an array follows; NULL for one that does not. */
static const char *flags_of(const struct array *a)
{
    if (a->fill == fill_hidden) return GRID "CellData/broken";
    return a->fill == fill_hidden_triangles ? FRAMES_BROKEN_TRIANGLES : NULL;
}

/* Whether the file is of a version that did not write this array yet, which follows from another one. */
static bool is_older(const hdf5_file *file, const struct array *a)
{
    return flags_of(a) != NULL && !hdf5_has(file, a->name);
}

/* Frames from a file of the whole to one of all rows, or of a stripe. */
typedef struct copying {
    const frames *whole, *target; /* the same, or the target has a scratch of its own */
    int stripe;                   /* < 0: all rows */
    const hdf5_file *from, *to;
} copying;

/* Where stripe k begins. */
static dem_index first_of(const frames *f, enum of of, int k)
{
    return team_share(count_of(f, of), f->n_stripes, k);
}

/* What is hidden is made of what is broken, where the file has only that. */
static dem_status copy_frame(const copying *c, const struct array *a, hsize_t from, hsize_t to)
{
    hdf5_rows rows = array_rows(c->whole, a);
    const hdf5_rows out = array_rows(c->target, a);
    const hsize_t all = (hsize_t)count_of(c->whole, a->of), n = (hsize_t)count_of(c->target, a->of);
    const hsize_t first = c->stripe < 0 ? 0 : (hsize_t)first_of(c->whole, a->of, c->stripe);
    const bool older = is_older(c->from, a);
    if (older) rows.name = flags_of(a);
    if (n == 0) return DEM_OK;
    TRY(hdf5_read(c->from, &rows, all * from + first, n, c->target->scratch));
    if (older) hide(c->target, (dem_index)n);
    return hdf5_append(c->to, &out, n * to, n, c->target->scratch);
}

static dem_status copy_arrays(const copying *c, hdf5_span span)
{
    for (int k = 0; k < N_ARRAYS; k++)
        for (hsize_t n = 0; n < span.count && is_wanted(c->target, &arrays[k]); n++)
            TRY(copy_frame(c, &arrays[k], span.first + n, span.at + n));
    return DEM_OK;
}

/* Data are copied, offsets are computed anew, since the frames begin elsewhere here. */
dem_status frames_copy(const frames *f, const hdf5_file *from, const hdf5_file *to, hdf5_span span)
{
    if (span.count == 0) return DEM_OK;
    const copying all = {f, f, -1, from, to};
    if (f->n_stripes == 0) TRY(copy_arrays(&all, span));
    for (int k = 0; k < N_ROWS; k++) {
        const hdf5_rows rows = row_of(k);
        TRY(hdf5_copy(from, to, &rows, span));
    }
    /* The offsets of frames that come from another file. */
    for (hsize_t n = span.at; n < span.at + span.count; n++) TRY(append_offsets(f, to, n));
    return write_count(f, to, (dem_index)(span.at + span.count));
}

/* ---- stripes ---- */

static dem_index rows_of(const frames *f, enum of of, int k)
{
    return first_of(f, of, k + 1) - first_of(f, of, k);
}

frames frames_of_stripe(const frames *f, int k)
{
    return (frames){.n_nodes = rows_of(f, NODES, k),
                    .n_springs = rows_of(f, SPRINGS, k),
                    .n_triangles = rows_of(f, TRIANGLES, k),
                    .fields = f->fields,
                    .real = f->real,
                    .deflate = f->deflate};
}

/* Bytes of a row in memory. */
static size_t size_of(const struct array *a)
{
    return (size_t)a->components * (a->kind == HDF5_U8 ? 1 : sizeof(double));
}

size_t frames_first_byte(const frames *f, int array, int k)
{
    return (size_t)first_of(f, arrays[array].of, k) * size_of(&arrays[array]);
}

dem_status frames_create_stripe(const frames *stripe, const hdf5_file *file)
{
    for (int k = 0; k < N_ARRAYS; k++) {
        const hdf5_rows rows = array_rows(stripe, &arrays[k]);
        if (is_wanted(stripe, &arrays[k])) TRY(hdf5_create(file, &rows));
    }
    return DEM_OK;
}

hsize_t frames_stripe_bytes(const frames *stripe, hsize_t n)
{
    return n * frames_bytes(stripe);
}

dem_status frames_write_stripe(const frames *stripe, const hdf5_file *file, int array, hsize_t frame, const void *data)
{
    const struct array *a = &arrays[array];
    const hdf5_rows rows = array_rows(stripe, a);
    const hsize_t n = (hsize_t)count_of(stripe, a->of);
    return is_wanted(stripe, a) ? hdf5_append(file, &rows, frame * n, n, data) : DEM_OK;
}

/* The scratch is that of one frame. */
dem_status frames_copy_stripe(const frames *f, int k, const hdf5_file *from, const hdf5_file *to, hdf5_span span)
{
    frames stripe = frames_of_stripe(f, k);
    TRY(make_scratch(&stripe));
    const copying c = {f, &stripe, k, from, to};
    const dem_status status = copy_arrays(&c, span);
    free(stripe.scratch);
    return status;
}

/* A stripe may have no row of a small array. */
static dem_status map_array(const frames *f, const hdf5_file *file, const struct array *a, frames_mapped n,
                            hdf5_stripe *stripes)
{
    const hdf5_rows rows = array_rows(f, a);
    const hsize_t all = (hsize_t)count_of(f, a->of);
    for (int k = 0; k < f->n_stripes; k++) {
        stripes[k].first = (hsize_t)first_of(f, a->of, k);
        stripes[k].stride = all;
        stripes[k].n = n.frames;
        stripes[k].grows = n.grow;
        stripes[k].rows = (hsize_t)rows_of(f, a->of, k);
    }
    return all > 0 ? hdf5_map(file, &rows, n.frames * all, stripes, f->n_stripes) : DEM_OK;
}

/* Without frames the arrays are as they were made. */
dem_status frames_map(const frames *f, const hdf5_file *file, frames_mapped n, const char (*names)[HDF5_STRIPES_NAME])
{
    hdf5_stripe *stripes = calloc((size_t)f->n_stripes + 1, sizeof *stripes);
    dem_status status = DEM_OK;
    CHECK_MEMORY(stripes);
    for (int k = 0; k < f->n_stripes; k++) memcpy(stripes[k].file, names[k], sizeof stripes[k].file);
    for (int k = 0; k < N_ARRAYS && (n.frames > 0 || n.grow) && status == DEM_OK; k++)
        if (is_wanted(f, &arrays[k])) status = map_array(f, file, &arrays[k], n, stripes);
    free(stripes);
    return status;
}

/* Checks the shape of every dataset that the frames need, by the same tables by which they are written.
 * \param older  the file may be of a version before some of them, which frames_copy() makes from others */
static dem_status check(const frames *f, const hdf5_file *file, hsize_t n, bool older)
{
    for (int k = 0; k < N_ARRAYS; k++) {
        const struct array *a = &arrays[k];
        hdf5_rows rows = array_rows(f, a);
        if (older && is_older(file, a)) rows.name = flags_of(a);
        if (is_wanted(f, a)) TRY(hdf5_expect_rows(file, &rows, n * (hsize_t)count_of(f, a->of)));
    }
    for (int k = 0; k < N_ROWS; k++) {
        const hdf5_rows rows = row_of(k);
        TRY(hdf5_expect_rows(file, &rows, n));
    }
    for (int o = 0; o < N_OFFSETS; o++) {
        const hdf5_rows rows = frame_rows(offsets[o].name, HDF5_I64, offsets[o].rank);
        const bool needed = is_there(f, offsets[o].of) && !(older && !hdf5_has(file, rows.name));
        if (needed) TRY(hdf5_expect_rows(file, &rows, n));
    }
    if (!older && f->n_triangles > 0) TRY(hdf5_expect_attribute(file, BODY_STEPS, "NSteps", (dem_index)n));
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
