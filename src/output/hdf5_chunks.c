/* SPDX-License-Identifier: BSD-3-Clause */
/* What is stored of a chunk is read as it is and unpacked here, to know how many bytes it gives: the filter mask and
 * the size of a chunk stand in an index without a checksum, and a short deflated stream is valid in itself. */
#include "output/hdf5_chunks.h"

#include "base/status.h"

#include <limits.h>
#include <stdlib.h>
#include <zlib.h>

/* How the chunks of a dataset are stored. */
typedef struct chunk_form {
    int rank, n_filters;
    int deflate; /* which filter unpacks; -1: none */
    hsize_t extent[HDF5_MAX_RANK];
    hsize_t bytes; /* of the numbers of a chunk */
} chunk_form;

/* A cache of no bytes takes no chunk. */
hid_t hdf5_chunks_open(hid_t file, const char *name)
{
    const hid_t access = H5Pcreate(H5P_DATASET_ACCESS);
    (void)H5Pset_chunk_cache(access, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, 0, H5D_CHUNK_CACHE_W0_DEFAULT);
    const hid_t dataset = H5Dopen2(file, name, access);
    (void)H5Pclose(access);
    return dataset;
}

/* Which filter is deflate, -1 if none. */
static int find_deflate(hid_t layout, int n_filters)
{
    for (int k = 0; k < n_filters; k++) {
        size_t n_values = 0;
        unsigned flags = 0;
        if (H5Pget_filter2(layout, (unsigned)k, &flags, &n_values, NULL, 0, NULL, NULL) == H5Z_FILTER_DEFLATE) return k;
    }
    return -1;
}

static hsize_t bytes_of_number(hid_t dataset)
{
    const hid_t type = H5Dget_type(dataset);
    const size_t size = H5Tget_size(type);
    (void)H5Tclose(type);
    return size;
}

static hsize_t bytes_of_file(hid_t dataset)
{
    hsize_t bytes = 0;
    const hid_t file = H5Iget_file_id(dataset);
    (void)H5Fget_filesize(file, &bytes);
    (void)H5Fclose(file);
    return bytes;
}

/* The rank is 0 where there are no chunks. */
static chunk_form form_of(hid_t dataset)
{
    chunk_form f = {.deflate = -1, .extent = {1, 1, 1}};
    const hid_t layout = H5Dget_create_plist(dataset);
    if (H5Pget_layout(layout) == H5D_CHUNKED) {
        f.rank = H5Pget_chunk(layout, HDF5_MAX_RANK, f.extent);
        f.n_filters = H5Pget_nfilters(layout);
        f.deflate = find_deflate(layout, f.n_filters);
    }
    (void)H5Pclose(layout);
    f.bytes = f.extent[0] * f.extent[1] * f.extent[2] * bytes_of_number(dataset);
    return f;
}

/* How many bytes a deflated stream gives, counted up to `enough`; 0 if it is damaged. */
static hsize_t count_inflated(unsigned char *packed, hsize_t size, hsize_t enough)
{
    unsigned char scratch[16384];
    z_stream z = {.next_in = packed, .avail_in = (uInt)size};
    int result = inflateInit(&z);
    while (result == Z_OK && z.total_out < enough) {
        z.next_out = scratch;
        z.avail_out = sizeof scratch;
        result = inflate(&z, Z_NO_FLUSH);
    }
    const hsize_t n = result == Z_OK || result == Z_STREAM_END ? z.total_out : 0;
    (void)inflateEnd(&z);
    return n;
}

/* What is stored of a chunk. */
typedef struct stored_chunk {
    unsigned char *bytes; /* [size] */
    hsize_t size;
    uint32_t left_out; /* the filters that were not used for it, a bit each */
} stored_chunk;

/* Reads a chunk. Whether its bytes give at least its extent.
 * \param enough  bytes after which no more are unpacked */
static bool gives_all(hid_t dataset, const chunk_form *f, const hsize_t *at, hsize_t enough, stored_chunk *c)
{
    if (H5Dread_chunk(dataset, H5P_DEFAULT, at, &c->left_out, c->bytes) < 0) return false;
    const bool packed = f->deflate >= 0 && (c->left_out >> f->deflate & 1) == 0;
    return (packed ? count_inflated(c->bytes, c->size, enough) : c->size) >= f->bytes;
}

/* Bytes that are stored of a chunk; 0 where it was never written, and is read as zeros, or where the index gives no
 * size: then reading fails and says why. */
static hsize_t bytes_stored(hid_t dataset, const hsize_t *at)
{
    hsize_t size = 0;
    return H5Dget_chunk_storage_size(dataset, at, &size) < 0 ? 0 : size;
}

static dem_status allocate(stored_chunk *c)
{
    c->bytes = malloc((size_t)c->size);
    CHECK(c->bytes != NULL, DEM_ERROR_MEMORY, "out of memory for a chunk of %llu bytes", (unsigned long long)c->size);
    return DEM_OK;
}

/* Reads what is stored of a chunk. */
static dem_status look_into(hid_t dataset, const chunk_form *f, const hsize_t *at, hsize_t enough, bool *whole)
{
    stored_chunk c = {.size = bytes_stored(dataset, at)};
    *whole = c.size <= bytes_of_file(dataset) && c.size <= UINT_MAX;
    if (!*whole) return DEM_OK;
    TRY(allocate(&c));
    *whole = gives_all(dataset, f, at, enough, &c);
    free(c.bytes);
    return DEM_OK;
}

