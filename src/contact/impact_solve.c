/* SPDX-License-Identifier: BSD-3-Clause */
/* Impacts of nodes by themselves, and of groups of contacts that share nodes. */
#include "contact/impact_solve.h"

#include <float.h>

#include "base/status.h"
#include "contact/impact_law.h"

/* Sweeps over a group of contacts that strike one another in turn; after half of them they do so without rebound. */
enum { most_sweeps = 200 };

static const double noise = 64.0 * DBL_EPSILON; /* of the speeds at hand: what rounding leaves */
static const double group_noise = 1e-11;        /* and what is left to the closing of a group */

static impact_surface surface_of(const contact_set *c, dem_index k, dem_index feature, vec2 normal)
{
    const dem_obstacle *o = contact_point_obstacle(&c->scene, &c->list[k], feature);
    return (impact_surface){normal, o->restitution, o->friction, o->friction_law};
}

/* The sign with which a contact begins: it slides the way it moves; at rest it sticks if there is friction. */
static int sign_of(const contact_set *c, dem_index k, dem_index feature, double speed)
{
    if (speed == 0.0 && contact_point_friction(&c->scene, &c->list[k], feature) > 0.0) return 0;
    return speed < 0.0 ? -1 : 1;
}

/* Hops of this many penetration tolerances are kept up where one contact's impact opens another that shares a node, or
 * the other side of a notch: each is taken a penetration tolerance deep. */
static const double shared_skins = 8.0;

/* Speed at or below which what an acceleration `back` returns to a surface is at rest: the hop would be lower than the
 * position tolerance, than what rounding leaves of the coordinates, or than the one that impacts taken at the depth of
 * the penetration tolerance keep up; or it would be shorter than twice the window. A rest speed that is given adds to
 * that and replaces none of it: a smaller one would leave bounces that never end. Nothing is at rest (-1) that does
 * not return. */
static double resting_speed(const contact_set *c, vec2 x, double back, const impact_surface *on, bool shared)
{
    const contact_rule *rule = &c->scene.rule;
    if (!(back > 0.0)) return -1.0;
    const double rounding = noise * fmax(fabs(x.x), fabs(x.y));
    const double skins = fmax(shared ? shared_skins : 0.0, 2.0 * impact_law_kept_up(on));
    const double height = fmax(fmax(rule->position_error, rounding), skins * rule->penetration_tolerance);
    return fmax(rule->rest_speed, fmax(sqrt(2.0 * back * height), back * rule->window));
}

static void book_impulse(contact_set *c, dem_index obstacle, vec2 impulse, vec2 normal)
{
    const dem_obstacle *o = &c->scene.model->obstacles.list[obstacle];
    const bool smooth = o->friction == 0.0 && o->friction_law == DEM_FRICTION_COULOMB;
    const vec2 along = smooth ? impulse : vec2_scale(vec2_dot(impulse, normal), normal);
    ledger_add_impulse(&c->ledger, obstacle, impulse, vec2_sub(impulse, along));
}

/* ---- a node by itself ---- */

/* How far a node has to be moved to be on one segment's line and not beyond a vertex of it, or where two meet. */
static vec2 way_back(const contact_set *c, impact_target hit, vec2 x)
{
    const segment *a = scene_segment(&c->scene, hit.feature[0]), *b = scene_segment(&c->scene, hit.feature[hit.n - 1]);
    vec2 vertex;
    if (hit.n == 2 && obstacles_share(&c->scene.model->obstacles, hit.feature[0], hit.feature[1], &vertex))
        return vec2_sub(vertex, x);
    const double h0 = segment_height(a, x), h1 = segment_height(b, x), place = segment_place(a, x);
    if (hit.n == 2) /* n0.shift = -h0 and n1.shift = -h1 */
        return vec2_scale(1.0 / vec2_cross(a->tangent, b->tangent),
                          vec2_along(vec2_scale(h1, a->tangent), -h0, b->tangent));
    const double beyond =
        (place < 0.0 && a->before >= 0) ? place : (place > a->length && a->after >= 0 ? place - a->length : 0.0);
    return vec2_along(vec2_scale(-h0, a->normal), -beyond, a->tangent);
}

