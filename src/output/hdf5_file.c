/* SPDX-License-Identifier: BSD-3-Clause */
/* The only file that calls HDF5 to write: datasets that grow row by row, attributes, texts, and the publishing of a
 * finished file. Each function makes all HDF5 calls that belong together, closes what it has opened, and turns a
 * failure into a status that names file, dataset and cause. Types in files are little-endian and times are not tracked,
 * so that equal data makes equal files. Callers are protected from three properties of HDF5: it prints errors, it may
 * leave a file that cannot be opened when the disk is full, and it may load plugins that a file names. Reading files
 * that may come from anywhere is in hdf5_untrusted.c; what datasets a run has is decided by the other files of this
 * folder. */
#include "output/hdf5_file.h"

#include "base/publish.h"
#include "base/status.h"
#include "output/hdf5_chunks.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    MAX_RANK = 3,
    CHUNK_LIMIT = 1 << 26, /* rows; HDF5 takes chunks below 4 GiB */
    SLACK = 1 << 20        /* bytes; more than HDF5 adds to the data at one opening */
};

/* The type of numbers in the file. */
static hid_t file_type(hdf5_kind kind)
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

/* Called by H5Ewalk2() from the inside out: depth 0 is where the error arose. */
static herr_t keep_innermost(unsigned depth, const H5E_error2_t *error, void *cause)
{
    if (depth == 0) (void)snprintf(cause, 200, "%s", error->desc != NULL ? error->desc : "no cause given");
    return 0;
}

/* HDF5 wraps the system's own words: "..., error message = 'No such file or directory', ...". Returns these words
 * alone; `cause` is changed. */
static const char *shorten(char *cause)
{
    static const char key[] = "error message = '";
    char *words = strstr(cause, key);
    if (words == NULL) return cause;
    words += sizeof key - 1;
    words[strcspn(words, "'")] = '\0';
    return words;
}

/* Closing the file closes all that is open in it, and no lock is taken, so that looking at a file does not stop a
 * run. */
static hid_t make_access(void)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (access >= 0 && H5Pset_fclose_degree(access, H5F_CLOSE_STRONG) >= 0 && H5Pset_file_locking(access, 0, 1) >= 0)
        return access;
    return H5I_INVALID_HID;
}

/* Missing groups on the way to a new object are made. */
static hid_t make_parents(void)
{
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    if (links >= 0) (void)H5Pset_create_intermediate_group(links, 1);
    return links;
}

/* Chunks of rows, without time stamps; shuffled and deflated if asked for. A negative number on failure. */
static hid_t make_layout(const hdf5_rows *rows)
{
    const hsize_t chunk = rows->chunk < 1 ? 1 : rows->chunk > CHUNK_LIMIT ? CHUNK_LIMIT : rows->chunk;
    const hsize_t extent[MAX_RANK] = {chunk, rows->tail[0], rows->tail[1]};
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    herr_t result = H5Pset_chunk(layout, rows->rank, extent);
    if (result >= 0) result = H5Pset_obj_track_times(layout, 0);
    if (result >= 0 && rows->deflate > 0) result = H5Pset_shuffle(layout);
    if (result >= 0 && rows->deflate > 0) result = H5Pset_deflate(layout, (unsigned)rows->deflate);
    if (result >= 0) return layout;
    (void)H5Pclose(layout);
    return H5I_INVALID_HID;
}

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
    const hid_t links = make_parents();
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

/* Reads `count` numbers in each dimension from `start` on. */
static herr_t read_slab(hid_t dataset, hid_t type, const hsize_t *start, const hsize_t *count, int rank, void *buffer)
{
    const hid_t space = H5Dget_space(dataset);
    const hid_t memory = H5Screate_simple(rank, count, NULL);
    herr_t result = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL);
    if (result >= 0) result = H5Dread(dataset, type, memory, space, H5P_DEFAULT, buffer);
    (void)H5Sclose(memory);
    (void)H5Sclose(space);
    return result;
}

