/* SPDX-License-Identifier: BSD-3-Clause */
/* Gaps and guards of one contact site. */
#include "contact/candidate.h"

/* ---- gaps ---- */

contact_spot site_spot(const contact_site *site, const double *x)
{
    contact_spot spot = {.a = vec2_at(x, site->node)};
    spot.b = site_is_edge(site) ? vec2_at(x, site->other) : spot.a;
    spot.previous = site->previous >= 0 ? vec2_at(x, site->previous) : spot.a;
    spot.next = site->next >= 0 ? vec2_at(x, site->next) : spot.b;
    return spot;
}

contact_spot site_spot_on(const contact_site *site, const dense_output *p, double t)
{
    contact_spot spot = {.a = dense_output_position(p, t, site->node)};
    spot.b = site_is_edge(site) ? dense_output_position(p, t, site->other) : spot.a;
    spot.previous = site->previous >= 0 ? dense_output_position(p, t, site->previous) : spot.a;
    spot.next = site->next >= 0 ? dense_output_position(p, t, site->next) : spot.b;
    return spot;
}

static contact_gap node_gap(const contact_scene *scene, const contact_site *site, vec2 x)
{
    const obstacle_set *o = &scene->model->obstacles;
    const dem_index own = site->n_closed > 0 ? scene_segment(scene, site->closed[0].feature)->obstacle : -1;
    const obstacle_gap gap = obstacles_gap(o, x, scene_margin(scene), site->behind[0], own);
    return (contact_gap){gap.distance, gap.segment, 0.0, gap.normal};
}

/* How far from an edge vertices are looked at, as a share of its length: in front of it and behind it, where a step
 * may take one at most. */
static const double edge_reach = 0.5, edge_depth = 0.25;

static obstacle_edge edge_query(const contact_scene *scene, const contact_site *site, const contact_spot *spot)
{
    const double length = vec2_norm(vec2_sub(spot->b, spot->a));
    return (obstacle_edge){.a = spot->a,
                           .b = spot->b,
                           .previous = spot->previous,
                           .next = spot->next,
                           .tolerance = scene->rule.skin,
                           .depth = edge_depth * length,
                           .reach = edge_reach * length,
                           .without = {site->behind[0], site->behind[1]},
                           .except = {site->n_closed > 0 ? site->closed[0].feature : -1, -1}};
}

static contact_gap edge_gap(const contact_scene *scene, const contact_site *site, const contact_spot *spot)
{
    const obstacle_edge edge = edge_query(scene, site, spot);
    const obstacle_poke poke = obstacles_poke(&scene->model->obstacles, &edge);
    return (contact_gap){poke.distance, poke.vertex, poke.place, poke.normal};
}

double site_moved(const contact_site *site, const contact_spot *spot)
{
    const double a = vec2_norm(vec2_sub(spot->a, site->clear_at[0]));
    return site_is_edge(site) ? fmax(a, vec2_norm(vec2_sub(spot->b, site->clear_at[1]))) : a;
}

contact_gap site_gap(const contact_scene *scene, const contact_site *site, const contact_spot *spot)
{
    if (site->n_closed == 2 || site->asleep) return (contact_gap){INFINITY, -1, 0.0, {0.0, 0.0}};
    const double left = site->clear > 0.0 ? site->clear - site_moved(site, spot) : 0.0;
    if (left > 0.0) return (contact_gap){left, -1, 0.0, {0.0, 0.0}};
    return site_is_edge(site) ? edge_gap(scene, site, spot) : node_gap(scene, site, spot->a);
}

contact_gap site_around(const contact_scene *scene, const contact_site *site, const contact_spot *spot, double reach)
{
    obstacle_edge edge = edge_query(scene, site, spot);
    edge.tolerance = edge.depth = edge.reach = reach;
    edge.previous = edge.a;
    edge.next = edge.b;
    const obstacle_poke poke = obstacles_poke(&scene->model->obstacles, &edge);
    return (contact_gap){poke.distance, poke.vertex, poke.place, poke.normal};
}

/* An edge that no vertex is near is as far from all as its node is from the obstacles, less its length. */
static double edge_clearance(const contact_scene *scene, const contact_site *site, const contact_spot *spot)
{
    const obstacle_set *o = &scene->model->obstacles;
    const obstacle_edge edge = edge_query(scene, site, spot);
    const double near = obstacles_clearance(o, &edge);
    if (near < edge.reach) return near;
    return fmax(near, obstacles_gap(o, spot->a, 0.0, site->behind[0], site->behind[1]).distance - near / edge_reach);
}

double site_clearance(const contact_scene *scene, const contact_site *site, const contact_spot *spot,
                      dem_index *nearest)
{
    if (site_is_edge(site)) return edge_clearance(scene, site, spot);
    const contact_gap gap = node_gap(scene, site, spot->a);
    *nearest = gap.feature;
    return gap.distance;
}

/* ---- guards of closed contacts ---- */

/* Distance to the nearer end of the segment or edge, and the skin: an end is passed when a contact is beyond it by
 * that. */
