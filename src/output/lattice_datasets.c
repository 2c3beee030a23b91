/* SPDX-License-Identifier: BSD-3-Clause */
#include "output/lattice_datasets.h"

#include "base/sorted.h"
#include "base/status.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ARRAY(member) offsetof(dem_lattice, member)

const lattice_dataset lattice_dataset_list[LATTICE_DATASETS] = {
    [LATTICE_X] = {"/lattice/x", HDF5_F64, LATTICE_NODES, 2, true, ARRAY(x)},
    [LATTICE_MASS] = {"/lattice/mass", HDF5_F64, LATTICE_NODES, 1, true, ARRAY(mass)},
    [LATTICE_ENDS] = {"/lattice/ends", HDF5_I64, LATTICE_SPRINGS, 2, true, ARRAY(ends)},
    [LATTICE_REST_LENGTH] = {"/lattice/rest_length", HDF5_F64, LATTICE_SPRINGS, 1, true, ARRAY(rest_length)},
    [LATTICE_STIFFNESS] = {"/lattice/stiffness", HDF5_F64, LATTICE_SPRINGS, 1, true, ARRAY(stiffness)},
    [LATTICE_VISCOSITY] = {"/lattice/viscosity", HDF5_F64, LATTICE_SPRINGS, 1, false, ARRAY(viscosity)},
    [LATTICE_CRITICAL_STRETCH] = {"/lattice/critical_stretch", HDF5_F64, LATTICE_SPRINGS, 1, false,
                                  ARRAY(critical_stretch)},
    [LATTICE_CORNERS] = {"/lattice/triangles", HDF5_I64, LATTICE_TRIANGLES, 3, false, ARRAY(triangles)},
    [LATTICE_GUARD] = {"/lattice/guard", HDF5_F64, LATTICE_TRIANGLES, 1, false, ARRAY(guard)},
    [LATTICE_AREA_STIFFNESS] = {"/lattice/area_stiffness", HDF5_F64, LATTICE_TRIANGLES, 1, false,
                                ARRAY(area_stiffness)},
    [LATTICE_THICKNESS] = {"/lattice/thickness", HDF5_F64, LATTICE_TRIANGLES, 1, false, ARRAY(thickness)},
    [LATTICE_MODULUS] = {"/lattice/modulus", HDF5_F64, LATTICE_TRIANGLES, 1, false, ARRAY(modulus)},
    [LATTICE_COUPLING] = {"/lattice/coupling", HDF5_F64, LATTICE_TRIANGLES, 3, false, ARRAY(coupling)},
    [LATTICE_STRENGTH] = {"/lattice/strength", HDF5_F64, LATTICE_TRIANGLES, 1, false, ARRAY(strength)},
    [LATTICE_SOFTENING] = {"/lattice/softening", HDF5_F64, LATTICE_TRIANGLES, 1, false, ARRAY(softening)},
    [LATTICE_COMPRESSIVE_STRENGTH] = {"/lattice/compressive_strength", HDF5_F64, LATTICE_TRIANGLES, 1, false,
                                      ARRAY(compressive_strength)},
    [LATTICE_CONFINEMENT] = {"/lattice/confinement", HDF5_F64, LATTICE_TRIANGLES, 1, false, ARRAY(confinement)},
    [LATTICE_OWN_STRESS] = {"/lattice/own_stress", HDF5_U8, LATTICE_TRIANGLES, 1, false, ARRAY(own_stress)},
    [LATTICE_BODY] = {"/lattice/body", HDF5_I32, LATTICE_NODES, 1, false, ARRAY(body)},
    [LATTICE_POSITION] = {"/lattice/position", HDF5_F64, LATTICE_NODES, 2, false, ARRAY(position)},
    [LATTICE_VELOCITY] = {"/lattice/velocity", HDF5_F64, LATTICE_NODES, 2, false, ARRAY(velocity)},
    [LATTICE_FIXED] = {"/lattice/fixed", HDF5_U8, LATTICE_NODES, 1, false, 0},
    [LATTICE_RIGID] = {"/lattice/rigid", HDF5_U8, LATTICE_NODES, 1, false, 0},
    [LATTICE_CONTACT_NODES] = {"/lattice/contact_nodes", HDF5_I64, LATTICE_ITEMS, 1, false, 0},
};

const unsigned char lattice_rigid_flags[LATTICE_RIGID_KINDS] = {0, DEM_NODE_RIGID, DEM_NODE_RIGID | DEM_NODE_GUIDE_X,
                                                                DEM_NODE_RIGID | DEM_NODE_GUIDE_Y};

