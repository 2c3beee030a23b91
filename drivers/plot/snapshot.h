/* SPDX-License-Identifier: BSD-3-Clause */
/* A frame of a trajectory as it is drawn: where the nodes are, and the number that gives each its colour. */
#ifndef DEM_SNAPSHOT_H
#define DEM_SNAPSHOT_H

#include <stdint.h>

#include <dem/reader.h>

#include "box.h"
#include "cracks.h"
#include "outcome.h"
#include "pieces.h"
#include "quantity.h"
#include "colour_range.h"

typedef struct snapshot {
    const dem_reader *reader;
    const quantity *shown;
    const dem_lattice *lattice;
    size_t n_values;
    double *x;                       /* [n_nodes][2] m */
    double *value;                   /* [n_values] of springs or nodes */
    double *work;                    /* [n_values][components of the source] */
    const dem_reader_array *breaks;  /* NULL: springs never break */
    double *broken_springs;          /* [n_springs] not 0 where a spring is no more */
    unsigned char *broken_triangles; /* [n_triangles] 1 where a triangle is no more */
    pieces pieces;                   /* where colours stand for fragments */
    cracks cracks;                   /* empty unless they are drawn */
    unsigned char *is_bare;          /* [n_nodes] 1: no spring holds the node, which is drawn as a point */
    dem_index frame;
    double t;                  /* s */
    box bounds;                /* of the nodes, m */
    colour_range_extent reach; /* of the values */
} snapshot;

/** What has to be known of cracks, too. False after a fault, which is reported. */
bool snapshot_follow_cracks(snapshot *s, outcome *o);

/** Without a frame yet; borrows trajectory and quantity. False after a fault, which is reported. To be freed in any
 *  case. */
bool snapshot_create(snapshot *s, const dem_reader *reader, const quantity *shown, outcome *o);
void snapshot_free(snapshot *s);

/** False after a fault, which is reported. */
bool snapshot_load(snapshot *s, dem_index frame, outcome *o);

/** The mean length of a spring of the lattice at rest, m; 0 without springs. */
double snapshot_spacing(const snapshot *s);

/** The hash of its frame, time, places, values and of what is broken, after `hash`. */
uint64_t snapshot_hash(const snapshot *s, uint64_t hash);

/** How many nodes no spring holds.
 *  \param[out] is_bare  [n_nodes] 1 of these, else 0 */
dem_index snapshot_bare(const dem_lattice *l, unsigned char *is_bare);

/** The number that colours a spring, or a triangle: its own, or the mean of its nodes'. 0 without a quantity. */
double snapshot_spring_value(const snapshot *s, dem_index spring);
double snapshot_triangle_value(const snapshot *s, dem_index triangle);

#endif
