/* SPDX-License-Identifier: BSD-3-Clause */
/* Features of surfaces that bodies touch: the one place where contacts ask where a surface is, how it is shaped, and
 * what law holds on it. Surfaces are those of the obstacles, whose nodes have inverse mass 0: they move by the laws of
 * the obstacles, whatever touches them. */
#ifndef DEM_CONTACT_SURFACE_FEATURE_H
#define DEM_CONTACT_SURFACE_FEATURE_H

#include "contact/scene.h"
#include "obstacle/given_motion.h"
#include "obstacle/point_gap.h"
#include "obstacle/edge_crossing.h"
#include "obstacle/vertex_gap.h"

typedef enum surface_kind { SURFACE_SEGMENT, SURFACE_VERTEX } surface_kind;

/** A segment, or a vertex where a surface bends so that the solid's corner sticks out. */
typedef struct surface_feature {
    surface_kind kind;
    dem_index id;
} surface_feature;

/** What holds between a body and a surface. */
typedef struct contact_law {
    double restitution, friction; /* eta, mu */
    dem_friction_law friction_law;
} contact_law;

/** A segment at a time. */
typedef struct surface_line {
    vec2 start, end;
    vec2 tangent, normal;    /* unit; the normal points out of the solid, to the left */
    double length;           /* m */
    dem_index before, after; /* the segments that go on at the start and at the end, -1 at a free end */
} surface_line;

static inline surface_line surface_line_of(const segment *s)
{
    return (surface_line){s->start, s->end, s->tangent, s->normal, s->length, s->before, s->after};
}

static inline surface_line surface_line_at(const contact_scene *scene, dem_index id, double t)
{
    segment moved;
    return surface_line_of(obstacles_segment(&scene->model->obstacles, id, t, &moved));
}

/** Where a vertex is at t. */
static inline vec2 surface_vertex_at(const contact_scene *scene, dem_index id, double t)
{
    return obstacles_vertex(&scene->model->obstacles, id, t);
}

/** Signed distance of x to a line, m, and place along it from its start, m. */
static inline double surface_height(const surface_line *line, vec2 x)
{
    return vec2_dot(vec2_sub(x, line->start), line->normal);
}

static inline double surface_place(const surface_line *line, vec2 x)
{
    return vec2_dot(vec2_sub(x, line->start), line->tangent);
}

/** The segment that a feature is, or that ends in the vertex it is. */
static inline dem_index surface_segment(const contact_scene *scene, surface_feature feature)
{
    return feature.kind == SURFACE_VERTEX ? scene->model->obstacles.vertices[feature.id].before : feature.id;
}

/** The obstacle that it is of, and the number of the segment in that obstacle's list. */
static inline dem_index surface_obstacle(const contact_scene *scene, surface_feature feature)
{
    return scene->model->obstacles.segments[surface_segment(scene, feature)].obstacle;
}

static inline dem_index surface_segment_index(const contact_scene *scene, surface_feature feature)
{
    return scene->model->obstacles.segments[surface_segment(scene, feature)].index;
}

/** The law between a body and an obstacle. */
static inline contact_law contact_law_of(const contact_scene *scene, dem_index obstacle)
{
    const dem_obstacle *o = &scene->model->obstacles.list[obstacle];
    return (contact_law){o->restitution, o->friction, o->friction_law};
}

/** Coefficient of the sustained friction of Coulomb's law; 0 where there is none. */
static inline double contact_law_friction(contact_law law)
{
    return law.friction_law == DEM_FRICTION_COULOMB ? law.friction : 0.0;
}

/** Whether a place `along` (m) a segment is near a free end of it, by this tolerance (m) or as far as the segment goes
 *  on inside another obstacle. */
bool surface_at_free_end(const contact_scene *scene, dem_index id, double along, double tolerance);

/** Whether a direction lies between the normals of a vertex at t. */
bool surface_in_cone(const contact_scene *scene, dem_index vertex, double t, vec2 direction);

/** Whether two segments are neighbours, and where the vertex is at t that they share. */
static inline bool surface_share(const contact_scene *scene, dem_index s, dem_index other, double t, vec2 *vertex)
{
    return obstacles_share(&scene->model->obstacles, t, s, other, vertex);
}

