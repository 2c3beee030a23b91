/* SPDX-License-Identifier: BSD-3-Clause */
/* The table `arrays` is the one list of arrays: making, writing, copying and checking go through it. What is broken is
 * written in every frame, as other arrays are: a segment has the flags of its own frames, whatever is in others, and
 * zeros deflate to a 200th. */
#include "output/frame_arrays.h"

#include "base/motion_source.h"
#include "base/status.h"
#include "lattice/lattice_source.h"
#include "output/vtk_grid.h"

#include <stdlib.h>
#include <string.h>

/* The dataset of an array, and that of its offsets. */
#define IN(set, name) GRID set "/" name, STEPS "/" set "Offsets/" name

/* Fields for which the stresses of all nodes are needed. */
enum { ANY_STRESS = DEM_FIELD_STRESS | DEM_FIELD_VON_MISES | DEM_FIELD_PRINCIPAL };

/* ---- arrays: what fills f->scratch, [6 n_nodes] at least ---- */

/* Where rows of two, or three, components of each node are before they are spread in place: as far behind as what they
 * become does not reach a row that is still to be read. */
static double *plane_of(const frames *f)
{
    return f->scratch + 4 * f->n_nodes;
}

static double *stresses_of(const frames *f)
{
    return f->scratch + 3 * f->n_nodes;
}

/* From two components to VTK's three: the plane lies at z = 0 of space. */
static void spread(const frames *f)
{
    const double *plane = plane_of(f);
    for (dem_index i = 0; i < f->n_nodes; i++) {
        const double x = plane[2 * i], y = plane[2 * i + 1];
        f->scratch[3 * i] = x;
        f->scratch[3 * i + 1] = y;
        f->scratch[3 * i + 2] = 0.0;
    }
}

/* VTK's order of a symmetric tensor: xx, yy, zz, xy, yz, xz. */
void frame_arrays_spread_stress(double *out, dem_index n, const double *stress)
{
    for (dem_index i = 0; i < n; i++) {
        const double *s = stress + 3 * i, six[6] = {s[0], s[1], 0.0, s[2], 0.0, 0.0};
        memcpy(out + 6 * i, six, sizeof six);
    }
}

static dem_status fill_points(const frames *f, const dem_simulation *simulation)
{
    TRY(dem_private_positions(simulation, plane_of(f)));
    spread(f);
    return DEM_OK;
}

static dem_status subtract(void *context, dem_index first, dem_index n, const void *rows)
{
    double *plane = (double *)context + 2 * first;
    const double *x = rows;
    for (dem_index k = 0; k < 2 * n; k++) plane[k] -= x[k];
    return DEM_OK;
}

/* From the rest position, which need not be where the motion started. */
static dem_status fill_displacement(const frames *f, const dem_simulation *simulation)
{
    const lattice_source lattice = dem_private_lattice_source(dem_simulation_model(simulation));
    TRY(dem_private_positions(simulation, plane_of(f)));
    TRY(dem_private_lattice_visit(&lattice, offsetof(dem_lattice, x), subtract, plane_of(f)));
    spread(f);
    return DEM_OK;
}

static dem_status fill_velocity(const frames *f, const dem_simulation *simulation)
{
    TRY(dem_private_velocities(simulation, plane_of(f)));
    spread(f);
    return DEM_OK;
}

/* The stresses are there (frame_arrays_hand_out), as they are computed once for all arrays made of them. */
static dem_status fill_stress(const frames *f, const dem_simulation *simulation)
{
    (void)simulation;
    frame_arrays_spread_stress(f->scratch, f->n_nodes, stresses_of(f));
    return DEM_OK;
}

static dem_status fill_von_mises(const frames *f, const dem_simulation *simulation)
{
    const double *stress = stresses_of(f);
    (void)simulation;
    for (dem_index i = 0; i < f->n_nodes; i++) f->scratch[i] = dem_stress_von_mises(stress + 3 * i);
    return DEM_OK;
}

