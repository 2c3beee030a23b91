/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 files of any datasets where a lattice's are looked for: types, ranks, extents, layouts, filters and links as the
 * bytes say. A lattice that is read has consistent arrays; a model can be made of it, which moves, or is refused. */
#include <dem/trajectory.h>

#include <hdf5.h>

#include "bytes.h"
#include "ask.h"
#include "scratch.h"
#include "slabs.h"

enum { MOST_VALUES = 256, N_NAMES = 19 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* As the reader expects them; the last but one is none of a lattice's. */
static const struct place {
    const char *name;
    unsigned width;
    char of;   /* nodes, springs, triangles, any number */
    char kind; /* x, another real, i: a node, b: a number */
} places[N_NAMES] = {{"x", 2, 'n', 'x'},           {"mass", 1, 'n', 'r'},          {"ends", 2, 's', 'i'},
                     {"rest_length", 1, 's', 'r'}, {"stiffness", 1, 's', 'r'},     {"viscosity", 1, 's', 'r'},
                     {"triangles", 3, 't', 'i'},   {"guard", 1, 't', 'r'},         {"area_stiffness", 1, 't', 'r'},
                     {"thickness", 1, 't', 'r'},   {"modulus", 1, 't', 'r'},       {"coupling", 3, 't', 'r'},
                     {"body", 1, 'n', 'b'},        {"position", 2, 'n', 'x'},      {"velocity", 2, 'n', 'r'},
                     {"fixed", 1, 'n', 'b'},       {"contact_nodes", 1, 'a', 'i'}, {"viscosty", 1, 's', 'r'},
                     {"rigid", 1, 'n', 'b'}};

typedef struct counts {
    hsize_t nodes, springs, triangles;
} counts;

/* ---- types ---- */

static hid_t make_boolean(const char *no, const char *yes, signed char value)
{
    const hid_t type = H5Tenum_create(H5T_STD_I8LE);
    const signed char zero = 0;
    (void)H5Tenum_insert(type, no, &zero);
    (void)H5Tenum_insert(type, yes, &value);
    return type;
}

static hid_t make_compound(void)
{
    const hid_t type = H5Tcreate(H5T_COMPOUND, 16);
    (void)H5Tinsert(type, "re", 0, H5T_IEEE_F64LE);
    (void)H5Tinsert(type, "im", 8, H5T_IEEE_F64LE);
    return type;
}

/* A number of odd make: fewer bits than bytes. */
static hid_t make_odd(bytes *from, hid_t like)
{
    const hid_t type = H5Tcopy(like);
    (void)H5Tset_size(type, 1 + bytes_below(from, 24));
    (void)H5Tset_precision(type, 1 + bytes_below(from, 128));
    (void)H5Tset_offset(type, bytes_below(from, 32));
    return type;
}

static hid_t make_special(bytes *from)
{
    const hsize_t extent[2] = {2, 3};
    hid_t type;
    switch (bytes_below(from, 12)) {
    case 0:
        return make_boolean("FALSE", "TRUE", 1);
    case 1:
        return make_boolean("NO", "YES", (signed char)bytes_take(from));
    case 2:
        return make_boolean("FALSE", "TRUE", (signed char)bytes_take(from));
    case 3:
        type = H5Tcopy(H5T_C_S1);
        (void)H5Tset_size(type, bytes_below(from, 2) ? H5T_VARIABLE : 8);
        return type;
    case 4:
        return H5Tvlen_create(H5T_IEEE_F64LE);
    case 5:
        return H5Tarray_create2(H5T_IEEE_F64LE, 1 + bytes_below(from, 2), extent);
    case 6:
        return make_compound();
    case 7:
        return H5Tcreate(H5T_OPAQUE, 1 + bytes_take(from));
    case 8:
        return H5Tcopy(H5T_STD_REF_OBJ);
    case 9:
        return H5Tcopy(H5T_STD_B64LE);
    case 10:
        return make_odd(from, H5T_IEEE_F64LE);
    default:
        return make_odd(from, H5T_STD_I64LE);
    }
}

static hid_t make_type(bytes *from, char kind)
{
    const hid_t reals[] = {H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_NATIVE_LDOUBLE};
    const hid_t integers[] = {H5T_STD_I64LE, H5T_STD_I32BE, H5T_STD_I16LE, H5T_STD_I8LE,
                              H5T_STD_U64LE, H5T_STD_U32LE, H5T_STD_U16BE, H5T_STD_U8LE};
    const unsigned choice = bytes_take(from);
    if (choice < 32) return make_special(from);
    if ((kind == 'r' || kind == 'x') != (choice < 48)) return H5Tcopy(reals[choice % 4]);
    return H5Tcopy(integers[choice % 8]);
}

/* ---- extents ---- */

static hsize_t rows_of(const struct place *p, const counts *n)
{
    return p->of == 'n' ? n->nodes : p->of == 's' ? n->springs : p->of == 't' ? n->triangles : n->nodes / 2;
}

/* Mostly as it should be. */
static hid_t make_space(bytes *from, const struct place *p, const counts *n)
{
    const unsigned choice = bytes_take(from);
    hsize_t extent[4] = {rows_of(p, n), p->width, 1, 1};
    int rank = p->width > 1 ? 2 : 1;
    if (choice == 1) return H5Screate(H5S_NULL);
    if (choice == 2) return H5Screate(H5S_SCALAR);
    if (choice >= 3 && choice < 12) rank = 1 + (int)choice % 4;
    if (choice >= 12 && choice < 32) extent[choice % 2] = bytes_below(from, 16);
    if (choice >= 32 && choice < 40) bytes_copy(from, &extent[choice % 2], 1 + choice % 8);
    const hsize_t most[4] = {H5S_UNLIMITED, extent[1], extent[2], extent[3]};
    return H5Screate_simple(rank, extent, choice % 4 == 3 ? most : NULL);
}

/* The last is none that there is. HDF5's own n-bit and scale-offset filters write beyond their memory for some of these
 * types. */
static void set_filter(bytes *from, hid_t layout)
{
    switch (bytes_below(from, 5)) {
    case 0:
        (void)H5Pset_deflate(layout, bytes_below(from, 10));
        break;
    case 1:
        (void)H5Pset_shuffle(layout);
        break;
    case 2:
        (void)H5Pset_fletcher32(layout);
        break;
    case 3:
        (void)H5Pset_filter(layout, 32000, H5Z_FLAG_OPTIONAL, 0, NULL);
        break;
    default:
        break;
    }
}

/* Compact, in one piece, in chunks with filters, in another file, virtual; contents written or only stated. */
static hid_t make_layout(bytes *from, hid_t space)
{
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    const unsigned choice = bytes_take(from);
    const int rank = H5Sget_simple_extent_ndims(space);
    hsize_t chunk[4];
    if (choice >= 128) {
        for (int d = 0; d < 4; d++) chunk[d] = 1 + bytes_below(from, 8);
        (void)H5Pset_chunk(layout, rank, chunk);
        for (unsigned k = 0; k < choice % 4; k++) set_filter(from, layout);
    } else if (choice >= 96) {
        (void)H5Pset_layout(layout, H5D_COMPACT);
    } else if (choice == 1) {
        (void)H5Pset_external(layout, "/etc/passwd", 0, H5F_UNLIMITED);
    } else if (choice == 2) {
        (void)H5Pset_virtual(layout, space, "other.h5", "/lattice/x", space);
    }
    return layout;
}

/* ---- contents ---- */

/* Of a lattice of squares, if nothing else is said. */
static double usual(const struct place *p, const counts *n, size_t k)
{
    if (p->kind == 'x') return (double)(k % 2 == 0 ? k / 2 % 2 : k / 4);
    if (p->kind == 'i') return n->nodes > 0 ? (double)(k % n->nodes) : 0.0;
    return p->kind == 'b' ? (double)(k % 2) : 1.0;
}

static void fill(bytes *from, const struct place *p, const counts *n, double *values)
{
    const unsigned choice = bytes_take(from);
    for (size_t k = 0; k < MOST_VALUES; k++)
        values[k] = from->left == 0 ? usual(p, n, k)
                    : choice == 1   ? bytes_real(from)
                    : choice == 2   ? bytes_between(from, -2.0, 2.0)
                    : choice == 3   ? bytes_take(from)
                                    : usual(p, n, k);
}

static void put_data(bytes *from, const struct place *p, const counts *n, hid_t dataset)
{
    double values[MOST_VALUES];
    const hid_t space = H5Dget_space(dataset), type = H5Dget_type(dataset);
    const H5T_class_t class = H5Tget_class(type);
    const hssize_t length = H5Sget_simple_extent_npoints(space);
    fill(from, p, n, values);
    if (length > 0 && length <= MOST_VALUES && (class == H5T_INTEGER || class == H5T_FLOAT))
        (void)H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    else if (length > 0 && length <= MOST_VALUES && class != H5T_VLEN && H5Tget_size(type) <= sizeof *values &&
             !H5Tis_variable_str(type))
        (void)H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    (void)H5Tclose(type);
    (void)H5Sclose(space);
}

static void put_dataset(bytes *from, const struct place *p, const counts *n, hid_t group)
{
    const hid_t type = make_type(from, p->kind), space = make_space(from, p, n), layout = make_layout(from, space);
    const hid_t dataset = H5Dcreate2(group, p->name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    if (dataset >= 0) put_data(from, p, n, dataset);
    if (dataset >= 0) (void)H5Dclose(dataset);
    (void)H5Pclose(layout);
    if (space >= 0) (void)H5Sclose(space);
    if (type >= 0) (void)H5Tclose(type);
}

/* A link that is no hard one, a group or a type where a dataset is looked for; or the dataset. */
static void put_place(bytes *from, const struct place *p, const counts *n, hid_t group)
{
    const unsigned choice = bytes_take(from);
    hid_t other = H5I_INVALID_HID;
    switch (choice) {
    case 1:
        (void)H5Lcreate_soft(bytes_below(from, 2) ? "/nowhere" : p->name, group, p->name, H5P_DEFAULT, H5P_DEFAULT);
        return;
    case 2:
        (void)H5Lcreate_external("other.h5", "/lattice/x", group, p->name, H5P_DEFAULT, H5P_DEFAULT);
        return;
    case 3:
        other = H5Gcreate2(group, p->name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        break;
    case 4:
        other = H5Tcopy(H5T_IEEE_F64LE);
        (void)H5Tcommit2(group, p->name, other, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        break;
    case 5:
        (void)H5Lcreate_hard(group, "x", group, p->name, H5P_DEFAULT, H5P_DEFAULT);
        return;
    default:
        put_dataset(from, p, n, group);
    }
    if (other >= 0) (void)H5Oclose(other);
}

/* By default a triangle of three nodes and springs. */
static counts count(bytes *from)
{
    const unsigned choice = bytes_take(from);
    counts n = {3, 3, 1};
    if (choice >= 128) n = (counts){bytes_below(from, 20), bytes_below(from, 20), bytes_below(from, 20)};
    return n;
}

static void write_file(bytes *from, const char *path)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    (void)H5Pset_libver_bounds(access, bytes_below(from, 2) ? H5F_LIBVER_LATEST : H5F_LIBVER_EARLIEST,
                               H5F_LIBVER_LATEST);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    (void)H5Pclose(access);
    if (file < 0) abort();
    const unsigned choice = bytes_take(from);
    const hid_t group = H5Gcreate2(file, choice == 1 ? "/other" : "/lattice", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (choice == 1) (void)H5Lcreate_soft("/other", file, "/lattice", H5P_DEFAULT, H5P_DEFAULT);
    const counts n = count(from);
    uint32_t which;
    bytes_copy(from, &which, 3);
    which ^= 0x1f; /* by default what must be there */
    for (unsigned k = 0; k < N_NAMES; k++)
        if (which >> k & 1) put_place(from, &places[k], &n, group);
    (void)H5Gclose(group);
    (void)H5Fclose(file);
}

/* ---- what must hold ---- */

static void check_lattice(const dem_lattice *l)
{
    require(l->n_nodes > 0 && l->n_springs >= 0 && l->n_triangles >= 0 && l->x != NULL && l->mass != NULL);
    require(l->n_springs == 0 || (l->ends != NULL && l->rest_length != NULL && l->stiffness != NULL));
    for (dem_index k = 0; k < 2 * l->n_springs; k++) require(l->ends[k] >= 0 && l->ends[k] < l->n_nodes);
    for (dem_index k = 0; l->triangles != NULL && k < 3 * l->n_triangles; k++)
        require(l->triangles[k] >= 0 && l->triangles[k] < l->n_nodes);
    for (dem_index k = 0; l->flags != NULL && k < l->n_nodes; k++) require(l->flags[k] < 2 * DEM_NODE_GUIDE_Y);
}

/* A model may have springs and masses that no step is short enough for. */
static void start(const dem_model *model)
{
    dem_options options = dem_options_default();
    dem_simulation *simulation = NULL;
    if (ask_sizes(model).n_springs == 0) options.spacing = options.max_step = 1.0;
    const dem_status status = dem_simulation_create(&simulation, model, &options);
    require(status == DEM_OK || status == DEM_ERROR_MODEL || status == DEM_ERROR_ARGUMENT);
    if (status == DEM_OK) {
        const double end = 4.0 * ask_options(simulation).max_step;
        const dem_status advanced = dem_simulation_advance(simulation, end);
        require(advanced == DEM_OK || advanced == DEM_ERROR_INTEGRATOR);
    }
    dem_simulation_destroy(simulation);
}

static void read_file(const char *path)
{
    dem_lattice lattice = dem_lattice_empty();
    dem_model *model = NULL;
    lattice = dem_lattice_empty();
    const dem_status status = dem_lattice_read(&lattice, path);
    require(status == DEM_OK || status == DEM_ERROR_IO || status == DEM_ERROR_MODEL);
    if (status != DEM_OK) {
        require(lattice.x == NULL && strstr(dem_status_message(), "lattice.h5") != NULL);
        slabs_check(path, NULL);
        return;
    }
    check_lattice(&lattice);
    slabs_check(path, &lattice);
    const dem_status made = dem_model_create(&model, &lattice, NULL, 0);
    require(made == DEM_OK || made == DEM_ERROR_MODEL);
    if (made == DEM_OK) start(model);
    dem_model_destroy(model);
    dem_lattice_free(&lattice);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes from = {data, size};
    const char *path = scratch_path("lattice.h5");
    H5E_auto2_t report;
    void *report_data;
    (void)H5Eget_auto2(H5E_DEFAULT, &report, &report_data);
    (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    write_file(&from, path);
    (void)H5Eset_auto2(H5E_DEFAULT, report, report_data);
    read_file(path);
    return 0;
}
