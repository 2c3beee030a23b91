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

static impact_surface surface_of(const contact_sites *c, dem_index k, dem_index feature, vec2 normal)
{
    const dem_obstacle *o = touch_obstacle(&c->scene, &c->list[k], feature);
    return (impact_surface){normal, o->restitution, o->friction, o->friction_law};
}

/* The sign with which a contact begins: it slides the way it moves; at rest it sticks if there is friction. */
static int sign_of(const contact_sites *c, dem_index k, dem_index feature, double speed)
{
    if (speed == 0.0 && touch_friction(&c->scene, &c->list[k], feature) > 0.0) return 0;
    return speed < 0.0 ? -1 : 1;
}

/* Hops of this many skins are kept up where one contact's impact opens another that shares a node, or the other side of
 * a notch: each is taken a skin deep. */
static const double shared_skins = 8.0;

/* Speed at or below which what an acceleration `back` returns to a surface is at rest: the hop would be lower than the
 * position tolerance, than what rounding leaves of the coordinates, or than the one that impacts taken at the depth of
 * the skin keep up; or it would be shorter than twice the window. A rest speed that is given adds to that and replaces
 * none of it: a smaller one would leave bounces that never end. Nothing is at rest (-1) that does not return. */
static double resting_speed(const contact_sites *c, vec2 x, double back, const impact_surface *on, bool shared)
{
    const contact_rule *rule = &c->scene.rule;
    if (!(back > 0.0)) return -1.0;
    const double rounding = noise * fmax(fabs(x.x), fabs(x.y));
    const double skins = fmax(shared ? shared_skins : 0.0, 2.0 * impact_kept_up(on));
    const double height = fmax(fmax(rule->position_error, rounding), skins * rule->skin);
    return fmax(rule->rest_speed, fmax(sqrt(2.0 * back * height), back * rule->window));
}

static void book_impulse(contact_sites *c, dem_index obstacle, vec2 impulse, vec2 normal)
{
    const dem_obstacle *o = &c->scene.model->obstacles.list[obstacle];
    const bool smooth = o->friction == 0.0 && o->friction_law == DEM_FRICTION_COULOMB;
    const vec2 along = smooth ? impulse : vec2_scale(vec2_dot(impulse, normal), normal);
    books_add_impulse(&c->books, obstacle, impulse, vec2_sub(impulse, along));
}

/* ---- a node by itself ---- */

/* How far a node has to be moved to be on one segment's line and not beyond a vertex of it, or where two meet. */
static vec2 way_back(const contact_sites *c, contact_hit hit, vec2 x)
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
static contact_hit lasting(const contact_sites *c, dem_index k, contact_hit hit, vec2 v, const contact_moment *now)
{
    const dem_index i = c->list[k].node;
    const vec2 a = forces_acceleration(c->scene.model, &c->scene.rule.load, i, now->x, now->v), at = vec2_at(now->x, i);
    const double speed = vec2_norm(v);
    impact_surface wall[2];
    double push[2], away[2];
    contact_hit held = {0};
    for (int q = 0; q < hit.n; q++) {
        wall[q] = surface_of(c, k, hit.feature[q], scene_segment(&c->scene, hit.feature[q])->normal);
        away[q] = vec2_dot(v, wall[q].normal);
    }
    const int holding = impact_holding(wall, hit.n, a, push);
    const double back = speed > 0.0 ? -vec2_dot(a, v) / speed : 0.0; /* what holds in a corner returns a node to it */
    if (speed == 0.0 || (holding == 3 && (back <= 0.0 || speed <= resting_speed(c, at, back, &wall[0], false)))) {
        for (int q = 0; q < hit.n; q++)
            if (holding & (1 << q)) held.feature[held.n++] = hit.feature[q];
        return held;
    }
    const int along = hit.n == 2 && away[1] < away[0] ? 1 : 0;
    if (away[along] <= resting_speed(c, at, -vec2_dot(a, wall[along].normal), &wall[along], false))
        held = (contact_hit){1, {hit.feature[along]}};
    return held;
}

static vec2 without_normals(const contact_sites *c, contact_hit held, vec2 v)
{
    if (held.n == 2) return (vec2){0.0, 0.0};
    if (held.n == 0) return v;
    const vec2 n = scene_segment(&c->scene, held.feature[0])->normal;
    return vec2_along(v, -vec2_dot(v, n), n);
}

