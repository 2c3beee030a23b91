/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /lattice of an HDF5 file: a lattice to start from, written by this library or by anybody else
 * (docs/output.md, /lattice). One table lists the datasets; reading, checking and writing go through it. A file may
 * come from anywhere, so it is read in this order:
 *   1. the names in the group: an unknown one is refused
 *   2. each dataset's link, type and shape (hdf5_untrusted.c), and that its rows agree with those of earlier ones
 *   3. its numbers, into an array of that size
 *   4. node numbers in springs, triangles and the list of contact nodes, before anything uses them
 * Whether the lattice can move is not checked here but in model/model.c. */
#include "output/lattice_file.h"

#include "base/status.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"
#include "output/hdf5_untrusted.h"

#include <dem/trajectory.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a dataset has a row of. ANY: a length of its own. */
enum rows_of { NODES, SPRINGS, TRIANGLES, ANY, N_ROWS_OF };
enum array {
    X,
    MASS,
    ENDS,
    REST_LENGTH,
    STIFFNESS,
    VISCOSITY,
    CRITICAL_STRETCH,
    CORNERS,
    GUARD,
    AREA_STIFFNESS,
    THICKNESS,
    MODULUS,
    COUPLING,
    STRENGTH,
    SOFTENING,
    COMPRESSIVE_STRENGTH,
    CONFINEMENT,
    OWN_STRESS,
    BODY,
    POSITION,
    VELOCITY,
    FIXED,
    RIGID,
    CONTACT_NODES,
    N_ARRAYS
};

/* The datasets, in the order in which they are read. The first one of each length decides it, and later ones must
 * agree. Without springs all their datasets may be absent. */
static const struct dataset {
    const char *name;
    hdf5_kind kind;
    enum rows_of of;
    hsize_t width;
    int required;
} datasets[N_ARRAYS] = {
    [X] = {"/lattice/x", HDF5_F64, NODES, 2, 1},
    [MASS] = {"/lattice/mass", HDF5_F64, NODES, 1, 1},
    [ENDS] = {"/lattice/ends", HDF5_I64, SPRINGS, 2, 1},
    [REST_LENGTH] = {"/lattice/rest_length", HDF5_F64, SPRINGS, 1, 1},
    [STIFFNESS] = {"/lattice/stiffness", HDF5_F64, SPRINGS, 1, 1},
    [VISCOSITY] = {"/lattice/viscosity", HDF5_F64, SPRINGS, 1, 0},
    [CRITICAL_STRETCH] = {"/lattice/critical_stretch", HDF5_F64, SPRINGS, 1, 0},
    [CORNERS] = {"/lattice/triangles", HDF5_I64, TRIANGLES, 3, 0},
    [GUARD] = {"/lattice/guard", HDF5_F64, TRIANGLES, 1, 0},
    [AREA_STIFFNESS] = {"/lattice/area_stiffness", HDF5_F64, TRIANGLES, 1, 0},
    [THICKNESS] = {"/lattice/thickness", HDF5_F64, TRIANGLES, 1, 0},
    [MODULUS] = {"/lattice/modulus", HDF5_F64, TRIANGLES, 1, 0},
    [COUPLING] = {"/lattice/coupling", HDF5_F64, TRIANGLES, 3, 0},
    [STRENGTH] = {"/lattice/strength", HDF5_F64, TRIANGLES, 1, 0},
    [SOFTENING] = {"/lattice/softening", HDF5_F64, TRIANGLES, 1, 0},
    [COMPRESSIVE_STRENGTH] = {"/lattice/compressive_strength", HDF5_F64, TRIANGLES, 1, 0},
    [CONFINEMENT] = {"/lattice/confinement", HDF5_F64, TRIANGLES, 1, 0},
    [OWN_STRESS] = {"/lattice/own_stress", HDF5_U8, TRIANGLES, 1, 0},
    [BODY] = {"/lattice/body", HDF5_I32, NODES, 1, 0},
    [POSITION] = {"/lattice/position", HDF5_F64, NODES, 2, 0},
    [VELOCITY] = {"/lattice/velocity", HDF5_F64, NODES, 2, 0},
    [FIXED] = {"/lattice/fixed", HDF5_U8, NODES, 1, 0},
    [RIGID] = {"/lattice/rigid", HDF5_U8, NODES, 1, 0},
    [CONTACT_NODES] = {"/lattice/contact_nodes", HDF5_I64, ANY, 1, 0},
};

