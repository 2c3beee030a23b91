/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/shape.h -- triangulations of bodies by their shapes: rectangles, discs, rings, polygons and images, less voids
 *  and random pores; those of meshes by Gmsh; and what of a lattice lies in a figure or on a crack.
 *  A dem_shape or a dem_mesh becomes a lattice of nodes and triangles, which dem/lattice.h cuts further, assembles and
 *  moves. */
#ifndef DEM_SHAPE_H
#define DEM_SHAPE_H

#include <stddef.h>
#include <stdint.h>

#include <dem/lattice.h>
#include <dem/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- figures --------------------------------------------------------------------------------------------------- */

typedef enum dem_outline_kind {
    DEM_OUTLINE_RECTANGLE = 0,
    DEM_OUTLINE_DISC,
    DEM_OUTLINE_RING,
    DEM_OUTLINE_POLYGON
} dem_outline_kind;

enum { DEM_OUTLINE_MAX_POINTS = 10000 }; /**< of a polygon: its check takes time of order points^2 */

/** A plane figure in its place. Members that its kind does not use are not looked at. */
typedef struct dem_outline {
    size_t struct_size; /**< to be set to sizeof(dem_outline), in each of an array */
    dem_outline_kind kind;
    double centre[2]; /**< m: of a rectangle, a disc, a ring; of a polygon how far its points are shifted */
    double angle;     /**< radians: by which a rectangle is turned about its centre, a polygon about the origin of its
                           points, before it is shifted */
    double size[2];   /**< m, > 0: width and height of a rectangle */
    double radius;    /**< m, > 0: of a disc, or the outer one of a ring */
    double inner_radius;  /**< m, > 0, < radius: of the hole of a ring */
    dem_index n_points;   /**< of a polygon, 3 to DEM_OUTLINE_MAX_POINTS; the last may be the first once more */
    const double *points; /**< [n_points][2], m, in either sense, consecutive ones distinct; the caller's, only read */
} dem_outline;

/** Whether points make a polyline: finite ones, n >= 1, with lengths between them that can be computed with.
 *  \param points  [n][2] m
 *  \return DEM_ERROR_ARGUMENT, with points numbered from 1 in its message */
DEM_API dem_status dem_points_check(const double *points, dem_index n);

/** Whether a figure is one: numbers in their ranges, and a polygon that does not meet itself.
 *  \return DEM_ERROR_ARGUMENT, with points and edges numbered from 1 in its message */
DEM_API dem_status dem_outline_check(const dem_outline *outline);

/** The box around a figure.  \param[out] box  [4] left, bottom, right, top, m */
DEM_API dem_status dem_outline_box(const dem_outline *outline, double box[4]);

/** Signed distances of points from the edge, > 0 outside; of a polygon that meets itself they have no meaning.
 *  \param x  [n][2] m
 *  \param[out] distance  [n] m */
DEM_API dem_status dem_outline_distance(const dem_outline *outline, const double *x, dem_index n, double *distance);

/** Number of corners; 0 of discs and rings, and of what is no figure. */
DEM_API dem_index dem_outline_corners(const dem_outline *outline);

/** Where a corner is, in the order of points; of a rectangle counter-clockwise from the lower left before it is turned.
 *  \param k  from 0
 *  \param[out] x  [2] m */
DEM_API dem_status dem_outline_corner(const dem_outline *outline, dem_index k, double x[2]);

/* ---- shapes ---------------------------------------------------------------------------------------------------- */

enum { DEM_IMAGE_MAX_SIDE = 32768 }; /**< pixels */

/** A body drawn in pixels. The origin is the middle of the lower edge. */
typedef struct dem_image {
    size_t struct_size;         /**< to be set to sizeof(dem_image) */
    dem_index width, height;    /**< pixels, 1 to DEM_IMAGE_MAX_SIDE */
    double pixel;               /**< m, > 0: side of a pixel */
    const unsigned char *solid; /**< [height][width] not 0: material; the top row first; the caller's, only read */
} dem_image;

/** What lattices are made of. */
typedef enum dem_grid {
    DEM_GRID_TRIANGLES = 0, /**< equilateral ones, for dem_lattice_assemble() */
    DEM_GRID_SQUARES        /**< cells of two triangles, 2 k and 2 k + 1, for dem_lattice_assemble_squares() */
} dem_grid;