/* Of the segments struck, those on which a node with velocity v stays. At rest it is all that push it; in a corner at
 * rest means that it would not get further out than a hop before the corner has it back. Otherwise it is the one
 * segment it moves along. */
static impact_target lasting(const contact_set *c, dem_index k, impact_target hit, vec2 v, const contact_instant *now)
{
    const dem_index i = c->list[k].node;
    const vec2 a = forces_acceleration(c->scene.model, &c->scene.rule.load, i, now->x, now->v), at = vec2_at(now->x, i);
    const double speed = vec2_norm(v);
    impact_surface wall[2];
    double push[2], away[2];
    impact_target held = {0};
    for (int q = 0; q < hit.n; q++) {
        wall[q] = surface_of(c, k, hit.feature[q], scene_segment(&c->scene, hit.feature[q])->normal);
        away[q] = vec2_dot(v, wall[q].normal);
    }
    const int holding = impact_law_holding(wall, hit.n, a, push);
    const double back = speed > 0.0 ? -vec2_dot(a, v) / speed : 0.0; /* what holds in a corner returns a node to it */
    if (speed == 0.0 || (holding == 3 && (back <= 0.0 || speed <= resting_speed(c, at, back, &wall[0], false)))) {
        for (int q = 0; q < hit.n; q++)
            if (holding & (1 << q)) held.feature[held.n++] = hit.feature[q];
        return held;
    }
    const int along = hit.n == 2 && away[1] < away[0] ? 1 : 0;
    if (away[along] <= resting_speed(c, at, -vec2_dot(a, wall[along].normal), &wall[along], false))
        held = (impact_target){1, {hit.feature[along]}};
    return held;
}

static vec2 without_normals(const contact_set *c, impact_target held, vec2 v)
{
    if (held.n == 2) return (vec2){0.0, 0.0};
    if (held.n == 0) return v;
    const vec2 n = scene_segment(&c->scene, held.feature[0])->normal;
    return vec2_along(v, -vec2_dot(v, n), n);
}

/* Tells of an impact and books its energy, J, and the impulse (N s) that each of the features gave. */
static void book(contact_set *c, dem_event *event, double energy, vec2 impulse, contact_instant *now)
{
    event->impulse[0] = impulse.x;
    event->impulse[1] = impulse.y;
    event->energy = energy;
    c->ledger.impact += energy;
    ledger_enter(&c->ledger, event, now);
}

/* Leaves what is closed and closes what is held, quietly. */
static dem_status hold_on(contact_set *c, dem_index k, impact_target held, const contact_instant *now)
{
    contact_candidate *candidate = &c->list[k];
    const bool stays_free = candidate->n_closed == 0 && held.n == 0;
    candidate->n_closed = 0;
    candidate_forget_clearance(candidate);
    if (stays_free) return DEM_OK;
    for (int q = 0; q < held.n; q++) {
        const segment *s = scene_segment(&c->scene, held.feature[q]);
        const double speed = vec2_dot(vec2_at(now->v, candidate->node), s->tangent);
        candidate->closed[candidate->n_closed++] =
            (contact_point){.feature = held.feature[q], .slide = sign_of(c, k, held.feature[q], speed)};
    }
    return contact_set_regroup(c);
}

/* Tells that contacts began or ceased to last where no impact tells it. */
static void tell_change(contact_set *c, dem_index k, int was_closed, dem_index feature, bool struck,
                        contact_instant *now)
{
    const int is_closed = c->list[k].n_closed;
    c->ledger.counts.closings += is_closed > was_closed;
    if (is_closed == was_closed || (struck && is_closed > was_closed)) return;
    const dem_event event =
        contact_set_event(c, k, feature, is_closed > was_closed ? DEM_EVENT_CLOSE : DEM_EVENT_RELEASE, now);
    ledger_enter(&c->ledger, &event, now);
}

