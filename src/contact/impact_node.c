/* SPDX-License-Identifier: BSD-3-Clause */
/* The impact of a node that shares no closed contact: put back on the surface, rebound by impact_law.c, and the
 * decision whether the contact lasts. A contact that lasts has not rebounded: the impact is then taken again with eta =
 * 0, so that its friction follows from the impulse that is really given (docs/method.md, The impact; What counts as
 * rest). Velocities are relative to the wall, or to the corner of two walls. Nodes whose closed contacts are coupled to
 * others, and edges, are in impact_group.c. */
#include "contact/impact_node.h"

#include <float.h>

#include "base/status.h"
#include "contact/impact_rest.h"

static const double noise = 64.0 * DBL_EPSILON; /* relative rounding of a velocity */

/* What a node hits: one or two walls, their velocities, and the frame relative to which the laws of impact hold, that
 * of the wall or of the corner. */
typedef struct hit_walls {
    surface_line line[2];
    vec2 velocity[2]; /* m/s */
    obstacle_motion frame;
} hit_walls;

/* Of one wall the frame is that wall; of two it is their corner. */
static void find_walls(const contact_set *c, impact_target hit, surface_query at, hit_walls *out)
{
    for (int q = 0; q < hit.n; q++) {
        const obstacle_motion motion = surface_motion(&c->scene, hit.feature[q], at);
        out->line[q] = surface_line_at(&c->scene, hit.feature[q], at.t);
        out->velocity[q] = motion.velocity;
        out->frame = motion;
    }
    if (hit.n == 2) out->frame = surface_corner_motion(&c->scene, hit.feature, at);
}

/* An impact of a node: velocities relative to the frame, m/s. */
typedef struct node_impact {
    impact_target hit;
    hit_walls walls;
    impact_surface surface[2];
    vec2 before, after, kick[2];
} node_impact;

/* The displacement that puts a node on one segment's line, but not beyond a vertex of it, or where two lines meet: at
 * the shared vertex of neighbours, else n_0.shift = -h_0 and n_1.shift = -h_1 with the heights h of the node over both
 * lines. */
static vec2 way_back(const contact_set *c, impact_target hit, const hit_walls *walls, surface_query at)
{
    const surface_line a = walls->line[0], b = walls->line[hit.n - 1];
    vec2 vertex;
    if (hit.n == 2 && surface_share(&c->scene, hit.feature[0], hit.feature[1], at.t, &vertex))
        return vec2_sub(vertex, at.x);
    const double h0 = surface_height(&a, at.x), h1 = surface_height(&b, at.x), place = surface_place(&a, at.x);
    if (hit.n == 2)
        return vec2_scale(1.0 / vec2_cross(a.tangent, b.tangent),
                          vec2_along(vec2_scale(h1, a.tangent), -h0, b.tangent));
    const double beyond =
        (place < 0.0 && a.before >= 0) ? place : (place > a.length && a.after >= 0 ? place - a.length : 0.0);
    return vec2_along(vec2_scale(-h0, a.normal), -beyond, a.tangent);
}

/* The surfaces as the laws of an impact see them: normal, eta, mu, and the velocity of each in the common frame. */
static void list_surfaces(const contact_set *c, dem_index k, impact_target hit, const hit_walls *walls,
                          impact_surface on[2])
{
    for (int q = 0; q < hit.n; q++) {
        on[q] = impact_rest_surface(c, k, hit.feature[q], walls->line[q].normal);
        on[q].drift = vec2_sub(walls->velocity[q], walls->frame.velocity);
    }
}

/* Of the segments that are hit, those on which a node with relative velocity v stays; a is its acceleration relative to
 * the walls. A node at rest stays on all that it presses. In a corner it counts as at rest if it would get no further
 * out than a hop before it comes back: on the wall along which it moves less it could be back at the other one without
 * end. That is decided along v, where `back` is its deceleration. Otherwise it can stay on the one segment along which
 * it moves, that of the smaller speed away from it, if that speed counts as rest there. */
