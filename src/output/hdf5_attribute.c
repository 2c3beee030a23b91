/* SPDX-License-Identifier: BSD-3-Clause */
/* Attributes, and texts, which are datasets with one string. Strings have fixed lengths and no terminator. */
#include "output/hdf5_attribute.h"

#include "base/status.h"
#include "output/hdf5_chunks.h"

#include <stdbool.h>
#include <string.h>

/* A string of fixed length, padded with zeros; an empty one takes a byte, since HDF5 has no strings of length 0. */
static hid_t make_string(const char *text, H5T_cset_t characters)
{
    const size_t length = strlen(text);
    const hid_t type = H5Tcopy(H5T_C_S1);
    (void)H5Tset_size(type, length > 0 ? length : 1);
    (void)H5Tset_strpad(type, H5T_STR_NULLPAD);
    (void)H5Tset_cset(type, characters);
    return type;
}

/* Opens an object, or makes a group of that name. */
static hid_t open_group(const hdf5_file *file, const char *name)
{
    const hid_t group = H5Oopen(file->id, name, H5P_DEFAULT);
    if (group >= 0) return group;
    const hid_t links = hdf5_parents();
    const hid_t made = H5Gcreate2(file->id, name, links, H5P_DEFAULT, H5P_DEFAULT);
    (void)H5Pclose(links);
    return made;
}

/* What an attribute is, apart from its value. */
typedef struct attribute_form {
    const char *name;
    hid_t stored, given; /* types in the file and in memory */
    hsize_t count;
} attribute_form;

/* An attribute that exists is overwritten, with the type and size that it has. */
static dem_status write_attribute(const hdf5_file *file, const char *object, attribute_form a, const void *data)
{
    dem_status status = DEM_OK;
    const hid_t group = open_group(file, object);
    const hid_t space = a.count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &a.count, NULL);
    const hid_t made = H5Aexists(group, a.name) > 0
                           ? H5Aopen(group, a.name, H5P_DEFAULT)
                           : H5Acreate2(group, a.name, a.stored, space, H5P_DEFAULT, H5P_DEFAULT);
    if (made < 0 || H5Awrite(made, a.given, data) < 0)
        status = hdf5_fail(file, object, "an attribute cannot be written");
    if (made >= 0) (void)H5Aclose(made);
    (void)H5Sclose(space);
    if (group >= 0) (void)H5Oclose(group);
    return status;
}

dem_status hdf5_write_attribute(const hdf5_file *file, const char *object, const char *name, hdf5_kind kind,
                                hsize_t count, const void *data)
{
    return write_attribute(file, object, (attribute_form){name, hdf5_file_type(kind), hdf5_memory_type(kind), count},
                           data);
}

dem_status hdf5_write_attribute_text(const hdf5_file *file, const char *object, const char *name, const char *text)
{
    const hid_t type = make_string(text, H5T_CSET_ASCII);
    const dem_status status = write_attribute(file, object, (attribute_form){name, type, type, 1}, text);
    (void)H5Tclose(type);
    return status;
}

/* A text that is replaced may have another length, so the old dataset is removed first. */
dem_status hdf5_write_text(const hdf5_file *file, const char *name, const char *text)
{
    const hid_t type = make_string(text, H5T_CSET_UTF8), space = H5Screate(H5S_SCALAR), links = hdf5_parents();
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    dem_status status = DEM_OK;
    (void)H5Pset_obj_track_times(layout, 0);
    /* Fails where there is none yet. */
    (void)H5Ldelete(file->id, name, H5P_DEFAULT);
    const hid_t dataset = H5Dcreate2(file->id, name, type, space, links, layout, H5P_DEFAULT);
    if (dataset < 0 || H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0)
        status = hdf5_fail(file, name, "cannot be written");
    if (dataset >= 0) (void)H5Dclose(dataset);
    (void)H5Pclose(layout);
    (void)H5Pclose(links);
    (void)H5Sclose(space);
    (void)H5Tclose(type);
    return status;
}

/* Strings of variable length are refused: their memory would be HDF5's. */
dem_status hdf5_read_text(const hdf5_file *file, const char *name, char *text, size_t size)
{
    dem_status status = DEM_OK;
    const hid_t dataset = hdf5_chunks_open(file->id, name);
    if (dataset < 0) return hdf5_fail(file, name, "cannot be opened");
    const hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    const size_t length = H5Tget_size(type);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || H5Sget_simple_extent_npoints(space) != 1)
        status = status_fail(DEM_ERROR_IO, "%s: %s: is not a string of fixed length", file->path, name);
    else if (length >= size)
        status = status_fail(DEM_ERROR_ARGUMENT, "%s: %s: %zu characters and the end do not fit into %zu", file->path,
                             name, length, size);
    else if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0)
        status = hdf5_fail(file, name, "cannot be read");
    else
        text[length] = '\0';
    (void)H5Sclose(space);
    (void)H5Tclose(type);
    (void)H5Dclose(dataset);
    return status;
}

/* Used for counts that must agree with the rows that have been found. */
dem_status hdf5_expect_attribute(const hdf5_file *file, const char *object, const char *name, int64_t value)
{
    int64_t stored = 0;
    const hid_t attribute = H5Aopen_by_name(file->id, object, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return hdf5_fail(file, object, "an attribute cannot be opened");
    /* In a damaged file there may be more numbers than `stored` has room for. */
    const hid_t space = H5Aget_space(attribute);
    const bool single = H5Sget_simple_extent_npoints(space) == 1;
    const herr_t result = single ? H5Aread(attribute, H5T_NATIVE_INT64, &stored) : -1;
    (void)H5Sclose(space);
    (void)H5Aclose(attribute);
    CHECK(result >= 0 && stored == value, DEM_ERROR_IO, "%s: %s: %s is %lld, %lld was written", file->path, object,
          name, (long long)stored, (long long)value);
    return DEM_OK;
}
