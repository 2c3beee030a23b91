/* SPDX-License-Identifier: BSD-3-Clause */
/* The table `arrays` is the one list of arrays: making, writing, copying and checking go through it. What is broken is
 * written in every frame, as other arrays are: a segment has the flags of its own frames, whatever is in others, and
 * zeros deflate to a 200th. */
#include "output/frame_arrays.h"

#include "base/status.h"
#include "lattice/lattice_source.h"
#include "output/vtk_grid.h"

#include <stdlib.h>
#include <string.h>

/* The dataset of an array, and that of its offsets. */
#define IN(set, name) GRID set "/" name, STEPS "/" set "Offsets/" name

/* Fields for which the stresses of all nodes are needed. */
enum { ANY_STRESS = DEM_FIELD_STRESS | DEM_FIELD_VON_MISES | DEM_FIELD_PRINCIPAL };

/* What is looked at while a frame is written. */
typedef struct view {
    const dem_simulation *simulation;
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

/* VTK's order of a symmetric tensor: xx, yy, zz, xy, yz, xz. */
void frame_arrays_spread_stress(double *out, dem_index n, const double *stress)
{
    for (dem_index i = 0; i < n; i++) {
        const double *s = stress + 3 * i, six[6] = {s[0], s[1], 0.0, s[2], 0.0, 0.0};
        memcpy(out + 6 * i, six, sizeof six);
    }
}

static dem_status fill_points(const frames *f, const view *v)
{
    spread(f->scratch, f->n_nodes, v->state.x, NULL);
    return DEM_OK;
}

/* From the rest position, which need not be where the motion started. */
static dem_status fill_displacement(const frames *f, const view *v)
{
    const lattice_source lattice = dem_private_lattice_source(dem_simulation_model(v->simulation));
    source_array x;
    const dem_status status = dem_private_lattice_open(&x, &lattice, offsetof(dem_lattice, x));
    if (status == DEM_OK) spread(f->scratch, f->n_nodes, v->state.x, x.items);
    dem_private_lattice_close(&x);
    return status;
}

static dem_status fill_velocity(const frames *f, const view *v)
{
    spread(f->scratch, f->n_nodes, v->state.v, NULL);
    return DEM_OK;
}

/* The stresses have been computed before (frame_arrays_hand_out), since several arrays are made of them. */
static dem_status fill_stress(const frames *f, const view *v)
{
    (void)v;
    frame_arrays_spread_stress(f->scratch, f->n_nodes, f->stress);
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
    frame_of of;
    int components;
    dem_status (*fill)(const frames *f, const view *v);
} arrays[] = {
    {GRID "Points", STEPS "/PointOffsets", 0, HDF5_F64, FRAME_OF_NODES, 3, fill_points},
    /* Nodes: what the options choose, in single precision unless they say otherwise. */
    {IN("PointData", "displacement"), DEM_FIELD_DISPLACEMENT, HDF5_F32, FRAME_OF_NODES, 3, fill_displacement},
    {IN("PointData", "velocity"), DEM_FIELD_VELOCITY, HDF5_F32, FRAME_OF_NODES, 3, fill_velocity},
    {IN("PointData", "stress"), DEM_FIELD_STRESS, HDF5_F32, FRAME_OF_NODES, 6, fill_stress},
    {IN("PointData", "von_mises"), DEM_FIELD_VON_MISES, HDF5_F32, FRAME_OF_NODES, 1, fill_von_mises},
    {IN("PointData", "principal_stress"), DEM_FIELD_PRINCIPAL, HDF5_F32, FRAME_OF_NODES, 2, fill_principal},
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
    view v = {simulation, {.struct_size = sizeof v.state}};
    TRY(dem_simulation_state(simulation, &v.state));
    /* Stresses are computed once for all arrays made of them. */
    if (f->fields & ANY_STRESS) TRY(dem_simulation_stress(simulation, f->stress));
    if (f->fields & DEM_FIELD_CONTACT) TRY(dem_simulation_contact_pressures(simulation, f->pressure));
    for (int k = 0; k < FRAME_ARRAYS; k++) {
        if (!frame_arrays_is_wanted(f, k)) continue;
        TRY(arrays[k].fill(f, &v));
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
