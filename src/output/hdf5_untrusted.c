/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads HDF5 files that may be damaged or made to do harm (docs/output.md, Which files are trusted). Before anything is
 * allocated or read, checks are made in the order in which HDF5 itself would come upon what they look at:
 *   links         hard ones only: a soft link may lead round in circles, an external one to another file
 *   type          integers and reals of at most 16 bytes, booleans as h5py has them
 *   extent        at most 3 dimensions, 2^40 rows and 2^44 numbers: no size in bytes overflows
 *   layout        in this file, no external or virtual storage; where it may be, stripes of files beside it, which are
 *                 checked in the same way when they are read and may not have stripes themselves
 *   filters       deflate, shuffle and fletcher32: others may be plugins, which are programs
 *   size          no more than the stored bytes can hold, however well they are deflated
 *   chunks        each holds what its extent says (hdf5_chunks.h)
 * The functions are fuzzed (docs/fuzzing.md). Files of this process's own run are opened by hdf5_file.c without these
 * checks. */
#include "output/hdf5_untrusted.h"

#include "base/status.h"
#include "output/hdf5_chunks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Larger than any run, and small enough that sizes in bytes do not overflow 64 bits. */
static const hsize_t most_rows = (hsize_t)1 << 40, most_numbers = (hsize_t)1 << 44;

/* Deflate shortens nothing by more than this factor: with the bytes stored it bounds what a dataset can hold. */
static const hsize_t most_deflation = 1032;

enum { most_bytes = 16 /* of a number */ };

dem_status hdf5_untrusted_refuse(const hdf5_file *file, const char *name, const char *reason)
{
    return status_fail(DEM_ERROR_IO, "%s: %s: %s", file->path, name, reason);
}

/* Control characters in a message could change what a terminal shows. */
void hdf5_untrusted_print(char out[HDF5_UNTRUSTED_PRINTABLE], const char *name)
{
    size_t n = 0;
    for (; n + 1 < HDF5_UNTRUSTED_PRINTABLE && name[n] != '\0'; n++)
        out[n] = name[n] > ' ' && name[n] <= '~' ? name[n] : '?';
    out[n] = '\0';
}

/* A pipe or a device would block or never end. A file that is not there is reported by the opening. */
dem_status hdf5_untrusted_open(hdf5_file *out, const char *path)
{
    struct stat kind;
    CHECK(stat(path, &kind) != 0 || S_ISREG(kind.st_mode), DEM_ERROR_IO, "%s: is not a regular file", path);
    return hdf5_open_read(out, path);
}

/* ---- links ---- */

/* Only hard links lead to what is in this file. */
static dem_status check_link(const hdf5_file *file, const char *name, bool *present)
{
    H5L_info_t info;
    *present = H5Lexists(file->id, name, H5P_DEFAULT) > 0;
    if (*present && (H5Lget_info(file->id, name, &info, H5P_DEFAULT) < 0 || info.type != H5L_TYPE_HARD))
        return hdf5_untrusted_refuse(file, name, "is a soft or external link");
    return DEM_OK;
}

/* Checks every link on the way, from the root on: HDF5 would follow all of them at once. */
dem_status hdf5_untrusted_find(const hdf5_file *file, const char *name, bool *present)
{
    char way[256];
    CHECK(strlen(name) < sizeof way, DEM_ERROR_IO, "%s: a path of %zu characters is too long", file->path,
          strlen(name));
    *present = true;
    for (const char *end = name; *present && *end != '\0';) {
        /* From one / to the next: /a, /a/b, /a/b/c. */
        end += 1 + strcspn(end + 1, "/");
        memcpy(way, name, (size_t)(end - name));
        way[end - name] = '\0';
        TRY(check_link(file, way, present));
    }
    return DEM_OK;
}

/* The caller's function, and what it returned. Names come in no order: to sort the names of a damaged group, HDF5 1.10
 * frees what it has not allocated. */
typedef struct listing {
    dem_status (*take)(void *context, const char *name);
    void *context;
    dem_status status;
} listing;