static dem_status solve_node(contact_set *c, dem_index k, impact_target hit, contact_instant *now)
{
    const dem_index i = c->list[k].node;
    const int was_closed = c->list[k].n_closed;
    const vec2 before = vec2_at(now->v, i);
    impact_surface wall[2];
    vec2 kick[2];
    for (int q = 0; q < hit.n; q++)
        wall[q] = surface_of(c, k, hit.feature[q], scene_segment(&c->scene, hit.feature[q])->normal);
    contact_set_move(c, i, way_back(c, hit, vec2_at(now->x, i)), now->x);
    vec2 after = impact_law_rebound(wall, hit.n, before, kick);
    if (vec2_norm(after) <= noise * vec2_norm(before)) after = (vec2){0.0, 0.0};
    const impact_target held = lasting(c, k, hit, after, now);
    if (held.n > 0) { /* what stays has not rebounded, and friction goes with the impulse given */
        for (int q = 0; q < hit.n; q++)
            for (int h = 0; h < held.n; h++)
                if (held.feature[h] == hit.feature[q]) wall[q].restitution = 0.0;
        after = without_normals(c, held, impact_law_rebound(wall, hit.n, before, kick));
    }
    vec2_put(now->v, i, after);
    TRY(hold_on(c, k, held, now));
    const bool struck = after.x != before.x || after.y != before.y;
    if (struck) {
        const double m = c->scene.model->lattice.mass[i];
        vec2 rest = vec2_sub(after, before); /* what rounding and closing add goes with the first that acts */
        for (int q = 0; q < hit.n; q++) rest = vec2_sub(rest, kick[q]);
        const int first = hit.n == 2 && kick[0].x == 0.0 && kick[0].y == 0.0 ? 1 : 0;
        kick[first] = vec2_add(kick[first], rest);
        for (int q = 0; q < hit.n; q++)
            book_impulse(c, scene_segment(&c->scene, hit.feature[q])->obstacle, vec2_scale(m, kick[q]), wall[q].normal);
        dem_event event = contact_set_event(c, k, hit.feature[0], DEM_EVENT_IMPACT, now);
        event.before[0] = before.x;
        event.before[1] = before.y;
        book(c, &event, 0.5 * m * (vec2_dot(before, before) - vec2_dot(after, after)),
             vec2_scale(m, vec2_sub(after, before)), now);
    }
    tell_change(c, k, was_closed, hit.feature[0], struck, now);
    return DEM_OK;
}

/* ---- contacts that share nodes ---- */

double impact_project(contact_set *c, dem_index group, contact_instant *now)
{
    contact_forces *r = &c->forces;
    double furthest = 0.0;
    const double *shift = contact_forces_shift(r, group, now->x, now->v);
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
        const contact_candidate *candidate = &c->list[r->members[p]];
        const dem_index nodes[2] = {candidate->node, candidate->other};
        for (int e = 0; e < (candidate_is_edge(candidate) ? 2 : 1); e++) {
            furthest = fmax(furthest, vec2_norm(vec2_at(shift, nodes[e])));
            contact_set_move(c, nodes[e], vec2_at(shift, nodes[e]), now->x);
            vec2_put(r->a, nodes[e], (vec2){0.0, 0.0}); /* an edge's node may come again */
        }
    }
    return furthest;
}

/* Notes where the contacts of the group start from; returns their largest speed. */
static double prepare(contact_set *c, dem_index group, const contact_instant *now)
{
    const contact_forces *r = &c->forces;
    double scale = 0.0;
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
        contact_candidate *candidate = &c->list[r->members[p]];
        candidate->involved = true;
        candidate->n_involved = candidate->n_closed;
        for (int q = 0; q < candidate->n_closed; q++) {
            const contact_frame f = contact_frame_at(&c->scene, candidate, q, now->x, now->v);
            contact_point *point = &candidate->closed[q];
            point->before = f.velocity;
            point->impulse = (vec2){0.0, 0.0};
            point->energy = 0.0;
            point->opens = point->held = point->struck = point->plastic = false;
            scale = fmax(scale, vec2_norm(f.velocity));
        }
    }
    return scale;
}