static double end_guard(const contact_scene *scene, const contact_site *site, int q, const double *x, int *end)
{
    double place, length;
    if (site_is_edge(site)) {
        const vec2 a = vec2_at(x, site->node), ab = vec2_sub(vec2_at(x, site->other), a);
        length = vec2_norm(ab);
        place = vec2_dot(vec2_sub(scene->model->obstacles.vertices[site->closed[q].feature].at, a), ab) / length;
    } else {
        const segment *s = scene_segment(scene, site->closed[q].feature);
        length = s->length;
        place = segment_place(s, vec2_at(x, site->node));
    }
    *end = place > 0.5 * length ? 1 : -1;
    return fmin(place, length - place) + scene->rule.skin;
}

/* A contact that sticks by friction has a grip; one that slides has a sign. */
static bool sticks(const contact_site *site, int q)
{
    return site->closed[q].sign == 0 && !site->closed[q].held;
}

int site_end_passed(const contact_scene *scene, const contact_site *site, int q, const double *x, const double *v)
{
    int end;
    if (sticks(site, q) || end_guard(scene, site, q, x, &end) > 0.0) return 0;
    const touch_frame f = touch_frame_at(scene, site, q, x, v);
    double speed = vec2_dot(f.velocity, f.tangent);
    const bool rests = speed == 0.0;
    for (int p = 0; p < f.n && rests; p++) /* then it heads where it is driven */
        speed +=
            f.weight[p] * vec2_dot(forces_acceleration(scene->model, &scene->rule.load, f.node[p], x, v), f.tangent);
    const double heading = site_is_edge(site) ? -speed : speed; /* a vertex moves along the edge against the body */
    return end * heading > 0.0 ? end : 0;
}

/* In units of the skin per step: slower than this is rounding. */
static const double rest_noise = 1e-16;

bool site_turns(const contact_scene *scene, const contact_site *site, int q, const touch_frame *f, const double *v)
{
    const int sign = site->closed[q].sign;
    if (sign == 0 || touch_friction(scene, site, site->closed[q].feature) == 0.0) return false;
    const double least = rest_noise * scene->rule.skin / scene->rule.max_step;
    return sign * vec2_dot(f->velocity, f->tangent) < -fmax(touch_noise(f, v), least);
}

double site_grip(const contact_scene *scene, const contact_site *site, int q, const touch_frame *f,
                 const reaction *force, const double *x)
{
    if (!sticks(site, q)) return INFINITY;
    const double limit = touch_friction(scene, site, site->closed[q].feature) * force->normal;
    return limit + touch_slack(scene, f, x) - fabs(force->tangent);
}

/* The gap as a guard, whose root is the contact time (7): finite where there is nothing. */
static double gap_guard(const contact_scene *scene, contact_gap gap)
{
    return fmin(gap.distance, 1.0) + scene->rule.skin;
}

void site_guards(const contact_scene *scene, const contact_site *site, const reaction force[2], const double *x,
                 const double *v, double *g)
{
    int end;
    const contact_spot spot = site_spot(site, x);
    g[0] = gap_guard(scene, site_gap(scene, site, &spot));
    g[1] = g[2] = g[3] = 1.0;
    if (site->n_closed == 0) return;
    g[1] = g[2] = g[3] = INFINITY;
    for (int q = 0; q < site->n_closed; q++) {
        g[1] = fmin(g[1], force[q].normal);
        if (site->closed[q].held) continue;
        if (!sticks(site, q) && touch_friction(scene, site, site->closed[q].feature) == 0.0) {
            g[2] = fmin(g[2], end_guard(scene, site, q, x, &end));
            continue;
        }
        const touch_frame f = touch_frame_at(scene, site, q, x, v);
        g[2] = fmin(g[2],
                    sticks(site, q) ? site_grip(scene, site, q, &f, &force[q], x) : end_guard(scene, site, q, x, &end));
        if (sticks(site, q)) continue;
        g[3] = fmin(g[3], site->closed[q].sign * vec2_dot(f.velocity, f.tangent));
    }
    for (int k = 1; k < SITE_GUARDS; k++)
        if (isinf(g[k])) g[k] = 1.0;
}

bool site_due(const contact_scene *scene, const contact_site *site, const reaction force[2], const double *x,
              const double *v)
{
    const contact_spot spot = site_spot(site, x);
    if (gap_guard(scene, site_gap(scene, site, &spot)) <= 0.0) return true;
    for (int q = 0; q < site->n_closed; q++) {
        if (force[q].normal <= 0.0) return true;
        if (site->closed[q].held) continue;
        if (site_end_passed(scene, site, q, x, v) != 0) return true;
        if (touch_friction(scene, site, site->closed[q].feature) == 0.0) continue;
        const touch_frame f = touch_frame_at(scene, site, q, x, v);
        if (site_grip(scene, site, q, &f, &force[q], x) < 0.0 || site_turns(scene, site, q, &f, v)) return true;
    }
    return false;
}
