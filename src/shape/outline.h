/* SPDX-License-Identifier: BSD-3-Clause */
/* Plane figures in their place: how far a point is from one, its nearest point, and where it cuts a horizontal line. */
#ifndef DEM_SHAPE_OUTLINE_H
#define DEM_SHAPE_OUTLINE_H

#include <stdbool.h>
#include <stddef.h>

#include <dem/shape.h>

typedef struct outline {
    dem_outline_kind kind;
    double centre[2];     /* m, of a rectangle, a disc, a ring */
    double size[2];       /* m, width and height of a rectangle */
    double radius, inner; /* m, of a disc or a ring; inner: of the ring's hole */
    size_t n_points;      /* of a polygon; the last is joined to the first */
    double *points;       /* [n_points][2], m; owned */
} outline;

void outline_free(outline *o);

/* Makes a polygon of the points, or of a rectangle's corners, turned about the origin and shifted: `turn` holds cosine
 * and sine. Returns false when memory runs out. */
bool outline_place(outline *o, const double turn[2], const double shift[2]);

/* Signed distance to the edge, m: > 0 outside. */
double outline_distance(const outline *o, double x, double y);

/* The point of the edge that is nearest to x, m. */
void outline_nearest(const outline *o, const double x[2], double near[2]);

/* A corner of a rectangle or a polygon, and the cosine of the angle by which the edge turns there: 1 straight on. */
typedef struct outline_corner {
    double x[2]; /* m */
    double cosine;
} outline_corner;

size_t outline_corners(const outline *o);
outline_corner outline_corner_at(const outline *o, size_t k);

/* A straight side, from corner k to the next: there are as many as corners. */
typedef struct outline_side {
    double a[2], b[2]; /* m */
} outline_side;

outline_side outline_side_at(const outline *o, size_t k);

/* left, bottom, right, top, m */
void outline_box(const outline *o, double box[4]);

/* Where the line of height y enters and leaves, ascending, m: an even number of places, at most outline_cuts(). Lines
 * through outline_levels() are left out. */
size_t outline_slice(const outline *o, double y, double *x);
size_t outline_cuts(const outline *o);

/* Heights between which the slices change smoothly, at most outline_cuts() of them. \return their number */
size_t outline_levels(const outline *o, double *y);

/* The first two edges of a polygon, from 0, that meet though they are no neighbours, or fold back upon each other. */
bool outline_crossing(const outline *o, size_t edges[2]);

#endif