static void push(const contact_set *c, const contact_frame *f, vec2 impulse, contact_instant *now)
{
    for (int p = 0; p < f->n; p++)
        vec2_put(
            now->v, f->node[p],
            vec2_along(vec2_at(now->v, f->node[p]), f->weight[p] * c->scene.model->inverse_mass[f->node[p]], impulse));
}

/* One contact of the group by itself: whether it strikes. */
static bool solve_contact(contact_set *c, dem_index k, int q, double tolerance, bool plastic, contact_instant *now)
{
    contact_point *point = &c->list[k].closed[q];
    const contact_frame f = contact_frame_at(&c->scene, &c->list[k], q, now->x, now->v);
    vec2 kick;
    if (vec2_dot(f.velocity, f.normal) >= -tolerance) return false;
    impact_surface wall = surface_of(c, k, point->feature, f.normal);
    if (plastic || point->plastic) wall.restitution = 0.0;
    const vec2 after = impact_law_rebound(&wall, 1, f.velocity, &kick);
    const vec2 impulse = vec2_scale(1.0 / f.mobility, kick);
    for (int p = 0; p < f.n; p++)
        vec2_put(
            now->v, f.node[p],
            vec2_along(vec2_at(now->v, f.node[p]), f.weight[p] * c->scene.model->inverse_mass[f.node[p]], impulse));
    point->struck = true;
    point->impulse = vec2_add(point->impulse, impulse);
    point->energy -= 0.5 * vec2_dot(impulse, vec2_add(f.velocity, after));
    return true;
}

/* The contacts of a group strike in turn, those of site k first. Returns false if that has not come to an end. */
static bool sweep(contact_set *c, dem_index k, double tolerance, contact_instant *now)
{
    const contact_forces *r = &c->forces;
    const dem_index group = r->group[k];
    bool struck = true;
    for (int q = 0; q < c->list[k].n_closed; q++)
        (void)solve_contact(c, k, q, tolerance, false, now); /* it is the first */
    for (int s = 0; s < most_sweeps && struck; s++) {
        struck = false;
        for (dem_index p = r->row[group]; p < r->row[group + 1]; p++)
            for (int q = 0; q < c->list[r->members[p]].n_closed; q++)
                struck |= solve_contact(c, r->members[p], q, tolerance, 2 * s >= most_sweeps, now);
    }
    return !struck;
}

/* Which contacts of the group last, and how they slide. */
static void judge(contact_set *c, dem_index group, double tolerance, const contact_instant *now)
{
    const contact_forces *r = &c->forces;
    const bool shared = r->row[group + 1] - r->row[group] > 1;
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
        const dem_index k = r->members[p];
        for (int q = 0; q < c->list[k].n_closed; q++) {
            contact_point *point = &c->list[k].closed[q];
            const contact_frame f = contact_frame_at(&c->scene, &c->list[k], q, now->x, now->v);
            const double away = vec2_dot(f.velocity, f.normal), speed = vec2_dot(f.velocity, f.tangent);
            double back = f.turning;
            for (int e = 0; e < f.n; e++)
                back -= f.weight[e] * vec2_dot(f.normal, forces_acceleration(c->scene.model, &c->scene.rule.load,
                                                                             f.node[e], now->x, now->v));
            const impact_surface wall = surface_of(c, k, point->feature, f.normal);
            const double rest = resting_speed(c, vec2_at(now->x, f.node[0]), back, &wall, shared);
            point->opens = away > (point->fresh ? rest : fmax(rest, tolerance));
            point->rests = rest > 0.0 && away <= rest;
            const int sign = sign_of(c, k, point->feature, fabs(speed) <= tolerance ? 0.0 : speed);
            if (point->fresh || point->slide != 0) point->place = fmin(fmax(f.place, 0.0), 1.0);
            point->slide = sign;
        }
    }
}