/* Tells of an impact and books its energy, J, and the impulse (N s) that each of the features gave. */
static void book(contact_sites *c, dem_event *event, double energy, vec2 impulse, contact_moment *now)
{
    event->impulse[0] = impulse.x;
    event->impulse[1] = impulse.y;
    event->energy = energy;
    c->books.impact += energy;
    books_enter(&c->books, event, now);
}

/* Leaves what is closed and closes what is held, quietly. */
static dem_status hold_on(contact_sites *c, dem_index k, contact_hit held, const contact_moment *now)
{
    contact_site *site = &c->list[k];
    const bool stays_free = site->n_closed == 0 && held.n == 0;
    site->n_closed = 0;
    sites_disturb(site);
    if (stays_free) return DEM_OK;
    for (int q = 0; q < held.n; q++) {
        const segment *s = scene_segment(&c->scene, held.feature[q]);
        const double speed = vec2_dot(vec2_at(now->v, site->node), s->tangent);
        site->closed[site->n_closed++] =
            (contact_touch){.feature = held.feature[q], .sign = sign_of(c, k, held.feature[q], speed)};
    }
    return sites_regroup(c);
}

/* Tells that contacts began or ceased to last where no impact tells it. */
static void tell_change(contact_sites *c, dem_index k, int was_closed, dem_index feature, bool struck,
                        contact_moment *now)
{
    const int is_closed = c->list[k].n_closed;
    c->books.counts.closings += is_closed > was_closed;
    if (is_closed == was_closed || (struck && is_closed > was_closed)) return;
    const dem_event event =
        sites_event(c, k, feature, is_closed > was_closed ? DEM_EVENT_CLOSE : DEM_EVENT_RELEASE, now);
    books_enter(&c->books, &event, now);
}

static dem_status strike_alone(contact_sites *c, dem_index k, contact_hit hit, contact_moment *now)
{
    const dem_index i = c->list[k].node;
    const int was_closed = c->list[k].n_closed;
    const vec2 before = vec2_at(now->v, i);
    impact_surface wall[2];
    vec2 kick[2];
    for (int q = 0; q < hit.n; q++)
        wall[q] = surface_of(c, k, hit.feature[q], scene_segment(&c->scene, hit.feature[q])->normal);
    sites_move(c, i, way_back(c, hit, vec2_at(now->x, i)), now->x);
    vec2 after = impact_rebound(wall, hit.n, before, kick);
    if (vec2_norm(after) <= noise * vec2_norm(before)) after = (vec2){0.0, 0.0};
    const contact_hit held = lasting(c, k, hit, after, now);
    if (held.n > 0) { /* what stays has not rebounded, and friction goes with the impulse given */
        for (int q = 0; q < hit.n; q++)
            for (int h = 0; h < held.n; h++)
                if (held.feature[h] == hit.feature[q]) wall[q].restitution = 0.0;
        after = without_normals(c, held, impact_rebound(wall, hit.n, before, kick));
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
        dem_event event = sites_event(c, k, hit.feature[0], DEM_EVENT_IMPACT, now);
        event.before[0] = before.x;
        event.before[1] = before.y;
        book(c, &event, 0.5 * m * (vec2_dot(before, before) - vec2_dot(after, after)),
             vec2_scale(m, vec2_sub(after, before)), now);
    }
    tell_change(c, k, was_closed, hit.feature[0], struck, now);
    return DEM_OK;
}

/* ---- contacts that share nodes ---- */

double strike_straighten(contact_sites *c, dem_index group, contact_moment *now)
{
    reactions *r = &c->reactions;
    double furthest = 0.0;
    const double *shift = reactions_shift(r, group, now->x, now->v);
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
        const contact_site *site = &c->list[r->members[p]];
        const dem_index nodes[2] = {site->node, site->other};
        for (int e = 0; e < (site_is_edge(site) ? 2 : 1); e++) {
            furthest = fmax(furthest, vec2_norm(vec2_at(shift, nodes[e])));
            sites_move(c, nodes[e], vec2_at(shift, nodes[e]), now->x);
            vec2_put(r->a, nodes[e], (vec2){0.0, 0.0}); /* an edge's node may come again */
        }
    }
    return furthest;
}