/* ---- checks ---- */

/* The number of dimensions and columns must be that of the table, and the rows those of earlier datasets of the same
 * kind. */
static dem_status check_extent(lattice_datasets *d, const lattice_dataset *set, const hdf5_untrusted_shape *shape)
{
    const hsize_t rows = shape->extent[0];
    const int rank = set->width > 1 ? 2 : 1;
    CHECK(shape->rank == rank && (rank == 1 || shape->extent[1] == set->width), DEM_ERROR_IO,
          "%s: %s: is not of shape [n]%s", d->file.path, set->name,
          set->width == 2   ? "[2]"
          : set->width == 3 ? "[3]"
                            : "");
    CHECK(!d->known[set->of] || rows == d->rows[set->of], DEM_ERROR_MODEL,
          "%s: %s: has %llu rows where the datasets before it have %llu", d->file.path, set->name,
          (unsigned long long)rows, (unsigned long long)d->rows[set->of]);
    d->rows[set->of] = rows;
    d->known[set->of] = true;
    return DEM_OK;
}

/* A missing dataset is an error if it is required, unless it is about springs and there are none at all. */
static dem_status measure_one(lattice_datasets *d, int a)
{
    const lattice_dataset *set = &lattice_dataset_list[a];
    hdf5_untrusted_shape shape;
    TRY(hdf5_untrusted_find(&d->file, set->name, &d->present[a]));
    if (!d->present[a] && set->required && (set->of != LATTICE_SPRINGS || d->has_springs))
        return hdf5_untrusted_refuse(&d->file, set->name, "is missing");
    if (!d->present[a]) return DEM_OK;
    TRY(hdf5_untrusted_measure(&d->file, set->name, set->kind, &shape));
    d->unit[a] = shape.unit;
    return check_extent(d, set, &shape);
}

/* A dataset of an unknown name is probably a misspelt one, and what it holds would be ignored without notice: it is
 * refused, with the names that are known. */
static dem_status check_name(void *context, const char *name)
{
    lattice_datasets *d = context;
    char known[512] = "", printable[HDF5_UNTRUSTED_PRINTABLE];
    size_t n = 0;
    for (int a = 0; a < LATTICE_DATASETS; a++) {
        const char *own = lattice_dataset_list[a].name + sizeof "/lattice";
        if (strcmp(name, own) == 0) {
            /* From now on the required datasets of springs are. */
            d->has_springs |= lattice_dataset_list[a].of == LATTICE_SPRINGS;
            return DEM_OK;
        }
        n += (size_t)snprintf(known + n, sizeof known - n, "%s%s", a == 0 ? "" : ", ", own);
    }
    hdf5_untrusted_print(printable, name);
    return status_fail(DEM_ERROR_IO, "%s: /lattice/%s: is none of the datasets of a lattice: %s", d->file.path,
                       printable, known);
}

/* All names are looked at before any dataset is: whether there are springs decides which ones are required. */
static dem_status measure(lattice_datasets *d)
{
    bool present = false;
    TRY(hdf5_untrusted_find(&d->file, "/lattice", &present));
    if (!present) return hdf5_untrusted_refuse(&d->file, "/lattice", "is missing");
    TRY(hdf5_untrusted_list(&d->file, "/lattice", check_name, d));
    for (int a = 0; a < LATTICE_DATASETS; a++) TRY(measure_one(d, a));
    /* Guard, area stiffness and the like need triangles to belong to. */
    for (int a = 0; a < LATTICE_DATASETS; a++)
        if (lattice_dataset_list[a].of == LATTICE_TRIANGLES && d->present[a] && !d->present[LATTICE_CORNERS])
            return hdf5_untrusted_refuse(&d->file, lattice_dataset_list[a].name, "is there without triangles");
    CHECK(d->rows[LATTICE_NODES] > 0, DEM_ERROR_MODEL, "%s: /lattice/x: has no nodes", d->file.path);
    for (int of = 0; of < LATTICE_ITEMS; of++) d->n[of] = (dem_index)d->rows[of];
    return DEM_OK;
}

dem_status lattice_datasets_open(lattice_datasets *d, const char *path)
{
    TRY(hdf5_untrusted_open(&d->file, path));
    const dem_status status = measure(d);
    return status == DEM_OK ? DEM_OK : hdf5_close(&d->file, status);
}