static dem_status check_chunk(const char *path, const char *name, hid_t dataset, const chunk_form *f, const hsize_t *at)
{
    bool whole;
    if (bytes_stored(dataset, at) == 0) return DEM_OK;
    TRY(look_into(dataset, f, at, f->bytes, &whole));
    CHECK(whole, DEM_ERROR_IO, "%s: %s: cannot be read (a chunk is shorter than its extent)", path, name);
    return DEM_OK;
}

/* The next chunk of the block behind the one at `at`, the last dimension first; false behind the last one. */
static bool go_on(const chunk_form *f, const hsize_t *start, const hsize_t *count, hsize_t *at)
{
    for (int d = f->rank - 1; d >= 0; d--) {
        at[d] += f->extent[d];
        if (at[d] < start[d] + count[d]) return true;
        at[d] = start[d] - start[d] % f->extent[d];
    }
    return false;
}

dem_status hdf5_chunks_check(const char *path, const char *name, hid_t dataset, const hsize_t *start,
                             const hsize_t *count, int rank)
{
    const chunk_form f = form_of(dataset);
    hsize_t at[HDF5_MAX_RANK] = {0};
    if (f.rank == 0) return DEM_OK;
    CHECK(f.rank == rank, DEM_ERROR_IO, "%s: %s: has chunks of rank %d, not %d", path, name, f.rank, rank);
    if (f.n_filters == 0 || count[0] == 0) return DEM_OK;
    for (int d = 0; d < rank; d++) at[d] = start[d] - start[d] % f.extent[d];
    do TRY(check_chunk(path, name, dataset, &f, at));
    while (go_on(&f, start, count, at));
    return DEM_OK;
}

dem_status hdf5_chunks_unpack(hid_t dataset, const hsize_t *start, const hsize_t *count, bool *all)
{
    const chunk_form f = form_of(dataset);
    hsize_t at[HDF5_MAX_RANK] = {0};
    bool whole = true;
    *all = f.rank > 0 && f.deflate >= 0;
    if (!*all) return DEM_OK;
    for (int d = 0; d < f.rank; d++) at[d] = start[d] - start[d] % f.extent[d];
    do {
        *all = *all && bytes_stored(dataset, at) > 0;
        if (*all) TRY(look_into(dataset, &f, at, UINT64_MAX, &whole));
    } while (*all && whole && go_on(&f, start, count, at));
    return whole ? DEM_OK : DEM_ERROR_IO;
}

/* Whether the chunk at row `first` has just so many rows, by HDF5's filters shuffle and deflate. */
static bool is_packed_chunk(hid_t dataset, const chunk_form *f, hsize_t first, hsize_t rows)
{
    const hsize_t at[HDF5_MAX_RANK] = {first}, size = f->rank > 0 ? bytes_stored(dataset, at) : 0;
    return f->n_filters == 2 && f->deflate == 1 && f->extent[0] == rows && first % rows == 0 && size > 0 &&
           size <= bytes_of_file(dataset) && size <= UINT_MAX;
}

dem_status hdf5_chunks_fetch(hid_t dataset, hsize_t first, hsize_t rows, unsigned char **bytes, size_t *size)
{
    const chunk_form f = form_of(dataset);
    const hsize_t at[HDF5_MAX_RANK] = {first};
    *bytes = NULL;
    if (!is_packed_chunk(dataset, &f, first, rows)) return DEM_OK;
    stored_chunk c = {.size = bytes_stored(dataset, at)};
    TRY(allocate(&c));
    const bool whole = gives_all(dataset, &f, at, UINT64_MAX, &c);
    *size = (size_t)c.size;
    if (whole && c.left_out == 0)
        *bytes = c.bytes;
    else
        free(c.bytes);
    return whole ? DEM_OK : DEM_ERROR_IO;
}

/* Of each read that converts numbers HDF5 fills a buffer of 1 MiB with zeros, which takes longer than few numbers do,
 * unless less is asked for: for a number it needs no more than 16 bytes. */
static hid_t make_transfer(const hsize_t *count, int rank)
{
    const hsize_t usual = 1 << 20;
    hsize_t bytes = 16;
    for (int d = 0; d < rank && bytes < usual; d++) bytes *= count[d] > 0 ? count[d] : 1;
    const hid_t transfer = H5Pcreate(H5P_DATASET_XFER);
    if (bytes < usual) (void)H5Pset_buffer(transfer, (size_t)bytes, NULL, NULL);
    return transfer;
}

herr_t hdf5_chunks_read(hid_t dataset, hid_t type, const hsize_t *start, const hsize_t *count, int rank, void *buffer)
{
    const hid_t space = H5Dget_space(dataset);
    const hid_t memory = H5Screate_simple(rank, count, NULL), transfer = make_transfer(count, rank);
    herr_t result = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL);
    if (result >= 0) result = H5Dread(dataset, type, memory, space, transfer, buffer);
    (void)H5Pclose(transfer);
    (void)H5Sclose(memory);
    (void)H5Sclose(space);
    return result;
}