/* Rank and extents of a dataset; 0 if it is none of ours. */
static int measure(hid_t dataset, hsize_t extent[MAX_RANK])
{
    const hid_t space = H5Dget_space(dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    const bool fits = rank > 0 && rank <= MAX_RANK && H5Sget_simple_extent_dims(space, extent, NULL) >= 0;
    (void)H5Sclose(space);
    return fits ? rank : 0;
}

/* Reads a whole dataset chunk by chunk and throws the numbers away. Returns DEM_OK, DEM_ERROR_MEMORY or DEM_ERROR_IO;
 * the message is the caller's. */
static dem_status read_slabs(hid_t dataset, hid_t type, hsize_t *extent, int rank)
{
    hsize_t start[MAX_RANK] = {0}, chunk[MAX_RANK] = {1, 1, 1}, cells = 1;
    const hid_t layout = H5Dget_create_plist(dataset);
    herr_t result = H5Pget_layout(layout) == H5D_CHUNKED ? H5Pget_chunk(layout, rank, chunk) : 0;
    (void)H5Pclose(layout);
    /* A slab is as many rows as a chunk has, and all columns. */
    for (int d = 1; d < rank; d++) cells *= extent[d];
    void *buffer = malloc((size_t)(chunk[0] * cells) * H5Tget_size(type));
    if (buffer == NULL) return DEM_ERROR_MEMORY;
    for (const hsize_t rows = extent[0]; result >= 0 && start[0] < rows; start[0] += chunk[0]) {
        extent[0] = rows - start[0] < chunk[0] ? rows - start[0] : chunk[0];
        result = read_slab(dataset, type, start, extent, rank, buffer);
    }
    free(buffer);
    return result < 0 ? DEM_ERROR_IO : DEM_OK;
}

/* The same of a dataset with a single item, such as a text. */
static dem_status read_scalar(hid_t dataset, hid_t type)
{
    void *buffer = malloc(H5Tget_size(type));
    if (buffer == NULL) return DEM_ERROR_MEMORY;
    const herr_t result = H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
    free(buffer);
    return result < 0 ? DEM_ERROR_IO : DEM_OK;
}

/* Reads all of a dataset, of whatever type. */
static dem_status read_dataset(hid_t dataset)
{
    hsize_t extent[MAX_RANK] = {0};
    dem_status status = DEM_ERROR_IO;
    const hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank == 0)
        status = read_scalar(dataset, type);
    else if (rank > 0 && rank <= MAX_RANK && H5Sget_simple_extent_dims(space, extent, NULL) >= 0)
        status = read_slabs(dataset, type, extent, rank);
    (void)H5Sclose(space);
    (void)H5Tclose(type);
    return status;
}

/* The first thing in a file that cannot be read back. */
typedef struct unread {
    const hdf5_file *file;
    dem_status status;
} unread;

/* Called for every link below the root. A number other than 0 ends the visit. */
static herr_t visit(hid_t root, const char *name, const H5L_info_t *info, void *context)
{
    unread *u = context;
    (void)info;
    const hid_t object = H5Oopen(root, name, H5P_DEFAULT);
    dem_status status = object < 0 ? DEM_ERROR_IO : DEM_OK;
    if (status == DEM_OK && H5Iget_type(object) == H5I_DATASET) status = read_dataset(object);
    if (status == DEM_ERROR_IO) u->status = hdf5_fail(u->file, name, "cannot be read back");
    if (status == DEM_ERROR_MEMORY) u->status = status_fail(status, "out of memory to read back %s", u->file->path);
    if (object >= 0) (void)H5Oclose(object);
    return u->status == DEM_OK ? 0 : -1;
}

/* One thread at a time has files open, as many as it likes, hence a recursive lock. HDF5 may be built without locks,
 * and whether it loads plugins is a setting of the process. A build with locks does not do two things at once
 * either. */
static pthread_mutex_t turn;
static pthread_once_t turn_made = PTHREAD_ONCE_INIT;

static void make_turn(void)
{
    pthread_mutexattr_t recursive;
    (void)pthread_mutexattr_init(&recursive);
    (void)pthread_mutexattr_settype(&recursive, PTHREAD_MUTEX_RECURSIVE);
    (void)pthread_mutex_init(&turn, &recursive);
    (void)pthread_mutexattr_destroy(&recursive);
}

/* Waits for this thread's turn, and notes the settings that restore() puts back. */
static void prepare(hdf5_file *file)
{
    (void)pthread_once(&turn_made, make_turn);
    (void)pthread_mutex_lock(&turn);
    (void)H5Eget_auto2(H5E_DEFAULT, &file->report, &file->report_data);
    (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    (void)H5PLget_loading_state(&file->plugins);
    (void)H5PLset_loading_state(0);
}

/* Leaves HDF5 as it was found. */
static void restore(const hdf5_file *file)
{
    (void)H5PLset_loading_state(file->plugins);
    (void)H5Eset_auto2(H5E_DEFAULT, file->report, file->report_data);
    (void)pthread_mutex_unlock(&turn);
}

/* On failure everything is as before; on success the lock is held until hdf5_close(). */
static dem_status open_file(hdf5_file *out, const char *path, unsigned access)
{
    hdf5_file file = {.id = H5I_INVALID_HID, .path = path};
    dem_status status = DEM_OK;
    if (access != H5F_ACC_RDONLY) {
        file.deflater = calloc(1, sizeof *file.deflater);
        CHECK_MEMORY(file.deflater);
    }
    prepare(&file);
    const hid_t how = make_access();
    /* An existing file is emptied, or opened as it is. */
    if (access == H5F_ACC_TRUNC)
        file.id = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, how);
    else
        file.id = H5Fopen(path, access, how);
    if (file.id < 0) status = hdf5_fail(&file, "", access == H5F_ACC_TRUNC ? "cannot be created" : "cannot be opened");
    (void)H5Pclose(how);
    if (status == DEM_OK)
        *out = file;
    else
        restore(&file);
    if (status != DEM_OK) free(file.deflater);
    return status;
}