void lattice_datasets_free(lattice_datasets *d)
{
    for (int a = 0; a < LATTICE_DATASETS; a++) free(d->data[a]);
}

/* lattice_check() and the like do not know the file. */
dem_status lattice_datasets_refuse(const lattice_datasets *d)
{
    char reason[256];
    (void)snprintf(reason, sizeof reason, "%s", dem_status_message());
    return status_fail(DEM_ERROR_MODEL, "%s: /lattice: %s", d->file.path, reason);
}

/* ---- rows ---- */

/* Bytes of a row in memory, of numbers as hdf5_memory_type() has them. */
static size_t size_of_row(const lattice_dataset *set)
{
    return (size_t)set->width * (set->kind == HDF5_U8 ? 1 : set->kind == HDF5_I32 ? 4 : 8);
}

/* A whole number of units. */
static hsize_t piece_of(const lattice_datasets *d, int a)
{
    const hsize_t unit = d->unit[a];
    return unit < LATTICE_PIECE ? LATTICE_PIECE / unit * unit : unit;
}

bool lattice_datasets_next(const lattice_datasets *d, int a, hdf5_untrusted_rows *piece)
{
    const hsize_t rows = d->rows[lattice_dataset_list[a].of], most = piece_of(d, a);
    const hsize_t first = piece->first + piece->count;
    *piece = (hdf5_untrusted_rows){first, rows - first < most ? rows - first : most, 0};
    return piece->count > 0;
}

void *lattice_datasets_room(const lattice_datasets *d, int a)
{
    hdf5_untrusted_rows first = {0};
    (void)lattice_datasets_next(d, a, &first); /* none is longer */
    return lattice_zeros((dem_index)first.count, size_of_row(&lattice_dataset_list[a]));
}

/* How many rows of a list are in the same piece of the file as the first of them. */
static dem_index count_in_piece(const lattice_datasets *d, int a, const dem_index *number, dem_index n)
{
    const dem_index most = (dem_index)piece_of(d, a);
    return sorted_first(number, n, (number[0] / most + 1) * most);
}

/* From the first row of a list to the last, which are in one piece. */
static dem_status read_some(const lattice_datasets *d, int a, const dem_index *number, dem_index n, char *to,
                            char *room)
{
    const lattice_dataset *set = &lattice_dataset_list[a];
    const size_t size = size_of_row(set);
    const hdf5_untrusted_rows span = {(hsize_t)number[0], (hsize_t)(number[n - 1] - number[0] + 1), 0};
    TRY(hdf5_untrusted_read(&d->file, set->name, set->kind, span, room));
    for (dem_index k = 0; k < n; k++)
        memcpy(to + (size_t)k * size, room + (size_t)(number[k] - number[0]) * size, size);
    return DEM_OK;
}

static dem_status read_list(const lattice_datasets *d, int a, char *to)
{
    const lattice_items of = lattice_dataset_list[a].of;
    const size_t size = size_of_row(&lattice_dataset_list[a]);
    dem_status status = DEM_OK;
    char *room = lattice_datasets_room(d, a);
    CHECK_MEMORY(room);
    for (dem_index k = 0, n; status == DEM_OK && k < d->n[of]; k += n) {
        n = count_in_piece(d, a, d->taken[of] + k, d->n[of] - k);
        status = read_some(d, a, d->taken[of] + k, n, to + (size_t)k * size, room);
    }
    free(room);
    return status;
}

/* The size has been checked against the file by then, so that it is safe to allocate it. */
static dem_status read_one(lattice_datasets *d, int a)
{
    const lattice_dataset *set = &lattice_dataset_list[a];
    const hdf5_untrusted_rows all = {0, d->rows[set->of], 0};
    d->data[a] = lattice_zeros(d->n[set->of], size_of_row(set));
    CHECK_MEMORY(d->data[a]);
    if (d->n[set->of] < (dem_index)all.count) return read_list(d, a, d->data[a]);
    return hdf5_untrusted_read(&d->file, set->name, set->kind, all, d->data[a]);
}

dem_status lattice_datasets_read(lattice_datasets *d)
{
    for (int a = 0; a < LATTICE_CONTACT_NODES; a++)
        if (d->present[a] && d->data[a] == NULL) TRY(read_one(d, a));
    return DEM_OK;
}

/* ---- from rows to a lattice ---- */

