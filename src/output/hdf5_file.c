/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that are written: opening, pausing, closing and publishing, and failures. Rows of datasets are in hdf5_rows.c,
 * attributes and texts in hdf5_attribute.c; nothing else calls HDF5 to write. Each function makes all HDF5 calls that
 * belong together, closes what it has opened, and turns a failure into a status that names file, dataset and cause.
 * Callers are protected from three properties of HDF5: it prints errors, it may leave a file that cannot be opened when
 * the disk is full, and it may load plugins that a file names. Reading files that may come from anywhere is in
 * hdf5_untrusted.c; what datasets a run has is decided by the other files of this folder. */
#include "output/hdf5_file.h"

#include "base/publish.h"
#include "base/status.h"
#include "output/hdf5_chunks.h"
#include "output/hdf5_stripes.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SLACK = 1 << 20 }; /* bytes; more than HDF5 adds to the data at one opening */

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

enum { SMALL = 0x10000 }; /* bytes by which a file in memory grows */

/* Closing the file closes all that is open in it, and no lock is taken, so that looking at a file does not stop a
 * run. */
static hid_t make_access(bool in_memory)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (in_memory && H5Pset_fapl_core(access, SMALL, false) < 0) return H5I_INVALID_HID;
    if (access >= 0 && H5Pset_fclose_degree(access, H5F_CLOSE_STRONG) >= 0 && H5Pset_file_locking(access, 0, 1) >= 0)
        return access;
    return H5I_INVALID_HID;
}

/* Missing groups on the way to a new object are made. */
hid_t hdf5_parents(void)
{
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    if (links >= 0) (void)H5Pset_create_intermediate_group(links, 1);
    return links;
}

/* Reads a block of numbers and throws them away. */
static dem_status read_slab(hid_t dataset, hid_t type, const hsize_t *start, const hsize_t *extent, int rank)
{
    size_t size = H5Tget_size(type);
    for (int d = 0; d < rank; d++) size *= (size_t)extent[d];
    void *buffer = malloc(size);
    if (buffer == NULL) return DEM_ERROR_MEMORY;
    const herr_t result = hdf5_chunks_read(dataset, type, start, extent, rank, buffer);
    free(buffer);
    return result < 0 ? DEM_ERROR_IO : DEM_OK;
}

/* The same, but that numbers which are deflated are not all in memory at once. */
static dem_status read_chunks(hid_t dataset, hid_t type, const hsize_t *start, const hsize_t *extent, int rank)
{
    bool all;
    TRY(hdf5_chunks_unpack(dataset, start, extent, &all));
    return all ? DEM_OK : read_slab(dataset, type, start, extent, rank);
}

/* Reads a whole dataset chunk by chunk. Returns DEM_OK, DEM_ERROR_MEMORY or DEM_ERROR_IO; the message is the
 * caller's. */
static dem_status read_slabs(hid_t dataset, hid_t type, hsize_t *extent, int rank)
{
    hsize_t start[HDF5_MAX_RANK] = {0}, chunk[HDF5_MAX_RANK] = {1, 1, 1};
    const hid_t layout = H5Dget_create_plist(dataset);
    const bool has_chunks = H5Pget_layout(layout) == H5D_CHUNKED;
    const herr_t result = has_chunks ? H5Pget_chunk(layout, rank, chunk) : 0;
    (void)H5Pclose(layout);
    dem_status status = result < 0 ? DEM_ERROR_IO : DEM_OK;
    /* A slab is as many rows as a chunk has, and all columns. */
    for (const hsize_t rows = extent[0]; status == DEM_OK && start[0] < rows; start[0] += chunk[0]) {
        extent[0] = rows - start[0] < chunk[0] ? rows - start[0] : chunk[0];
        status = has_chunks ? read_chunks(dataset, type, start, extent, rank)
                            : read_slab(dataset, type, start, extent, rank);
    }
    return status;
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
    hsize_t extent[HDF5_MAX_RANK] = {0};
    dem_status status = DEM_ERROR_IO;
    const hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank == 0)
        status = read_scalar(dataset, type);
    else if (rank > 0 && rank <= HDF5_MAX_RANK && H5Sget_simple_extent_dims(space, extent, NULL) >= 0)
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

/* Called for every link below the root. A number other than 0 ends the visit. What a link by name leads to is read
 * where it is, and so is what stands in another file. */
