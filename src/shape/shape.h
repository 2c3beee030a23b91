/* SPDX-License-Identifier: BSD-3-Clause */
/* An outline or a mask, less voids, in its own coordinates: what lies in its material, and its lattice. */
#ifndef DEM_SHAPE_SHAPE_H
#define DEM_SHAPE_SHAPE_H

#include <stdbool.h>

#include <dem/dem.h>

#include "lattice/grid.h"
#include "shape/mask.h"
#include "shape/outline.h"

typedef struct shape {
    outline outline; /* owned; of a mask the rectangle of its image */
    mask mask;       /* owned; without pixels: none */
    double spacing;  /* m */
    bool squares;    /* its lattice is of squares, each of two triangles, 2 k and 2 k + 1; else of triangles */
    bool smooth;     /* nodes are to lie on its edges, as smoothing.h moves them */
    size_t n_voids;
    outline *voids; /* owned */
} shape;

void shape_free(shape *s);

/* Takes the void over, also where memory runs out: then it returns false. */
bool shape_add_void(shape *s, outline *hole);

/* m: what is nearer to an edge is on it, and stays where the shape is cut out, whatever its rounding. */
double shape_slack(const shape *s);

/* Whether x lies in the material, voids apart; on the edge it does. */
bool shape_outline_has(const shape *s, const double x[2]);

/* What bounds the material: 0 is the outline, k + 1 is void k. \return the one whose edge is nearest to x, m */
size_t shape_edge(const shape *s, const double x[2]);
const outline *shape_edge_at(const shape *s, size_t edge);

/* Signed distance from the material, m: > 0 outside of it. Not of a mask. */
double shape_distance(const shape *s, const double x[2]);

/* Whether a disc about x is all material, m. */
bool shape_fits(const shape *s, const double x[2], double radius);

/* Whether a void lies in the outline, as far as a point of it tells. */
bool shape_has_void(const shape *s, const outline *hole);
const double *shape_void_point(const outline *hole);

/* Whether one of its voids takes a node of a lattice.  \param node  [n_nodes] those that are there; NULL: all */
bool shape_takes(const shape *s, const outline *hole, const dem_lattice *lattice, const bool *node);

/* What its lattice is cut out of. */
typedef struct shape_grid {
    grid rows;
    double reach;   /* m, of a disc about the origin of the grid, and only what is in it is made; 0: all is */
    double foot[2]; /* m, where this origin is */
} shape_grid;

/* \return DEM_ERROR_MODEL if it had too many nodes */
dem_status shape_find_grid(shape_grid *out, const shape *s);

/* Of each cell of a lattice of squares keeps both triangles or none.  \param keep [n_triangles] 0 or 1 */
void shape_keep_cells(bool *keep, dem_index n_triangles);

/* Takes out what of rows of such a grid is not in its disc, and puts the rest where the shape is.
 * \return DEM_ERROR_MODEL if nothing is left */
dem_status shape_place_rows(dem_lattice *rows, const shape_grid *g);

/* Triangulation that has the rectangle or disc of its outline, or covers any other one, without voids; of a smooth
 * shape it covers all, with two spacings about it. Caller owns *out.
 * \return DEM_ERROR_MODEL if it had too many nodes */
dem_status shape_mesh(dem_lattice *out, const shape *s);

/* Marks what of a lattice is neither beyond the outline nor in a void, whole cells of squares: nodes on the edge of one
 * stay.
 * \param[out] keep      [n_triangles]
 * \param[in,out] node  [n_nodes] those that are there; those of them that stay, but for whole cells */
void shape_mark(bool *keep, bool *node, const shape *s, const dem_lattice *lattice);

/* Takes out what is beyond the outline or in a void, whole cells of squares: nodes on the edge of one stay.
 * \return DEM_ERROR_MODEL if nothing is left */
dem_status shape_cut(dem_lattice *lattice, const shape *s);

#endif