void lattice_datasets_give(lattice_datasets *d, dem_lattice *lattice)
{
    lattice->n_nodes = d->n[LATTICE_NODES];
    lattice->n_springs = d->n[LATTICE_SPRINGS];
    lattice->n_triangles = d->n[LATTICE_TRIANGLES];
    for (int a = 0; a < LATTICE_FIXED; a++) {
        memcpy((char *)lattice + lattice_dataset_list[a].offset, &d->data[a], sizeof d->data[a]);
        d->data[a] = NULL;
    }
}

/* Node numbers of the file are checked before they index anything. */
static dem_status mark_listed(const lattice_datasets *d, dem_lattice *lattice, const hdf5_untrusted_rows *piece,
                              const dem_index *nodes)
{
    const dem_index n_nodes = (dem_index)d->rows[LATTICE_NODES], *taken = d->taken[LATTICE_NODES];
    for (hsize_t k = 0; k < piece->count; k++) {
        CHECK(nodes[k] >= 0 && nodes[k] < n_nodes, DEM_ERROR_MODEL,
              "%s: %s: entry %llu is %lld, which is no node: there are %lld", d->file.path,
              lattice_dataset_list[LATTICE_CONTACT_NODES].name, (unsigned long long)(piece->first + k),
              (long long)nodes[k], (long long)n_nodes);
        const dem_index i = taken != NULL ? sorted_find(taken, d->n[LATTICE_NODES], nodes[k]) : nodes[k];
        if (i >= 0) lattice->flags[i] |= DEM_NODE_CONTACT;
    }
    return DEM_OK;
}

static dem_status mark_list(const lattice_datasets *d, dem_lattice *lattice)
{
    const lattice_dataset *set = &lattice_dataset_list[LATTICE_CONTACT_NODES];
    hdf5_untrusted_rows piece = {0};
    dem_status status = DEM_OK;
    dem_index *nodes = lattice_datasets_room(d, LATTICE_CONTACT_NODES);
    CHECK_MEMORY(nodes);
    while (status == DEM_OK && lattice_datasets_next(d, LATTICE_CONTACT_NODES, &piece)) {
        status = hdf5_untrusted_read(&d->file, set->name, set->kind, piece, nodes);
        if (status == DEM_OK) status = mark_listed(d, lattice, &piece, nodes);
    }
    free(nodes);
    return status;
}

/* Whether only what is not taken has triangles. */
static bool lacks_triangles(const lattice_datasets *d)
{
    return d->n[LATTICE_TRIANGLES] == 0 && d->rows[LATTICE_TRIANGLES] > 0;
}

/* A list of contact nodes that is missing stands for the boundary. */
static dem_status mark_contacts(const lattice_datasets *d, dem_lattice *lattice)
{
    if (d->present[LATTICE_CONTACT_NODES]) return mark_list(d, lattice);
    return lacks_triangles(d) ? DEM_OK : mesh_edges_contact_flags(lattice->flags, lattice);
}

static dem_status mark_rigid(const lattice_datasets *d, dem_lattice *lattice)
{
    const unsigned char *rigid = d->data[LATTICE_RIGID];
    const dem_index *taken = d->taken[LATTICE_NODES];
    for (dem_index i = 0; rigid != NULL && i < lattice->n_nodes; i++) {
        CHECK(rigid[i] < LATTICE_RIGID_KINDS, DEM_ERROR_MODEL, "%s: %s: entry %lld is %d, which is not in 0 to %d",
              d->file.path, lattice_dataset_list[LATTICE_RIGID].name, (long long)(taken != NULL ? taken[i] : i),
              rigid[i], LATTICE_RIGID_KINDS - 1);
        lattice->flags[i] |= lattice_rigid_flags[rigid[i]];
    }
    return DEM_OK;
}

dem_status lattice_datasets_flags(const lattice_datasets *d, dem_lattice *lattice)
{
    const unsigned char *fixed = d->data[LATTICE_FIXED];
    const bool has_flags = fixed != NULL || d->data[LATTICE_RIGID] != NULL || d->present[LATTICE_CONTACT_NODES];
    if (!has_flags && !lacks_triangles(d)) return DEM_OK;
    lattice->flags = lattice_zeros(lattice->n_nodes, 1);
    CHECK_MEMORY(lattice->flags);
    TRY(mark_contacts(d, lattice));
    for (dem_index i = 0; fixed != NULL && i < lattice->n_nodes; i++)
        if (fixed[i] != 0) lattice->flags[i] |= DEM_NODE_FIXED;
    return mark_rigid(d, lattice);
}
