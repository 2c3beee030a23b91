/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /lattice of an HDF5 file: a lattice to start from, written by this library or by anybody else. */
#include "output/lattice_file.h"

#include "base/status.h"
#include "lattice/lattice.h"
#include "output/chunkwise.h"
#include "output/lattice_datasets.h"

#include <dem/trajectory.h>

#include <stdlib.h>
#include <string.h>

/* ---- reading ---- */

static dem_status read_all(lattice_datasets *d, dem_lattice *lattice)
{
    TRY(lattice_datasets_read(d));
    lattice_datasets_give(d, lattice);
    if (lattice_check(lattice) != DEM_OK) return lattice_datasets_refuse(d);
    return lattice_datasets_flags(d, lattice);
}

/* The file is open only while it is read. */
dem_status dem_lattice_read(dem_lattice *out, const char *path)
{
    lattice_datasets d = {0};
    dem_lattice lattice = dem_lattice_empty();
    CHECK(out != NULL && path != NULL, DEM_ERROR_ARGUMENT, "dem_lattice_read: an argument is NULL");
    TRY(lattice_check_out(out));
    TRY(lattice_datasets_open(&d, path));
    const dem_status status = hdf5_close(&d.file, read_all(&d, &lattice));
    if (status == DEM_OK)
        lattice_give(out, &lattice);
    else
        dem_lattice_free(&lattice);
    lattice_datasets_free(&d);
    return status;
}

/* Makes all checks of names and shapes, but reads no array. */
dem_status dem_lattice_measure(const char *path, dem_index *n_nodes, dem_index *n_springs)
{
    lattice_datasets d = {0};
    CHECK(path != NULL && n_nodes != NULL && n_springs != NULL, DEM_ERROR_ARGUMENT,
          "dem_lattice_measure: an argument is NULL");
    TRY(lattice_datasets_open(&d, path));
    TRY(hdf5_close(&d.file, DEM_OK));
    *n_nodes = d.n[LATTICE_NODES];
    *n_springs = d.n[LATTICE_SPRINGS];
    return DEM_OK;
}

/* ---- writing ---- */

static hdf5_rows rows_of(const lattice_dataset *d, int deflate)
{
    return (hdf5_rows){d->name, d->kind, d->width > 1 ? 2 : 1, {d->width}, LATTICE_PIECE, deflate};
}

static dem_status write_array(const hdf5_file *file, int a, int deflate, dem_index count, const void *data)
{
    return hdf5_write(file, rows_of(&lattice_dataset_list[a], deflate), (hsize_t)count, data);
}

/* A byte for each node, if one is of a rigid body. */
static dem_status write_rigid(const hdf5_file *file, const unsigned char *flags, dem_index n, int deflate,
                              unsigned char *rigid)
{
    bool some = false;
    for (dem_index i = 0; i < n; i++) {
        rigid[i] = 0;
        for (int k = 1; k < LATTICE_RIGID_KINDS; k++)
            if ((flags[i] & lattice_rigid_flags[k]) == lattice_rigid_flags[k]) rigid[i] = (unsigned char)k;
        some = some || rigid[i] != 0;
    }
    return some ? write_array(file, LATTICE_RIGID, deflate, n, rigid) : DEM_OK;
}

/* Flags are stored as a byte for each node that is fixed or not, another for rigid bodies, and the list of nodes that
 * may touch. */
static dem_status write_flags(const hdf5_file *file, const unsigned char *flags, dem_index n, int deflate)
{
    dem_status status = DEM_ERROR_MEMORY;
    dem_index n_contacts = 0, listed = 0;
    for (dem_index i = 0; i < n; i++) n_contacts += (flags[i] & DEM_NODE_CONTACT) != 0;
    unsigned char *fixed = malloc((size_t)n);
    dem_index *contacts = malloc((size_t)(n_contacts + 1) * sizeof *contacts);
    if (fixed == NULL || contacts == NULL) {
        (void)status_fail(status, "out of memory");
        goto out;
    }
    for (dem_index i = 0; i < n; i++) {
        fixed[i] = (flags[i] & DEM_NODE_FIXED) != 0;
        if (flags[i] & DEM_NODE_CONTACT) contacts[listed++] = i;
    }
    status = write_array(file, LATTICE_FIXED, deflate, n, fixed);
    if (status == DEM_OK) status = write_rigid(file, flags, n, deflate, fixed);
    if (status == DEM_OK) status = write_array(file, LATTICE_CONTACT_NODES, deflate, n_contacts, contacts);
out:
    free(contacts);
    free(fixed);
    return status;
}

static dem_status write_member(const hdf5_file *file, int a, const lattice_source *from, int deflate)
{
    const lattice_dataset *d = &lattice_dataset_list[a];
    if (!d->required && !dem_private_lattice_has(from, d->offset)) return DEM_OK;
    return chunkwise_copy(file, rows_of(d, deflate), from, d->offset, lattice_count(from->lattice, d->of), 1);
}

/* Optional arrays that are not there are left out. The others stand in the order of the table; flags are last, since
 * they become several datasets. */
dem_status lattice_file_write(const hdf5_file *file, const lattice_source *from, int deflate)
{
    source_array flags;
    for (int a = 0; a < LATTICE_FIXED; a++) TRY(write_member(file, a, from, deflate));
    dem_status status = dem_private_lattice_open(&flags, from, offsetof(dem_lattice, flags));
    if (status == DEM_OK && flags.items != NULL)
        status = write_flags(file, flags.items, from->lattice->n_nodes, deflate);
    dem_private_lattice_close(&flags);
    return status;
}
