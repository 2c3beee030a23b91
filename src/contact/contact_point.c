/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics of closed contacts: where the touching point of the body is, how it moves relative to the obstacle, and
 * which acceleration keeps it there (docs/method.md, An edge on a vertex; Moving obstacles). Everything is a function
 * of the state (t, x, v); nothing is stored. A node on a segment and an edge on a convex vertex have the same
 * contact_frame, so that forces and impacts need not know which of the two they have. The forces are in
 * contact_forces.c, the geometry of obstacles in src/obstacle. */
#include "contact/contact_point.h"

#include <float.h>

/* beta in units of 1/max_step: how fast a closed contact that the integrator's error has opened is drawn back. */
static const double draw_back = 0.1;

/* Two edges between the same nodes, one for each side, differ in where they start. */
bool candidate_is_before(const contact_candidate *a, const contact_candidate *b)
{
    if (!candidate_is_edge(a) || !candidate_is_edge(b))
        return candidate_is_edge(a) == candidate_is_edge(b) ? a->node < b->node : !candidate_is_edge(a);
    const bool forth = a->node < a->other, back = b->node < b->other;
    const dem_index low[2] = {forth ? a->node : a->other, back ? b->node : b->other};
    const dem_index high[2] = {forth ? a->other : a->node, back ? b->other : b->node};
    if (low[0] != low[1]) return low[0] < low[1];
    return high[0] != high[1] ? high[0] < high[1] : a->node < b->node;
}

double contact_point_friction(const contact_scene *scene, const contact_candidate *candidate, dem_index feature)
{
    return contact_law_friction(contact_point_law(scene, candidate, feature));
}

/* Node on a segment, which is at rest: gap and place are linear in x, so that the integrator keeps them by itself once
 * velocity and acceleration along n are 0, and `turning` and `keep` stay 0. */
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

/* How the obstacle's vertex moves, m, m/s, m/s^2. */
typedef struct vertex_motion {
    bool moves; /* else only the place is given */
    vec2 at, velocity, acceleration;
} vertex_motion;

/* Edge from node a to b on a vertex V. P = (1 - s) a + s b is the point of the edge nearest to V, t and n the tangent
 * and normal of the edge, L its length, g = (P - V).n the gap. With v_P = (1 - s) v_a + s v_b, the velocity of the body
 * at P, and omega = (v_b - v_a).n/L, the turning rate of the edge,
 *   g' = v_P.n,   s' = -v_P.t/L,   g'' = a_P.n - 2 omega v_P.t   (where g = 0).
 * So a_P.n = 2 omega v_P.t keeps the contact closed while it slides (`turning`); if it sticks, s is constant and a_P =
 * 0. Neither constraint is linear in x, and the integrator's error opens them. To draw the contact back,
 *   keep = turning - 2 beta g' - beta^2 g,
 * which is critically damped; the same holds along t for a contact that sticks, with (P - V).t in place of g. If the
 * vertex moves, velocities are relative to its own, and its acceleration is added. */
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

/* A node on a segment that moves: b = w' + 2 q' z x (v - w), see docs/method.md, Moving obstacles. Where no obstacle
 * accelerates, the node's path on it is straight and nothing has to be drawn back. */
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

/* A node in a corner stays in it. The heights over both lines give by how much it is off the corner. */
vec2 contact_point_keep_corner(const contact_scene *scene, dem_index node, const surface_line lines[2],
                               const obstacle_motion *corner, scene_state state)
{
    if (surface_acceleration(scene) == 0.0) return corner->acceleration;
    const vec2 x = vec2_at(state.x, node), v = vec2_at(state.v, node);
    const double beta = draw_back / scene->rule.max_step;
    const vec2 off = vec2_with_products(surface_height(&lines[0], x), lines[0].normal, surface_height(&lines[1], x),
                                        lines[1].normal);
    const vec2 back = vec2_along(vec2_scale(-2.0 * beta, obstacle_motion_relative(corner, v)), -beta * beta, off);
    return vec2_add(corner->acceleration, back);
}

/* The frame of a node or an edge with the motion of the obstacle at the point that is touched. */
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

contact_frame contact_frame_on(const contact_scene *scene, const contact_candidate *candidate, dem_index feature,
                               scene_state state)
{
    contact_candidate alone = *candidate;
    alone.closed[0] = (contact_point){.feature = feature, .slide = 1};
    return contact_frame_at(scene, &alone, 0, state);
}

/* A displacement d changes the force on a node of mass m by at most m omega_max^2 d/2, N. Here d is the rounding of the
 * coordinates of the node and its neighbours, 64 units in the last place of their extent, and m = 1/mobility. */
double contact_point_slack(const contact_scene *scene, const contact_frame *f, const double *x)
{
    const double omega = scene->model->omega_max,
                 extent = vec2_norm(vec2_at(x, f->nodes.node[0])) + 2.0 * scene->model->spacing;
    return 32.0 * DBL_EPSILON * extent * omega * omega / f->mobility;
}

/* 64 roundings of the velocities that are subtracted: of both nodes of an edge, and of the wall. */
double contact_point_noise(const contact_frame *f, const double *v)
{
    const contact_nodes *on = &f->nodes;
    double speed = vec2_norm(f->wall);
    for (int p = 0; p < on->n && on->n > 1; p++) speed += fabs(on->weight[p]) * vec2_norm(vec2_at(v, on->node[p]));
    return 64.0 * DBL_EPSILON * speed;
}

/* Only positions are needed of the frame; x stands in for the velocities, which are not read further. */
dem_contact contact_point_describe(const contact_scene *scene, const contact_candidate *candidate, int q, double t,
                                   const double *x)
{
    const contact_point *point = &candidate->closed[q];
    const contact_frame f = contact_frame_at(scene, candidate, q, (scene_state){t, x, x});
    const surface_feature feature = contact_point_feature(candidate, point->feature);
    const vec2 at =
        candidate_is_edge(candidate) ? surface_vertex_at(scene, point->feature, t) : vec2_at(x, candidate->node);
    dem_contact out = {.n_nodes = f.nodes.n,
                       .body = scene->model->lattice.body[candidate->node],
                       .other_body = -1,
                       .state = contact_point_state(point),
                       .obstacle = surface_obstacle(scene, feature),
                       .segment = surface_segment_index(scene, feature),
                       .x = {at.x, at.y},
                       .normal = {f.normal.x, f.normal.y},
                       .force = point->force,
                       .friction = {point->friction, 0.0}};
    for (int p = 0; p < f.nodes.n; p++) {
        out.nodes[p] = model_node(scene->model, f.nodes.node[p]);
        out.weights[p] = f.nodes.weight[p];
    }
    return out;
}
