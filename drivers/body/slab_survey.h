/* SPDX-License-Identifier: BSD-3-Clause */
/* What is found of a body slab by slab, in their order, so that nobody has to have all of it: whether it hangs
 * together, and its boundary strip, the triangles that have a node on the boundary. Only these meet obstacles. The
 * triangle with the shortest side of all is there, too, as tolerances go by that side. */
#ifndef DEM_SLAB_SURVEY_H
#define DEM_SLAB_SURVEY_H

#include <stdbool.h>

#include <dem/slab.h>

typedef struct slab_corner {
    dem_index number; /* in the whole */
    double x[2];      /* m */
    unsigned char flags;
} slab_corner;

/* Zero at first. Free with slab_survey_free() in any case. */
typedef struct slab_survey {
    dem_index n_corners, corner_room;
    slab_corner *corners; /* [n_corners] of the triangles of the strip, three each */
    bool has_inner;       /* there are triangles inside of the strip, */
    double shortest;      /* m, of which this is the shortest side, */
    slab_corner inner[3]; /* and this the triangle that has it */
    bool has_hinge;       /* triangles meet in a node that share no edge */
    double rest_length;   /* m, of the shortest spring; 0 without springs */
    dem_index n_parts, part_room;
    dem_index *parent; /* [n_parts] of parts of slabs, which of them are one (base/union_find.h) */
    dem_index n_last;
    dem_index *last_number, *last_part; /* [n_last] of the nodes of the last slab, ascending */
} slab_survey;

/* Looks at a triangulation, which has no springs yet. False when memory runs out. */
bool slab_survey_add_strip(slab_survey *s, const dem_slab *slab);

/* Looks at its springs and at what they connect. False when memory runs out. */
bool slab_survey_add_parts(slab_survey *s, const dem_slab *slab);

/* Whether the body is in one part, all of whose triangles hang together by edges. */
bool slab_survey_is_one(const slab_survey *s);

/* The strip, with the triangle that has the shortest side, as a triangulation, whose nodes on the boundary of the body
 * may touch, and no others. False when memory runs out; *out is then empty. */
bool slab_survey_take_strip(dem_lattice *out, slab_survey *s);

void slab_survey_free(slab_survey *s);

#endif
