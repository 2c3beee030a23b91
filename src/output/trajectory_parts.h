/* SPDX-License-Identifier: BSD-3-Clause */
/* The files of a run NAME: the live part NAME.part.vtkhdf, the segments NAME.00001.vtkhdf, ... with the rows before it,
 * and the whole NAME.vtkhdf that they become. What is made stands under a name of its own until it is whole, and
 * nothing is removed before what takes its place is on the disk: a kill at any moment leaves, for every checkpoint that
 * was written after its segments, these segments or a whole with their rows. */
#ifndef DEM_OUTPUT_TRAJECTORY_PARTS_H
#define DEM_OUTPUT_TRAJECTORY_PARTS_H

#include "output/trajectory_rows.h"

enum {
    PARTS_WHOLE,
    PARTS_PART,
    PARTS_OBSTACLE,
    PARTS_OBSTACLE_PART,
    PARTS_HEAD, /* temporary: the next segment, or the whole */
    PARTS_REST, /* temporary: the next part */
    PARTS_NAMES
};

#define PARTS_SUFFIX ".vtkhdf"

typedef struct segments {
    char *names[PARTS_NAMES];
    char *segment;    /* the one last named */
    size_t size;      /* of each name */
    dem_index n;      /* before the part */
    bool soiled;      /* the part may have what only its next name would have asked for */
    hdf5_span *spans; /* [kinds of rows] scratch */
} segments;

/** `path` must end in PARTS_SUFFIX. Free with trajectory_parts_free(), after a failure too. */
dem_status trajectory_parts_init(segments *out, const char *path, const trajectory_rows *r);
void trajectory_parts_free(segments *s);

/** Makes the part without rows, in place of an older one; after a failure there is none. */
dem_status trajectory_parts_open(const segments *s, const trajectory_rows *r);

/** Removes the segments beyond those that count. */
dem_status trajectory_parts_prune(segments *s);

/** Makes the rows up to `upto` [n_kinds] the next segment. The buffers must be empty. On failure nothing changes. */
dem_status trajectory_parts_cut(segments *s, trajectory_rows *r, const hsize_t *upto);

/** Finds the segments with the rows up to `upto`, which end with r->history.last; where they are not, but a whole is,
 *  its first rows become the one segment.
 *  \return DEM_ERROR_IO with the file that is missing or another's */
dem_status trajectory_parts_find(segments *s, trajectory_rows *r, const hsize_t *upto);

/** Publishes all rows and the peaks as the whole. The buffers must be empty. */
dem_status trajectory_parts_join(segments *s, const trajectory_rows *r);

#endif