static herr_t visit(hid_t root, const char *name, const H5L_info_t *info, void *context)
{
    unread *u = context;
    if (info->type != H5L_TYPE_HARD) return 0;
    const hid_t object = H5Oopen(root, name, H5P_DEFAULT);
    dem_status status = object < 0 ? DEM_ERROR_IO : DEM_OK;
    if (status == DEM_OK && H5Iget_type(object) == H5I_DATASET && hdf5_stripes_count(object) == 0)
        status = read_dataset(object);
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
static dem_status open_with(hdf5_file *out, const char *path, unsigned access, bool in_memory)
{
    hdf5_file file = {.id = H5I_INVALID_HID, .path = path, .in_memory = in_memory};
    dem_status status = DEM_OK;
    if (access != H5F_ACC_RDONLY) {
        file.deflater = calloc(1, sizeof *file.deflater);
        CHECK_MEMORY(file.deflater);
    }
    prepare(&file);
    const hid_t how = make_access(in_memory);
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

static dem_status open_file(hdf5_file *out, const char *path, unsigned access)
{
    return open_with(out, path, access, false);
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

dem_status hdf5_open_small(hdf5_file *out, const char *path)
{
    return open_with(out, path, H5F_ACC_TRUNC, true);
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

/* By one call, so that a kill leaves no file, an empty one, or all of it. */
static dem_status write_bytes(const char *path, const void *bytes, size_t n)
{
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    CHECK(descriptor >= 0, DEM_ERROR_IO, "%s: cannot be created (%s)", path, strerror(errno));
    errno = ENOSPC; /* of a write that is cut short */
    const bool all = write(descriptor, bytes, n) == (ssize_t)n;
    const int cause = errno;
    (void)close(descriptor);
    if (!all) (void)unlink(path);
    CHECK(all, DEM_ERROR_IO, "%s: cannot be written (%s)", path, strerror(cause));
    return DEM_OK;
}

static dem_status write_from_memory(const hdf5_file *file)
{
    const ssize_t n = H5Fget_file_image(file->id, NULL, 0);
    void *bytes = malloc(n > 0 ? (size_t)n : 1);
    CHECK_MEMORY(bytes);
    dem_status status = DEM_OK;
    if (n <= 0 || H5Fget_file_image(file->id, bytes, (size_t)n) != n) status = hdf5_fail(file, "", "cannot be written");
    if (status == DEM_OK) status = write_bytes(file->path, bytes, (size_t)n);
    free(bytes);
    return status;
}

/* The flush comes first, so that a failed write is found while the file is open. The lock is given back in any case. */
dem_status hdf5_close(hdf5_file *file, dem_status status)
{
    if (kept_datasets_close(file->kept) < 0 && status == DEM_OK) status = hdf5_fail(file, "", "cannot be written");
    file->kept = NULL;
    if (H5Fflush(file->id, H5F_SCOPE_GLOBAL) < 0 && status == DEM_OK) status = hdf5_fail(file, "", "cannot be flushed");
    if (file->in_memory && status == DEM_OK) status = write_from_memory(file);
    if (H5Fclose(file->id) < 0 && status == DEM_OK) status = hdf5_fail(file, "", "cannot be closed");
    restore(file);
    if (file->deflater != NULL) deflater_free(file->deflater);
    free(file->deflater);
    return status;
}

/* Ends what made a link. */
static dem_status end_link(const hdf5_file *file, const char *name, hid_t links, herr_t made)
{
    const dem_status status = made >= 0 ? DEM_OK : hdf5_fail(file, name, "cannot be linked");
    (void)H5Pclose(links);
    return status;
}

bool hdf5_has(const hdf5_file *file, const char *name)
{
    return H5Lexists(file->id, name, H5P_DEFAULT) > 0;
}

dem_status hdf5_beside(char out[HDF5_PATH], const hdf5_file *file, const char *name)
{
    const char *slash = strrchr(file->path, '/');
    const int folder = slash != NULL ? (int)(slash - file->path) + 1 : 0;
    const int n = snprintf(out, HDF5_PATH, "%.*s%s", folder, file->path, name);
    CHECK(n > 0 && n < HDF5_PATH, DEM_ERROR_IO, "%s: the path of a file beside it is too long", file->path);
    return DEM_OK;
}

dem_status hdf5_link(const hdf5_file *file, const char *name, const char *target)
{
    const hid_t links = hdf5_parents();
    return end_link(file, name, links, H5Lcreate_hard(file->id, target, file->id, name, links, H5P_DEFAULT));
}

dem_status hdf5_link_name(const hdf5_file *file, const char *name, const char *target)
{
    const hid_t links = hdf5_parents();
    return end_link(file, name, links, H5Lcreate_soft(target, file->id, name, links, H5P_DEFAULT));
}

dem_status hdf5_link_file(const hdf5_file *file, const char *name, const char *other, const char *target)
{
    const hid_t links = hdf5_parents();
    return end_link(file, name, links, H5Lcreate_external(other, target, file->id, name, links, H5P_DEFAULT));
}

/* The order matters: sync, read back, rename, sync the folder (base/publish.c). */
dem_status hdf5_publish(const char *part, const char *path)
{
    TRY(publish_sync(part));
    TRY(read_back(part));
    return publish_rename(part, path);
}