static herr_t take_name(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
    listing *l = context;
    (void)group, (void)info;
    l->status = l->take(l->context, name);
    return l->status == DEM_OK ? 0 : 1;
}

/* A positive number from take_name() ends the iteration without being an error of HDF5. */
dem_status hdf5_untrusted_list(const hdf5_file *file, const char *group,
                               dem_status (*take)(void *context, const char *name), void *context)
{
    listing l = {take, context, DEM_OK};
    const hid_t id = H5Gopen2(file->id, group, H5P_DEFAULT);
    if (id < 0) return hdf5_fail(file, group, "is not a readable group");
    if (H5Literate(id, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, take_name, &l) < 0)
        l.status = hdf5_fail(file, group, "cannot be listed");
    (void)H5Gclose(id);
    return l.status;
}

/* ---- datasets ---- */

/* As h5py stores it: an enumeration of FALSE = 0 and TRUE = 1. */
static bool is_boolean(hid_t type)
{
    signed char no = -1, yes = -1;
    /* Its members are asked for by name, so their order does not matter. */
    if (H5Tget_class(type) != H5T_ENUM || H5Tget_size(type) != 1 || H5Tget_nmembers(type) != 2) return false;
    return H5Tenum_valueof(type, "FALSE", &no) >= 0 && H5Tenum_valueof(type, "TRUE", &yes) >= 0 && no == 0 && yes == 1;
}

static bool is_real(hdf5_kind kind)
{
    return kind == HDF5_F64 || kind == HDF5_F32;
}

/* Why numbers of this type cannot be read as `kind`; NULL if they can. Integers become reals, but not the other way
 * round. */
static const char *find_misfit(hid_t type, hdf5_kind kind)
{
    const H5T_class_t class = H5Tget_class(type);
    const bool flag = kind == HDF5_U8;
    const bool fits = class == H5T_INTEGER || (is_real(kind) && class == H5T_FLOAT) || (flag && is_boolean(type));
    if (fits && H5Tget_size(type) <= most_bytes) return NULL;
    return is_real(kind) ? "is neither floating-point nor integer"
           : flag        ? "is neither integer nor boolean"
                         : "is not integer";
}

/* The kind of ours that comes nearest to a type in the file. */
static hdf5_kind kind_of(hid_t type)
{
    const size_t size = H5Tget_size(type);
    if (H5Tget_class(type) == H5T_FLOAT) return size <= 4 ? HDF5_F32 : HDF5_F64;
    if (size > 1) return size <= 4 ? HDF5_I32 : HDF5_I64;
    return H5Tget_class(type) == H5T_INTEGER && H5Tget_sign(type) != H5T_SGN_NONE ? HDF5_I8 : HDF5_U8;
}

/* Only filters that are built in, and deflate once: each further one would multiply most_deflation. */
static dem_status check_filters(const hdf5_file *file, const char *name, hid_t layout)
{
    const int n = H5Pget_nfilters(layout);
    int deflates = 0;
    for (int k = 0; k < n; k++) {
        size_t n_values = 0;
        unsigned flags = 0;
        const H5Z_filter_t filter = H5Pget_filter2(layout, (unsigned)k, &flags, &n_values, NULL, 0, NULL, NULL);
        deflates += filter == H5Z_FILTER_DEFLATE;
        if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_FLETCHER32)
            return hdf5_untrusted_refuse(file, name, "uses a filter other than deflate, shuffle and fletcher32");
    }
    return n < 0 || deflates > 1 ? hdf5_untrusted_refuse(file, name, "has filters that cannot be read") : DEM_OK;
}

/* The numbers of a chunk, which HDF5 reads as a whole; 0 where there are no chunks. */
static hsize_t count_chunk(hid_t layout)
{
    hsize_t extent[HDF5_MAX_RANK] = {1, 1, 1};
    if (H5Pget_layout(layout) != H5D_CHUNKED || H5Pget_chunk(layout, HDF5_MAX_RANK, extent) < 0) return 0;
    return extent[0] * extent[1] * extent[2]; /* below 2^32 bytes, says HDF5 */
}