/* The work in hand; `data` has an array for each dataset that has been read. */
typedef struct reader {
    hdf5_file file;
    hsize_t rows[N_ROWS_OF]; /* valid once `known` */
    int known[N_ROWS_OF];
    int springs; /* one of their datasets is there */
    int measure; /* nothing but extents is wanted */
    bool present[N_ARRAYS];
    void *data[N_ARRAYS];
} reader;

/* ---- checks ---- */

/* Bytes of a number in memory, as hdf5_memory_type() has them. */
static size_t item_size(hdf5_kind kind)
{
    return kind == HDF5_U8 ? 1 : kind == HDF5_I32 ? 4 : 8;
}

static dem_status refuse(const reader *r, const char *name, const char *reason)
{
    return hdf5_untrusted_refuse(&r->file, name, reason);
}

/* The number of dimensions and columns must be that of the table, and the rows those of earlier datasets of the same
 * kind. */
static dem_status check_extent(reader *r, const struct dataset *d, const hdf5_untrusted_shape *shape)
{
    const hsize_t rows = shape->extent[0];
    const int rank = d->width > 1 ? 2 : 1;
    CHECK(shape->rank == rank && (rank == 1 || shape->extent[1] == d->width), DEM_ERROR_IO,
          "%s: %s: is not of shape [n]%s", r->file.path, d->name,
          d->width == 2   ? "[2]"
          : d->width == 3 ? "[3]"
                          : "");
    CHECK(!r->known[d->of] || rows == r->rows[d->of], DEM_ERROR_MODEL,
          "%s: %s: has %llu rows where the datasets before it have %llu", r->file.path, d->name,
          (unsigned long long)rows, (unsigned long long)r->rows[d->of]);
    r->rows[d->of] = rows;
    r->known[d->of] = d->of != ANY;
    return DEM_OK;
}

/* ---- reading ---- */

/* The size has been checked against the file by then, so that it is safe to allocate it. */
static dem_status read_data(reader *r, enum array a)
{
    const struct dataset *d = &datasets[a];
    const hdf5_untrusted_rows all = {0, r->rows[d->of], 0};
    r->data[a] = lattice_zeros((dem_index)(all.count * d->width), item_size(d->kind));
    CHECK_MEMORY(r->data[a]);
    return hdf5_untrusted_read(&r->file, d->name, d->kind, all, r->data[a]);
}

/* A missing dataset is an error if it is required, unless it is about springs and there are none at all. */
static dem_status read_array(reader *r, enum array a)
{
    const struct dataset *d = &datasets[a];
    hdf5_untrusted_shape shape;
    TRY(hdf5_untrusted_find(&r->file, d->name, &r->present[a]));
    if (!r->present[a])
        return d->required && (d->of != SPRINGS || r->springs) ? refuse(r, d->name, "is missing") : DEM_OK;
    TRY(hdf5_untrusted_measure(&r->file, d->name, d->kind, &shape));
    TRY(check_extent(r, d, &shape));
    return r->measure ? DEM_OK : read_data(r, a);
}

/* A dataset of an unknown name is probably a misspelt one, and what it holds would be ignored without notice: it is
 * refused, with the names that are known. */
static dem_status check_name(void *context, const char *name)
{
    reader *r = context;
    char known[512] = "", printable[HDF5_UNTRUSTED_PRINTABLE];
    size_t n = 0;
    for (int a = 0; a < N_ARRAYS; a++) {
        const char *own = datasets[a].name + sizeof "/lattice";
        if (strcmp(name, own) == 0) {
            /* From now on the required datasets of springs are. */
            r->springs |= datasets[a].of == SPRINGS;
            return DEM_OK;
        }
        n += (size_t)snprintf(known + n, sizeof known - n, "%s%s", a == 0 ? "" : ", ", own);
    }
    hdf5_untrusted_print(printable, name);
    return status_fail(DEM_ERROR_IO, "%s: /lattice/%s: is none of the datasets of a lattice: %s", r->file.path,
                       printable, known);
}