/* If contacts last that have rebounded, takes all impulses back, to be given again with those plastic: what stays has
 * not rebounded, and friction goes with the impulse given. */
static bool take_back(contact_set *c, dem_index group, contact_instant *now)
{
    const contact_forces *r = &c->forces;
    bool any = false;
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++)
        for (int q = 0; q < c->list[r->members[p]].n_closed; q++) {
            contact_point *point = &c->list[r->members[p]].closed[q];
            point->plastic = point->struck && point->rests;
            any |= point->plastic;
        }
    for (dem_index p = r->row[group]; p < r->row[group + 1] && any; p++)
        for (int q = 0; q < c->list[r->members[p]].n_closed; q++) {
            contact_point *point = &c->list[r->members[p]].closed[q];
            const contact_frame f = contact_frame_at(&c->scene, &c->list[r->members[p]], q, now->x, now->v);
            push(c, &f, vec2_scale(-1.0, point->impulse), now);
            point->impulse = (vec2){0.0, 0.0};
            point->energy = 0.0;
            point->struck = false;
        }
    return any;
}

/* What still strikes after all sweeps is held for now: it stops exactly with the others, and opens if nothing
 * presses. */
static void keep_struck(contact_set *c, dem_index group)
{
    const contact_forces *r = &c->forces;
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++)
        for (int q = 0; q < c->list[r->members[p]].n_closed; q++)
            if (c->list[r->members[p]].closed[q].struck) c->list[r->members[p]].closed[q].opens = false;
}

/* Takes the contacts that open out of the closed ones, but keeps them behind these. */
static void part(contact_candidate *candidate)
{
    candidate_forget_clearance(candidate);
    if (candidate->n_closed == 2 && candidate->closed[0].opens && !candidate->closed[1].opens) {
        const contact_point first = candidate->closed[0];
        candidate->closed[0] = candidate->closed[1];
        candidate->closed[1] = first;
    }
    while (candidate->n_closed > 0 && candidate->closed[candidate->n_closed - 1].opens) candidate->n_closed--;
}

void impact_stop(contact_set *c, dem_index group, contact_instant *now)
{
    const contact_forces *r = &c->forces;
    c->ledger.impact += contact_set_stop(c, group, now->x, now->v);
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
        const contact_candidate *candidate = &c->list[r->members[p]];
        for (int q = 0; q < candidate->n_closed; q++) {
            const contact_frame f = contact_frame_at(&c->scene, candidate, q, now->x, now->v);
            const dem_obstacle *on = contact_point_obstacle(&c->scene, candidate, candidate->closed[q].feature);
            book_impulse(c, on - c->scene.model->obstacles.list, candidate->closed[q].stop, f.normal);
        }
    }
}

/* Stops the groups that have a node in common with a site: what the integrator's error has left them of velocity is no
 * approach. */
static void stop_around(contact_set *c, dem_index k, contact_instant *now)
{
    const surface *s = &c->scene.model->surface;
    const dem_index nodes[2] = {c->list[k].node, c->list[k].other};
    for (int e = 0; e < (candidate_is_edge(&c->list[k]) ? 2 : 1); e++) {
        const dem_index own = c->of_node[nodes[e]];
        if (own >= 0 && c->list[own].n_closed > 0) impact_stop(c, c->forces.group[own], now);
        for (dem_index p = s->row[nodes[e]]; p < s->row[nodes[e] + 1] && c->n > c->scene.model->n_contact_nodes; p++) {
            const dem_index edge = contact_set_of_edge(c, s->at[p]);
            if (c->list[edge].n_closed > 0) impact_stop(c, c->forces.group[edge], now);
        }
    }
}