/* A dataset cannot hold more bytes than are stored for it times what deflate can save, nor store more than the file
 * has. */
static dem_status check_size(const hdf5_file *file, const char *name, hid_t dataset, hsize_t bytes)
{
    hsize_t in_file = 0;
    (void)H5Fget_filesize(file->id, &in_file);
    const hsize_t stored = H5Dget_storage_size(dataset);
    /* A dataset that was never written stores nothing, and would be read as any number of zeros. */
    if (stored > in_file || bytes / most_deflation > stored || (bytes > 0 && stored == 0))
        return hdf5_untrusted_refuse(file, name, "claims more data than the file holds");
    return DEM_OK;
}

/* Extents beyond the rank are 1, so that their product is always the number of items. */
static void measure_extent(hid_t dataset, hdf5_untrusted_shape *out)
{
    const hid_t space = H5Dget_space(dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    const bool fits = H5Sget_simple_extent_type(space) == H5S_SIMPLE && rank >= 1 && rank <= HDF5_MAX_RANK;
    for (int d = 0; d < HDF5_MAX_RANK; d++) out->extent[d] = 1;
    out->rank = fits && H5Sget_simple_extent_dims(space, out->extent, NULL) >= 0 ? rank : 0;
    (void)H5Sclose(space);
}

/* All rows of a dataset have to be those of a stripe. Whether these are there is seen when they are read. */
static dem_status check_stripes(const hdf5_file *file, const char *name, hid_t dataset, hsize_t n)
{
    hdf5_untrusted_shape shape;
    hsize_t rows = 0;
    int n_stripes = 0;
    hdf5_stripe *list = NULL;
    measure_extent(dataset, &shape);
    const dem_status status = hdf5_stripes_list(dataset, name, &list, &n_stripes);
    bool good = status == DEM_OK;
    if (status == DEM_ERROR_MEMORY) return status;
    hsize_t all = shape.extent[0];
    for (int k = 0; k < n_stripes && good; k++) {
        good = list[k].n * list[k].rows <= shape.extent[0] - rows;
        rows += list[k].n * list[k].rows;
        if (list[k].grows) all = list[k].n * list[k].stride; /* what is more is of a block that is being written */
    }
    free(list);
    if (!good) return hdf5_untrusted_refuse(file, name, "has a virtual or unknown layout");
    if (n > 0 && rows != all) return hdf5_untrusted_refuse(file, name, "has rows that stand in no file");
    return DEM_OK;
}

/* Checks where and how n numbers of `size` bytes are kept. A chunk may be larger than the dataset and counts in
 * full. */
static dem_status check_storage(const hdf5_file *file, const char *name, hid_t dataset, hsize_t size, hsize_t n)
{
    const hid_t layout = H5Dget_create_plist(dataset);
    const H5D_layout_t kind = H5Pget_layout(layout);
    const hsize_t chunk = n > 0 ? count_chunk(layout) : 0;
    dem_status status;
    if (H5Pget_external_count(layout) != 0)
        status = hdf5_untrusted_refuse(file, name, "keeps its data in an external file");
    else if (kind == H5D_VIRTUAL && file->takes_stripes)
        status = check_stripes(file, name, dataset, n);
    else if (kind != H5D_COMPACT && kind != H5D_CONTIGUOUS && kind != H5D_CHUNKED)
        status = hdf5_untrusted_refuse(file, name, "has a virtual or unknown layout");
    /* Sizes say something only if the filters are known. */
    else if ((status = check_filters(file, name, layout)) == DEM_OK)
        status = check_size(file, name, dataset, size * (n > chunk ? n : chunk));
    (void)H5Pclose(layout);
    return status;
}

/* Multiplies extents without overflow: each factor is compared with what is left of the limit first. */
static dem_status count_numbers(const hdf5_file *file, const char *name, const hdf5_untrusted_shape *shape, hsize_t *n)
{
    *n = 1;
    if (shape->extent[0] > most_rows) return hdf5_untrusted_refuse(file, name, "has more than 2^40 rows");
    for (int d = 0; d < HDF5_MAX_RANK; d++) {
        /* + 1, since an extent may be 0. */
        if (*n > most_numbers / (shape->extent[d] + 1))
            return hdf5_untrusted_refuse(file, name, "has more than 2^44 numbers");
        *n *= shape->extent[d];
    }
    return DEM_OK;
}

/* HDF5 opens files of virtual storage when it is asked for an extent. */
static dem_status check_virtual(const hdf5_file *file, const char *name, hid_t dataset)
{
    const hid_t layout = H5Dget_create_plist(dataset);
    const bool is_virtual = H5Pget_layout(layout) == H5D_VIRTUAL;
    (void)H5Pclose(layout);
    if (is_virtual && !(file->takes_stripes && hdf5_stripes_are_beside(dataset, name)))
        return hdf5_untrusted_refuse(file, name, "has a virtual or unknown layout");
    return DEM_OK;
}

/* HDF5 unpacks whole chunks, and reads what is not packed row by row. */
static hsize_t measure_unit(hid_t dataset)
{
    hsize_t extent[HDF5_MAX_RANK] = {1};
    const hid_t layout = H5Dget_create_plist(dataset);
    const bool is_packed = H5Pget_layout(layout) == H5D_CHUNKED && H5Pget_nfilters(layout) > 0 &&
                           H5Pget_chunk(layout, HDF5_MAX_RANK, extent) >= 0;
    (void)H5Pclose(layout);
    return is_packed ? extent[0] : 1;
}

/* Type, virtual storage, extent, number of items, other storage: in this order nothing depends on what has not been
 * checked. */
static dem_status measure(const hdf5_file *file, const char *name, hid_t dataset, hdf5_kind kind,
                          hdf5_untrusted_shape *out)
{
    const hid_t type = H5Dget_type(dataset);
    const hsize_t size = H5Tget_size(type);
    const char *misfit = find_misfit(type, kind);
    hsize_t n = 0;
    out->stored = kind_of(type);
    (void)H5Tclose(type);
    if (misfit != NULL) return hdf5_untrusted_refuse(file, name, misfit);
    TRY(check_virtual(file, name, dataset));
    measure_extent(dataset, out);
    out->unit = measure_unit(dataset);
    if (out->rank == 0) return DEM_OK;
    TRY(count_numbers(file, name, out, &n));
    return check_storage(file, name, dataset, size, n);
}

dem_status hdf5_untrusted_measure(const hdf5_file *file, const char *name, hdf5_kind kind, hdf5_untrusted_shape *out)
{
    const hid_t dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (dataset < 0) return hdf5_fail(file, name, "is not a readable dataset");
    const dem_status status = measure(file, name, dataset, kind, out);
    (void)H5Dclose(dataset);
    return status;
}

/* Called by HDF5 where a number does not fit the type in memory: that is an error, not the nearest number that does. */
static H5T_conv_ret_t on_conversion(H5T_conv_except_t exception, hid_t from, hid_t to, void *value, void *result,
                                    void *context)
{
    (void)from, (void)to, (void)value, (void)result, (void)context;
    return exception == H5T_CONV_EXCEPT_RANGE_HI || exception == H5T_CONV_EXCEPT_RANGE_LOW ? H5T_CONV_ABORT
                                                                                           : H5T_CONV_UNHANDLED;
}

/* ---- rows ---- */

/* Rows of a dataset that stand in files beside it, and where they go. */
typedef struct stripe_rows {
    hdf5_untrusted_rows rows;
    hdf5_untrusted_shape shape; /* of the dataset */
    size_t size;                /* bytes of a row in memory */
    void *data;
} stripe_rows;

/* All columns of the rows, or the first `width` of each. The cause of a failure is HDF5's only until its next call. */
static dem_status read_rows(const hdf5_file *file, const char *name, hid_t dataset, hdf5_kind kind,
                            const hdf5_untrusted_rows *rows, void *data)
{
    const hsize_t start[HDF5_MAX_RANK] = {rows->first};
    hsize_t count[HDF5_MAX_RANK] = {0, 1, 1};
    const hid_t space = H5Dget_space(dataset), transfer = H5Pcreate(H5P_DATASET_XFER);
    const int rank = H5Sget_simple_extent_dims(space, count, NULL);
    count[0] = rows->count;
    /* A selection of columns within the rows. */
    if (rows->width > 0 && rank > 1) count[1] = rows->width;
    const hid_t memory = H5Screate_simple(rank, count, NULL);
    dem_status status = hdf5_chunks_check(file->path, name, dataset, start, count, rank);
    if (status == DEM_OK && (H5Pset_type_conv_cb(transfer, on_conversion, NULL) < 0 ||
                             H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) < 0 ||
                             H5Dread(dataset, hdf5_memory_type(kind), memory, space, transfer, data) < 0))
        status = hdf5_fail(file, name, "cannot be read");
    (void)H5Sclose(memory);
    (void)H5Pclose(transfer);
    (void)H5Sclose(space);
    return status;
}