/* Notes where the contacts of the group start from; returns their largest speed. */
static double prepare(contact_sites *c, dem_index group, const contact_moment *now)
{
    const reactions *r = &c->reactions;
    double scale = 0.0;
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
        contact_site *site = &c->list[r->members[p]];
        site->stirred = true;
        site->n_struck = site->n_closed;
        for (int q = 0; q < site->n_closed; q++) {
            const touch_frame f = touch_frame_at(&c->scene, site, q, now->x, now->v);
            contact_touch *touch = &site->closed[q];
            touch->before = f.velocity;
            touch->impulse = (vec2){0.0, 0.0};
            touch->energy = 0.0;
            touch->opens = touch->held = touch->struck = touch->plastic = false;
            scale = fmax(scale, vec2_norm(f.velocity));
        }
    }
    return scale;
}

static void push(const contact_sites *c, const touch_frame *f, vec2 impulse, contact_moment *now)
{
    for (int p = 0; p < f->n; p++)
        vec2_put(
            now->v, f->node[p],
            vec2_along(vec2_at(now->v, f->node[p]), f->weight[p] * c->scene.model->inverse_mass[f->node[p]], impulse));
}

/* One contact of the group by itself: whether it strikes. */
static bool strike_once(contact_sites *c, dem_index k, int q, double tolerance, bool plastic, contact_moment *now)
{
    contact_touch *touch = &c->list[k].closed[q];
    const touch_frame f = touch_frame_at(&c->scene, &c->list[k], q, now->x, now->v);
    vec2 kick;
    if (vec2_dot(f.velocity, f.normal) >= -tolerance) return false;
    impact_surface wall = surface_of(c, k, touch->feature, f.normal);
    if (plastic || touch->plastic) wall.restitution = 0.0;
    const vec2 after = impact_rebound(&wall, 1, f.velocity, &kick);
    const vec2 impulse = vec2_scale(1.0 / f.mobility, kick);
    for (int p = 0; p < f.n; p++)
        vec2_put(
            now->v, f.node[p],
            vec2_along(vec2_at(now->v, f.node[p]), f.weight[p] * c->scene.model->inverse_mass[f.node[p]], impulse));
    touch->struck = true;
    touch->impulse = vec2_add(touch->impulse, impulse);
    touch->energy -= 0.5 * vec2_dot(impulse, vec2_add(f.velocity, after));
    return true;
}

/* The contacts of a group strike in turn, those of site k first. Returns false if that has not come to an end. */
static bool sweep(contact_sites *c, dem_index k, double tolerance, contact_moment *now)
{
    const reactions *r = &c->reactions;
    const dem_index group = r->group[k];
    bool struck = true;
    for (int q = 0; q < c->list[k].n_closed; q++)
        (void)strike_once(c, k, q, tolerance, false, now); /* it is the first */
    for (int s = 0; s < most_sweeps && struck; s++) {
        struck = false;
        for (dem_index p = r->row[group]; p < r->row[group + 1]; p++)
            for (int q = 0; q < c->list[r->members[p]].n_closed; q++)
                struck |= strike_once(c, r->members[p], q, tolerance, 2 * s >= most_sweeps, now);
    }
    return !struck;
}

/* Which contacts of the group last, and how they slide. */
static void judge(contact_sites *c, dem_index group, double tolerance, const contact_moment *now)
{
    const reactions *r = &c->reactions;
    const bool shared = r->row[group + 1] - r->row[group] > 1;
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
        const dem_index k = r->members[p];
        for (int q = 0; q < c->list[k].n_closed; q++) {
            contact_touch *touch = &c->list[k].closed[q];
            const touch_frame f = touch_frame_at(&c->scene, &c->list[k], q, now->x, now->v);
            const double away = vec2_dot(f.velocity, f.normal), speed = vec2_dot(f.velocity, f.tangent);
            double back = f.turning;
            for (int e = 0; e < f.n; e++)
                back -= f.weight[e] * vec2_dot(f.normal, forces_acceleration(c->scene.model, &c->scene.rule.load,
                                                                             f.node[e], now->x, now->v));
            const impact_surface wall = surface_of(c, k, touch->feature, f.normal);
            const double rest = resting_speed(c, vec2_at(now->x, f.node[0]), back, &wall, shared);
            touch->opens = away > (touch->fresh ? rest : fmax(rest, tolerance));
            touch->rests = rest > 0.0 && away <= rest;
            const int sign = sign_of(c, k, touch->feature, fabs(speed) <= tolerance ? 0.0 : speed);
            if (touch->fresh || touch->sign != 0) touch->place = fmin(fmax(f.place, 0.0), 1.0);
            touch->sign = sign;
        }
    }
}

