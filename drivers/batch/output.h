/* SPDX-License-Identifier: BSD-3-Clause */
/* Where a run writes, and whether it may: an output of another problem is never touched. */
#ifndef DEM_OUTPUT_H
#define DEM_OUTPUT_H

#include <stdbool.h>

#include "deck.h"

/** What to do about files that are in the way. */
#define OUTPUT_WAY_OUT "move it away, change 'name' in &output, or use --overwrite"

typedef enum output_state {
    OUTPUT_FREE,    /* nothing there, or a part of the same problem that a new run may replace */
    OUTPUT_DONE,    /* the same run is there, complete */
    OUTPUT_SHORTER, /* a run of the same problem is there, complete, to no later t_end */
    OUTPUT_TAKEN    /* something else is there */
} output_state;

enum {
    OUTPUT_PATH = 4096, /* bytes of a path */
    OUTPUT_REASON = OUTPUT_PATH + 512,
    OUTPUT_HASH = 20 /* of a hash as text, with some to spare */
};

/** A hash as it stands in /provenance. */
void output_print_hash(char text[OUTPUT_HASH], uint64_t hash);

/** Folder and name to the path of NAME.vtkhdf; false if it does not fit. */
bool output_path(char *path, size_t size, const char *folder, const char *name);

/** Makes a folder where it is missing, and those above it. Where that fails `path` is the one that cannot be made, and
 *  `reason` says why. */
bool output_make_folder(const char *folder, char path[OUTPUT_PATH], char reason[OUTPUT_REASON]);

/** Whether a run could write into the folder, or make it; nothing is left behind. Where not, `path` is the folder that
 *  is in the way or cannot be made, and `reason` says why. */
bool output_check_folder(const char *folder, char path[OUTPUT_PATH], char reason[OUTPUT_REASON]);

/** The path of a file beside it: with another end than ".vtkhdf". */
void output_beside(char out[OUTPUT_PATH], const char *path, const char *end);

/** Looks at what lies at `path` and at its part; `reason` says in words what was found. */
output_state output_claim(const char *path, const deck *d, char reason[OUTPUT_REASON]);

/** Renames every file of the output at `path` from NAME... to NAME.old..., or to NAME.old2... and so on if there are
 *  such files; `reason` says what failed, or the new name. One with stripes is left alone. */
bool output_set_aside(const char *path, char reason[OUTPUT_REASON]);

#endif