static dem_status read_here(const hdf5_file *file, const char *name, hdf5_kind kind, hdf5_untrusted_rows rows,
                            void *data)
{
    const hid_t dataset = hdf5_chunks_open(file->id, name);
    if (dataset < 0) return hdf5_fail(file, name, "is not a readable dataset");
    const dem_status status = read_rows(file, name, dataset, kind, &rows, data);
    (void)H5Dclose(dataset);
    return status;
}

/* Bytes in memory of the numbers that are read of a row. */
static size_t size_of_row(const hdf5_untrusted_shape *shape, hdf5_kind kind, hsize_t width)
{
    const hsize_t columns = width > 0 && shape->rank > 1 ? width : shape->extent[1];
    return (size_t)(columns * shape->extent[2]) * H5Tget_size(hdf5_memory_type(kind));
}

/* Checks what a stripe has of a dataset of this shape. */
static dem_status check_stripe(const hdf5_file *other, const char *name, const hdf5_untrusted_shape *here,
                               const hdf5_stripe *stripe)
{
    hdf5_untrusted_shape there;
    bool present = false;
    TRY(hdf5_untrusted_find(other, name, &present));
    if (!present) return hdf5_untrusted_refuse(other, name, "is missing");
    TRY(hdf5_untrusted_measure(other, name, HDF5_F64, &there));
    const bool has_rows = stripe->grows || there.extent[0] >= stripe->n * stripe->rows;
    if (here->rank != there.rank || !has_rows || there.extent[1] != here->extent[1] ||
        there.extent[2] != here->extent[2])
        return hdf5_untrusted_refuse(other, name, "does not have the rows of its stripe");
    return DEM_OK;
}

