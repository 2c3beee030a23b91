/* SPDX-License-Identifier: BSD-3-Clause */
/* Which of a run's checkpoints goes to disk, as NAME.checkpoint, and when; and whether a later run may go on from it.
 * */
#ifndef DEM_CHECKPOINT_FILE_H
#define DEM_CHECKPOINT_FILE_H

#include <dem/checkpoint.h>

#include "command.h"
#include "deck.h"
#include "output.h"
#include "run_log.h"

/* ---- what is there ---- */

typedef enum checkpoint_state {
    CHECKPOINT_NONE,
    CHECKPOINT_FOUND,
    CHECKPOINT_OTHER, /* of another problem, output or version */
    CHECKPOINT_DAMAGED,
    CHECKPOINT_MEMORY /* ran out */
} checkpoint_state;

/** To be set to 0. */
typedef struct checkpoint_source {
    dem_checkpoint *checkpoint; /* NULL: none */
    double t;                   /* s, of it */
    char *lineage; /* the versions that the run has had so far and has now, a line each; NULL: only this one */
} checkpoint_source;

/** Looks for a checkpoint beside the output at `path`. One that is damaged is renamed to NAME.checkpoint.damaged where
 *  the one before serves. `reason` says what is wrong with what was found. Free with checkpoint_file_source_free() in
 *  any case, which sets it to 0.
 *  \param anyway  another version will do */
checkpoint_state checkpoint_file_find(checkpoint_source *out, const char *path, const deck *d, bool anyway,
                                      char reason[OUTPUT_REASON]);
void checkpoint_file_source_free(checkpoint_source *source);

/* ---- what is written ---- */

typedef struct checkpoint_file {
    char path[OUTPUT_PATH];
    const deck *deck;
    const checkpoint_source *source;
    dem_trajectory *trajectory;
    run_log *log;
    requests *requests;
    double interval;    /* s on the wall between checkpoints */
    double deadline;    /* s on the wall */
    double wall_next;   /* s, from when on the next checkpoint is written */
    double wall_ending; /* s, when the end was asked for; 0: it was not */
    double t_written;   /* s, of the checkpoint on disk; < 0: none of this run */
    char versions[256];
    const char *ended; /* why the run was stopped; NULL: it was not */
} checkpoint_file;

/** The first is due after 30 s, or the interval where that is shorter: a young run has something to lose too.
 *  \param path  of the output */
checkpoint_file checkpoint_file_start(const command *c, const char *path, const deck *d,
                                      const checkpoint_source *source);

/** To be handed to the simulation behind all others, trajectory and log set. Once the end is asked for it ends the run
 *  at the next checkpoint, or after ten seconds, and then with the checkpoint before.
 *  \param every  steps from one look at the clock to the next; 0: 1 */
dem_observer checkpoint_file_observer(checkpoint_file *c, dem_index every);

/** Puts the last checkpoint on the disk, what was seen up to it before. */
dem_status checkpoint_file_save(checkpoint_file *c, const dem_simulation *simulation);

/** The same for a run that is complete: all is in its output. */
dem_status checkpoint_file_close(checkpoint_file *c, const dem_simulation *simulation);

#endif
