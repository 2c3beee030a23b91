/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames of closed contacts. */
#include "contact/contact_point.h"

#include <float.h>

/* How fast a closed contact that the integrator's error has opened is drawn back, in units of 1/max_step. */
static const double draw_back = 0.1;

double contact_point_friction(const contact_scene *scene, const contact_candidate *candidate, dem_index feature)
{
    return contact_law_friction(contact_point_law(scene, candidate, feature));
}

static inline contact_frame node_frame(const contact_scene *scene, const contact_candidate *candidate,
                                       const surface_line *line, scene_state state)
{
    const vec2 at = vec2_at(state.x, candidate->node);
    return (contact_frame){.nodes = {1, {candidate->node}, {1.0}},
                           .normal = line->normal,
                           .tangent = line->tangent,
                           .velocity = vec2_at(state.v, candidate->node),
                           .gap = surface_height(line, at),
                           .place = surface_place(line, at),
                           .mobility = scene->model->inverse_mass[candidate->node]};
}

typedef struct vertex_motion {
    bool moves; /* else only the place is given */
    vec2 at, velocity, acceleration;
} vertex_motion;

/* Vertex V on the edge from a to b, P = (1 - s) a + s b the point of the edge nearest to it, N normal and t tangent of
 * the edge, gap g = (P - V).N. With v_P the velocity of the point of the body at P and omega = (v_b - v_a).N/L,
 *   g' = v_P.N,  s' = -v_P.t/L,  g'' = a_P.N - 2 omega v_P.t  (at g = 0):  a_P.N = 2 omega v_P.t keeps it closed.
 * If the vertex moves, velocities and accelerations are relative to it. */
static inline contact_frame edge_frame(const contact_scene *scene, const contact_candidate *candidate,
                                       const contact_point *point, const vertex_motion *vertex, scene_state state)
{
    const vec2 at = vertex->at;
    const vec2 a = vec2_at(state.x, candidate->node), b = vec2_at(state.x, candidate->other), ab = vec2_sub(b, a);
    const vec2 va = vec2_at(state.v, candidate->node), vb = vec2_at(state.v, candidate->other);
    const double length = vec2_norm(ab);
    const vec2 t = vec2_scale(1.0 / length, ab), n = {-t.y, t.x};
    const double place = point->slide == 0 ? point->place : vec2_dot(vec2_sub(at, a), t) / length;
    const double turn = vec2_dot(vec2_sub(vb, va), n) / length;
    contact_frame f = {
        .nodes = {2, {candidate->node, candidate->other}, {1.0 - place, place}}, .normal = n, .tangent = t};
    const double beta = draw_back / scene->rule.max_step;
    const vec2 off = vec2_sub(vec2_along(a, place, ab), at);
    f.velocity = contact_nodes_sum(&f.nodes, state.v);
    if (vertex->moves) f.wall = vertex->velocity;
    if (vertex->moves) f.velocity = vec2_sub(f.velocity, f.wall);
    f.gap = vec2_dot(off, n);
    f.place = place;
    const double vn = vec2_dot(f.velocity, n), vt = vec2_dot(f.velocity, t);
    f.turning = point->slide == 0 ? 0.0 : 2.0 * turn * vt;
    if (vertex->moves) f.carried = vec2_dot(vertex->acceleration, t);
    if (vertex->moves) f.turning += vec2_dot(vertex->acceleration, n);
    f.keep[0] = f.turning - beta * (2.0 * vn + beta * f.gap);
    f.keep[1] = -beta * (2.0 * vt + beta * vec2_dot(off, t));
    if (vertex->moves) f.keep[1] += f.carried;
    f.mobility = contact_nodes_mobility(&f.nodes, scene->model->inverse_mass);
    return f;
}

vec2 contact_point_keep(const contact_scene *scene, dem_index node, const surface_line *line,
                        const obstacle_motion *wall, scene_state state)
{
    const vec2 x = vec2_at(state.x, node), v = vec2_at(state.v, node), carried = obstacle_motion_sliding(wall, v);
    if (surface_acceleration(scene) == 0.0) return carried;
    const double beta = draw_back / scene->rule.max_step;
    const vec2 back = vec2_along(vec2_scale(-2.0 * beta, obstacle_motion_relative(wall, v)),
                                 -beta * beta * surface_height(line, x), line->normal);
    return vec2_add(carried, back);
}

