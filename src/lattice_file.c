/* SPDX-License-Identifier: BSD-3-Clause */
/* The group /lattice of an HDF5 file. It may come from anywhere: nothing is allocated unchecked. */
#include "lattice_file.h"

#include "lattice.h"
#include "sides.h"
#include "status.h"

#include <dem/trajectory.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum rows_of { NODES, SPRINGS, TRIANGLES, ANY, N_ROWS_OF };
enum array {
    X,
    MASS,
    ENDS,
    REST_LENGTH,
    STIFFNESS,
    VISCOSITY,
    CORNERS,
    GUARD,
    AREA_STIFFNESS,
    THICKNESS,
    MODULUS,
    BODY,
    POSITION,
    VELOCITY,
    FIXED,
    CONTACT_NODES,
    N_ARRAYS
};

/* The first dataset of each length decides it. Without springs their datasets may all be absent. */
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
    [CORNERS] = {"/lattice/triangles", HDF5_I64, TRIANGLES, 3, 0},
    [GUARD] = {"/lattice/guard", HDF5_F64, TRIANGLES, 1, 0},
    [AREA_STIFFNESS] = {"/lattice/area_stiffness", HDF5_F64, TRIANGLES, 1, 0},
    [THICKNESS] = {"/lattice/thickness", HDF5_F64, TRIANGLES, 1, 0},
    [MODULUS] = {"/lattice/modulus", HDF5_F64, TRIANGLES, 1, 0},
    [BODY] = {"/lattice/body", HDF5_I32, NODES, 1, 0},
    [POSITION] = {"/lattice/position", HDF5_F64, NODES, 2, 0},
    [VELOCITY] = {"/lattice/velocity", HDF5_F64, NODES, 2, 0},
    [FIXED] = {"/lattice/fixed", HDF5_U8, NODES, 1, 0},
    [CONTACT_NODES] = {"/lattice/contact_nodes", HDF5_I64, ANY, 1, 0},
};

/* Larger than any lattice, small enough that sizes in bytes do not overflow. */
static const hsize_t most_rows = (hsize_t)1 << 40;

/* Deflate makes nothing shorter than by this factor. */
static const hsize_t most_deflation = 1032;

typedef struct reader {
    hdf5_file file;
    hsize_t rows[N_ROWS_OF]; /* valid once `known` */
    int known[N_ROWS_OF];
    int springs; /* one of their datasets is there */
    int measure; /* nothing but extents is wanted */
    int present[N_ARRAYS];
    void *data[N_ARRAYS];
} reader;

/* ---- checks ---- */

static size_t item_size(hdf5_kind kind)
{
    return kind == HDF5_U8 ? 1 : kind == HDF5_I32 ? 4 : 8;
}

static dem_status refuse(const reader *r, const char *name, const char *reason)
{
    return status_fail(DEM_ERROR_IO, "%s: %s: %s", r->file.path, name, reason);
}

/* As h5py stores it: an enumeration of FALSE = 0 and TRUE = 1. */
static int is_boolean(hid_t type)
{
    signed char no = -1, yes = -1;
    if (H5Tget_class(type) != H5T_ENUM || H5Tget_size(type) != 1 || H5Tget_nmembers(type) != 2) return 0;
    return H5Tenum_valueof(type, "FALSE", &no) >= 0 && H5Tenum_valueof(type, "TRUE", &yes) >= 0 && no == 0 && yes == 1;
}

static dem_status check_type(const reader *r, const struct dataset *d, hid_t type)
{
    const H5T_class_t class = H5Tget_class(type);
    const int number = d->kind == HDF5_F64, flag = d->kind == HDF5_U8;
    const int fits = class == H5T_INTEGER || (number && class == H5T_FLOAT) || (flag && is_boolean(type));
    if (fits && H5Tget_size(type) <= 16) return DEM_OK;
    return refuse(r, d->name,
                  number ? "is neither floating-point nor integer"
                  : flag ? "is neither integer nor boolean"
                         : "is not integer");
}

static dem_status check_filters(const reader *r, const struct dataset *d, hid_t layout)
{
    const int n = H5Pget_nfilters(layout);
    int deflates = 0;
    for (int k = 0; k < n; k++) {
        size_t n_values = 0;
        unsigned flags = 0;
        const H5Z_filter_t filter = H5Pget_filter2(layout, (unsigned)k, &flags, &n_values, NULL, 0, NULL, NULL);
        deflates += filter == H5Z_FILTER_DEFLATE;
        if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_FLETCHER32)
            return refuse(r, d->name, "uses a filter other than deflate, shuffle and fletcher32");
    }
    return n < 0 || deflates > 1 ? refuse(r, d->name, "has filters that cannot be told") : DEM_OK;
}