/* What the rows have of a stripe, block by block, from its file. */
static dem_status read_blocks(const hdf5_file *other, const char *name, hdf5_kind kind, const hdf5_stripe *stripe,
                              const stripe_rows *wanted)
{
    const hsize_t first = wanted->rows.first, end = first + wanted->rows.count;
    const hsize_t before = first > stripe->first ? (first - stripe->first) / stripe->stride : 0;
    for (hsize_t k = before; k < stripe->n && stripe->first + k * stripe->stride < end; k++) {
        const hsize_t block = stripe->first + k * stripe->stride, from = block > first ? block : first;
        const hsize_t to = block + stripe->rows < end ? block + stripe->rows : end;
        if (to <= from) continue;
        const hdf5_untrusted_rows rows = {k * stripe->rows + from - block, to - from, wanted->rows.width};
        TRY(read_here(other, name, kind, rows, (char *)wanted->data + (size_t)(from - first) * wanted->size));
    }
    return DEM_OK;
}

/* From the file of a stripe, which may not have stripes itself. */
static dem_status read_stripe(const hdf5_file *file, const char *name, hdf5_kind kind, const hdf5_stripe *stripe,
                              const stripe_rows *wanted)
{
    char path[HDF5_PATH];
    hdf5_file other;
    TRY(hdf5_beside(path, file, stripe->file));
    TRY(hdf5_untrusted_open(&other, path));
    dem_status status = check_stripe(&other, name, &wanted->shape, stripe);
    if (status == DEM_OK) status = read_blocks(&other, name, kind, stripe, wanted);
    return hdf5_close(&other, status);
}