/** What becomes of nodes near edges. */
typedef enum dem_edge {
    DEM_EDGE_STEPPED = 0, /**< they stay in the grid: edges that are not along it have steps */
    DEM_EDGE_SMOOTH       /**< they are moved on to the edges, so that areas, stresses and bending converge; no triangle
                               gets an angle below 20 degrees. For triangles, with springs coupled in the material */
} dem_edge;

/** What is to be triangulated: an outline or an image, less voids and pores. All is in one system of coordinates. */
typedef struct dem_shape {
    size_t struct_size;         /**< to be set to sizeof(dem_shape) */
    const dem_outline *outline; /**< the body's edge; NULL for an image */
    const dem_image *image;     /**< NULL for an outline */
    double spacing; /**< m, > 0: length of the sides of triangles or squares; not more than the width and the height of
                         the body, the radius of a disc, the wall of a ring */
    dem_grid grid;
    dem_edge edge;            /**< smooth: neither with squares nor of an image */
    dem_index n_voids;        /**< >= 0 */
    const dem_outline *voids; /**< [n_voids] that are not material; they may overlap, and stick out of the body */
    dem_index n_pores;        /**< >= 0 */
    const double *pores;      /**< [n_pores][3] x, y and radius > 0 of round voids, m: see dem_shape_place_pores() */
    bool numbered;    /**< true: `strength` of the lattice holds the numbers that its triangles had before anything was
                        cut, and keeps them at further cuts. They are for dem_weibull.number: what is drawn for a place
                        then does not depend on voids and cracks. To be taken out, and `strength` freed and set to NULL,
                        before the lattice is assembled */
    const char *name; /**< by which messages call it, such as "body 1"; NULL: "the shape" */
} dem_shape;

/** What came out beside the lattice. */
typedef struct dem_shape_report {
    size_t struct_size;  /**< to be set to sizeof(dem_shape_report) */
    dem_index n_rim;     /**< of a smooth edge: nodes at it; else 0, as the next three */
    dem_index n_off;     /**< of these nodes, those that could not be moved on to an edge */
    dem_index n_cut;     /**< corners that no node is near, so that they are cut off */
    double farthest;     /**< m, that the worst of the n_off nodes is off its edge */
    dem_index idle_void; /**< after a failure too: the void, from 0, that takes nothing of the body; else -1 */
} dem_shape_report;

/** Triangulates a shape: nodes and triangles only, as dem_lattice_rectangle() does. Of an outline of triangles that is
 *  not smooth the nodes are those of an equilateral grid: of a rectangle that is not turned it has rows along its lower
 *  side and its height is rounded to whole ones, in a disc or a ring a node is at its centre, others stand on their
 *  lowest points. Nodes on an edge belong to the body. Coordinates are mirror symmetric to the bit where the shape is.
 *  \param[out] out     from dem_lattice_empty(); overwritten, not freed; caller owns it
 *  \param[out] report  may be NULL
 *  \return DEM_ERROR_ARGUMENT for a member outside its range, and where there would be more than 2^40 nodes;
 *          DEM_ERROR_MODEL where a void lies wholly outside of the body, and where nothing is left of it;
 *          DEM_ERROR_MEMORY */
DEM_API dem_status dem_shape_lattice(dem_lattice *out, const dem_shape *shape, dem_shape_report *report);

/** True area of a shape without its lattice: exact to rounding where all edges are straight, to 1e-4 of the body for
 *  others. Takes time of order (n_voids + n_pores)^2.
 *  \param[out] area  m^2 */
DEM_API dem_status dem_shape_area(const dem_shape *shape, double *area);

/* ---- pores ----------------------------------------------------------------------------------------------------- */

enum { DEM_PORES_MAX = 10000 }; /**< of one recipe: placing takes time of order number^2 */

/** How radii of pores are distributed. */
typedef enum dem_pore_radii {
    DEM_PORE_RADII_UNIFORM = 0, /**< from radius_min to radius_max */
    DEM_PORE_RADII_LOGNORMAL,
    DEM_PORE_RADII_NORMAL
} dem_pore_radii;

/** Round pores of random sizes at random places. */
typedef struct dem_pores {
    size_t struct_size; /**< to be set to sizeof(dem_pores) */
    dem_index number;   /**< 0 to DEM_PORES_MAX; 0: as many as the area needs */
    double area;        /**< m^2, >= 0: of all pores where number is 0, such as a porosity times dem_shape_area(); they
                             miss it by at most half of the last one's */
    double radius_min;  /**< m, > 0: no smaller one is drawn, and no larger one than the next */
    double radius_max;  /**< m, >= radius_min */
    dem_pore_radii distribution;
    double mean, deviation; /**< m, > 0: of all numbers drawn, those beyond included; not of a uniform distribution */
    double wall;            /**< m, >= 0: least material between two pores, and between a pore and an edge */
    uint64_t seed;          /**< below 2^32 counts; 0 is as 4357 */
} dem_pores;