/* Sizes are only believed as far as the bytes in the file bear them out. */
static dem_status check_storage(const reader *r, const struct dataset *d, hid_t dataset, hsize_t bytes)
{
    const hid_t layout = H5Dget_create_plist(dataset);
    const H5D_layout_t kind = H5Pget_layout(layout);
    dem_status status;
    hsize_t in_file = 0;
    (void)H5Fget_filesize(r->file.id, &in_file);
    const hsize_t stored = H5Dget_storage_size(dataset);
    if (H5Pget_external_count(layout) != 0)
        status = refuse(r, d->name, "keeps its data in an external file");
    else if (kind != H5D_COMPACT && kind != H5D_CONTIGUOUS && kind != H5D_CHUNKED)
        status = refuse(r, d->name, "has a virtual or unknown layout");
    else if ((status = check_filters(r, d, layout)) == DEM_OK &&
             (stored > in_file || bytes / most_deflation > stored || (bytes > 0 && stored == 0)))
        status = refuse(r, d->name, "claims more data than the file holds");
    (void)H5Pclose(layout);
    return status;
}

static dem_status check_extent(reader *r, const struct dataset *d, hid_t dataset)
{
    hsize_t extent[2] = {0, 1};
    const int rank = d->width > 1 ? 2 : 1;
    const hid_t space = H5Dget_space(dataset);
    const int simple = H5Sget_simple_extent_type(space) == H5S_SIMPLE && H5Sget_simple_extent_ndims(space) == rank;
    if (simple) (void)H5Sget_simple_extent_dims(space, extent, NULL);
    (void)H5Sclose(space);
    CHECK(simple && extent[1] == d->width, DEM_ERROR_IO, "%s: %s: is not of shape [n]%s", r->file.path, d->name,
          d->width == 2   ? "[2]"
          : d->width == 3 ? "[3]"
                          : "");
    if (extent[0] > most_rows) return refuse(r, d->name, "has more than 2^40 rows");
    CHECK(!r->known[d->of] || extent[0] == r->rows[d->of], DEM_ERROR_MODEL,
          "%s: %s: has %llu rows where the datasets before it have %llu", r->file.path, d->name,
          (unsigned long long)extent[0], (unsigned long long)r->rows[d->of]);
    r->rows[d->of] = extent[0];
    r->known[d->of] = d->of != ANY;
    return DEM_OK;
}

static dem_status check_dataset(reader *r, const struct dataset *d, hid_t dataset)
{
    const hid_t type = H5Dget_type(dataset);
    const dem_status status = check_type(r, d, type);
    const hsize_t size = H5Tget_size(type);
    (void)H5Tclose(type);
    TRY(status);
    TRY(check_extent(r, d, dataset));
    return check_storage(r, d, dataset, r->rows[d->of] * d->width * size);
}

/* ---- reading ---- */

/* A number that does not fit is an error, not the nearest number that does. */
static H5T_conv_ret_t on_conversion(H5T_conv_except_t exception, hid_t from, hid_t to, void *value, void *result,
                                    void *context)
{
    (void)from, (void)to, (void)value, (void)result, (void)context;
    return exception == H5T_CONV_EXCEPT_RANGE_HI || exception == H5T_CONV_EXCEPT_RANGE_LOW ? H5T_CONV_ABORT
                                                                                           : H5T_CONV_UNHANDLED;
}

static dem_status read_data(reader *r, enum array a, hid_t dataset)
{
    const struct dataset *d = &datasets[a];
    r->data[a] = lattice_zeros((dem_index)(r->rows[d->of] * d->width), item_size(d->kind));
    CHECK_MEMORY(r->data[a]);
    if (r->rows[d->of] == 0) return DEM_OK;
    const hid_t transfer = H5Pcreate(H5P_DATASET_XFER);
    (void)H5Pset_type_conv_cb(transfer, on_conversion, NULL);
    dem_status status = DEM_OK;
    if (H5Dread(dataset, hdf5_memory_type(d->kind), H5S_ALL, H5S_ALL, transfer, r->data[a]) < 0)
        status = hdf5_fail(&r->file, d->name, "cannot be read");
    (void)H5Pclose(transfer);
    return status;
}

/* Soft and external links could lead anywhere. */
static dem_status check_link(const reader *r, const char *name, int *present)
{
    H5L_info_t info;
    *present = H5Lexists(r->file.id, name, H5P_DEFAULT) > 0;
    if (*present && (H5Lget_info(r->file.id, name, &info, H5P_DEFAULT) < 0 || info.type != H5L_TYPE_HARD))
        return refuse(r, name, "is a soft or external link");
    return DEM_OK;
}