static impact_target lasting(const contact_set *c, dem_index k, impact_target hit, const hit_walls *walls, vec2 v,
                             const contact_instant *now)
{
    const dem_index i = c->list[k].node;
    const vec2 at = vec2_at(now->x, i);
    const vec2 carried = obstacle_motion_sliding(&walls->frame, obstacle_motion_carry(walls->frame.velocity, v));
    const vec2 a = vec2_sub(forces_acceleration(c->scene.forces, i, now->x, now->v), carried);
    const double speed = vec2_norm(v);
    impact_surface wall[2];
    double push[2], away[2];
    impact_target held = {0};
    list_surfaces(c, k, hit, walls, wall);
    for (int q = 0; q < hit.n; q++) away[q] = vec2_dot(v, wall[q].normal);
    const int holding = impact_law_holding(wall, hit.n, a, push);
    const double back = speed > 0.0 ? -vec2_dot(a, v) / speed : 0.0; /* deceleration of a node that leaves the corner */
    const bool returns = hit.n == 2 && holding != 0 && speed <= impact_rest_speed(c, at, back, &wall[0], false);
    if (speed == 0.0 || (holding == 3 && back <= 0.0) || returns) {
        for (int q = 0; q < hit.n; q++)
            if (holding & (1 << q)) held.feature[held.n++] = hit.feature[q];
        return held;
    }
    const int along = hit.n == 2 && away[1] < away[0] ? 1 : 0;
    if (away[along] <= impact_rest_speed(c, at, -vec2_dot(a, wall[along].normal), &wall[along], false))
        held = (impact_target){1, {hit.feature[along]}};
    return held;
}

/* The velocity of a node that is held: without its part along the normal, 0 in a corner. */
static vec2 without_normals(const contact_set *c, impact_target held, double t, vec2 v)
{
    if (held.n == 2) return (vec2){0.0, 0.0};
    if (held.n == 0) return v;
    const vec2 n = surface_line_at(&c->scene, held.feature[0], t).normal;
    return vec2_along(v, -vec2_dot(v, n), n);
}

/* Opens the node's contacts and closes those on `held`, without an event; each begins with the sign of its sliding. */
static dem_status hold_on(contact_set *c, dem_index k, impact_target held, const contact_instant *now)
{
    contact_candidate *candidate = &c->list[k];
    const bool stays_free = candidate->n_closed == 0 && held.n == 0;
    candidate->n_closed = 0;
    candidate_forget_clearance(candidate);
    if (stays_free) return DEM_OK;
    for (int q = 0; q < held.n; q++) {
        const vec2 tangent = surface_line_at(&c->scene, held.feature[q], now->t).tangent;
        const surface_query at = {now->t, vec2_at(now->x, candidate->node)};
        const obstacle_motion wall = surface_motion(&c->scene, held.feature[q], at);
        const double speed = vec2_dot(obstacle_motion_relative(&wall, vec2_at(now->v, candidate->node)), tangent);
        candidate->closed[candidate->n_closed++] =
            (contact_point){.feature = held.feature[q], .slide = impact_rest_slide(c, k, held.feature[q], speed)};
    }
    return contact_set_regroup_some(c, &k, 1);
}

/* Reports that a contact has closed or opened, where no impact reports it; counts closings in any case. */
static void report_change(contact_set *c, dem_index k, int was_closed, dem_index feature, bool approached,
                          contact_instant *now)
{
    const int is_closed = c->list[k].n_closed;
    c->ledger.counts.closings += is_closed > was_closed;
    if (is_closed == was_closed || (approached && is_closed > was_closed)) return;
    const dem_event event =
        contact_set_event(c, k, feature, is_closed > was_closed ? DEM_EVENT_CLOSE : DEM_EVENT_RELEASE, now);
    ledger_enter(&c->ledger, &event, now);
}

