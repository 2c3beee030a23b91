/* SPDX-License-Identifier: BSD-3-Clause */
/* What the keys of &material and &body mean, geometry apart: from the groups to a lattice in its place. */
#ifndef DEM_BODY_H
#define DEM_BODY_H

#include <dem/dem.h>

#include "clearance.h"
#include "body_geometry.h"
#include "parts.h"
#include "schema.h"
#include "strengths.h"
#include "weakness.h"

/* What a body is built from and put into. */
typedef struct body_scene {
    const schema_deck *groups;
    const char *folder; /* of the deck, with its last '/', or "" */
    const dem_obstacle *obstacles;
    dem_index n_obstacles;
    double gravity[2]; /* m/s^2 */
} body_scene;

/* What can be said without geometry: keys a shape lacks or does not use, names and numbers that refer to nothing. */
void body_check_all(const schema_deck *groups, namelist_errors *errors);

/* Takes the defaults of keys away that a choice does not use: they mean nothing, and stated they are faults. */
void body_drop_unused(schema_deck *groups);

/* Puts 'lattice' for a default `outline` of bodies with independent springs: their stresses would be wrong at a smooth
 * one. To be called after body_drop_unused(). Returns false only when memory runs out. */
bool body_settle_outlines(schema_deck *groups);

/* How a body starts: its node that may touch and lies deepest in the obstacles; their point deepest in its triangles;
 * its side that they go through deepest. */
typedef struct body_start {
    size_t copy;        /* from 0 */
    double depth;       /* m; < 0 in front of all obstacles, -infinity where nothing can touch */
    double x[2];        /* of the node, m */
    double rest_length; /* m, of its shortest spring; infinity without springs */
    clearance_spike spike;
    clearance_pierced pierced;
    double angle, offset[2]; /* how its own coordinates were turned, radians, and shifted, m, */
    double shift[2];         /* at last by so much, to its clearance */
} body_start;

/* What the log says of a body. */
typedef struct body_facts {
    bool is_strip;          /* its lattice has but the boundary strip (slab_survey.h) */
    size_t further;         /* copies beside it, of each of which the same holds */
    double mass, true_mass; /* kg; of one; that of its true shape, 0 where none is known: of a lattice file */
    dem_plane plane;        /* of its material; stress where it has none */
    body_geometry geometry;
    double least_angle;   /* degrees, of all triangles in the end; 0 of a lattice file */
    dem_index n_included; /* triangles of its inclusions */
    parts_loose loose;    /* apart from its largest part */
    bool removed;         /* they have been */
    parts_hinges hinges;
    weakness_report weak;
    strengths strengths; /* of the copies, too; strengths_free() when these are made */
} body_facts;

/* Builds body k, from 0, of a deck without faults. A fault of its geometry is appended to `errors` and *out is empty.
 * Returns false only when memory runs out (*out is then empty). Caller owns *out. */
bool body_build(dem_lattice *out, body_facts *facts, body_start *start, const body_scene *scene, size_t k,
                namelist_errors *errors);

/* Moves the body that was built, or copied, last to where its next copy is to be, with strengths of its own. A fault is
 * appended to `errors`. Returns false only when memory runs out. */
bool body_copy(dem_lattice *lattice, const body_facts *facts, body_start *start, const body_scene *scene, size_t k,
               namelist_errors *errors);

/* Puts a body, or a slab of it, where its keys say, without regard to its clearance, in the motion that it starts with.
 * \param centre  of its mass, there, m, about which it spins; NULL: the lattice has all of the body
 * \return as dem_lattice_launch() and dem_lattice_spin() */
dem_status body_put(dem_lattice *lattice, const schema_instance *body, const double *centre);

/* Moves a body, or a slab of it, from where its last copy is, or where body_put() has put it, to where copy k, from 0,
 * is to be. `offset` is how far its own coordinates are shifted. False when memory runs out. */
bool body_put_copy(dem_lattice *lattice, double offset[2], const schema_instance *body, size_t k);

/* What is found of inclusions slab by slab. Zero at first; is_met is to be freed. */
typedef struct body_inclusions {
    size_t n;              /* that the body has */
    bool *is_met;          /* [n] they have a triangle */
    dem_index n_triangles; /* of theirs */
} body_inclusions;

/* Gives a slab of body k, as body_geometry_slab() makes it, the springs and masses that it has in the whole: a slab of
 * a lattice file has them. A fault is appended to `errors` with any other status but DEM_OK and DEM_ERROR_MEMORY.
 * \param found  in it the inclusions of the slab are counted */
dem_status body_assemble_slab(dem_slab *slab, body_inclusions *found, const body_scene *scene, size_t k,
                              namelist_errors *errors);

/* Puts the strip of a body, as a triangulation, in the place that body k has by its keys, with springs of its material.
 * A strip of a lattice file has springs already (file_slab.h). A fault is appended to `errors`. Returns false only when
 * memory runs out.
 * \param centre  of the mass of the body, m, as body_put() has it */
bool body_place_strip(dem_lattice *strip, body_start *start, const body_scene *scene, size_t k, const double centre[2],
                      namelist_errors *errors);

/* Reports body k if it starts deeper in an obstacle, or an obstacle in it, than `penetration_tolerance`, m. Returns
 * false only when memory runs out. */
bool body_check_start(const body_scene *scene, size_t k, const body_start *start, double penetration_tolerance,
                      namelist_errors *errors);

#endif