static dem_status read_array(reader *r, enum array a)
{
    const struct dataset *d = &datasets[a];
    TRY(check_link(r, d->name, &r->present[a]));
    if (!r->present[a])
        return d->required && (d->of != SPRINGS || r->springs) ? refuse(r, d->name, "is missing") : DEM_OK;
    const hid_t dataset = H5Dopen2(r->file.id, d->name, H5P_DEFAULT);
    if (dataset < 0) return hdf5_fail(&r->file, d->name, "is not a readable dataset");
    dem_status status = check_dataset(r, d, dataset);
    if (status == DEM_OK && !r->measure) status = read_data(r, a, dataset);
    (void)H5Dclose(dataset);
    return status;
}

/* A name that is not known is a misspelt one, and what it holds would be missed without a word. */
static herr_t check_name(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
    reader *r = context;
    char known[192] = "", printable[41];
    size_t n = 0;
    (void)group, (void)info;
    for (int a = 0; a < N_ARRAYS; a++) {
        const char *own = datasets[a].name + sizeof "/lattice";
        if (strcmp(name, own) == 0) {
            r->springs |= datasets[a].of == SPRINGS;
            return 0;
        }
        n += (size_t)snprintf(known + n, sizeof known - n, "%s%s", a == 0 ? "" : ", ", own);
    }
    for (n = 0; n + 1 < sizeof printable && name[n] != '\0'; n++)
        printable[n] = name[n] > ' ' && name[n] <= '~' ? name[n] : '?';
    printable[n] = '\0';
    (void)status_fail(DEM_ERROR_IO, "%s: /lattice/%s: is none of the datasets of a lattice: %s", r->file.path,
                      printable, known);
    return 1;
}

/* In no order: to sort the names of a damaged group, HDF5 1.10 frees what it has not allocated. */
static dem_status check_names(reader *r)
{
    const hid_t group = H5Gopen2(r->file.id, "/lattice", H5P_DEFAULT);
    if (group < 0) return hdf5_fail(&r->file, "/lattice", "is not a readable group");
    const herr_t stopped = H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, check_name, r);
    const dem_status status = stopped < 0   ? hdf5_fail(&r->file, "/lattice", "cannot be listed")
                              : stopped > 0 ? DEM_ERROR_IO
                                            : DEM_OK;
    (void)H5Gclose(group);
    return status;
}

static dem_status read_arrays(reader *r)
{
    int present = 0;
    TRY(check_link(r, "/lattice", &present));
    if (!present) return refuse(r, "/lattice", "is missing");
    TRY(check_names(r));
    for (int a = 0; a < N_ARRAYS; a++) TRY(read_array(r, (enum array)a));
    for (int a = 0; a < N_ARRAYS; a++)
        if (datasets[a].of == TRIANGLES && r->present[a] && !r->present[CORNERS])
            return refuse(r, datasets[a].name, "is there without triangles");
    return DEM_OK;
}

/* ---- from arrays to a lattice ---- */

static dem_status mark_contacts(const reader *r, dem_lattice *lattice)
{
    const dem_index *nodes = r->data[CONTACT_NODES];
    if (nodes == NULL) return sides_contact_flags(lattice->flags, lattice);
    for (hsize_t k = 0; k < r->rows[ANY]; k++) {
        CHECK(nodes[k] >= 0 && nodes[k] < lattice->n_nodes, DEM_ERROR_MODEL,
              "%s: %s: entry %llu is %lld, which is no node: there are %lld", r->file.path,
              datasets[CONTACT_NODES].name, (unsigned long long)k, (long long)nodes[k], (long long)lattice->n_nodes);
        lattice->flags[nodes[k]] |= DEM_NODE_CONTACT;
    }
    return DEM_OK;
}

static dem_status make_flags(const reader *r, dem_lattice *lattice)
{
    const unsigned char *fixed = r->data[FIXED];
    if (fixed == NULL && r->data[CONTACT_NODES] == NULL) return DEM_OK;
    lattice->flags = lattice_zeros(lattice->n_nodes, 1);
    CHECK_MEMORY(lattice->flags);
    TRY(mark_contacts(r, lattice));
    for (dem_index i = 0; fixed != NULL && i < lattice->n_nodes; i++)
        if (fixed[i] != 0) lattice->flags[i] |= DEM_NODE_FIXED;
    return DEM_OK;
}