/* What the sweeps have left of velocities that closed contacts do not allow goes. */
static void settle_velocities(contact_set *c, contact_instant *now)
{
    const contact_forces *r = &c->forces;
    for (dem_index g = 0; g < r->n_groups; g++) {
        if (!c->list[r->members[r->row[g]]].involved) continue;
        c->ledger.impact += contact_set_stop(c, g, now->x, now->v);
        for (dem_index p = r->row[g]; p < r->row[g + 1]; p++) {
            contact_candidate *candidate = &c->list[r->members[p]];
            for (int q = 0; q < candidate->n_closed; q++)
                candidate->closed[q].impulse = vec2_add(candidate->closed[q].impulse, candidate->closed[q].stop);
        }
    }
}

/* Books and tells what the contacts of a site got. */
static void tell_party(contact_set *c, dem_index k, contact_instant *now)
{
    contact_candidate *candidate = &c->list[k];
    for (int q = 0; q < candidate->n_involved; q++) {
        const contact_point *point = &candidate->closed[q];
        const bool kept = q < candidate->n_closed;
        dem_event event = contact_set_event(c, k, point->feature, DEM_EVENT_IMPACT, now);
        c->ledger.counts.closings += point->fresh && kept;
        book_impulse(c, event.obstacle, point->impulse, vec2_at(event.normal, 0));
        if (point->struck) {
            event.before[0] = point->before.x;
            event.before[1] = point->before.y;
            book(c, &event, point->energy, point->impulse, now);
        }
        if (kept == !point->fresh || (point->struck && kept)) continue;
        event = contact_set_event(c, k, point->feature, kept ? DEM_EVENT_CLOSE : DEM_EVENT_RELEASE, now);
        ledger_enter(&c->ledger, &event, now);
    }
    for (int q = 0; q < candidate->n_closed; q++) candidate->closed[q].fresh = false;
    candidate->involved = false;
    candidate->n_involved = 0;
}

/* Takes up the hit among the closed contacts of the site, in place of those it does not go with. */
static dem_status take_up(contact_set *c, dem_index k, impact_target hit)
{
    contact_candidate *candidate = &c->list[k];
    for (int q = 0; q < candidate->n_closed; q++) candidate->closed[q].fresh = false;
    if (!candidate_is_edge(candidate) && candidate->n_closed == 1 && hit.n == 1) candidate->n_closed = 0;
    for (int h = 0; h < hit.n && candidate->n_closed < 2; h++) {
        const bool known = candidate->n_closed == 1 && candidate->closed[0].feature == hit.feature[h];
        if (!known) TRY(contact_set_close(c, k, (contact_point){.feature = hit.feature[h], .slide = 1, .fresh = true}));
    }
    return contact_set_regroup(c);
}

/* The contacts of the group strike one another in turn until none approaches any more. */
static dem_status solve_group(contact_set *c, dem_index k, impact_target hit, contact_instant *now)
{
    stop_around(c, k, now);
    TRY(take_up(c, k, hit));
    const dem_index group = c->forces.group[k];
    (void)impact_project(c, c->forces.group[k], now);
    const double tolerance = group_noise * prepare(c, group, now);
    bool done = sweep(c, k, tolerance, now);
    judge(c, group, tolerance, now);
    if (take_back(c, group, now)) {
        done = sweep(c, k, tolerance, now);
        judge(c, group, tolerance, now);
    }
    if (!done) keep_struck(c, group);
    for (dem_index m = 0; m < c->n; m++)
        if (c->list[m].involved) part(&c->list[m]);
    TRY(contact_set_regroup(c));
    settle_velocities(c, now);
    for (dem_index m = 0; m < c->n; m++)
        if (c->list[m].involved) tell_party(c, m, now);
    return DEM_OK;
}

dem_status impact_solve(contact_set *c, dem_index k, impact_target hit, contact_instant *now)
{
    if (!candidate_is_edge(&c->list[k]) && !contact_set_coupled(c, k)) return solve_node(c, k, hit, now);
    return solve_group(c, k, hit, now);
}

