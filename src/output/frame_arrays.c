/* SPDX-License-Identifier: BSD-3-Clause */
/* The table `arrays` is the one list of arrays: making, writing, copying and checking go through it. What is broken is
 * written in every frame, as other arrays are: a segment has the flags of its own frames, whatever is in others, and
 * zeros deflate to a 200th. */
#include "output/frame_arrays.h"

#include "base/status.h"
#include "output/vtk_grid.h"

#include <stdlib.h>
#include <string.h>

/* The dataset of an array, and that of its offsets. */
#define IN(set, name) GRID set "/" name, STEPS "/" set "Offsets/" name

/* ---- from rows of fields to those of arrays ---- */

/* From two components to VTK's three: the plane lies at z = 0 of space. */
static void spread(dem_index n, const void *rows, void *out)
{
    const double *plane = rows;
    double *space = out;
    for (dem_index i = 0; i < n; i++) {
        space[3 * i] = plane[2 * i];
        space[3 * i + 1] = plane[2 * i + 1];
        space[3 * i + 2] = 0.0;
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

static void spread_stress(dem_index n, const void *rows, void *out)
{
    frame_arrays_spread_stress(out, n, rows);
}

static void find_von_mises(dem_index n, const void *rows, void *out)
{
    const double *stress = rows;
    double *value = out;
    for (dem_index i = 0; i < n; i++) value[i] = dem_stress_von_mises(stress + 3 * i);
}

/* The values only; directions are not written. */
static void find_principal(dem_index n, const void *rows, void *out)
{
    double direction[2], *value = out;
    const double *stress = rows;
    for (dem_index i = 0; i < n; i++) dem_stress_principal(stress + 3 * i, value + 2 * i, direction);
}

/* From what is broken to what VTK does not draw. */
static void hide(dem_index n, const void *rows, void *out)
{
    enum { VTK_HIDDEN_CELL = 32 };
    const unsigned char *broken = rows;
    unsigned char *hidden = out;
    for (dem_index k = 0; k < n; k++) hidden[k] = broken[k] != 0 ? VTK_HIDDEN_CELL : 0;
}

/* All arrays that change from frame to frame, those of a field one behind the other. `option` asks for one. */
static const struct array {
    const char *name, *offset; /* offset NULL: outside of the grids */
    uint32_t option;           /* 0: always there */
    hdf5_kind kind;            /* HDF5_F32: as the options say */
    frame_of of;
    int components;
    field_kind field;
    void (*convert)(dem_index n, const void *rows, void *out); /* NULL: rows of the field are those of the array */
} arrays[] = {
    {GRID "Points", STEPS "/PointOffsets", 0, HDF5_F64, FRAME_OF_NODES, 3, FIELD_POSITIONS, spread},
    /* Nodes: what the options choose, in single precision unless they say otherwise. */
    {IN("PointData", "displacement"), DEM_FIELD_DISPLACEMENT, HDF5_F32, FRAME_OF_NODES, 3, FIELD_DISPLACEMENTS, spread},
    {IN("PointData", "velocity"), DEM_FIELD_VELOCITY, HDF5_F32, FRAME_OF_NODES, 3, FIELD_VELOCITIES, spread},
    {IN("PointData", "von_mises"), DEM_FIELD_VON_MISES, HDF5_F32, FRAME_OF_NODES, 1, FIELD_STRESS, find_von_mises},
    {IN("PointData", "principal_stress"), DEM_FIELD_PRINCIPAL, HDF5_F32, FRAME_OF_NODES, 2, FIELD_STRESS,
     find_principal},
    {IN("PointData", "stress"), DEM_FIELD_STRESS, HDF5_F32, FRAME_OF_NODES, 6, FIELD_STRESS, spread_stress},
    {IN("PointData", "contact_force"), DEM_FIELD_CONTACT, HDF5_F32, FRAME_OF_NODES, 3, FIELD_CONTACT_FORCES, spread},
    {IN("PointData", "contact_pressure"), DEM_FIELD_CONTACT, HDF5_F32, FRAME_OF_NODES, 1, FIELD_CONTACT_PRESSURES,
     NULL},
    {IN("PointData", "fragment"), DEM_FIELD_FRAGMENT, HDF5_I64, FRAME_OF_NODES, 1, FIELD_FRAGMENTS, NULL},
    {IN("PointData", "damage"), DEM_FIELD_DAMAGE, HDF5_F32, FRAME_OF_NODES, 1, FIELD_DAMAGE, NULL},
    /* Springs. */
    {IN("CellData", "strain"), DEM_FIELD_STRAIN, HDF5_F32, FRAME_OF_SPRINGS, 1, FIELD_STRAINS, NULL},
    {IN("CellData", "force"), DEM_FIELD_FORCE, HDF5_F32, FRAME_OF_SPRINGS, 1, FIELD_FORCES, NULL},
    {IN("CellData", "broken"), 0, HDF5_U8, FRAME_OF_SPRINGS, 1, FIELD_BROKEN_SPRINGS, NULL},
    {IN("CellData", FRAMES_HIDDEN), 0, HDF5_U8, FRAME_OF_SPRINGS, 1, FIELD_BROKEN_SPRINGS, hide},
    /* Triangles. */
    {FRAMES_BROKEN_TRIANGLES, NULL, 0, HDF5_U8, FRAME_OF_TRIANGLES, 1, FIELD_BROKEN_TRIANGLES, NULL},
    {FRAMES_BODIES "/CellData/" FRAMES_HIDDEN, FRAMES_BODY_STEPS "/CellDataOffsets/" FRAMES_HIDDEN, 0, HDF5_U8,
     FRAME_OF_TRIANGLES, 1, FIELD_BROKEN_TRIANGLES, hide},
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
    return (a->option == 0 || (f->fields & a->option) != 0) && frame_arrays_has(f, a->of);
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

/* A chunk is a frame, so that no frame touches another's. HDF5 takes chunks below 4 GiB: where those of the widest
 * array would be larger, all arrays of as many rows are stored plain, and written in place, as frames share chunks. */
static int deflate_of(const frames *f, frame_of of)
{
    const dem_index widest = (of == FRAME_OF_NODES ? 6 : 1) * (dem_index)sizeof(double);
    return frame_arrays_count(f, of) <= (dem_index)UINT32_MAX / widest ? f->deflate : 0;
}

hdf5_rows frame_arrays_rows(const frames *f, int array)
{
    const struct array *a = &arrays[array];
    /* HDF5_F32 in the table stands for the precision that the options choose. */
    const hdf5_kind kind = a->kind == HDF5_F32 ? f->real : a->kind;
    return (hdf5_rows){a->name,
                       kind,
                       a->components > 1 ? 2 : 1,
                       {(hsize_t)a->components},
                       (hsize_t)frame_arrays_count(f, a->of),
                       deflate_of(f, a->of)};
}

field_kind frame_arrays_field(int array)
{
    return arrays[array].field;
}

const void *frame_arrays_convert(int array, dem_index n, const void *rows, void *room)
{
    if (arrays[array].convert == NULL) return rows;
    arrays[array].convert(n, rows, room);
    return room;
}

/* Bytes of a row in memory. */
size_t frame_arrays_row_bytes(int array)
{
    return (size_t)arrays[array].components * (arrays[array].kind == HDF5_U8 ? 1 : sizeof(double));
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
    if (a->convert != hide) return NULL;
    return a->of == FRAME_OF_SPRINGS ? GRID "CellData/broken" : FRAMES_BROKEN_TRIANGLES;
}

/* Whether the file is of a version that did not write this array yet, which follows from another one. */
static bool is_older(const hdf5_file *file, const struct array *a)
{
    return flags_of(a) != NULL && !hdf5_has(file, a->name);
}

/* Numbers that are unpacked. What is hidden is made of what is broken, where the file has only that. */
static dem_status copy_numbers(const frame_arrays_copying *c, int array, const hdf5_rows *source, hdf5_span rows)
{
    const hdf5_rows target = frame_arrays_rows(c->target, array);
    const bool hides = strcmp(source->name, target.name) != 0;
    void *data = malloc((size_t)rows.count * frame_arrays_row_bytes(array));
    CHECK(data != NULL, DEM_ERROR_MEMORY, "out of memory for %llu rows of a frame", (unsigned long long)rows.count);
    dem_status status = hdf5_read(c->from, source, rows.first, rows.count, data);
    if (status == DEM_OK && hides) hide((dem_index)rows.count, data, data);
    if (status == DEM_OK) status = hdf5_append(c->to, &target, rows.at, rows.count, data);
    free(data);
    return status;
}

/* As it is stored, if both files have it as a chunk. */
static dem_status copy_frame(const frame_arrays_copying *c, int array, hsize_t from, hsize_t to)
{
    const struct array *a = &arrays[array];
    const hsize_t all = (hsize_t)frame_arrays_count(c->whole, a->of);
    const hsize_t n = (hsize_t)frame_arrays_count(c->target, a->of);
    const hdf5_rows target = frame_arrays_rows(c->target, array);
    const hdf5_span rows = {all * from + (hsize_t)c->first[a->of], n, n * to};
    hdf5_rows source = frame_arrays_rows(c->whole, array);
    bool is_done = false;
    if (n == 0) return DEM_OK;
    if (is_older(c->from, a))
        source.name = flags_of(a);
    else
        TRY(hdf5_copy_chunk(c->from, c->to, &source, &target, rows, &is_done));
    return is_done ? DEM_OK : copy_numbers(c, array, &source, rows);
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
