/* SPDX-License-Identifier: BSD-3-Clause */
/* Datasets that grow row by row. Types in files are little-endian and times are not tracked, so that equal data makes
 * equal files. Whole chunks of deflated rows go past HDF5's own filters (deflater.c). */
#include "output/hdf5_rows.h"

#include "base/status.h"
#include "output/deflated_chunk.h"
#include "output/hdf5_chunks.h"

#include <stdbool.h>
#include <stdlib.h>

hid_t hdf5_file_type(hdf5_kind kind)
{
    switch (kind) {
    case HDF5_F64:
        return H5T_IEEE_F64LE;
    case HDF5_F32:
        return H5T_IEEE_F32LE;
    case HDF5_I64:
        return H5T_STD_I64LE;
    case HDF5_I32:
        return H5T_STD_I32LE;
    case HDF5_I8:
        return H5T_STD_I8LE;
    default:
        return H5T_STD_U8LE;
    }
}

/* The type of numbers in memory: single precision and signed bytes are widened. */
hid_t hdf5_memory_type(hdf5_kind kind)
{
    switch (kind) {
    case HDF5_I64:
    case HDF5_I8:
        return H5T_NATIVE_INT64;
    case HDF5_I32:
        return H5T_NATIVE_INT32;
    case HDF5_U8:
        return H5T_NATIVE_UINT8;
    default:
        return H5T_NATIVE_DOUBLE;
    }
}

/* Numbers of a row. */
static hsize_t width_of(const hdf5_rows *rows)
{
    return (rows->rank > 1 ? rows->tail[0] : 1) * (rows->rank > 2 ? rows->tail[1] : 1);
}

/* HDF5 takes chunks below 4 GiB. */
static hsize_t chunk_limit(const hdf5_rows *rows)
{
    return UINT32_MAX / (width_of(rows) * H5Tget_size(hdf5_file_type(rows->kind)));
}

/* Chunks of rows, without time stamps; shuffled and deflated if asked for. A negative number on failure. */
static hid_t make_layout(const hdf5_rows *rows)
{
    const hsize_t limit = chunk_limit(rows);
    const hsize_t chunk = rows->chunk < 1 ? 1 : rows->chunk > limit ? limit : rows->chunk;
    const hsize_t extent[HDF5_MAX_RANK] = {chunk, rows->tail[0], rows->tail[1]};
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    herr_t result = H5Pset_chunk(layout, rows->rank, extent);
    if (result >= 0) result = H5Pset_obj_track_times(layout, 0);
    if (result >= 0 && rows->deflate > 0) result = H5Pset_shuffle(layout);
    if (result >= 0 && rows->deflate > 0) result = H5Pset_deflate(layout, (unsigned)rows->deflate);
    if (result >= 0) return layout;
    (void)H5Pclose(layout);
    return H5I_INVALID_HID;
}