/* Moves the arrays. */
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
    lattice->triangles = r->data[CORNERS];
    lattice->guard = r->data[GUARD];
    lattice->area_stiffness = r->data[AREA_STIFFNESS];
    lattice->thickness = r->data[THICKNESS];
    lattice->modulus = r->data[MODULUS];
    lattice->body = r->data[BODY];
    lattice->position = r->data[POSITION];
    lattice->velocity = r->data[VELOCITY];
    for (int a = 0; a < FIXED; a++) r->data[a] = NULL;
}

static dem_status check_indices(const dem_lattice *lattice, const char *path)
{
    char reason[256];
    CHECK(lattice->n_nodes > 0, DEM_ERROR_MODEL, "%s: /lattice/x: has no nodes", path);
    if (lattice_check(lattice) == DEM_OK) return DEM_OK;
    (void)snprintf(reason, sizeof reason, "%s", dem_status_message());
    return status_fail(DEM_ERROR_MODEL, "%s: /lattice: %s", path, reason);
}

static dem_status read_file(reader *r, const char *path)
{
    struct stat kind;
    CHECK(stat(path, &kind) != 0 || S_ISREG(kind.st_mode), DEM_ERROR_IO, "%s: is not a regular file", path);
    TRY(hdf5_open_read(&r->file, path));
    return hdf5_close(&r->file, read_arrays(r));
}

dem_status dem_lattice_read(dem_lattice *out, const char *path)
{
    reader r = {0};
    dem_lattice lattice;
    CHECK(out != NULL && path != NULL, DEM_ERROR_ARGUMENT, "dem_lattice_read: an argument is NULL");
    dem_lattice_init(&lattice);
    dem_status status = read_file(&r, path);
    if (status != DEM_OK) goto out;
    fill(&lattice, &r);
    status = check_indices(&lattice, path);
    if (status == DEM_OK) status = make_flags(&r, &lattice);
    if (status == DEM_OK)
        *out = lattice;
    else
        dem_lattice_free(&lattice);
out:
    for (int a = 0; a < N_ARRAYS; a++) free(r.data[a]);
    return status;
}

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

static dem_status write_array(const hdf5_file *file, enum array a, int deflate, dem_index count, const void *data)
{
    const struct dataset *d = &datasets[a];
    const hdf5_rows rows = {d->name, d->kind, d->width > 1 ? 2 : 1, {d->width}, 0, deflate};
    return data != NULL || d->required ? hdf5_write(file, rows, (hsize_t)count, data) : DEM_OK;
}

static dem_status write_flags(const hdf5_file *file, const dem_lattice *lattice, int deflate)
{
    dem_status status = DEM_ERROR_MEMORY;
    dem_index n_contacts = 0;
    unsigned char *fixed = malloc((size_t)lattice->n_nodes);
    dem_index *contacts = malloc((size_t)lattice->n_nodes * sizeof *contacts);
    if (fixed == NULL || contacts == NULL) {
        (void)status_fail(status, "out of memory");
        goto out;
    }
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        fixed[i] = (lattice->flags[i] & DEM_NODE_FIXED) != 0;
        if (lattice->flags[i] & DEM_NODE_CONTACT) contacts[n_contacts++] = i;
    }
    status = write_array(file, FIXED, deflate, lattice->n_nodes, fixed);
    if (status == DEM_OK) status = write_array(file, CONTACT_NODES, deflate, n_contacts, contacts);
out:
    free(contacts);
    free(fixed);
    return status;
}

dem_status lattice_file_write(const hdf5_file *file, const dem_lattice *lattice, int deflate)
{
    const dem_index n = lattice->n_nodes, m = lattice->n_springs, t = lattice->n_triangles;
    TRY(write_array(file, X, deflate, n, lattice->x));
    TRY(write_array(file, MASS, deflate, n, lattice->mass));
    TRY(write_array(file, ENDS, deflate, m, lattice->ends));
    TRY(write_array(file, REST_LENGTH, deflate, m, lattice->rest_length));
    TRY(write_array(file, STIFFNESS, deflate, m, lattice->stiffness));
    TRY(write_array(file, VISCOSITY, deflate, m, lattice->viscosity));
    TRY(write_array(file, CORNERS, deflate, t, lattice->triangles));
    TRY(write_array(file, GUARD, deflate, t, lattice->guard));
    TRY(write_array(file, AREA_STIFFNESS, deflate, t, lattice->area_stiffness));
    TRY(write_array(file, THICKNESS, deflate, t, lattice->thickness));
    TRY(write_array(file, MODULUS, deflate, t, lattice->modulus));
    TRY(write_array(file, BODY, deflate, n, lattice->body));
    TRY(write_array(file, POSITION, deflate, n, lattice->position));
    TRY(write_array(file, VELOCITY, deflate, n, lattice->velocity));
    return lattice->flags != NULL ? write_flags(file, lattice, deflate) : DEM_OK;
}