/* All names are looked at before any dataset is read: whether there are springs decides which ones are required. */
static dem_status read_arrays(reader *r)
{
    bool present = false;
    TRY(hdf5_untrusted_find(&r->file, "/lattice", &present));
    if (!present) return refuse(r, "/lattice", "is missing");
    TRY(hdf5_untrusted_list(&r->file, "/lattice", check_name, r));
    for (int a = 0; a < N_ARRAYS; a++) TRY(read_array(r, (enum array)a));
    /* Guard, area stiffness and the like need triangles to belong to. */
    for (int a = 0; a < N_ARRAYS; a++)
        if (datasets[a].of == TRIANGLES && r->present[a] && !r->present[CORNERS])
            return refuse(r, datasets[a].name, "is there without triangles");
    return DEM_OK;
}

/* ---- from arrays to a lattice ---- */

/* A list of contact nodes that is missing stands for the boundary. */
static dem_status mark_contacts(const reader *r, dem_lattice *lattice)
{
    const dem_index *nodes = r->data[CONTACT_NODES];
    if (nodes == NULL) return mesh_edges_contact_flags(lattice->flags, lattice);
    /* Node numbers of the file are checked before they index anything. */
    for (hsize_t k = 0; k < r->rows[ANY]; k++) {
        CHECK(nodes[k] >= 0 && nodes[k] < lattice->n_nodes, DEM_ERROR_MODEL,
              "%s: %s: entry %llu is %lld, which is no node: there are %lld", r->file.path,
              datasets[CONTACT_NODES].name, (unsigned long long)k, (long long)nodes[k], (long long)lattice->n_nodes);
        lattice->flags[nodes[k]] |= DEM_NODE_CONTACT;
    }
    return DEM_OK;
}

/* What the numbers of the dataset of rigid bodies stand for. */
static const unsigned char rigid_flags[] = {0, DEM_NODE_RIGID, DEM_NODE_RIGID | DEM_NODE_GUIDE_X,
                                            DEM_NODE_RIGID | DEM_NODE_GUIDE_Y};
enum { N_RIGID = sizeof rigid_flags };

static dem_status mark_rigid(const reader *r, dem_lattice *lattice)
{
    const unsigned char *rigid = r->data[RIGID];
    for (dem_index i = 0; rigid != NULL && i < lattice->n_nodes; i++) {
        CHECK(rigid[i] < N_RIGID, DEM_ERROR_MODEL, "%s: %s: entry %lld is %d, which is not in 0 to %d", r->file.path,
              datasets[RIGID].name, (long long)i, rigid[i], N_RIGID - 1);
        lattice->flags[i] |= rigid_flags[rigid[i]];
    }
    return DEM_OK;
}

/* Without these datasets the lattice has no flags, which stand for the boundary and nothing fixed or rigid. */
static dem_status make_flags(const reader *r, dem_lattice *lattice)
{
    const unsigned char *fixed = r->data[FIXED];
    if (fixed == NULL && r->data[RIGID] == NULL && r->data[CONTACT_NODES] == NULL) return DEM_OK;
    lattice->flags = lattice_zeros(lattice->n_nodes, 1);
    CHECK_MEMORY(lattice->flags);
    TRY(mark_contacts(r, lattice));
    for (dem_index i = 0; fixed != NULL && i < lattice->n_nodes; i++)
        if (fixed[i] != 0) lattice->flags[i] |= DEM_NODE_FIXED;
    return mark_rigid(r, lattice);
}