/* Rank and extents of a dataset; 0 if it is none of ours. */
static int measure(hid_t dataset, hsize_t extent[HDF5_MAX_RANK])
{
    const hid_t space = H5Dget_space(dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    const bool fits = rank > 0 && rank <= HDF5_MAX_RANK && H5Sget_simple_extent_dims(space, extent, NULL) >= 0;
    (void)H5Sclose(space);
    return fits ? rank : 0;
}

/* A new dataset, if all for it is ready. Space and layout are closed. */
static dem_status make_dataset(const hdf5_file *file, const hdf5_rows *rows, hid_t space, hid_t layout, bool is_ready)
{
    const hid_t links = hdf5_parents(), type = hdf5_file_type(rows->kind);
    const hid_t dataset =
        is_ready ? H5Dcreate2(file->id, rows->name, type, space, links, layout, H5P_DEFAULT) : H5I_INVALID_HID;
    const dem_status status = dataset < 0 ? hdf5_fail(file, rows->name, "cannot be created") : DEM_OK;
    if (dataset >= 0) (void)H5Dclose(dataset);
    if (layout >= 0) (void)H5Pclose(layout);
    (void)H5Pclose(links);
    (void)H5Sclose(space);
    return status;
}

/* The first dimension may grow without limit; the others are fixed. */
dem_status hdf5_create(const hdf5_file *file, const hdf5_rows *rows)
{
    const hsize_t extent[HDF5_MAX_RANK] = {0, rows->tail[0], rows->tail[1]};
    /* Only rows can be added. */
    const hsize_t most[HDF5_MAX_RANK] = {H5S_UNLIMITED, rows->tail[0], rows->tail[1]};
    return make_dataset(file, rows, H5Screate_simple(rows->rank, extent, most), make_layout(rows), true);
}

/* ---- rows in other files ---- */

static herr_t add_stripes(hid_t layout, const hdf5_rows *rows, const hsize_t *extent, const hdf5_stripe *stripes, int n)
{
    herr_t result = layout >= 0 ? 0 : -1;
    for (int k = 0; k < n && result >= 0; k++)
        if (stripes[k].rows > 0) result = hdf5_stripes_add(layout, rows->name, extent, rows->rank, &stripes[k]);
    return result;
}

dem_status hdf5_map(const hdf5_file *file, const hdf5_rows *rows, hsize_t count, const hdf5_stripe *stripes, int n)
{
    const hsize_t extent[HDF5_MAX_RANK] = {count, rows->tail[0], rows->tail[1]};
    const hsize_t most[HDF5_MAX_RANK] = {H5S_UNLIMITED, rows->tail[0], rows->tail[1]};
    const hid_t space = H5Screate_simple(rows->rank, extent, n > 0 && stripes->grows ? most : NULL);
    const hid_t layout = hdf5_stripes_layout(hdf5_file_type(rows->kind));
    const bool is_free = !hdf5_has(file, rows->name) || H5Ldelete(file->id, rows->name, H5P_DEFAULT) >= 0;
    return make_dataset(file, rows, space, layout, is_free && add_stripes(layout, rows, extent, stripes, n) >= 0);
}

size_t hdf5_row_bytes(const hdf5_rows *rows)
{
    return (size_t)width_of(rows) * H5Tget_size(hdf5_memory_type(rows->kind));
}

bool hdf5_packs(const hdf5_rows *rows)
{
    return rows->deflate > 0 && rows->kind != HDF5_I8 && rows->chunk <= chunk_limit(rows) &&
           H5Tequal(H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE) > 0;
}

deflater_numbers hdf5_numbers(const hdf5_rows *rows, hsize_t count, const void *data)
{
    return (deflater_numbers){data, count, width_of(rows), H5Tget_size(hdf5_file_type(rows->kind)),
                              rows->kind == HDF5_F32};
}

/* ---- writing ---- */

/* Rows that a dataset gets. */
typedef struct addition {
    const hdf5_file *file;
    const hdf5_rows *rows;
    hsize_t first, count;
    const void *data; /* [count] rows, or [packed] bytes of a chunk that they are */
    size_t packed;    /* 0: they are not packed */
    bool sets_extent; /* behind them there is nothing */
} addition;

/* A chunk at once, past HDF5's conversion, cache and filters. */
static herr_t write_packed(const addition *a, hid_t dataset)
{
    const hsize_t start[HDF5_MAX_RANK] = {a->first};
    return H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, start, a->packed, a->data);
}

static herr_t write_slab(const addition *a, hid_t dataset)
{
    const hdf5_rows *rows = a->rows;
    const hsize_t start[HDF5_MAX_RANK] = {a->first}, block[HDF5_MAX_RANK] = {a->count, rows->tail[0], rows->tail[1]};
    const hid_t memory = H5Screate_simple(rows->rank, block, NULL), space = H5Dget_space(dataset);
    herr_t result = space < 0 ? -1 : H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, block, NULL);
    if (result >= 0) result = H5Dwrite(dataset, hdf5_memory_type(rows->kind), memory, space, H5P_DEFAULT, a->data);
    if (space >= 0) (void)H5Sclose(space);
    (void)H5Sclose(memory);
    return result;
}

/* Rows behind the new ones, which a failed attempt has left, are cut off. */
static herr_t add(const addition *a, hid_t dataset)
{
    const hsize_t whole[HDF5_MAX_RANK] = {a->first + a->count, a->rows->tail[0], a->rows->tail[1]};
    if (dataset < 0 || (a->sets_extent && H5Dset_extent(dataset, whole) < 0)) return -1;
    if (a->packed > 0) return write_packed(a, dataset);
    return a->count > 0 && a->data != NULL ? write_slab(a, dataset) : 0;
}

/* Closing the dataset may be what fails: its chunk cache is written then. */
static dem_status write_rows(const addition *a)
{
    const hdf5_file *file = a->file;
    dem_status status = DEM_OK;
    const hid_t dataset = kept_datasets_open(file->kept, file->id, a->rows->name);
    if (add(a, dataset) < 0) status = hdf5_fail(file, a->rows->name, "cannot be written");
    if (dataset >= 0 && kept_datasets_leave(file->kept, dataset) < 0 && status == DEM_OK)
        status = hdf5_fail(file, a->rows->name, "cannot be written");
    return status;
}

