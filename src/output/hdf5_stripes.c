/* SPDX-License-Identifier: BSD-3-Clause */
/* With N rows a frame, T frames and C numbers a row, a stripe of n rows from row o on is
 *   in the virtual dataset [T N][C]   T blocks of n rows, the first from row o on, each N rows behind the one before
 *   in the other file [..][C]         the first T n rows
 * A block that is not repeated, and blocks that follow each other, may come back from HDF5 as one. */
#include "output/hdf5_stripes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"

/* What is not there is to be seen. */
static herr_t fill(hid_t layout, hid_t type)
{
    const double nothing = (double)NAN;
    const int64_t none = -1;
    const unsigned char no_flag = 255;
    if (H5Tget_class(type) == H5T_FLOAT) return H5Pset_fill_value(layout, H5T_NATIVE_DOUBLE, &nothing);
    if (H5Tget_sign(type) != H5T_SGN_NONE) return H5Pset_fill_value(layout, H5T_NATIVE_INT64, &none);
    return H5Pset_fill_value(layout, H5T_NATIVE_UINT8, &no_flag);
}

hid_t hdf5_stripes_layout(hid_t type)
{
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    if (H5Pset_layout(layout, H5D_VIRTUAL) >= 0 && H5Pset_obj_track_times(layout, 0) >= 0 && fill(layout, type) >= 0)
        return layout;
    (void)H5Pclose(layout);
    return H5I_INVALID_HID;
}

/* Blocks of whole rows of a space. */
static herr_t select_blocks(hid_t space, const hsize_t *extent, int rank, const hdf5_stripe *s)
{
    hsize_t start[HDF5_MAX_RANK] = {s->first}, stride[HDF5_MAX_RANK] = {s->stride};
    hsize_t count[HDF5_MAX_RANK] = {s->grows ? H5S_UNLIMITED : s->n}, block[HDF5_MAX_RANK] = {s->rows};
    for (int d = 1; d < rank; d++) {
        count[d] = 1;
        stride[d] = block[d] = extent[d];
    }
    return H5Sselect_hyperslab(space, H5S_SELECT_SET, start, stride, count, block);
}

/* So many rows; or any number, if it grows. */
static hid_t make_space(hsize_t rows, const hsize_t *extent, int rank, bool grows)
{
    const hsize_t now[HDF5_MAX_RANK] = {rows, extent[1], extent[2]};
    const hsize_t most[HDF5_MAX_RANK] = {H5S_UNLIMITED, extent[1], extent[2]};
    return H5Screate_simple(rank, now, grows ? most : NULL);
}

enum { ESCAPED = 2 * HDF5_STRIPES_NAME };

/* To HDF5 a % alone is the beginning of a pattern. */
static void escape(char out[ESCAPED], const char *name)
{
    for (; *name != '\0'; name++) {
        if (*name == '%') *out++ = '%';
        *out++ = *name;
    }
    *out = '\0';
}

/* In place.  \return false if it is a pattern */
static bool unescape(char *name)
{
    const char *from = name;
    while (*from != '\0') {
        if (*from == '%' && *++from != '%') return false;
        *name++ = *from++;
    }
    *name = '\0';
    return true;
}

/* The other file may have more rows, which count where the stripe grows. */
herr_t hdf5_stripes_add(hid_t layout, const char *name, const hsize_t *extent, int rank, const hdf5_stripe *stripe)
{
    const hsize_t rows = stripe->n * stripe->rows;
    const hdf5_stripe all = {.stride = stripe->grows ? stripe->rows : rows,
                             .n = 1,
                             .rows = stripe->grows ? stripe->rows : rows,
                             .grows = stripe->grows};
    const hid_t here = make_space(extent[0], extent, rank, stripe->grows);
    const hid_t source = make_space(rows, extent, rank, stripe->grows);
    char file[ESCAPED];
    escape(file, stripe->file);
    herr_t result = select_blocks(here, extent, rank, stripe);
    if (result >= 0) result = select_blocks(source, extent, rank, &all);
    if (result >= 0) result = H5Pset_virtual(layout, here, file, name, source);
    (void)H5Sclose(source);
    (void)H5Sclose(here);
    return result;
}

int hdf5_stripes_count(hid_t dataset)
{
    enum { MOST = 1 << 20 };
    size_t n = 0;
    const hid_t layout = H5Dget_create_plist(dataset);
    const bool is_virtual = H5Pget_layout(layout) == H5D_VIRTUAL && H5Pget_virtual_count(layout, &n) >= 0;
    (void)H5Pclose(layout);
    return is_virtual && n <= MOST ? (int)n : 0;
}

/* Whole rows, where that is what is selected.
 * \param extent  of the virtual dataset, of which other files have as many numbers in each row */