/* Unit normal of an edge, into the body. */
static vec2 edge_normal(const contact_candidate *edge, const double *x)
{
    const vec2 way = vec2_sub(vec2_at(x, edge->other), vec2_at(x, edge->node));
    return vec2_scale(1.0 / vec2_norm(way), (vec2){-way.y, way.x});
}

bool impact_rests_in_notch(const contact_set *c, dem_index edge, dem_index next, const contact_instant *now)
{
    const contact_candidate *here = &c->list[edge], *there = &c->list[next];
    const dem_index node = here->node == there->other ? here->node : here->other, feature = here->closed[0].feature;
    const vec2 a = forces_acceleration(c->scene.model, &c->scene.rule.load, node, now->x, now->v);
    const impact_surface sides[2] = {surface_of(c, edge, feature, edge_normal(here, now->x)),
                                     surface_of(c, edge, feature, edge_normal(there, now->x))};
    double push_on[2];
    vec2 kick;
    if (impact_law_holding(sides, 2, a, push_on) != 3) return false;
    const vec2 after = impact_law_rebound(&sides[1], 1, vec2_at(now->v, node), &kick);
    const double speed = vec2_norm(after), back = speed > 0.0 ? -vec2_dot(a, after) / speed : 0.0;
    return speed == 0.0 || speed <= resting_speed(c, vec2_at(now->x, node), back, &sides[0], true);
}

void impact_early(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now)
{
    contact_candidate *candidate = &c->list[k];
    contact_candidate alone = *candidate;
    vec2 kick;
    alone.closed[0] = (contact_point){.feature = gap->feature, .slide = 1};
    contact_frame f = contact_frame_at(&c->scene, &alone, 0, now->x, now->v);
    f.normal = gap->normal;
    const impact_surface wall = surface_of(c, k, gap->feature, f.normal);
    const vec2 after = impact_law_rebound(&wall, 1, f.velocity, &kick), impulse = vec2_scale(1.0 / f.mobility, kick);
    dem_event event = contact_set_event(c, k, gap->feature, DEM_EVENT_IMPACT, now);
    for (int p = 0; p < f.n; p++)
        vec2_put(
            now->v, f.node[p],
            vec2_along(vec2_at(now->v, f.node[p]), f.weight[p] * c->scene.model->inverse_mass[f.node[p]], impulse));
    event.normal[0] = f.normal.x;
    event.normal[1] = f.normal.y;
    event.after[0] = after.x;
    event.after[1] = after.y;
    c->ledger.counts.early++;
    book_impulse(c, event.obstacle, impulse, f.normal);
    book(c, &event, -0.5 * vec2_dot(impulse, vec2_add(f.velocity, after)), impulse, now);
}

/* ---- what is struck ---- */

double impact_depth(const contact_set *c, dem_index k, const contact_instant *now)
{
    const contact_candidate *candidate = &c->list[k];
    const double located = 1000.0 * DBL_EPSILON * (fabs(now->t) + c->scene.rule.max_step);
    const double speed = vec2_norm(vec2_at(now->v, candidate->node));
    const double other = candidate_is_edge(candidate) ? vec2_norm(vec2_at(now->v, candidate->other)) : 0.0;
    return 2.0 * c->scene.rule.penetration_tolerance + c->straightened + located * fmax(speed, other);
}

/* A node at a vertex meets one segment only, unless the vertex is a corner: of two in line or with a convex bend the
 * one approached faster, on a tie the one that ends there. */
static bool yields(const contact_set *c, dem_index s, dem_index to, vec2 v)
{
    dem_index after, before;
    const obstacle_bend ahead = obstacles_bend(&c->scene.model->obstacles, s, false, &after);
    const obstacle_bend behind = obstacles_bend(&c->scene.model->obstacles, s, true, &before);
    const bool follows = before == to && behind != OBSTACLE_CONCAVE, leads = after == to && ahead != OBSTACLE_CONCAVE;
    if (!follows && !leads) return false;
    const double mine = vec2_dot(v, scene_segment(&c->scene, s)->normal),
                 other = vec2_dot(v, scene_segment(&c->scene, to)->normal);
    return mine > other || (mine == other && follows);
}