/* If contacts last that have rebounded, takes all impulses back, to be given again with those plastic: what stays has
 * not rebounded, and friction goes with the impulse given. */
static bool take_back(contact_sites *c, dem_index group, contact_moment *now)
{
    const reactions *r = &c->reactions;
    bool any = false;
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++)
        for (int q = 0; q < c->list[r->members[p]].n_closed; q++) {
            contact_touch *touch = &c->list[r->members[p]].closed[q];
            touch->plastic = touch->struck && touch->rests;
            any |= touch->plastic;
        }
    for (dem_index p = r->row[group]; p < r->row[group + 1] && any; p++)
        for (int q = 0; q < c->list[r->members[p]].n_closed; q++) {
            contact_touch *touch = &c->list[r->members[p]].closed[q];
            const touch_frame f = touch_frame_at(&c->scene, &c->list[r->members[p]], q, now->x, now->v);
            push(c, &f, vec2_scale(-1.0, touch->impulse), now);
            touch->impulse = (vec2){0.0, 0.0};
            touch->energy = 0.0;
            touch->struck = false;
        }
    return any;
}

/* What still strikes after all sweeps is held for now: it stops exactly with the others, and opens if nothing
 * presses. */
static void keep_struck(contact_sites *c, dem_index group)
{
    const reactions *r = &c->reactions;
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++)
        for (int q = 0; q < c->list[r->members[p]].n_closed; q++)
            if (c->list[r->members[p]].closed[q].struck) c->list[r->members[p]].closed[q].opens = false;
}

/* Takes the contacts that open out of the closed ones, but keeps them behind these. */
static void part(contact_site *site)
{
    sites_disturb(site);
    if (site->n_closed == 2 && site->closed[0].opens && !site->closed[1].opens) {
        const contact_touch first = site->closed[0];
        site->closed[0] = site->closed[1];
        site->closed[1] = first;
    }
    while (site->n_closed > 0 && site->closed[site->n_closed - 1].opens) site->n_closed--;
}

void strike_stop(contact_sites *c, dem_index group, contact_moment *now)
{
    const reactions *r = &c->reactions;
    c->books.impact += sites_stop(c, group, now->x, now->v);
    for (dem_index p = r->row[group]; p < r->row[group + 1]; p++) {
        const contact_site *site = &c->list[r->members[p]];
        for (int q = 0; q < site->n_closed; q++) {
            const touch_frame f = touch_frame_at(&c->scene, site, q, now->x, now->v);
            const dem_obstacle *on = touch_obstacle(&c->scene, site, site->closed[q].feature);
            book_impulse(c, on - c->scene.model->obstacles.list, site->closed[q].stop, f.normal);
        }
    }
}

/* Stops the groups that have a node in common with a site: what the integrator's error has left them of velocity is no
 * approach. */
static void stop_around(contact_sites *c, dem_index k, contact_moment *now)
{
    const surface *s = &c->scene.model->surface;
    const dem_index nodes[2] = {c->list[k].node, c->list[k].other};
    for (int e = 0; e < (site_is_edge(&c->list[k]) ? 2 : 1); e++) {
        const dem_index own = c->of_node[nodes[e]];
        if (own >= 0 && c->list[own].n_closed > 0) strike_stop(c, c->reactions.group[own], now);
        for (dem_index p = s->row[nodes[e]]; p < s->row[nodes[e] + 1] && c->n > c->scene.model->n_sites; p++) {
            const dem_index edge = sites_of_edge(c, s->at[p]);
            if (c->list[edge].n_closed > 0) strike_stop(c, c->reactions.group[edge], now);
        }
    }
}

/* What the sweeps have left of velocities that closed contacts do not allow goes. */
static void settle_velocities(contact_sites *c, contact_moment *now)
{
    const reactions *r = &c->reactions;
    for (dem_index g = 0; g < r->n_groups; g++) {
        if (!c->list[r->members[r->row[g]]].stirred) continue;
        c->books.impact += sites_stop(c, g, now->x, now->v);
        for (dem_index p = r->row[g]; p < r->row[g + 1]; p++) {
            contact_site *site = &c->list[r->members[p]];
            for (int q = 0; q < site->n_closed; q++)
                site->closed[q].impulse = vec2_add(site->closed[q].impulse, site->closed[q].stop);
        }
    }
}