/* Moves the arrays: the lattice owns them from here on, and the reader forgets those up to FIXED. */
static void fill(dem_lattice *lattice, reader *r)
{
    lattice->n_nodes = (dem_index)r->rows[NODES];
    lattice->n_springs = (dem_index)r->rows[SPRINGS];
    lattice->n_triangles = (dem_index)r->rows[TRIANGLES];
    lattice->x = r->data[X];
    lattice->mass = r->data[MASS];
    lattice->ends = r->data[ENDS];
    lattice->rest_length = r->data[REST_LENGTH];
    lattice->stiffness = r->data[STIFFNESS];
    lattice->viscosity = r->data[VISCOSITY];
    lattice->critical_stretch = r->data[CRITICAL_STRETCH];
    lattice->strength = r->data[STRENGTH];
    lattice->softening = r->data[SOFTENING];
    lattice->compressive_strength = r->data[COMPRESSIVE_STRENGTH];
    lattice->confinement = r->data[CONFINEMENT];
    lattice->own_stress = r->data[OWN_STRESS];
    lattice->triangles = r->data[CORNERS];
    lattice->guard = r->data[GUARD];
    lattice->area_stiffness = r->data[AREA_STIFFNESS];
    lattice->thickness = r->data[THICKNESS];
    lattice->modulus = r->data[MODULUS];
    lattice->coupling = r->data[COUPLING];
    lattice->body = r->data[BODY];
    lattice->position = r->data[POSITION];
    lattice->velocity = r->data[VELOCITY];
    /* FIXED and what follows it are made into flags and stay with the reader. */
    for (int a = 0; a < FIXED; a++) r->data[a] = NULL;
}

/* lattice_check() does not know the file, so its message gets the path in front. */
static dem_status check_indices(const dem_lattice *lattice, const char *path)
{
    char reason[256];
    CHECK(lattice->n_nodes > 0, DEM_ERROR_MODEL, "%s: /lattice/x: has no nodes", path);
    if (lattice_check(lattice) == DEM_OK) return DEM_OK;
    (void)snprintf(reason, sizeof reason, "%s", dem_status_message());
    return status_fail(DEM_ERROR_MODEL, "%s: /lattice: %s", path, reason);
}

/* The file is open only while it is read. */
static dem_status read_file(reader *r, const char *path)
{
    TRY(hdf5_untrusted_open(&r->file, path));
    return hdf5_close(&r->file, read_arrays(r));
}

/* On failure the arrays are freed by whoever has them at that moment. */
dem_status dem_lattice_read(dem_lattice *out, const char *path)
{
    reader r = {0};
    dem_lattice lattice;
    CHECK(out != NULL && path != NULL, DEM_ERROR_ARGUMENT, "dem_lattice_read: an argument is NULL");
    TRY(lattice_check_out(out));
    lattice = dem_lattice_empty();
    dem_status status = read_file(&r, path);
    if (status != DEM_OK) goto out;
    fill(&lattice, &r);
    status = check_indices(&lattice, path);
    if (status == DEM_OK) status = make_flags(&r, &lattice);
    if (status == DEM_OK)
        lattice_give(out, &lattice);
    else
        dem_lattice_free(&lattice);
out:
    for (int a = 0; a < N_ARRAYS; a++) free(r.data[a]);
    return status;
}

/* Makes all checks of names and shapes, but reads no array. */
dem_status dem_lattice_measure(const char *path, dem_index *n_nodes, dem_index *n_springs)
{
    reader r = {.measure = 1};
    CHECK(path != NULL && n_nodes != NULL && n_springs != NULL, DEM_ERROR_ARGUMENT,
          "dem_lattice_measure: an argument is NULL");
    TRY(read_file(&r, path));
    *n_nodes = (dem_index)r.rows[NODES];
    *n_springs = (dem_index)r.rows[SPRINGS];
    return DEM_OK;
}

/* ---- writing ---- */

/* An optional array that is NULL is left out. All rows are one chunk. */
static dem_status write_array(const hdf5_file *file, enum array a, int deflate, dem_index count, const void *data)
{
    const struct dataset *d = &datasets[a];
    const hdf5_rows rows = {d->name, d->kind, d->width > 1 ? 2 : 1, {d->width}, 0, deflate};
    return data != NULL || d->required ? hdf5_write(file, rows, (hsize_t)count, data) : DEM_OK;
}

/* A byte for each node, if one is of a rigid body. */
static dem_status write_rigid(const hdf5_file *file, const unsigned char *flags, dem_index n, int deflate,
                              unsigned char *rigid)
{
    bool some = false;
    for (dem_index i = 0; i < n; i++) {
        rigid[i] = 0;
        for (int k = 1; k < N_RIGID; k++)
            if ((flags[i] & rigid_flags[k]) == rigid_flags[k]) rigid[i] = (unsigned char)k;
        some = some || rigid[i] != 0;
    }
    return some ? write_array(file, RIGID, deflate, n, rigid) : DEM_OK;
}