dem_status hdf5_extend(const hdf5_file *file, const hdf5_rows *rows, hsize_t count)
{
    return write_rows(&(addition){file, rows, count, 0, NULL, 0, true});
}

dem_status hdf5_put(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, const void *data)
{
    return write_rows(&(addition){file, rows, first, count, data, 0, false});
}

dem_status hdf5_append_packed(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, const deflated_run *chunk)
{
    return write_rows(&(addition){file, rows, first, rows->chunk, chunk->bytes, chunk->n, true});
}

/* All of a chunk. */
static dem_status append_chunk(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, const void *data)
{
    deflater *d = file->deflater;
    deflated_chunk c = {0};
    const deflater_numbers numbers = hdf5_numbers(rows, rows->chunk, data);
    dem_status status = deflated_chunk_begin(&c, deflater_planes(numbers), 1);
    if (status == DEM_OK) status = deflater_pack(d, numbers, c.n_planes, rows->deflate, file->team);
    if (status == DEM_OK) status = deflated_chunk_add(&c, 0, d->sections, d->n_slices);
    if (status == DEM_OK) status = deflated_chunk_end(&c);
    if (status == DEM_OK) status = hdf5_append_packed(file, rows, first, &c.all);
    deflated_chunk_free(&c);
    return status;
}

dem_status hdf5_append(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, const void *data)
{
    const bool is_chunk = count > 0 && count == rows->chunk && first % count == 0;
    if (is_chunk && hdf5_packs(rows)) return append_chunk(file, rows, first, data);
    return write_rows(&(addition){file, rows, first, count, data, 0, true});
}

dem_status hdf5_read(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, void *data)
{
    const hsize_t start[HDF5_MAX_RANK] = {first}, block[HDF5_MAX_RANK] = {count, rows->tail[0], rows->tail[1]};
    const hid_t dataset = file->kept != NULL ? kept_datasets_open(file->kept, file->id, rows->name)
                                             : hdf5_chunks_open(file->id, rows->name);
    if (dataset < 0) return hdf5_fail(file, rows->name, "cannot be read");
    dem_status status = hdf5_chunks_check(file->path, rows->name, dataset, start, block, rows->rank);
    if (status == DEM_OK && hdf5_chunks_read(dataset, hdf5_memory_type(rows->kind), start, block, rows->rank, data) < 0)
        status = hdf5_fail(file, rows->name, "cannot be read");
    (void)kept_datasets_leave(file->kept, dataset);
    return status;
}

/* What is stored is the same for any reader, whoever has packed it. */
dem_status hdf5_copy_chunk(const hdf5_file *from, const hdf5_file *to, const hdf5_rows *source, const hdf5_rows *target,
                           hdf5_span span, bool *is_done)
{
    deflated_run chunk = {0};
    *is_done = false;
    if (!hdf5_packs(target) || target->chunk != span.count) return DEM_OK;
    const hid_t dataset = kept_datasets_open(from->kept, from->id, source->name);
    if (dataset < 0) return hdf5_fail(from, source->name, "cannot be read");
    dem_status status = hdf5_chunks_fetch(dataset, span.first, span.count, &chunk.bytes, &chunk.n);
    if (status == DEM_ERROR_IO) status = hdf5_fail(from, source->name, "cannot be read");
    (void)kept_datasets_leave(from->kept, dataset);
    *is_done = chunk.bytes != NULL;
    if (status == DEM_OK && *is_done) status = hdf5_append_packed(to, target, span.at, &chunk);
    free(chunk.bytes);
    return status;
}

/* A chunk at a time. Numbers pass through the types in memory, which hold those of every kind exactly. */
dem_status hdf5_copy(const hdf5_file *from, const hdf5_file *to, const hdf5_rows *rows, hdf5_span span)
{
    /* The buffer holds one chunk of rows, of at most 8 bytes a number. */
    const hsize_t step = rows->chunk > 1 ? rows->chunk : 1;
    dem_status status = DEM_OK;
    void *buffer = malloc((size_t)(step * width_of(rows)) * sizeof(double));
    CHECK_MEMORY(buffer);
    for (hsize_t done = 0; done < span.count && status == DEM_OK; done += step) {
        const hsize_t count = span.count - done < step ? span.count - done : step;
        status = hdf5_read(from, rows, span.first + done, count, buffer);
        if (status == DEM_OK) status = hdf5_append(to, rows, span.at + done, count, buffer);
    }
    free(buffer);
    return status;
}