/* Books and tells what the contacts of a site got. */
static void tell_party(contact_sites *c, dem_index k, contact_moment *now)
{
    contact_site *site = &c->list[k];
    for (int q = 0; q < site->n_struck; q++) {
        const contact_touch *touch = &site->closed[q];
        const bool kept = q < site->n_closed;
        dem_event event = sites_event(c, k, touch->feature, DEM_EVENT_IMPACT, now);
        c->books.counts.closings += touch->fresh && kept;
        book_impulse(c, event.obstacle, touch->impulse, vec2_at(event.normal, 0));
        if (touch->struck) {
            event.before[0] = touch->before.x;
            event.before[1] = touch->before.y;
            book(c, &event, touch->energy, touch->impulse, now);
        }
        if (kept == !touch->fresh || (touch->struck && kept)) continue;
        event = sites_event(c, k, touch->feature, kept ? DEM_EVENT_CLOSE : DEM_EVENT_RELEASE, now);
        books_enter(&c->books, &event, now);
    }
    for (int q = 0; q < site->n_closed; q++) site->closed[q].fresh = false;
    site->stirred = false;
    site->n_struck = 0;
}

/* Takes up the hit among the closed contacts of the site, in place of those it does not go with. */
static dem_status take_up(contact_sites *c, dem_index k, contact_hit hit)
{
    contact_site *site = &c->list[k];
    for (int q = 0; q < site->n_closed; q++) site->closed[q].fresh = false;
    if (!site_is_edge(site) && site->n_closed == 1 && hit.n == 1) site->n_closed = 0;
    for (int h = 0; h < hit.n && site->n_closed < 2; h++) {
        const bool known = site->n_closed == 1 && site->closed[0].feature == hit.feature[h];
        if (!known) TRY(sites_close(c, k, (contact_touch){.feature = hit.feature[h], .sign = 1, .fresh = true}));
    }
    return sites_regroup(c);
}

/* The contacts of the group strike one another in turn until none approaches any more. */
static dem_status strike_together(contact_sites *c, dem_index k, contact_hit hit, contact_moment *now)
{
    stop_around(c, k, now);
    TRY(take_up(c, k, hit));
    const dem_index group = c->reactions.group[k];
    (void)strike_straighten(c, c->reactions.group[k], now);
    const double tolerance = group_noise * prepare(c, group, now);
    bool done = sweep(c, k, tolerance, now);
    judge(c, group, tolerance, now);
    if (take_back(c, group, now)) {
        done = sweep(c, k, tolerance, now);
        judge(c, group, tolerance, now);
    }
    if (!done) keep_struck(c, group);
    for (dem_index m = 0; m < c->n; m++)
        if (c->list[m].stirred) part(&c->list[m]);
    TRY(sites_regroup(c));
    settle_velocities(c, now);
    for (dem_index m = 0; m < c->n; m++)
        if (c->list[m].stirred) tell_party(c, m, now);
    return DEM_OK;
}

dem_status strike(contact_sites *c, dem_index k, contact_hit hit, contact_moment *now)
{
    if (!site_is_edge(&c->list[k]) && !sites_coupled(c, k)) return strike_alone(c, k, hit, now);
    return strike_together(c, k, hit, now);
}

/* Unit normal of an edge, into the body. */
static vec2 edge_normal(const contact_site *edge, const double *x)
{
    const vec2 way = vec2_sub(vec2_at(x, edge->other), vec2_at(x, edge->node));
    return vec2_scale(1.0 / vec2_norm(way), (vec2){-way.y, way.x});
}

bool strike_notch(const contact_sites *c, dem_index edge, dem_index next, const contact_moment *now)
{
    const contact_site *here = &c->list[edge], *there = &c->list[next];
    const dem_index node = here->node == there->other ? here->node : here->other, feature = here->closed[0].feature;
    const vec2 a = forces_acceleration(c->scene.model, &c->scene.rule.load, node, now->x, now->v);
    const impact_surface sides[2] = {surface_of(c, edge, feature, edge_normal(here, now->x)),
                                     surface_of(c, edge, feature, edge_normal(there, now->x))};
    double push_on[2];
    vec2 kick;
    if (impact_holding(sides, 2, a, push_on) != 3) return false;
    const vec2 after = impact_rebound(&sides[1], 1, vec2_at(now->v, node), &kick);
    const double speed = vec2_norm(after), back = speed > 0.0 ? -vec2_dot(a, after) / speed : 0.0;
    return speed == 0.0 || speed <= resting_speed(c, vec2_at(now->x, node), back, &sides[0], true);
}

