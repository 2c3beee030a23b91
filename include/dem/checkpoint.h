/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/checkpoint.h -- what a run has to remember so as to go on to the same bits, in memory and as a file.
 *
 *  A checkpoint is a list of entries: a name and bytes. dem_simulation_advance() takes one at t = 0 and after every
 *  `checkpoint_steps`-th accepted step, in every run, and goes on from it as a run does that is resumed from it; so
 *  whether one is written to disk, and when, changes no bit of the run. Observers put in themselves what they have to
 *  remember.
 *
 *  The file holds numbers as this machine does: it is for going on, not for exchange. One that is damaged is refused,
 *  whatever its bytes are. */
#ifndef DEM_CHECKPOINT_H
#define DEM_CHECKPOINT_H

#include <stddef.h>

#include <dem/status.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dem_checkpoint dem_checkpoint;

/** An empty one. */
DEM_API dem_status dem_checkpoint_create(dem_checkpoint **out);

/** Accepts NULL. */
DEM_API void dem_checkpoint_destroy(dem_checkpoint *checkpoint);

/** Copies `size` bytes into the entry of this name, which is made or replaced.
 *  \param name  1 to 31 characters
 *  \return DEM_ERROR_MEMORY, then the entry is as it was */
DEM_API dem_status dem_checkpoint_put(dem_checkpoint *checkpoint, const char *name, const void *data, size_t size);

/** Copies an entry out; the address may be that of any type without pointers.
 *  \return DEM_ERROR_IO if there is none of this name, or if it does not have `size` bytes */
DEM_API dem_status dem_checkpoint_get(const dem_checkpoint *checkpoint, const char *name, void *data, size_t size);

/** The bytes of an entry, aligned for any type, until it is put again; NULL if there is none.
 *  \param[out] size  their number */
DEM_API const void *dem_checkpoint_find(const dem_checkpoint *checkpoint, const char *name, size_t *size);

/** Writes a file: a temporary one beside it is synced and read back, the older file of this name becomes
 *  `path`.prev, and the new one takes its name. Whatever fails, and whenever the process or the machine stops, one of
 *  both is there and whole.
 *  \return DEM_ERROR_IO with the file and the cause */
DEM_API dem_status dem_checkpoint_write(const dem_checkpoint *checkpoint, const char *path);

/** \return DEM_ERROR_IO with the file and the reason: not there, no checkpoint, of another format, damaged */
DEM_API dem_status dem_checkpoint_read(dem_checkpoint **out, const char *path);

/** Syncs the closed file `part`, renames it to `path` and syncs the folder. */
DEM_API dem_status dem_publish(const char *part, const char *path);

#ifdef __cplusplus
}
#endif

#endif