/* Enters an impact in the ledger and reports it. Each surface s has added kick_s to the relative velocity v, so has
 * given the impulse J_s = m kick_s. The energy taken is
 *   -sum J_s.((v + v')/2 - drift_s) = m/2 (v^2 - v'^2) + sum J_s.drift_s,
 * as the surfaces do the work J_s.drift_s in the common frame. What rounding and closing have changed besides counts
 * for the first surface that acts, so that the impulses sum up to m (v' - v). */
static void enter(contact_set *c, dem_index k, const node_impact *impact, contact_instant *now)
{
    const double m = c->scene.model->lattice.mass[c->list[k].node];
    const impact_target hit = impact->hit;
    vec2 kick[2] = {impact->kick[0], impact->kick[1]};
    double energy = 0.5 * m * (vec2_dot(impact->before, impact->before) - vec2_dot(impact->after, impact->after));
    vec2 rest = vec2_sub(impact->after, impact->before); /* what rounding and closing have changed */
    for (int q = 0; q < hit.n; q++) rest = vec2_sub(rest, kick[q]);
    const int first = hit.n == 2 && kick[0].x == 0.0 && kick[0].y == 0.0 ? 1 : 0;
    kick[first] = vec2_add(kick[first], rest);
    for (int q = 0; q < hit.n; q++) {
        const vec2 impulse = vec2_scale(m, kick[q]);
        energy += vec2_dot(impulse, impact->surface[q].drift);
        contact_set_add_impulse(c, surface_obstacle(&c->scene, (surface_feature){SURFACE_SEGMENT, hit.feature[q]}),
                                impulse, impact->surface[q].normal, impact->walls.velocity[q]);
    }
    dem_event event = contact_set_event(c, k, hit.feature[0], DEM_EVENT_IMPACT, now);
    vec2_put(event.before, 0, obstacle_motion_carry(impact->walls.frame.velocity, impact->before));
    contact_set_enter_impact(c, &event, energy, vec2_scale(m, vec2_sub(impact->after, impact->before)), now);
}

/* The velocity before is taken where the node was found; then the node is put back, and the forces that decide about
 * lasting are those of its new place. A rebound below the rounding of the velocity before is none. */
dem_status impact_node_solve(contact_set *c, dem_index k, impact_target hit, contact_instant *now)
{
    const dem_index i = c->list[k].node;
    const int was_closed = c->list[k].n_closed;
    const surface_query at = {now->t, vec2_at(now->x, i)};
    node_impact p = {.hit = hit};
    find_walls(c, hit, at, &p.walls);
    list_surfaces(c, k, hit, &p.walls, p.surface);
    p.before = obstacle_motion_relative(&p.walls.frame, vec2_at(now->v, i));
    contact_set_move(c, i, way_back(c, hit, &p.walls, at), now->x);
    p.after = impact_law_rebound(p.surface, hit.n, p.before, p.kick);
    if (vec2_norm(p.after) <= noise * vec2_norm(p.before)) p.after = (vec2){0.0, 0.0};
    const impact_target held = lasting(c, k, hit, &p.walls, p.after, now);
    if (held.n > 0) { /* a contact that lasts has not rebounded */
        for (int q = 0; q < hit.n; q++)
            for (int h = 0; h < held.n; h++)
                if (held.feature[h] == hit.feature[q]) p.surface[q].restitution = 0.0;
        p.after = without_normals(c, held, now->t, impact_law_rebound(p.surface, hit.n, p.before, p.kick));
    }
    vec2_put(now->v, i, obstacle_motion_carry(p.walls.frame.velocity, p.after));
    TRY(hold_on(c, k, held, now));
    const bool approached = p.after.x != p.before.x || p.after.y != p.before.y;
    if (approached) enter(c, k, &p, now);
    report_change(c, k, was_closed, hit.feature[0], approached, now);
    return DEM_OK;
}
