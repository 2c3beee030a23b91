/* SPDX-License-Identifier: BSD-3-Clause */
/* What counts as rest (docs/method.md, What counts as rest): rebounds whose hop would be lower than what tolerances,
 * rounding or the depth of impacts make of hops anyway, or shorter than twice the window. With eta < 1 a point bounces
 * infinitely often in finite time (Zeno); the hop below which it counts as rest is what ends this. Nodes
 * (impact_node.c) and groups (impact_group.c) have the same rule. */
#include "contact/impact_rest.h"

#include <float.h>

static const double noise = 64.0 * DBL_EPSILON; /* relative rounding of a coordinate */

/* The law of the obstacle, with a normal that the caller knows: of a segment, or of the edge of the body. */
impact_surface impact_rest_surface(const contact_set *c, dem_index k, dem_index feature, vec2 normal)
{
    const contact_law law = contact_point_law(&c->scene, &c->list[k], feature);
    return (impact_surface){
        .normal = normal, .restitution = law.restitution, .friction = law.friction, .law = law.friction_law};
}

int impact_rest_slide(const contact_set *c, dem_index k, dem_index feature, double speed)
{
    if (speed == 0.0 && contact_point_friction(&c->scene, &c->list[k], feature) > 0.0) return 0;
    return speed < 0.0 ? -1 : 1;
}

/* The impact of one contact may open another that shares a node, or the other side of a notch. Each impact is taken at
 * the depth of the penetration tolerance, so hops of this many tolerances may never end. */
static const double shared_tolerances = 8.0;

/* A rebound of speed u against the acceleration `back` hops u^2/(2 back) high and takes 2 u/back. So a height below h
 * is u <= sqrt(2 back h), a time below twice the window is u <= back window. The largest of all limits counts; without
 * an acceleration towards the surface nothing comes back, and no speed counts as rest. */
double impact_rest_speed(const contact_set *c, vec2 x, double back, const impact_surface *on, bool shared)
{
    const contact_rule *rule = &c->scene.rule;
    if (!(back > 0.0)) return -1.0;
    const double rounding = noise * fmax(fabs(x.x), fabs(x.y));
    const double tolerances = fmax(shared ? shared_tolerances : 0.0, 2.0 * impact_law_kept_up(on));
    const double height = fmax(fmax(rule->position_error, rounding), tolerances * rule->penetration_tolerance);
    return fmax(rule->rest_speed, fmax(sqrt(2.0 * back * height), back * rule->window));
}

/* Unit normal of an edge, into the body. */
static vec2 edge_normal(const contact_candidate *edge, const double *x)
{
    const vec2 way = vec2_sub(vec2_at(x, edge->other), vec2_at(x, edge->node));
    return vec2_scale(1.0 / vec2_norm(way), (vec2){-way.y, way.x});
}

/* Whether a vertex that passes from one edge to the next, where the body bends in, comes to rest on both: the forces on
 * the node there press both edges, and after the impact with the next edge it would hop no further than counts as rest.
 * Both are judged in the frame of the vertex's obstacle. */
bool impact_rest_in_notch(const contact_set *c, dem_index edge, dem_index next, const contact_instant *now)
{
    const contact_candidate *here = &c->list[edge], *there = &c->list[next];
    const dem_index node = here->node == there->other ? here->node : here->other, feature = here->closed[0].feature;
    const obstacle_motion wall =
        surface_motion(&c->scene, surface_segment(&c->scene, contact_point_feature(here, feature)),
                       (surface_query){now->t, surface_vertex_at(&c->scene, feature, now->t)});
    const vec2 a = vec2_sub(forces_acceleration(c->scene.forces, node, now->x, now->v), wall.acceleration);
    const impact_surface sides[2] = {impact_rest_surface(c, edge, feature, edge_normal(here, now->x)),
                                     impact_rest_surface(c, edge, feature, edge_normal(there, now->x))};
    double push_on[2];
    vec2 kick;
    if (impact_law_holding(sides, 2, a, push_on) != 3) return false;
    const vec2 after = impact_law_rebound(&sides[1], 1, obstacle_motion_relative(&wall, vec2_at(now->v, node)), &kick);
    const double speed = vec2_norm(after), back = speed > 0.0 ? -vec2_dot(a, after) / speed : 0.0;
    return speed == 0.0 || speed <= impact_rest_speed(c, vec2_at(now->x, node), back, &sides[0], true);
}