static bool get_blocks(hid_t space, const hsize_t *extent, hdf5_stripe *out)
{
    hsize_t start[HDF5_MAX_RANK], stride[HDF5_MAX_RANK], count[HDF5_MAX_RANK], block[HDF5_MAX_RANK];
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 1 || rank > HDF5_MAX_RANK || H5Sget_select_type(space) != H5S_SEL_HYPERSLABS ||
        H5Sis_regular_hyperslab(space) <= 0 || H5Sget_regular_hyperslab(space, start, stride, count, block) < 0)
        return false;
    for (int d = 1; d < rank; d++)
        if (start[d] != 0 || count[d] != 1 || block[d] != extent[d]) return false;
    /* A stride over which nothing is repeated means nothing. */
    *out = (hdf5_stripe){.first = start[0],
                         .stride = count[0] > 1 ? stride[0] : block[0],
                         .n = count[0],
                         .rows = block[0],
                         .grows = count[0] == H5S_UNLIMITED};
    return true;
}

static bool get_columns(hid_t space, hsize_t extent[HDF5_MAX_RANK])
{
    const int rank = H5Sget_simple_extent_ndims(space);
    return rank >= 1 && rank <= HDF5_MAX_RANK && H5Sget_simple_extent_dims(space, extent, NULL) >= 0;
}

/* The first rows of the other file, as one block, or as blocks one behind the other. */
static bool has_rows(hid_t space, const hsize_t *extent, const hdf5_stripe *s)
{
    hdf5_stripe all;
    if (!get_blocks(space, extent, &all) || all.first != 0 || all.grows != s->grows) return false;
    return s->grows ? all.rows == s->rows && all.stride == s->rows : all.n == 1 && all.rows == s->n * s->rows;
}

/* HDF5 would look in other folders, too, and takes . for the file of the dataset. */
static bool is_beside(const char *file)
{
    return *file != '\0' && strchr(file, '/') == NULL && strcmp(file, ".") != 0 && strcmp(file, "..") != 0;
}

static bool get_names(hid_t layout, const char *name, int k, hdf5_stripe *out)
{
    char file[ESCAPED], there[HDF5_STRIPES_NAME];
    const ssize_t n = H5Pget_virtual_filename(layout, (size_t)k, file, sizeof file);
    const ssize_t m = H5Pget_virtual_dsetname(layout, (size_t)k, there, sizeof there);
    if (n <= 0 || (size_t)n >= sizeof file || m <= 0 || (size_t)m >= sizeof there || strcmp(there, name) != 0)
        return false;
    if (!unescape(file) || strlen(file) >= sizeof out->file || !is_beside(file)) return false;
    memcpy(out->file, file, strlen(file) + 1);
    return true;
}

/* Whether no place of a row overflows. */
static bool is_sound(const hdf5_stripe *s)
{
    const hsize_t most = (hsize_t)1 << 60;
    return s->n >= 1 && s->rows >= 1 && s->rows <= s->stride && s->first <= most && s->n <= most / s->stride;
}

/* How many whole blocks a dataset has at least of each stripe that grows. HDF5 looks into the files for it. */
static hsize_t count_blocks(hid_t dataset, hsize_t stride)
{
    hsize_t extent[HDF5_MAX_RANK] = {0};
    const hid_t space = H5Dget_space(dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    const bool known = rank >= 1 && rank <= HDF5_MAX_RANK && H5Sget_simple_extent_dims(space, extent, NULL) >= 0;
    (void)H5Sclose(space);
    return known ? extent[0] / stride : 0;
}

/* Stripe k, from the layout of a dataset: no file is opened for it. */
static bool get(hid_t layout, const char *name, int k, hdf5_stripe *out)
{
    hsize_t extent[HDF5_MAX_RANK] = {0};
    const hid_t here = H5Pget_virtual_vspace(layout, (size_t)k), there = H5Pget_virtual_srcspace(layout, (size_t)k);
    bool good = here >= 0 && there >= 0 && get_columns(here, extent) && get_blocks(here, extent, out);
    if (good && out->grows) out->n = 1;
    good = good && is_sound(out) && has_rows(there, extent, out) && get_names(layout, name, k, out);
    if (there >= 0) (void)H5Sclose(there);
    if (here >= 0) (void)H5Sclose(here);
    return good;
}

bool hdf5_stripes_are_beside(hid_t dataset, const char *name)
{
    const int n = hdf5_stripes_count(dataset);
    const hid_t layout = H5Dget_create_plist(dataset);
    hdf5_stripe stripe;
    bool good = true;
    for (int k = 0; k < n && good; k++) good = get(layout, name, k, &stripe);
    (void)H5Pclose(layout);
    return good;
}

/* Whether all are ours. */
static bool get_all(hid_t dataset, const char *name, hdf5_stripe *list, int n)
{
    const hid_t layout = H5Dget_create_plist(dataset);
    bool good = true;
    for (int k = 0; k < n && good; k++) {
        good = get(layout, name, k, &list[k]);
        if (good && list[k].grows) list[k].n = count_blocks(dataset, list[k].stride);
        good = good && (list[k].n == 0 || is_sound(&list[k]));
    }
    (void)H5Pclose(layout);
    return good;
}

dem_status hdf5_stripes_list(hid_t dataset, const char *name, hdf5_stripe **list, int *n)
{
    *n = hdf5_stripes_count(dataset);
    *list = calloc((size_t)*n + 1, sizeof **list);
    CHECK_MEMORY(*list);
    if (get_all(dataset, name, *list, *n)) return DEM_OK;
    free(*list);
    *list = NULL;
    return DEM_ERROR_IO;
}