void strike_early(contact_sites *c, dem_index k, const contact_gap *gap, contact_moment *now)
{
    contact_site *site = &c->list[k];
    contact_site alone = *site;
    vec2 kick;
    alone.closed[0] = (contact_touch){.feature = gap->feature, .sign = 1};
    touch_frame f = touch_frame_at(&c->scene, &alone, 0, now->x, now->v);
    f.normal = gap->normal;
    const impact_surface wall = surface_of(c, k, gap->feature, f.normal);
    const vec2 after = impact_rebound(&wall, 1, f.velocity, &kick), impulse = vec2_scale(1.0 / f.mobility, kick);
    dem_event event = sites_event(c, k, gap->feature, DEM_EVENT_IMPACT, now);
    for (int p = 0; p < f.n; p++)
        vec2_put(
            now->v, f.node[p],
            vec2_along(vec2_at(now->v, f.node[p]), f.weight[p] * c->scene.model->inverse_mass[f.node[p]], impulse));
    event.normal[0] = f.normal.x;
    event.normal[1] = f.normal.y;
    event.after[0] = after.x;
    event.after[1] = after.y;
    c->books.counts.early++;
    book_impulse(c, event.obstacle, impulse, f.normal);
    book(c, &event, -0.5 * vec2_dot(impulse, vec2_add(f.velocity, after)), impulse, now);
}

/* ---- what is struck ---- */

double strike_depth(const contact_sites *c, dem_index k, const contact_moment *now)
{
    const contact_site *site = &c->list[k];
    const double located = 1000.0 * DBL_EPSILON * (fabs(now->t) + c->scene.rule.max_step);
    const double speed = vec2_norm(vec2_at(now->v, site->node));
    const double other = site_is_edge(site) ? vec2_norm(vec2_at(now->v, site->other)) : 0.0;
    return 2.0 * c->scene.rule.skin + c->straightened + located * fmax(speed, other);
}

/* A node at a vertex meets one segment only, unless the vertex is a corner: of two in line or with a convex bend the
 * one approached faster, on a tie the one that ends there. */
static bool yields(const contact_sites *c, dem_index s, dem_index to, vec2 v)
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

bool strike_corner(const contact_sites *c, dem_index s, dem_index other, vec2 x, double tolerance)
{
    vec2 vertex;
    if (obstacles_share(&c->scene.model->obstacles, s, other, &vertex))
        return vec2_norm(vec2_sub(x, vertex)) <= 4.0 * tolerance;
    return fabs(vec2_cross(scene_segment(&c->scene, s)->tangent, scene_segment(&c->scene, other)->tangent)) > 0.01;
}

static double approach(const contact_sites *c, dem_index s, vec2 v)
{
    return -vec2_dot(v, scene_segment(&c->scene, s)->normal);
}

contact_hit strike_met(const contact_sites *c, dem_index k, const contact_moment *now)
{
    enum { capacity = 8 };
    dem_index hits[capacity];
    contact_hit out = {0};
    const contact_site *site = &c->list[k];
    const vec2 x = vec2_at(now->x, site->node), v = vec2_at(now->v, site->node);
    const obstacle_touch touch = {strike_depth(c, k, now), scene_margin(&c->scene), site->behind[0]};
    const int n = obstacles_touching(&c->scene.model->obstacles, x, &touch, hits, capacity);
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
    if (out.n == 2 && !strike_corner(c, out.feature[0], out.feature[1], x, touch.tolerance)) out.n = 1;
    return out;
}

/* Whether a direction lies between the normals of a convex vertex. */
static bool in_cone(const contact_sites *c, const obstacle_vertex *at, vec2 n)
{
    return vec2_cross(scene_segment(&c->scene, at->before)->normal, n) <= 0.0 &&
           vec2_cross(n, scene_segment(&c->scene, at->after)->normal) <= 0.0;
}

dem_index strike_side(const contact_sites *c, dem_index k, const contact_moment *now, dem_index *vertex)
{
    const surface *s = &c->scene.model->surface;
    const dem_index node = c->list[k].node;
    const double tolerance = strike_depth(c, k, now);
    double fastest = 0.0;
    dem_index best = -1;
    for (dem_index p = s->row[node]; p < s->row[node + 1] && c->n > c->scene.model->n_sites; p++) {
        const dem_index e = sites_of_edge(c, s->at[p]);
        const contact_spot spot = site_spot(&c->list[e], now->x);
        const contact_gap gap = site_gap(&c->scene, &c->list[e], &spot);
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