/* No chunk needs room for more. */
dem_status hdf5_create_for(const hdf5_file *file, hdf5_rows *rows, hsize_t count)
{
    if (rows->chunk == 0 || rows->chunk > count) rows->chunk = count;
    return hdf5_create(file, rows);
}

dem_status hdf5_write(const hdf5_file *file, hdf5_rows rows, hsize_t count, const void *data)
{
    const size_t size = hdf5_row_bytes(&rows);
    TRY(hdf5_create_for(file, &rows, count));
    if (count == 0) return hdf5_append(file, &rows, 0, 0, data);
    for (hsize_t first = 0; first < count; first += rows.chunk) {
        const hsize_t n = count - first < rows.chunk ? count - first : rows.chunk;
        TRY(hdf5_append(file, &rows, first, n, (const char *)data + (size_t)first * size));
    }
    return DEM_OK;
}

/* A dataset of another shape counts as having no rows; hdf5_expect_rows() will refuse it. */
dem_status hdf5_count_rows(const hdf5_file *file, const char *name, hsize_t *count)
{
    hsize_t extent[HDF5_MAX_RANK] = {0};
    const hid_t dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (dataset < 0) return hdf5_fail(file, name, "cannot be opened");
    *count = measure(dataset, extent) > 0 ? extent[0] : 0;
    (void)H5Dclose(dataset);
    return DEM_OK;
}

/* Whether a dataset has these extents, and so many rows at least. */
static bool has_rows(hid_t dataset, const hdf5_rows *rows, hsize_t count)
{
    hsize_t extent[HDF5_MAX_RANK] = {0};
    const hid_t type = H5Dget_type(dataset);
    bool good = H5Tequal(type, hdf5_file_type(rows->kind)) > 0 && measure(dataset, extent) == rows->rank;
    for (int d = 1; d < rows->rank && good; d++) good = extent[d] == rows->tail[d - 1];
    (void)H5Tclose(type);
    return good && extent[0] >= count;
}

/* Where a file is missing HDF5 would go on without it. */
static dem_status expect_stripe(const hdf5_file *file, const hdf5_rows *rows, const hdf5_stripe *stripe)
{
    char path[HDF5_PATH];
    hdf5_file other;
    TRY(hdf5_beside(path, file, stripe->file));
    TRY(hdf5_open_read(&other, path));
    const hid_t dataset = H5Dopen2(other.id, rows->name, H5P_DEFAULT);
    const bool good = dataset >= 0 && has_rows(dataset, rows, stripe->n * stripe->rows);
    if (dataset >= 0) (void)H5Dclose(dataset);
    TRY(hdf5_close(&other, DEM_OK));
    CHECK(good, DEM_ERROR_IO, "%s: %s: does not have the rows that %s is to have of it", path, rows->name, file->path);
    return DEM_OK;
}

static dem_status expect_stripes(const hdf5_file *file, const hdf5_rows *rows)
{
    int n = 0;
    hdf5_stripe *list = NULL;
    const hid_t dataset = H5Dopen2(file->id, rows->name, H5P_DEFAULT);
    dem_status status = hdf5_stripes_list(dataset, rows->name, &list, &n);
    (void)H5Dclose(dataset);
    CHECK(status != DEM_ERROR_IO, DEM_ERROR_IO, "%s: %s: is virtual", file->path, rows->name);
    for (int k = 0; k < n && status == DEM_OK; k++) status = expect_stripe(file, rows, &list[k]);
    free(list);
    return status;
}

/* The type must be exactly the one that this library writes. */
dem_status hdf5_expect_rows(const hdf5_file *file, const hdf5_rows *rows, hsize_t count)
{
    hsize_t extent[HDF5_MAX_RANK] = {0};
    const hid_t dataset = H5Dopen2(file->id, rows->name, H5P_DEFAULT);
    if (dataset < 0) return hdf5_fail(file, rows->name, "cannot be opened");
    const hid_t type = H5Dget_type(dataset);
    bool alike = H5Tequal(type, hdf5_file_type(rows->kind)) > 0 && measure(dataset, extent) == rows->rank;
    for (int d = 1; d < rows->rank && alike; d++) alike = extent[d] == rows->tail[d - 1];
    (void)H5Tclose(type);
    (void)H5Dclose(dataset);
    CHECK(alike, DEM_ERROR_IO, "%s: %s: is of another type or shape", file->path, rows->name);
    CHECK(extent[0] == count, DEM_ERROR_IO, "%s: %s: has %llu rows, %llu were written", file->path, rows->name,
          (unsigned long long)extent[0], (unsigned long long)count);
    return expect_stripes(file, rows);
}