/** Bend where segment s ends (or, backwards, starts), and the segment beyond it. */
static inline obstacle_bend surface_bend(const contact_scene *scene, dem_index s, bool backwards, dem_index *beyond)
{
    return obstacles_bend(&scene->model->obstacles, s, backwards, beyond);
}

/** A point at a time. */
typedef struct surface_query {
    double t; /* s */
    vec2 x;
} surface_query;

/** No surface is faster, m/s; 0 if all rest. */
static inline double surface_speed(const contact_scene *scene)
{
    return scene->model->obstacles.bounds.speed;
}

/** No surface is accelerated more, m/s^2; 0 if each goes on as it does. */
static inline double surface_acceleration(const contact_scene *scene)
{
    return scene->model->obstacles.bounds.acceleration;
}

/** Whether the place of a surface could not be found since the failure was last asked for. */
static inline bool surface_failed(const contact_scene *scene)
{
    return scene->model->obstacles.is_asked && given_motion_failed();
}

/** Whether the surface of a segment moves, and the motion of its point at a place. */
static inline bool surface_moves(const contact_scene *scene, dem_index id)
{
    const obstacle_set *o = &scene->model->obstacles;
    return obstacles_moves(o, o->segments[id].obstacle);
}

static inline obstacle_motion surface_motion(const contact_scene *scene, dem_index id, surface_query at)
{
    const obstacle_set *o = &scene->model->obstacles;
    return obstacles_motion(o, o->segments[id].obstacle, at.t, at.x);
}

/** Motion of the corner in which two segments meet: theirs if both move alike, else that of the point where their lines
 *  cross. */
obstacle_motion surface_corner_motion(const contact_scene *scene, const dem_index ids[2], surface_query at);

/** Smallest of the signed distances of a point to the surfaces, leaving out up to two obstacles (-1: none). Free ends
 *  count as longer by `margin`, m. */
static inline obstacle_gap surface_gap(const contact_scene *scene, surface_query at, double margin,
                                       const dem_index without[2])
{
    return obstacles_gap(&scene->model->obstacles, at.t, at.x, margin, without[0], without[1]);
}

/** The segment over whose line the smallest of them is the height of all points about x, free ends counting as longer
 *  by scene_margin(). */
static inline obstacle_lone_segment surface_lone(const contact_scene *scene, vec2 x)
{
    return obstacles_lone_segment(&scene->model->obstacles, x, scene_margin(scene));
}

/** The distance of a point that it covers, the same as by a search, and the segment itself. */
static inline obstacle_gap surface_lone_gap(const contact_scene *scene, const obstacle_lone_segment *lone, vec2 x)
{
    return obstacle_lone_gap(&scene->model->obstacles, lone, x);
}

static inline const segment *surface_lone_segment(const contact_scene *scene, const obstacle_lone_segment *lone)
{
    return &scene->model->obstacles.segments[lone->segment];
}

/** The same to one obstacle, free ends counting as longer by scene_margin(). */
static inline obstacle_gap surface_gap_of(const contact_scene *scene, surface_query at, dem_index obstacle)
{
    return obstacles_gap_of(&scene->model->obstacles, at.t, at.x, scene_margin(scene), obstacle);
}

/** Segments that a point touches, at most `capacity` of them, into hits; returns their number. */
static inline int surface_touching(const contact_scene *scene, surface_query at, const obstacle_touch *point,
                                   dem_index *hits, int capacity)
{
    return obstacles_touching(&scene->model->obstacles, at.t, at.x, point, hits, capacity);
}

/** The vertex nearest to entering through an edge of a body at t. */
static inline obstacle_vertex_gap surface_vertex_gap(const contact_scene *scene, double t, const obstacle_edge *edge)
{
    return obstacles_vertex_gap(&scene->model->obstacles, t, edge);
}

/** Distance of the edge at t to the nearest convex vertex, at most its reach, m. */
static inline double surface_clearance(const contact_scene *scene, double t, const obstacle_edge *edge)
{
    return obstacles_clearance(&scene->model->obstacles, t, edge);
}

/** The segment that goes deepest through an edge at t, leaving out up to two obstacles (-1: none). */
static inline obstacle_crossing surface_crossing_of(const contact_scene *scene, double t, const vec2 edge[2],
                                                    const dem_index without[2])
{
    return obstacles_crossing(&scene->model->obstacles, t, edge, without);
}

#endif