/* Makes the closed file longer, so that a full disk is met here and not inside of HDF5; HDF5 cuts off at the next
 * closing what it has not used. A file system that cannot reserve is taken as it is. On failure the file has its old
 * length. */
static dem_status reserve(const char *path, int flags, hsize_t bytes)
{
    struct stat now = {0};
    const int descriptor = open(path, O_RDWR | O_CLOEXEC | flags, 0666);
    CHECK(descriptor >= 0, DEM_ERROR_IO, "%s: cannot be %s (%s)", path, flags != 0 ? "created" : "opened",
          strerror(errno));
    /* posix_fallocate() returns the error and leaves errno alone. */
    int cause = fstat(descriptor, &now) == 0 ? 0 : errno;
    if (cause == 0) cause = posix_fallocate(descriptor, now.st_size, (off_t)bytes + SLACK);
    /* Not an error: some file systems cannot reserve. */
    if (cause == EOPNOTSUPP || cause == EINVAL || cause == ENOSYS) cause = 0;
    if (cause != 0) (void)!ftruncate(descriptor, now.st_size);
    (void)close(descriptor);
    CHECK(cause == 0, DEM_ERROR_IO, "%s: there is no room for %llu bytes more (%s)", path,
          (unsigned long long)bytes + SLACK, strerror(cause));
    return DEM_OK;
}