bool impact_is_corner(const contact_set *c, dem_index s, dem_index other, vec2 x, double tolerance)
{
    vec2 vertex;
    if (obstacles_share(&c->scene.model->obstacles, s, other, &vertex))
        return vec2_norm(vec2_sub(x, vertex)) <= 4.0 * tolerance;
    return fabs(vec2_cross(scene_segment(&c->scene, s)->tangent, scene_segment(&c->scene, other)->tangent)) > 0.01;
}

static double approach(const contact_set *c, dem_index s, vec2 v)
{
    return -vec2_dot(v, scene_segment(&c->scene, s)->normal);
}

impact_target impact_target_of_node(const contact_set *c, dem_index k, const contact_instant *now)
{
    enum { capacity = 8 };
    dem_index hits[capacity];
    impact_target out = {0};
    const contact_candidate *candidate = &c->list[k];
    const vec2 x = vec2_at(now->x, candidate->node), v = vec2_at(now->v, candidate->node);
    const obstacle_touch point = {impact_depth(c, k, now), scene_margin(&c->scene), candidate->behind[0]};
    const int n = obstacles_touching(&c->scene.model->obstacles, x, &point, hits, capacity);
    for (int h = 0; h < n; h++) {
        bool meets = true;
        for (int q = 0; q < n && meets; q++) meets = !yields(c, hits[h], hits[q], v);
        if (!meets) continue;
        const int place = out.n > 0 && approach(c, hits[h], v) <= approach(c, out.feature[0], v) ? 1 : 0;
        if (place == 1 && out.n == 2 && approach(c, hits[h], v) <= approach(c, out.feature[1], v)) continue;
        if (place == 0) out.feature[1] = out.feature[0];
        out.feature[place] = hits[h];
        out.n = out.n < 2 ? out.n + 1 : 2;
    }
    if (out.n == 2 && !impact_is_corner(c, out.feature[0], out.feature[1], x, point.tolerance)) out.n = 1;
    return out;
}

/* Whether a direction lies between the normals of a convex vertex. */
static bool in_cone(const contact_set *c, const obstacle_vertex *at, vec2 n)
{
    return vec2_cross(scene_segment(&c->scene, at->before)->normal, n) <= 0.0 &&
           vec2_cross(n, scene_segment(&c->scene, at->after)->normal) <= 0.0;
}

dem_index impact_target_edge(const contact_set *c, dem_index k, const contact_instant *now, dem_index *vertex)
{
    const surface *s = &c->scene.model->surface;
    const dem_index node = c->list[k].node;
    const double tolerance = impact_depth(c, k, now);
    double fastest = 0.0;
    dem_index best = -1;
    for (dem_index p = s->row[node]; p < s->row[node + 1] && c->n > c->scene.model->n_contact_nodes; p++) {
        const dem_index e = contact_set_of_edge(c, s->at[p]);
        const candidate_positions spot = candidate_place(&c->list[e], now->x);
        const contact_gap gap = candidate_gap(&c->scene, &c->list[e], &spot);
        if (gap.feature < 0 || fabs(gap.distance) > tolerance) continue;
        const obstacle_vertex *v = &c->scene.model->obstacles.vertices[gap.feature];
        if (vec2_norm(vec2_sub(v->at, vec2_at(now->x, node))) > 2.0 * tolerance || !in_cone(c, v, gap.normal)) continue;
        const double speed = -vec2_dot(vec2_at(now->v, node), gap.normal);
        if (speed <= fastest) continue;
        fastest = speed;
        best = e;
        *vertex = gap.feature;
    }
    return best;
}