/* The values only; directions are not written. */
static dem_status fill_principal(const frames *f, const dem_simulation *simulation)
{
    double direction[2];
    const double *stress = stresses_of(f);
    (void)simulation;
    for (dem_index i = 0; i < f->n_nodes; i++) dem_stress_principal(stress + 3 * i, f->scratch + 2 * i, direction);
    return DEM_OK;
}

static dem_status fill_contact_force(const frames *f, const dem_simulation *simulation)
{
    TRY(dem_simulation_contact_forces(simulation, plane_of(f)));
    spread(f);
    return DEM_OK;
}

static dem_status fill_contact_pressure(const frames *f, const dem_simulation *simulation)
{
    return dem_simulation_contact_pressures(simulation, f->scratch);
}

/* The simulation computes strains and forces of all springs, straight into the scratch. */
static dem_status fill_strain(const frames *f, const dem_simulation *simulation)
{
    return dem_simulation_strains(simulation, f->scratch);
}

static dem_status fill_force(const frames *f, const dem_simulation *simulation)
{
    return dem_simulation_forces(simulation, f->scratch);
}

/* Numbers of 8 bytes, in the room of reals. */
static dem_status fill_fragment(const frames *f, const dem_simulation *simulation)
{
    dem_index n_fragments;
    return dem_simulation_fragments(simulation, &n_fragments, (dem_index *)(void *)f->scratch);
}

static dem_status fill_damage(const frames *f, const dem_simulation *simulation)
{
    return dem_simulation_damage(simulation, NULL, f->scratch);
}

static dem_status fill_broken(const frames *f, const dem_simulation *simulation)
{
    return dem_simulation_broken(simulation, NULL, (unsigned char *)f->scratch);
}

static dem_status fill_broken_triangles(const frames *f, const dem_simulation *simulation)
{
    return dem_simulation_broken(simulation, (unsigned char *)f->scratch, NULL);
}

/* From what is broken, in the scratch, to what VTK does not draw. */
static void hide(const frames *f, dem_index n)
{
    enum { VTK_HIDDEN_CELL = 32 };
    unsigned char *hidden = (unsigned char *)f->scratch;
    for (dem_index k = 0; k < n; k++) hidden[k] = hidden[k] != 0 ? VTK_HIDDEN_CELL : 0;
}

static dem_status fill_hidden(const frames *f, const dem_simulation *simulation)
{
    TRY(fill_broken(f, simulation));
    hide(f, f->n_springs);
    return DEM_OK;
}

static dem_status fill_hidden_triangles(const frames *f, const dem_simulation *simulation)
{
    TRY(fill_broken_triangles(f, simulation));
    hide(f, f->n_triangles);
    return DEM_OK;
}