/* Flags are stored as a byte for each node that is fixed or not, another for rigid bodies, and the list of nodes that
 * may touch. */
static dem_status write_flags(const hdf5_file *file, const unsigned char *flags, dem_index n, int deflate)
{
    dem_status status = DEM_ERROR_MEMORY;
    dem_index n_contacts = 0;
    unsigned char *fixed = malloc((size_t)n);
    dem_index *contacts = malloc((size_t)n * sizeof *contacts);
    if (fixed == NULL || contacts == NULL) {
        (void)status_fail(status, "out of memory");
        goto out;
    }
    for (dem_index i = 0; i < n; i++) {
        fixed[i] = (flags[i] & DEM_NODE_FIXED) != 0;
        if (flags[i] & DEM_NODE_CONTACT) contacts[n_contacts++] = i;
    }
    status = write_array(file, FIXED, deflate, n, fixed);
    if (status == DEM_OK) status = write_rigid(file, flags, n, deflate, fixed);
    if (status == DEM_OK) status = write_array(file, CONTACT_NODES, deflate, n_contacts, contacts);
out:
    free(contacts);
    free(fixed);
    return status;
}

/* An array that is a dataset as it is. */
static const struct written {
    enum array array;
    size_t member; /* its offset in a dem_lattice */
} written[] = {
    {X, offsetof(dem_lattice, x)},
    {MASS, offsetof(dem_lattice, mass)},
    {ENDS, offsetof(dem_lattice, ends)},
    {REST_LENGTH, offsetof(dem_lattice, rest_length)},
    {STIFFNESS, offsetof(dem_lattice, stiffness)},
    {VISCOSITY, offsetof(dem_lattice, viscosity)},
    {CRITICAL_STRETCH, offsetof(dem_lattice, critical_stretch)},
    {CORNERS, offsetof(dem_lattice, triangles)},
    {GUARD, offsetof(dem_lattice, guard)},
    {AREA_STIFFNESS, offsetof(dem_lattice, area_stiffness)},
    {THICKNESS, offsetof(dem_lattice, thickness)},
    {MODULUS, offsetof(dem_lattice, modulus)},
    {STRENGTH, offsetof(dem_lattice, strength)},
    {SOFTENING, offsetof(dem_lattice, softening)},
    {COMPRESSIVE_STRENGTH, offsetof(dem_lattice, compressive_strength)},
    {CONFINEMENT, offsetof(dem_lattice, confinement)},
    {OWN_STRESS, offsetof(dem_lattice, own_stress)},
    {COUPLING, offsetof(dem_lattice, coupling)},
    {BODY, offsetof(dem_lattice, body)},
    {POSITION, offsetof(dem_lattice, position)},
    {VELOCITY, offsetof(dem_lattice, velocity)},
};

static dem_status write_member(const hdf5_file *file, const struct written *w, const lattice_source *from, int deflate)
{
    const dem_lattice *l = from->lattice;
    const dem_index counts[] = {[NODES] = l->n_nodes, [SPRINGS] = l->n_springs, [TRIANGLES] = l->n_triangles};
    source_array a;
    dem_status status = dem_private_lattice_open(&a, from, w->member);
    if (status == DEM_OK) status = write_array(file, w->array, deflate, counts[datasets[w->array].of], a.items);
    dem_private_lattice_close(&a);
    return status;
}

/* Flags last, since they become several datasets. */
dem_status lattice_file_write(const hdf5_file *file, const lattice_source *from, int deflate)
{
    source_array flags;
    for (size_t k = 0; k < sizeof written / sizeof *written; k++) TRY(write_member(file, &written[k], from, deflate));
    dem_status status = dem_private_lattice_open(&flags, from, offsetof(dem_lattice, flags));
    if (status == DEM_OK && flags.items != NULL)
        status = write_flags(file, flags.items, from->lattice->n_nodes, deflate);
    dem_private_lattice_close(&flags);
    return status;
}
