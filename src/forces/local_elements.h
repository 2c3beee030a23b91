/* SPDX-License-Identifier: BSD-3-Clause */
/* The springs and triangles near an event, listed by local numbers, and their forces. Damping is not among them. */
#ifndef DEM_FORCES_LOCAL_ELEMENTS_H
#define DEM_FORCES_LOCAL_ELEMENTS_H

#include "forces/forces.h"
#include "forces/local_nodes.h"

/** A spring between two local nodes, first < second: where their rows begin, twice their numbers. */
typedef struct local_bond {
    int32_t first, second;
} local_bond;

/** The other two corners of a triangle at a local node, counter-clockwise; -1: it is broken. */
typedef struct local_corners {
    int32_t next, last;
    double rest_area; /* m^2 */
} local_corners;

/** The corners of a triangle that has a guard and no area term, local nodes. */
typedef struct local_guarded {
    int32_t corner[3];
} local_guarded;

/** A triangle whose springs are coupled. */
typedef struct local_coupled {
    coupled_triangle own; /* with local nodes as its corners */
    double left;
} local_coupled;

/** How many of each list are those of the nodes before a node. */
typedef struct local_places {
    int32_t bonds, pulls, corners, guarded, coupled, pushes;
} local_places;

/** What acts between local nodes. */
typedef struct local_lists {
    bool by_node;           /* whether sums go node by node */
    local_places *places;   /* [n + 1] of the n nodes that are accelerated, and of all of them */
    local_bond *bonds;      /* each is listed at its first node */
    int32_t *pulls;         /* of nodes, in the order of forces_of_elements(): 4 bond, + 2 on its second node */
    int32_t *pushes;        /* of nodes, in that order: 3 coupled + corner */
    local_guarded *guarded; /* each is listed at the corner with the lowest number, as the coupled are */
    double *pushed, *pulled, *rest_length; /* of bonds: stiffness under pressure and in tension, N; m */
    double *inverse_mass;                  /* of the nodes that are accelerated, 1/kg */
    double *onset;                         /* of guarded: area below which the guard acts, m^2 */
    local_coupled *coupled;
} local_lists;

enum { LOCAL_ELEMENTS_LISTS = 11, LOCAL_ELEMENTS_ARRAYS = LOCAL_ELEMENTS_LISTS + 4 };

typedef struct local_elements {
    const forces *forces;
    local_lists own, lists;     /* memory for them; those that count: these, or others that are kept elsewhere */
    double *both;               /* [bonds][2][2] force on the first node, and on the second, N: scratch */
    vec2 *coupled_force;        /* [coupled][3] on the corners, N: scratch */
    local_corners *corners;     /* of nodes, in the order of forces_of_elements(), too; */
    bool have_corners;          /* whether they are listed: where no guard is on nobody asks for them */
    double *known;              /* [n_known][2] where nodes were at first, m: */
    dem_index n_known, n_slack; /* of so many of the guarded triangles it is known that they are off */
    bool were_near;             /* all of them when they were looked at last */
    double leeway;              /* as long as no coordinate is further from these than this, m; < 0: it is not known */
    dem_index room[LOCAL_ELEMENTS_ARRAYS]; /* of the arrays */
} local_elements;

/** Lists what acts between the nodes.  \param by_node  whether sums go node by node, to the bits of
 *  forces_of_elements(); otherwise there are no elements but springs
 *  \return DEM_ERROR_MEMORY: nothing is listed. Free with local_elements_destroy(). */
dem_status local_elements_list(local_elements *e, const local_nodes *nodes, bool by_node);

/** Lists anew what acts between the nodes of ring 0, where elements have broken or softened since.
 *  \return DEM_ERROR_MEMORY: nothing is listed */
dem_status local_elements_renew(local_elements *e, const local_nodes *nodes);

/** Takes lists that are kept elsewhere, of these nodes; they are borrowed until others are listed or taken.
 *  \return DEM_ERROR_MEMORY: nothing is listed */
dem_status local_elements_take(local_elements *e, const local_nodes *nodes, const local_lists *lists);
void local_elements_destroy(local_elements *e);

/** Forces, N, of the elements on the nodes of a ring or nearer, f [n][2], at local positions x [n][2] of one ring more,
 *  for which f has room. */
void local_elements_push(local_elements *e, const local_nodes *nodes, int ring, const double *x, double *f);

/** The same right after it, at positions that only the first n_moved nodes have changed. */
void local_elements_push_moved(local_elements *e, const local_nodes *nodes, dem_index n_moved, int ring,
                               const double *x, double *f);

#endif