/* All arrays that change from frame to frame. `field` is the option that asks for one. */
static const struct array {
    const char *name, *offset; /* offset NULL: outside of the grids */
    uint32_t field;            /* 0: always there */
    hdf5_kind kind;            /* HDF5_F32: as the options say */
    frame_of of;
    int components;
    dem_status (*fill)(const frames *f, const dem_simulation *simulation);
} arrays[] = {
    {GRID "Points", STEPS "/PointOffsets", 0, HDF5_F64, FRAME_OF_NODES, 3, fill_points},
    /* Nodes: what the options choose, in single precision unless they say otherwise. */
    {IN("PointData", "displacement"), DEM_FIELD_DISPLACEMENT, HDF5_F32, FRAME_OF_NODES, 3, fill_displacement},
    {IN("PointData", "velocity"), DEM_FIELD_VELOCITY, HDF5_F32, FRAME_OF_NODES, 3, fill_velocity},
    /* Those made of stresses one after the other; the tensors, which take the place of these, last. */
    {IN("PointData", "von_mises"), DEM_FIELD_VON_MISES, HDF5_F32, FRAME_OF_NODES, 1, fill_von_mises},
    {IN("PointData", "principal_stress"), DEM_FIELD_PRINCIPAL, HDF5_F32, FRAME_OF_NODES, 2, fill_principal},
    {IN("PointData", "stress"), DEM_FIELD_STRESS, HDF5_F32, FRAME_OF_NODES, 6, fill_stress},
    {IN("PointData", "contact_force"), DEM_FIELD_CONTACT, HDF5_F32, FRAME_OF_NODES, 3, fill_contact_force},
    {IN("PointData", "contact_pressure"), DEM_FIELD_CONTACT, HDF5_F32, FRAME_OF_NODES, 1, fill_contact_pressure},
    {IN("PointData", "fragment"), DEM_FIELD_FRAGMENT, HDF5_I64, FRAME_OF_NODES, 1, fill_fragment},
    {IN("PointData", "damage"), DEM_FIELD_DAMAGE, HDF5_F32, FRAME_OF_NODES, 1, fill_damage},
    /* Springs. */
    {IN("CellData", "strain"), DEM_FIELD_STRAIN, HDF5_F32, FRAME_OF_SPRINGS, 1, fill_strain},
    {IN("CellData", "force"), DEM_FIELD_FORCE, HDF5_F32, FRAME_OF_SPRINGS, 1, fill_force},
    {IN("CellData", "broken"), 0, HDF5_U8, FRAME_OF_SPRINGS, 1, fill_broken},
    {IN("CellData", FRAMES_HIDDEN), 0, HDF5_U8, FRAME_OF_SPRINGS, 1, fill_hidden},
    /* Triangles. */
    {FRAMES_BROKEN_TRIANGLES, NULL, 0, HDF5_U8, FRAME_OF_TRIANGLES, 1, fill_broken_triangles},
    {FRAMES_BODIES "/CellData/" FRAMES_HIDDEN, FRAMES_BODY_STEPS "/CellDataOffsets/" FRAMES_HIDDEN, 0, HDF5_U8,
     FRAME_OF_TRIANGLES, 1, fill_hidden_triangles},
};
_Static_assert(sizeof arrays / sizeof arrays[0] == FRAME_ARRAYS, "all arrays are counted");

/* ---- rows ---- */

/* VTK wants springs as cells even if there are none. */
bool frame_arrays_has(const frames *f, frame_of of)
{
    return of != FRAME_OF_TRIANGLES || f->n_triangles > 0;
}

/* Whether the options ask for this array, too. */
bool frame_arrays_is_wanted(const frames *f, int array)
{
    const struct array *a = &arrays[array];
    return (a->field == 0 || (f->fields & a->field) != 0) && frame_arrays_has(f, a->of);
}

frame_of frame_arrays_of(int array)
{
    return arrays[array].of;
}

const char *frame_arrays_offset(int array)
{
    return arrays[array].offset;
}

dem_index frame_arrays_count(const frames *f, frame_of of)
{
    const dem_index count[] = {[FRAME_OF_NONE] = 0,
                               [FRAME_OF_ONE] = 1,
                               [FRAME_OF_NODES] = f->n_nodes,
                               [FRAME_OF_SPRINGS] = f->n_springs,
                               [FRAME_OF_TRIANGLES] = f->n_triangles};
    return count[of];
}

/* A chunk is a frame, so that no frame touches another's. */
hdf5_rows frame_arrays_rows(const frames *f, int array)
{
    const struct array *a = &arrays[array];
    /* HDF5_F32 in the table stands for the precision that the options choose. */
    const hdf5_kind kind = a->kind == HDF5_F32 ? f->real : a->kind;
    return (hdf5_rows){
        a->name,   kind, a->components > 1 ? 2 : 1, {(hsize_t)a->components}, (hsize_t)frame_arrays_count(f, a->of),
        f->deflate};
}

/* Bytes of a row in memory. */
size_t frame_arrays_row_bytes(int array)
{
    return (size_t)arrays[array].components * (arrays[array].kind == HDF5_U8 ? 1 : sizeof(double));
}

