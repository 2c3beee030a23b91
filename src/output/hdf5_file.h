/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 files of this library, and failures as a status that names file, dataset and cause. Names are absolute paths
 * within the file; missing groups on the way are made. What is in files is written and read by hdf5_rows.h and
 * hdf5_attribute.h. */
#ifndef DEM_OUTPUT_HDF5_FILE_H
#define DEM_OUTPUT_HDF5_FILE_H

#include <stdbool.h>

#include <dem/dem.h>

#include "output/deflater.h"
#include "output/hdf5_api.h"
#include "output/kept_datasets.h"

/** An open file. It must be opened and closed by the same thread, and until it is closed other threads wait to open
 *  theirs. Meanwhile HDF5 prints no errors in this thread, and loads no plugins (programs that a file names) in this
 *  process. */
typedef struct hdf5_file {
    hid_t id;
    const char *path;
    H5E_auto2_t report; /**< how errors were printed before */
    void *report_data;
    unsigned plugins;   /**< whether plugins were loaded before */
    deflater *deflater; /**< of a file that is written to */
    team *team;         /**< whose threads pack; NULL at first: the caller */
    kept_datasets *kept;
    bool in_memory;     /**< until it is closed */
    bool takes_stripes; /**< of one that may come from anywhere: its rows may stand in files beside it */
} hdf5_file;

enum { HDF5_PATH = 4608 /**< bytes */ };

dem_status hdf5_open_read(hdf5_file *out, const char *path);

/** Opens to add up to about `bytes`, after reserving room for them: if HDF5 1.10 itself meets a full disk, the file
 *  cannot be opened any more. Takes no lock, so that programs may look at the file during a run. */
dem_status hdf5_open_write(hdf5_file *out, const char *path, hsize_t bytes);

/** The same with a new, empty file in place of an older one. */
dem_status hdf5_open_new(hdf5_file *out, const char *path, hsize_t bytes);

/** A new file of a few kilobytes, in memory: closing writes it at once, in place of an older one, so that a kill leaves
 *  an empty file or all of it. */
dem_status hdf5_open_small(hdf5_file *out, const char *path);

/** Keeps the datasets that rows are appended to, or read from, from now on open until the file is closed. */
void hdf5_keep(hdf5_file *file);

/** Flushes, so that on the disk is a whole file, and gives back the lock; the file stays open. After a failure, which
 *  may be `status`, it is closed. */
dem_status hdf5_pause(hdf5_file *file, dem_status status);

/** After a pause, what hdf5_open_write() does; after a failure the pause goes on. Or the file is closed after it. */
dem_status hdf5_resume(hdf5_file *file, hsize_t bytes);
dem_status hdf5_close_paused(hdf5_file *file);

/** Flushes and closes.
 *  \return `status` if that is a failure already; otherwise whether closing succeeded */
dem_status hdf5_close(hdf5_file *file, dem_status status);

/** DEM_ERROR_IO with "path: name: what (innermost cause given by HDF5)". To be called before any other HDF5 call. */
dem_status hdf5_fail(const hdf5_file *file, const char *name, const char *what);

/** Property list for a new object by which missing groups on the way to it are made. */
hid_t hdf5_parents(void);

/** Whether there is an object of this name. */
bool hdf5_has(const hdf5_file *file, const char *name);

/** The path of a file in the same folder.  \return DEM_ERROR_IO if it is too long */
dem_status hdf5_beside(char out[HDF5_PATH], const hdf5_file *file, const char *name);

/** Gives a dataset a second name. */
dem_status hdf5_link(const hdf5_file *file, const char *name, const char *target);

/** A link by name, to what the file may get later. */
dem_status hdf5_link_name(const hdf5_file *file, const char *name, const char *target);

/** A link by name to an object of another file.
 *  \param other  as seen from the folder of this file */
dem_status hdf5_link_file(const hdf5_file *file, const char *name, const char *other, const char *target);

/** Syncs the closed file `part`, reads all of it back that stands in it, renames it to `path`, which may be its name,
 *  and syncs the folder. HDF5 1.10 may report success on a full disk, so that only reading shows whether the file is
 *  whole. */
dem_status hdf5_publish(const char *part, const char *path);

#endif