/* A selection of no rows is not read at all. Of stripes, what none has is 0. */
dem_status hdf5_untrusted_read(const hdf5_file *file, const char *name, hdf5_kind kind, hdf5_untrusted_rows rows,
                               void *data)
{
    int n = 0;
    dem_status status = DEM_OK;
    if (rows.count == 0) return DEM_OK;
    if (!file->takes_stripes) return read_here(file, name, kind, rows, data);
    const hid_t dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (dataset < 0) return hdf5_fail(file, name, "is not a readable dataset");
    const bool is_striped = hdf5_stripes_count(dataset) > 0;
    stripe_rows wanted = {.rows = rows, .data = data};
    hdf5_stripe *list = NULL;
    if (is_striped) status = hdf5_stripes_list(dataset, name, &list, &n);
    if (is_striped) measure_extent(dataset, &wanted.shape);
    (void)H5Dclose(dataset);
    if (!is_striped) return read_here(file, name, kind, rows, data);
    if (status == DEM_ERROR_IO) return hdf5_untrusted_refuse(file, name, "has a virtual or unknown layout");
    TRY(status);
    wanted.size = size_of_row(&wanted.shape, kind, rows.width);
    memset(data, 0, (size_t)rows.count * wanted.size);
    for (int k = 0; k < n && status == DEM_OK; k++) status = read_stripe(file, name, kind, &list[k], &wanted);
    free(list);
    return status;
}

/* ---- attributes ---- */

/* An attribute of one item, or a negative number. */
static hid_t open_attribute(const hdf5_file *file, const char *object, const char *name)
{
    const hid_t id = H5Aopen_by_name(file->id, object, name, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = id < 0 ? H5I_INVALID_HID : H5Aget_space(id);
    const bool single = space >= 0 && H5Sget_simple_extent_npoints(space) == 1;
    if (space >= 0) (void)H5Sclose(space);
    if (id < 0 || single) return id;
    (void)H5Aclose(id);
    return H5I_INVALID_HID;
}

static dem_status refuse_attribute(const hdf5_file *file, const char *object, const char *name, const char *what)
{
    return status_fail(DEM_ERROR_IO, "%s: %s: has no attribute %s that is %s", file->path, object, name, what);
}

/* One item of a type that find_misfit() accepts has at most `most_bytes` in the file and 8 in memory. */
dem_status hdf5_untrusted_read_attribute(const hdf5_file *file, const char *object, const char *name, hdf5_kind kind,
                                         void *value)
{
    const hid_t id = open_attribute(file, object, name);
    bool read = false;
    if (id >= 0) {
        const hid_t type = H5Aget_type(id);
        read = find_misfit(type, kind) == NULL && H5Aread(id, hdf5_memory_type(kind), value) >= 0;
        (void)H5Tclose(type);
        (void)H5Aclose(id);
    }
    return read ? DEM_OK : refuse_attribute(file, object, name, is_real(kind) ? "a number" : "an integer");
}

/* The string has to leave room for the terminator that is added. */
dem_status hdf5_untrusted_read_attribute_text(const hdf5_file *file, const char *object, const char *name, char *text,
                                              size_t size)
{
    const hid_t id = open_attribute(file, object, name);
    bool read = false;
    if (id >= 0) {
        const hid_t type = H5Aget_type(id);
        const size_t length = H5Tget_size(type);
        read = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && length < size &&
               H5Aread(id, type, text) >= 0;
        if (read) text[length] = '\0';
        (void)H5Tclose(type);
        (void)H5Aclose(id);
    }
    return read ? DEM_OK : refuse_attribute(file, object, name, "a short string");
}