/* It holds the largest array: six components of each node, or one number of each spring or triangle. */
dem_status frame_arrays_make_scratch(frames *f)
{
    const size_t n = (size_t)f->n_nodes, m = (size_t)f->n_springs, k = (size_t)f->n_triangles;
    const size_t cells = m > k ? m : k;
    f->scratch = calloc((6 * n > cells ? 6 * n : cells) + 1, sizeof *f->scratch);
    CHECK(f->scratch != NULL, DEM_ERROR_MEMORY, "out of memory for the frames of %lld nodes", (long long)f->n_nodes);
    return DEM_OK;
}

/* ---- frames ---- */

dem_status frame_arrays_hand_out(const frames *f, const dem_simulation *simulation, frame_arrays_taker *take,
                                 void *context)
{
    bool has_stresses = false;
    for (int k = 0; k < FRAME_ARRAYS; k++) {
        const bool is_of_stresses = (arrays[k].field & ANY_STRESS) != 0;
        if (!frame_arrays_is_wanted(f, k)) continue;
        if (is_of_stresses && !has_stresses) TRY(dem_simulation_stress(simulation, stresses_of(f)));
        has_stresses = is_of_stresses;
        TRY(arrays[k].fill(f, simulation));
        TRY(take(context, k, f->scratch));
    }
    return DEM_OK;
}

dem_status frame_arrays_append(const frames *f, const hdf5_file *file, int array, hsize_t frame, const void *data)
{
    const hdf5_rows rows = frame_arrays_rows(f, array);
    const hsize_t n = (hsize_t)frame_arrays_count(f, arrays[array].of);
    return frame_arrays_is_wanted(f, array) ? hdf5_append(file, &rows, frame * n, n, data) : DEM_OK;
}

/* All arrays in double. */
hsize_t frame_arrays_bytes(const frames *f)
{
    return 200 * (hsize_t)f->n_nodes + 18 * (hsize_t)f->n_springs + 2 * (hsize_t)f->n_triangles;
}

/* ---- other files ---- */

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

/* What is hidden is made of what is broken, where the file has only that. */
static dem_status copy_frame(const frame_arrays_copying *c, int array, hsize_t from, hsize_t to)
{
    const struct array *a = &arrays[array];
    hdf5_rows rows = frame_arrays_rows(c->whole, array);
    const hdf5_rows out = frame_arrays_rows(c->target, array);
    const hsize_t all = (hsize_t)frame_arrays_count(c->whole, a->of);
    const hsize_t n = (hsize_t)frame_arrays_count(c->target, a->of);
    const bool older = is_older(c->from, a);
    if (older) rows.name = flags_of(a);
    if (n == 0) return DEM_OK;
    TRY(hdf5_read(c->from, &rows, all * from + (hsize_t)c->first[a->of], n, c->target->scratch));
    if (older) hide(c->target, (dem_index)n);
    return hdf5_append(c->to, &out, n * to, n, c->target->scratch);
}

dem_status frame_arrays_copy(const frame_arrays_copying *c, hdf5_span span)
{
    for (int k = 0; k < FRAME_ARRAYS; k++)
        for (hsize_t n = 0; n < span.count && frame_arrays_is_wanted(c->target, k); n++)
            TRY(copy_frame(c, k, span.first + n, span.at + n));
    return DEM_OK;
}

dem_status frame_arrays_check(const frames *f, const hdf5_file *file, hsize_t n, bool older)
{
    for (int k = 0; k < FRAME_ARRAYS; k++) {
        const struct array *a = &arrays[k];
        hdf5_rows rows = frame_arrays_rows(f, k);
        if (older && is_older(file, a)) rows.name = flags_of(a);
        if (frame_arrays_is_wanted(f, k)) TRY(hdf5_expect_rows(file, &rows, n * (hsize_t)frame_arrays_count(f, a->of)));
    }
    return DEM_OK;
}