/** Draws radii and places the pores in the material of a shape, the largest first, each at the first admissible of at
 *  most 100,000 random centres. The same recipe gives the same pores on every machine. They become part of a shape as
 *  its `pores`, where those of further recipes are appended.
 *  \param[out] pores  [capacity][3] x, y and radius, m, by falling radius
 *  \param capacity    number of rows; DEM_PORES_MAX are enough for any recipe, `number` of them where that is not 0
 *  \param[out] n      how many there are; after DEM_ERROR_MODEL how many have found a place, DEM_PORES_MAX where the
 *                     area needs more than these
 *  \return DEM_ERROR_ARGUMENT for a number outside its range, where next to no radius lies between the smallest and the
 *          largest, and where the capacity is too small; DEM_ERROR_MODEL where a pore finds no place or the area needs
 *          more than DEM_PORES_MAX; DEM_ERROR_MEMORY */
DEM_API dem_status dem_shape_place_pores(const dem_shape *shape, const dem_pores *recipe, double *pores,
                                         dem_index capacity, dem_index *n);

/* ---- meshes ---------------------------------------------------------------------------------------------------- */

/** A mesh by Gmsh: MSH 4.1, text, with triangles of 3 nodes in the plane z = 0; `gmsh -2 -format msh41` writes it.
 *  Points and lines among its elements are passed over. */
typedef struct dem_mesh {
    size_t struct_size; /**< to be set to sizeof(dem_mesh) */
    const char *path;   /**< of its file, a regular one of 1 GiB at most; NULL for a text */
    const char *text;   /**< [size] what would be in the file, any bytes, without a zero at the end; NULL for a path */
    dem_index size;     /**< bytes of the text, >= 0 */
    double scale;       /**< m, > 0: length of 1 in its coordinates */
    bool numbered;      /**< as in dem_shape */
} dem_mesh;

/** Reads a mesh: its nodes, but for those of no triangle, and its triangles, made counter-clockwise, both in the order
 *  of the mesh. Nodes and triangles only, as of dem_shape_lattice().
 *  \param[out] out  from dem_lattice_empty(); overwritten, not freed; caller owns it
 *  \return DEM_ERROR_MODEL for what is no such mesh, without triangles, or with one that has no area or overlaps
 *          another on its side of an edge: the message is "PATH:LINE: what is wrong", of a text "the mesh:LINE: ...",
 *          with the end of a long path only; DEM_ERROR_IO where the file cannot be read; DEM_ERROR_ARGUMENT for a
 *          member outside its range; DEM_ERROR_MEMORY */
DEM_API dem_status dem_mesh_lattice(dem_lattice *out, const dem_mesh *mesh);

/* ---- what of a lattice is where -------------------------------------------------------------------------------- */

/** Marks triangles whose centres lie in a figure or on its edge, and springs whose middles do, such as those of an
 *  inclusion of another material.
 *  \param step  1; 2: both triangles of a cell of squares go by their common centre
 *  \param[out] triangles  [n_triangles]; may be NULL
 *  \param[out] springs    [n_springs]; may be NULL */
DEM_API dem_status dem_lattice_inside(const dem_lattice *lattice, const dem_outline *outline, dem_index step,
                                      bool *triangles, bool *springs);

/** Marks triangles and springs that a polyline crosses. A crack is what is left when these triangles are taken out, by
 *  dem_lattice_trim(); of cells of squares both go.
 *  \param points    [n_points][2], m, n_points >= 2, consecutive ones distinct
 *  \param aside     m, >= 0: how far the polyline is shifted to its left, usually 1e-6 of the spacing: where it runs
 *                   along edges it then crosses the triangles on its left, and nodes on it belong to its right face
 *  \param[out] triangles  [n_triangles]; may be NULL
 *  \param[out] springs    [n_springs]; may be NULL */
DEM_API dem_status dem_lattice_crossed(const dem_lattice *lattice, const double *points, dem_index n_points,
                                       double aside, bool *triangles, bool *springs);

/** The least angle of all triangles, which tells how sound they are.
 *  \param[out] angle  radians; 0 if a triangle is turned over, pi/2 without triangles */
DEM_API dem_status dem_lattice_least_angle(const dem_lattice *lattice, double *angle);

#ifdef __cplusplus
}
#endif

#endif