/* Visits every object of the file and reads every dataset. */
static dem_status read_back(const char *path)
{
    hdf5_file file;
    TRY(hdf5_open_read(&file, path));
    unread u = {&file, DEM_OK};
    if (H5Lvisit(file.id, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &u) < 0 && u.status == DEM_OK)
        u.status = hdf5_fail(&file, "/", "cannot be listed");
    return hdf5_close(&file, u.status);
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

/* The error stack of HDF5 is valid only until its next call, so this must come first after a failure. */
dem_status hdf5_fail(const hdf5_file *file, const char *name, const char *what)
{
    char cause[200] = "no cause given";
    (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, cause);
    return status_fail(DEM_ERROR_IO, "%s: %s%s%s (%s)", file->path, name, *name != '\0' ? ": " : "", what,
                       shorten(cause));
}

dem_status hdf5_open_read(hdf5_file *out, const char *path)
{
    return open_file(out, path, H5F_ACC_RDONLY);
}

dem_status hdf5_open_write(hdf5_file *out, const char *path, hsize_t bytes)
{
    TRY(reserve(path, 0, bytes));
    return open_file(out, path, H5F_ACC_RDWR);
}

/* An empty file is made and closed before room is reserved in it: creating a file throws away what has been
 * reserved. */
dem_status hdf5_open_new(hdf5_file *out, const char *path, hsize_t bytes)
{
    hdf5_file empty;
    TRY(reserve(path, O_CREAT | O_TRUNC, bytes));
    TRY(open_file(&empty, path, H5F_ACC_TRUNC));
    TRY(hdf5_close(&empty, DEM_OK));
    return hdf5_open_write(out, path, bytes);
}

void hdf5_keep(hdf5_file *file)
{
    if (file->kept == NULL) file->kept = kept_datasets_create();
}

/* HDF5 does not know of the room that was reserved while the file was open, and leaves what it has not used. */
static dem_status cut_off(const hdf5_file *file)
{
    hsize_t bytes = 0;
    if (H5Fget_filesize(file->id, &bytes) < 0) return hdf5_fail(file, "", "cannot be measured");
    CHECK(truncate(file->path, (off_t)bytes) == 0, DEM_ERROR_IO, "%s: cannot be cut to its length (%s)", file->path,
          strerror(errno));
    return DEM_OK;
}

dem_status hdf5_pause(hdf5_file *file, dem_status status)
{
    if (status == DEM_OK && H5Fflush(file->id, H5F_SCOPE_GLOBAL) < 0) status = hdf5_fail(file, "", "cannot be flushed");
    if (status == DEM_OK) status = cut_off(file);
    if (status != DEM_OK) return hdf5_close(file, status);
    deflater_free(file->deflater);
    restore(file);
    return DEM_OK;
}

dem_status hdf5_resume(hdf5_file *file, hsize_t bytes)
{
    TRY(reserve(file->path, 0, bytes));
    prepare(file);
    return DEM_OK;
}

dem_status hdf5_close_paused(hdf5_file *file)
{
    prepare(file);
    return hdf5_close(file, DEM_OK);
}

/* The flush comes first, so that a failed write is found while the file is open. The lock is given back in any case. */
dem_status hdf5_close(hdf5_file *file, dem_status status)
{
    if (kept_datasets_close(file->kept) < 0 && status == DEM_OK) status = hdf5_fail(file, "", "cannot be written");
    file->kept = NULL;
    if (H5Fflush(file->id, H5F_SCOPE_GLOBAL) < 0 && status == DEM_OK) status = hdf5_fail(file, "", "cannot be flushed");
    if (H5Fclose(file->id) < 0 && status == DEM_OK) status = hdf5_fail(file, "", "cannot be closed");
    restore(file);
    if (file->deflater != NULL) deflater_free(file->deflater);
    free(file->deflater);
    return status;
}

/* The first dimension may grow without limit; the others are fixed. */
dem_status hdf5_create(const hdf5_file *file, const hdf5_rows *rows)
{
    const hsize_t extent[MAX_RANK] = {0, rows->tail[0], rows->tail[1]};
    /* Only rows can be added. */
    const hsize_t most[MAX_RANK] = {H5S_UNLIMITED, rows->tail[0], rows->tail[1]};
    const hid_t space = H5Screate_simple(rows->rank, extent, most);
    const hid_t links = make_parents(), layout = make_layout(rows);
    const hid_t dataset = H5Dcreate2(file->id, rows->name, file_type(rows->kind), space, links, layout, H5P_DEFAULT);
    const dem_status status = dataset < 0 ? hdf5_fail(file, rows->name, "cannot be created") : DEM_OK;
    if (dataset >= 0) (void)H5Dclose(dataset);
    if (layout >= 0) (void)H5Pclose(layout);
    (void)H5Pclose(links);
    (void)H5Sclose(space);
    return status;
}

dem_status hdf5_link(const hdf5_file *file, const char *name, const char *target)
{
    const hid_t links = make_parents();
    const bool linked = H5Lcreate_hard(file->id, target, file->id, name, links, H5P_DEFAULT) >= 0;
    const dem_status status = linked ? DEM_OK : hdf5_fail(file, name, "cannot be linked");
    (void)H5Pclose(links);
    return status;
}

/* Numbers of a row. */
static hsize_t width_of(const hdf5_rows *rows)
{
    return (rows->rank > 1 ? rows->tail[0] : 1) * (rows->rank > 2 ? rows->tail[1] : 1);
}

/* Whether the rows are all of a chunk, and in memory as they are stored but for their precision. */
static bool is_chunk(const hdf5_rows *rows, hsize_t first, hsize_t count)
{
    const bool whole = count > 0 && count == rows->chunk && count <= CHUNK_LIMIT && first % count == 0;
    return whole && rows->deflate > 0 && rows->kind != HDF5_I8 && H5Tequal(H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE) > 0;
}

/* A chunk at once, past HDF5's conversion, cache and filters. */
static dem_status write_chunk(const hdf5_file *file, const hdf5_rows *rows, hid_t dataset, hsize_t first,
                              const void *data)
{
    const hsize_t start[MAX_RANK] = {first};
    deflater *d = file->deflater;
    const deflater_numbers numbers = {data, rows->chunk * width_of(rows), H5Tget_size(file_type(rows->kind)),
                                      rows->kind == HDF5_F32};
    TRY(deflater_pack(d, numbers, rows->deflate));
    if (H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, start, d->n_packed, d->packed) < 0)
        return hdf5_fail(file, rows->name, "cannot be written");
    return DEM_OK;
}

static dem_status write_slab(const hdf5_file *file, const hdf5_rows *rows, hid_t dataset, hdf5_span span,
                             const void *data)
{
    const hsize_t start[MAX_RANK] = {span.at}, block[MAX_RANK] = {span.count, rows->tail[0], rows->tail[1]};
    const hid_t memory = H5Screate_simple(rows->rank, block, NULL), space = H5Dget_space(dataset);
    dem_status status = DEM_OK;
    if (space < 0 || H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, block, NULL) < 0 ||
        H5Dwrite(dataset, hdf5_memory_type(rows->kind), memory, space, H5P_DEFAULT, data) < 0)
        status = hdf5_fail(file, rows->name, "cannot be written");
    if (space >= 0) (void)H5Sclose(space);
    (void)H5Sclose(memory);
    return status;
}

