/* SPDX-License-Identifier: BSD-3-Clause */
/* The files of a run NAME: the live part NAME.part.vtkhdf, the segments NAME.00001.vtkhdf, ... with the rows before it,
 * and the whole NAME.vtkhdf that they become. A new file has a temporary name until it is whole, and no file is removed
 * before the one that replaces it is on the disk. A kill at any moment therefore leaves, for every checkpoint that was
 * written after its segments, either these segments or a whole with their rows. Where there are stripes (stripes.h)
 * each of these files has the arrays of its frames in files beside it. */
#ifndef DEM_OUTPUT_TRAJECTORY_PARTS_H
#define DEM_OUTPUT_TRAJECTORY_PARTS_H

#include "output/trajectory_rows.h"

enum {
    PARTS_WHOLE,
    PARTS_PART,
    PARTS_OBSTACLE,
    PARTS_OBSTACLE_PART,
    PARTS_BODY,
    PARTS_BODY_PART,
    PARTS_HEAD, /* temporary: the next segment, or the whole */
    PARTS_REST, /* temporary: the next part */
    PARTS_NAMES
};

#define PARTS_SUFFIX ".vtkhdf"

typedef struct segments {
    char *names[PARTS_NAMES];
    char *segment;    /* name of the segment that name_segment() was last asked for */
    size_t size;      /* of each name */
    dem_index n;      /* segments before the part */
    bool soiled;      /* the part may have a mark or peaks of a failed attempt: rows must be copied from it */
    hdf5_span *spans; /* [kinds of rows] scratch */
} segments;

/** `path` must end in PARTS_SUFFIX; stripes get their names from it. Free with trajectory_parts_free(), after a failure
 *  too. */
dem_status trajectory_parts_init(segments *out, const char *path, trajectory_rows *r);
void trajectory_parts_free(segments *s);

/** Makes a part without rows, in place of an older one. After a failure there is no part. */
dem_status trajectory_parts_open(const segments *s, const trajectory_rows *r);

/** Writes the arrays of a frame to the stripes of the part, if there are any. */
dem_status trajectory_parts_append(const segments *s, const trajectory_rows *r, const dem_simulation *simulation);

/** Removes the segments with numbers above s->n. */
dem_status trajectory_parts_prune(segments *s);

/** Makes the rows up to `upto` [n_kinds] the next segment. The buffers must be empty. On failure nothing changes. */
dem_status trajectory_parts_cut(segments *s, trajectory_rows *r, const hsize_t *upto);

/** Finds the segments with the rows up to `upto`, the last of which ends at r->history.last. If they are not there but
 *  a whole is, its first rows are made into one segment.
 *  \return DEM_ERROR_IO with the file that is missing or belongs to another run */
dem_status trajectory_parts_find(segments *s, trajectory_rows *r, const hsize_t *upto);

/** Publishes all rows, and the peaks, as the whole. The buffers must be empty. */
dem_status trajectory_parts_join(segments *s, const trajectory_rows *r);

#endif
