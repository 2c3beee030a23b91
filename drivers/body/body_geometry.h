/* SPDX-License-Identifier: BSD-3-Clause */
/* What the keys of &body, &void, &pores, &crack and &inclusion say of a body's geometry: from the groups to a
 * triangulation, and to the materials of its triangles. The keys have passed body_checks_all(). */
#ifndef DEM_BODY_GEOMETRY_H
#define DEM_BODY_GEOMETRY_H

#include <dem/dem.h>
#include <dem/shape.h>
#include <dem/slab.h>

#include "schema.h"

#define BODY_GEOMETRY_ASIDE 1e-6 /* of the spacing: how far cracks run beside their points */

/* What came out beside the triangulation. */
typedef struct body_geometry {
    double spacing;   /* m, of its lattice; of a mesh the side of an equilateral triangle as large as its smallest */
    double area;      /* m^2, true one of the shape, which the lattice's comes near to; cracks have none */
    double pore_area; /* m^2, of its random pores */
    double mass;      /* kg, of that area: by the material of the body, and of its inclusions where they are */
    size_t n_pores;   /* random ones */
    size_t n_inclusions;
    dem_index n_cracked;     /* triangles that cracks took */
    dem_shape_report report; /* of a smooth outline; else n_rim is 0 */
} body_geometry;

/* Triangulates body k, from 0, of any shape but 'file'; there are no springs yet. Caller owns *lattice, which is empty
 * unless DEM_OK is returned; a fault is appended to `errors` with any other status but DEM_ERROR_MEMORY. `folder`: see
 * body_geometry_file(). */
dem_status body_geometry_triangulate(dem_lattice *lattice, body_geometry *out, const schema_deck *groups, size_t k,
                                     const char *folder, namelist_errors *errors);

/* A slab of a body: the rows whose first nodes have the numbers from `begin` on, before `end`. */
typedef struct body_range {
    dem_index begin, end;
} body_range;

/* A body of a deck, from 0, and the folder for its file: see body_geometry_file(). */
typedef struct body_keys {
    const schema_deck *groups;
    size_t k;
    const char *folder;
    dem_index **rows; /* for slabs: NULL in it, or what an earlier one left, which is to be freed: counts of rows, or
                         ranges of nodes. The first number says how many follow */
} body_keys;

/* The same as body_geometry_triangulate() of a slab of a body, which is no mesh; n_cracked and the report are those of
 * the whole where the slab had no `rows` yet, else 0. A lattice file has no geometry, and gives all that it has of the
 * nodes in the range, wherever they are in a row. Where there are no such rows, or nodes, the slab has the numbers of
 * nodes and triangles of the body, and no own nodes. Free with dem_slab_free(). */
dem_status body_geometry_slab(dem_slab *slab, body_geometry *out, const body_keys *body, body_range range,
                              namelist_errors *errors);

/* What a fault of an image's lattice may come from: which pixels are material; "" for other shapes. */
const char *body_geometry_hint(const schema_instance *body);

/* Whether a body's lattice is of squares: its triangles 2 k and 2 k + 1 are then a cell. */
bool body_geometry_has_squares(const schema_instance *body);

/* Takes the numbers that the triangles of a triangulation had before anything was cut out of it, which came along as
 * its strengths: they do not depend on cuts, cracks and voids. [n_triangles], malloc'ed; NULL when memory runs out. */
dem_index *body_geometry_take_numbers(dem_lattice *lattice);

/* The groups that name the materials of body k: itself, then its inclusions, i from 0. */
const schema_instance *body_geometry_user(const schema_deck *groups, size_t k, size_t i);

/* The material of body k; and those of it and of its inclusions, [1 + n_inclusions]. */
dem_material body_geometry_material(const schema_deck *groups, size_t k);
void body_geometry_materials(dem_material *out, const schema_deck *groups, size_t k);

/* Which of these each triangle of its lattice has: that of the last inclusion that its centre is in; whole cells of
 * squares.
 * \param[out] of  [n_triangles]
 * \param is_met   [n_inclusions] those that have a triangle here become true: the lattice is but a part of the body;
 *                 NULL: it is all of it, and an inclusion without a triangle is a fault */
dem_status body_geometry_mark(dem_index *of, bool *is_met, const dem_lattice *lattice, const schema_deck *groups,
                              size_t k, namelist_errors *errors);

/* Path of the file that a body is made from, malloc'ed; NULL when memory runs out. `folder` is that of the deck, with
 * its last '/', or "". */
char *body_geometry_file(const char *folder, const schema_instance *body);

#endif