/* Sets the number of rows to first + count, which also cuts off rows that a failed attempt has left, and fills the new
 * ones. Closing the dataset may be what fails: its chunk cache is written then. */
dem_status hdf5_append(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, const void *data)
{
    const hsize_t whole[MAX_RANK] = {first + count, rows->tail[0], rows->tail[1]};
    dem_status status = DEM_OK;
    const hid_t dataset = kept_datasets_open(file->kept, file->id, rows->name);
    if (dataset < 0 || H5Dset_extent(dataset, whole) < 0)
        status = hdf5_fail(file, rows->name, "cannot be written");
    else if (is_chunk(rows, first, count))
        status = write_chunk(file, rows, dataset, first, data);
    else if (count > 0)
        status = write_slab(file, rows, dataset, (hdf5_span){0, count, first}, data);
    if (dataset >= 0 && kept_datasets_leave(file->kept, dataset) < 0 && status == DEM_OK)
        status = hdf5_fail(file, rows->name, "cannot be written");
    return status;
}

dem_status hdf5_read(const hdf5_file *file, const hdf5_rows *rows, hsize_t first, hsize_t count, void *data)
{
    const hsize_t start[MAX_RANK] = {first}, block[MAX_RANK] = {count, rows->tail[0], rows->tail[1]};
    const hid_t dataset = hdf5_chunks_open(file->id, rows->name);
    if (dataset < 0) return hdf5_fail(file, rows->name, "cannot be read");
    dem_status status = hdf5_chunks_check(file->path, rows->name, dataset, start, block, rows->rank);
    if (status == DEM_OK && read_slab(dataset, hdf5_memory_type(rows->kind), start, block, rows->rank, data) < 0)
        status = hdf5_fail(file, rows->name, "cannot be read");
    (void)H5Dclose(dataset);
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

/* All rows are one chunk, since nothing is added later. */
dem_status hdf5_write(const hdf5_file *file, hdf5_rows rows, hsize_t count, const void *data)
{
    rows.chunk = count;
    TRY(hdf5_create(file, &rows));
    return hdf5_append(file, &rows, 0, count, data);
}

dem_status hdf5_write_attribute(const hdf5_file *file, const char *object, const char *name, hdf5_kind kind,
                                hsize_t count, const void *data)
{
    return write_attribute(file, object, (attribute_form){name, file_type(kind), hdf5_memory_type(kind), count}, data);
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
    const hid_t type = make_string(text, H5T_CSET_UTF8), space = H5Screate(H5S_SCALAR), links = make_parents();
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

/* A dataset of another shape counts as having no rows; hdf5_expect_rows() will refuse it. */
dem_status hdf5_count_rows(const hdf5_file *file, const char *name, hsize_t *count)
{
    hsize_t extent[MAX_RANK] = {0};
    const hid_t dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (dataset < 0) return hdf5_fail(file, name, "cannot be opened");
    *count = measure(dataset, extent) > 0 ? extent[0] : 0;
    (void)H5Dclose(dataset);
    return DEM_OK;
}

/* The type must be exactly the one that this library writes. */
dem_status hdf5_expect_rows(const hdf5_file *file, const hdf5_rows *rows, hsize_t count)
{
    hsize_t extent[MAX_RANK] = {0};
    const hid_t dataset = H5Dopen2(file->id, rows->name, H5P_DEFAULT);
    if (dataset < 0) return hdf5_fail(file, rows->name, "cannot be opened");
    const hid_t type = H5Dget_type(dataset);
    bool alike = H5Tequal(type, file_type(rows->kind)) > 0 && measure(dataset, extent) == rows->rank;
    for (int d = 1; d < rows->rank && alike; d++) alike = extent[d] == rows->tail[d - 1];
    (void)H5Tclose(type);
    (void)H5Dclose(dataset);
    CHECK(alike, DEM_ERROR_IO, "%s: %s: is of another type or shape", file->path, rows->name);
    CHECK(extent[0] == count, DEM_ERROR_IO, "%s: %s: has %llu rows, %llu were written", file->path, rows->name,
          (unsigned long long)extent[0], (unsigned long long)count);
    return DEM_OK;
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

/* The order matters: sync, read back, rename, sync the folder (base/publish.c). */
dem_status hdf5_publish(const char *part, const char *path)
{
    TRY(publish_sync(part));
    TRY(read_back(part));
    return publish_rename(part, path);
}
