/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles as rigid bodies meet them: their points are vertices and their segments edges, which push by the contact
 * potential as edges of bodies do. Their motion is given, so that they are edges of infinite mass. A closed polyline
 * has its edges in front; an open one is a wall without thickness, round which its edges go there and back. */
#ifndef DEM_SURFACE_CONTACT_OBSTACLE_SURFACE_H
#define DEM_SURFACE_CONTACT_OBSTACLE_SURFACE_H

#include "model/model.h"

/** An edge with its body, or the solid of its obstacle, on the left; by the places of its ends in some list. */
typedef struct surface_edge {
    dem_index first, second;
    dem_index before, after; /* first end of the edge before it, second end of the one behind it */
} surface_edge;

typedef struct obstacle_surface {
    const obstacle_set *of;
    dem_index n_vertices, n_edges;
    dem_index *first_vertex;  /* [obstacles + 1] vertices first_vertex[k] .. first_vertex[k+1]-1 are of obstacle k */
    dem_index *obstacle;      /* [n_vertices] */
    double *half_length;      /* [n_vertices] m, half of what a vertex has of its obstacle's length */
    surface_edge *edges;      /* [n_edges] by numbers of vertices */
    box *frames;              /* [obstacles] of the points as they are given */
    pose *poses;              /* [obstacles] at the time asked for last, of those that move */
    unsigned char *is_marked; /* [n_vertices] scratch of those who list some of them, 0 */
} obstacle_surface;

enum { OBSTACLE_SURFACE_CORNERS = 4 };

/** Borrows the obstacles; the time is 0. Free with obstacle_surface_free().  \return DEM_ERROR_MEMORY */
dem_status obstacle_surface_compile(obstacle_surface *out, const obstacle_set *of);
void obstacle_surface_free(obstacle_surface *s);

/** Goes to the time t. */
void obstacle_surface_follow(obstacle_surface *s, double t);

/** Where a vertex is at the time asked for last. */
vec2 obstacle_surface_place(const obstacle_surface *s, dem_index vertex);

/** Where a corner of the box round an obstacle's points is: no vertex has gone further than one of them. */
vec2 obstacle_surface_corner(const obstacle_surface *s, dem_index obstacle, int corner);

/** Coefficient of friction of an obstacle: that of Coulomb's law. The paper's law is one of impacts, and has none. */
static inline double obstacle_surface_friction(const obstacle_surface *s, dem_index obstacle)
{
    const dem_obstacle *o = &s->of->list[obstacle];
    return o->friction_law == DEM_FRICTION_COULOMB ? o->friction : 0.0;
}

/** Whether any has. */
bool obstacle_surface_has_friction(const obstacle_surface *s);

/** Velocity of a vertex at the time asked for last, m/s. */
vec2 obstacle_surface_velocity(const obstacle_surface *s, dem_index vertex);

#endif