contact_frame contact_frame_moving(const contact_scene *scene, const contact_candidate *candidate, int q,
                                   scene_state state)
{
    const contact_point *point = &candidate->closed[q];
    const dem_index id = surface_segment(scene, contact_point_feature(candidate, point->feature));
    if (candidate_is_edge(candidate)) {
        const vec2 at = surface_vertex_at(scene, point->feature, state.t);
        const obstacle_motion wall = surface_motion(scene, id, (surface_query){state.t, at});
        const vertex_motion vertex = {wall.moves, at, wall.velocity, wall.acceleration};
        return edge_frame(scene, candidate, point, &vertex, state);
    }
    const surface_line line = surface_line_at(scene, id, state.t);
    const obstacle_motion wall = surface_motion(scene, id, (surface_query){state.t, vec2_at(state.x, candidate->node)});
    contact_frame f = node_frame(scene, candidate, &line, state);
    const vec2 carried = obstacle_motion_sliding(&wall, f.velocity),
               keep = contact_point_keep(scene, candidate->node, &line, &wall, state);
    f.wall = wall.velocity;
    f.velocity = obstacle_motion_relative(&wall, f.velocity);
    f.turning = vec2_dot(carried, f.normal);
    f.carried = vec2_dot(carried, f.tangent);
    f.keep[0] = vec2_dot(keep, f.normal);
    f.keep[1] = vec2_dot(keep, f.tangent);
    return f;
}

contact_frame contact_frame_at(const contact_scene *scene, const contact_candidate *candidate, int q, scene_state state)
{
    const contact_point *point = &candidate->closed[q];
    if (surface_speed(scene) > 0.0) return contact_frame_moving(scene, candidate, q, state);
    if (candidate_is_edge(candidate)) {
        const vertex_motion vertex = {.at = scene->model->obstacles.vertices[point->feature].at};
        return edge_frame(scene, candidate, point, &vertex, state);
    }
    const surface_line line = surface_line_of(&scene->model->obstacles.segments[point->feature]);
    return node_frame(scene, candidate, &line, state);
}

/* A displacement d changes the force on a node of mass m by at most m omega_max^2 d/2; here it is the rounding of the
 * coordinates of the node and its neighbours, 64 units. */
double contact_point_slack(const contact_scene *scene, const contact_frame *f, const double *x)
{
    const double omega = scene->model->omega_max,
                 extent = vec2_norm(vec2_at(x, f->nodes.node[0])) + 2.0 * scene->model->spacing;
    return 32.0 * DBL_EPSILON * extent * omega * omega / f->mobility;
}

double contact_point_noise(const contact_frame *f, const double *v)
{
    const contact_nodes *on = &f->nodes;
    double speed = vec2_norm(f->wall);
    for (int p = 0; p < on->n && on->n > 1; p++) speed += fabs(on->weight[p]) * vec2_norm(vec2_at(v, on->node[p]));
    return 64.0 * DBL_EPSILON * speed;
}

dem_contact contact_point_describe(const contact_scene *scene, const contact_candidate *candidate, int q, double t,
                                   const double *x)
{
    const contact_point *point = &candidate->closed[q];
    const contact_frame f = contact_frame_at(scene, candidate, q, (scene_state){t, x, x});
    const surface_feature feature = contact_point_feature(candidate, point->feature);
    const vec2 at =
        candidate_is_edge(candidate) ? surface_vertex_at(scene, point->feature, t) : vec2_at(x, candidate->node);
    dem_contact out = {.n_nodes = f.nodes.n,
                       .state = point->held || point->slide == 0 ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP,
                       .obstacle = surface_obstacle(scene, feature),
                       .segment = surface_segment_index(scene, feature),
                       .x = {at.x, at.y},
                       .normal = {f.normal.x, f.normal.y},
                       .force = point->force,
                       .friction = point->friction};
    for (int p = 0; p < f.nodes.n; p++) {
        out.nodes[p] = f.nodes.node[p];
        out.weights[p] = f.nodes.weight[p];
    }
    return out;
}
