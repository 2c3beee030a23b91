/* SPDX-License-Identifier: BSD-3-Clause */
/* Moving a body along gravity to a given distance from the obstacles, and which points of theirs are in it then. */
#ifndef DEM_CLEARANCE_H
#define DEM_CLEARANCE_H

#include <stdbool.h>

#include <dem/dem.h>

/* A body in its place, and a model of it that knows the obstacles. */
typedef struct clearance_body {
    const dem_model *model;
    const dem_lattice *lattice;
    /* Whether the lattice has but the triangles at the boundary of the body, whose nodes are those that may touch
     * (slab_survey.h). */
    bool is_strip;
} clearance_body;

/* The shift along `gravity` (not 0) after which the smallest gap between body and obstacles, where the motion starts,
 * is `clearance`: of the nodes that may touch, by dem_model_gap(), and of the obstacles' points to the sides between
 * two such nodes. A body nearer than that, inside an obstacle, or with one through a side goes back to the first place
 * free of it; from there, or from where it is, it goes on until it is as near as that for the first time. *reached is
 * false if no obstacle lies in its way. Returns false when memory runs out. */
bool clearance_shift(double shift[2], bool *reached, const clearance_body *body, const double gravity[2],
                     double clearance);

/* A point of an obstacle in the material of a body. */
typedef struct clearance_spike {
    dem_index obstacle, point; /* from 0 */
    double x[2];               /* m */
    double depth;              /* m, to the nearest side of the body; 0: there is no such point */
} clearance_spike;

/* The point that lies deepest in the triangles that can move, where their motion starts. Only triangles are material:
 * springs alone let points pass. Returns false when memory runs out. */
bool clearance_find_spike(clearance_spike *deepest, const clearance_body *body, const dem_obstacle *list,
                          dem_index n_obstacles);

/* A side of a body with an obstacle through it, which may end in a void of the body. */
typedef struct clearance_pierced {
    dem_index obstacle, point; /* from 0: its segment that begins at that point */
    double x[2];               /* m, the middle of the side */
    double depth;              /* m, by which either must move to come apart; 0: there is no such side */
} clearance_pierced;

/* The side that an obstacle goes through deepest, of those between two nodes that may touch and can move, by the flags
 * of the model and at the places of the lattice. Returns false when memory runs out. */
bool clearance_find_pierced(clearance_pierced *deepest, const clearance_body *body);

#endif
