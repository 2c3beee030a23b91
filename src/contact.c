/* SPDX-License-Identifier: BSD-3-Clause */
/* The automaton FREE - sliding - held of every contact site: its resets, and the books kept of them. */
#include "contact.h"

#include <float.h>
#include <stdlib.h>

#include "impact.h"
#include "status.h"

static const double touch_share =
    0.99; /* of the skin: as deep counts as touching, so that near ties are taken together */

/* The state being changed: views into y = (x, v), and who is told. */
typedef struct moment {
    double t;
    double *x, *v;
    const contact_listener *listener;
    dem_status told; /* the first status other than DEM_OK that the listener returned */
} moment;

/* The one or two segments that a node touches. */
typedef struct meeting {
    int n;
    dem_index s[2];
} meeting;

static impact_surface surface_of(const contact *c, dem_index s)
{
    return (impact_surface){scene_segment(&c->scene, s)->normal, scene_segment(&c->scene, s)->restitution};
}

static dem_contact describe(const contact *c, const contact_site *site, dem_index s)
{
    const segment *seg = scene_segment(&c->scene, s);
    return (dem_contact){.n_nodes = 1,
                         .state = DEM_CONTACT_SLIP,
                         .nodes = {site->node},
                         .weights = {1.0},
                         .obstacle = seg->obstacle,
                         .segment = seg->index,
                         .normal = {seg->normal.x, seg->normal.y}};
}

static void close_on(contact *c, contact_site *site, meeting on)
{
    site->n_closed = on.n;
    for (int k = 0; k < on.n; k++) {
        site->segments[k] = on.s[k];
        site->closed[k] = describe(c, site, on.s[k]);
        site->closed[k].state = on.n == 2 ? DEM_CONTACT_STICK : DEM_CONTACT_SLIP;
    }
}

/* How far a node has to be moved to be on one segment's line and not beyond a vertex of it, or where two meet. */
static vec2 way_back(const contact *c, meeting with, vec2 x)
{
    const segment *a = scene_segment(&c->scene, with.s[0]), *b = scene_segment(&c->scene, with.s[with.n - 1]);
    vec2 vertex;
    if (with.n == 2 && obstacles_share(&c->scene.model->obstacles, with.s[0], with.s[1], &vertex))
        return vec2_sub(vertex, x);
    const double h0 = segment_height(a, x), h1 = segment_height(b, x), place = segment_place(a, x);
    if (with.n == 2) /* n0.shift = -h0 and n1.shift = -h1 */
        return vec2_scale(1.0 / vec2_cross(a->tangent, b->tangent),
                          vec2_along(vec2_scale(h1, a->tangent), -h0, b->tangent));
    const double beyond =
        (place < 0.0 && a->before >= 0) ? place : (place > a->length && a->after >= 0 ? place - a->length : 0.0);
    return vec2_along(vec2_scale(-h0, a->normal), -beyond, a->tangent);
}

/* Moves the node and books the energy that this puts in. */
static void move(contact *c, const contact_site *site, vec2 shift, moment *now)
{
    const dem_index i = site->node;
    const double before = model_node_energy(c->scene.model, c->scene.rule.load.gravity, i, now->x);
    vec2_put(now->x, i, vec2_add(vec2_at(now->x, i), shift));
    c->projection_energy += model_node_energy(c->scene.model, c->scene.rule.load.gravity, i, now->x) - before;
}

/* Speed at or below which a node that an acceleration `back` returns is at rest: the hop would be lower than the
 * position tolerance, or than what rounding leaves of the coordinates. Nothing is at rest (-1) that does not return. */
static double resting_speed(const contact *c, vec2 x, double back)
{
    if (!(back > 0.0)) return -1.0;
    if (c->scene.rule.rest_speed > 0.0) return c->scene.rule.rest_speed;
    const double rounding = 64.0 * DBL_EPSILON * fmax(fabs(x.x), fabs(x.y));
    return sqrt(2.0 * back * fmax(c->scene.rule.position_error, rounding));
}

/* Of the surfaces touched, those on which a node with velocity v stays. At rest it is all that push it; in a corner
 * at rest means that it would not get further out than a hop before the corner has it back. Otherwise it is the one
 * surface it moves along. */
static meeting lasting(const contact *c, const contact_site *site, meeting with, vec2 v, const double *x)
{
    const vec2 a = model_acceleration(c->scene.model, &c->scene.rule.load, site->node, x,
                                      x + 2 * c->scene.model->lattice.n_nodes),
               at = vec2_at(x, site->node);
    const double speed = vec2_norm(v);
    impact_surface surface[2];
    double reaction[2], away[2];
    meeting held = {0};
    for (int k = 0; k < with.n; k++) {
        surface[k] = surface_of(c, with.s[k]);
        away[k] = vec2_dot(v, surface[k].normal);
    }
    const int holding = impact_holding(surface, with.n, a, reaction);
    const double back = speed > 0.0 ? -vec2_dot(a, v) / speed : 0.0; /* what holds in a corner returns a node to it */
    if (speed == 0.0 || (holding == 3 && (back <= 0.0 || speed <= resting_speed(c, at, back)))) {
        for (int k = 0; k < with.n; k++)
            if (holding & (1 << k)) held.s[held.n++] = with.s[k];
        return held;
    }
    const int along = with.n == 2 && away[1] < away[0] ? 1 : 0;
    if (away[along] <= resting_speed(c, at, -vec2_dot(a, surface[along].normal))) held = (meeting){1, {with.s[along]}};
    return held;
}

static vec2 without_normals(const contact *c, const contact_site *site, vec2 v)
{
    if (site->n_closed == 2) return (vec2){0.0, 0.0};
    if (site->n_closed == 0) return v;
    const vec2 n = scene_segment(&c->scene, site->segments[0])->normal;
    return vec2_along(v, -vec2_dot(v, n), n);
}

/* Gives every obstacle its part of an impulse that acts along the normals. */
static void book_impulse(contact *c, meeting with, vec2 impulse)
{
    double parts[2] = {0.0, 0.0};
    const vec2 n0 = scene_segment(&c->scene, with.s[0])->normal;
    if (with.n == 2)
        vec2_parts(impulse, n0, scene_segment(&c->scene, with.s[1])->normal, parts);
    else
        parts[0] = vec2_dot(impulse, n0);
    for (int k = 0; k < with.n; k++) {
        const segment *seg = scene_segment(&c->scene, with.s[k]);
        c->impulse[2 * seg->obstacle] += parts[k] * seg->normal.x;
        c->impulse[2 * seg->obstacle + 1] += parts[k] * seg->normal.y;
    }
}

static void tell(const contact *c, const contact_site *site, dem_index s, vec2 before, moment *now)
{
    if (now->listener->event == NULL) return;
    const dem_index i = site->node;
    const vec2 after = vec2_at(now->v, i), x = vec2_at(now->x, i);
    const vec2 impulse = vec2_scale(c->scene.model->lattice.mass[i], vec2_sub(after, before));
    const segment *seg = scene_segment(&c->scene, s);
    const dem_event event = {.t = now->t,
                             .kind = DEM_EVENT_IMPACT,
                             .other = -1,
                             .node = i,
                             .obstacle = seg->obstacle,
                             .segment = seg->index,
                             .x = {x.x, x.y},
                             .normal = {seg->normal.x, seg->normal.y},
                             .impulse = {impulse.x, impulse.y},
                             .before = {before.x, before.y},
                             .after = {after.x, after.y},
                             .state = site->n_closed > 0 ? DEM_CONTACT_SLIP : DEM_CONTACT_FREE};
    const dem_status status = now->listener->event(now->listener->context, &event);
    if (now->told == DEM_OK) now->told = status;
}

/* Books what the node's change of velocity means: energy taken, impulse given; tells the listener. */
static void book_impact(contact *c, const contact_site *site, meeting with, vec2 before, moment *now)
{
    const vec2 after = vec2_at(now->v, site->node);
    const double m = c->scene.model->lattice.mass[site->node];
    if (after.x == before.x && after.y == before.y) return;
    c->counts.impacts++;
    c->impact_energy += 0.5 * m * (vec2_dot(before, before) - vec2_dot(after, after));
    book_impulse(c, with, vec2_scale(m, vec2_sub(after, before)));
    tell(c, site, with.s[0], before, now);
}

/* The node strikes one or two segments, the one approached faster first: projection, rebound, and which contacts
 * last. */
static void strike(contact *c, contact_site *site, meeting with, moment *now)
{
    const vec2 before = vec2_at(now->v, site->node);
    const int was_closed = site->n_closed;
    impact_surface surface[2];
    for (int k = 0; k < with.n; k++) surface[k] = surface_of(c, with.s[k]);
    move(c, site, way_back(c, with, vec2_at(now->x, site->node)), now);
    vec2 after = impact_rebound(surface, with.n, before);
    if (vec2_norm(after) <= 64.0 * DBL_EPSILON * vec2_norm(before)) after = (vec2){0.0, 0.0};
    close_on(c, site, lasting(c, site, with, after, now->x));
    vec2_put(now->v, site->node, without_normals(c, site, after));
    c->counts.closings += site->n_closed > was_closed;
    c->counts.releases += site->n_closed < was_closed;
    book_impact(c, site, with, before, now);
}

/* ---- which reset is due ---- */

/* How deep a node can be at an impact, m: twice the skin, and how far it moves in ten times the time to which events
 * are located (100 units of rounding of t and of the step). */
static double contact_depth(const contact *c, const contact_site *site, const moment *now)
{
    const double located = 1000.0 * DBL_EPSILON * (fabs(now->t) + c->scene.rule.max_step);
    return 2.0 * c->scene.rule.skin + located * vec2_norm(vec2_at(now->v, site->node));
}

/* A node at a vertex meets one segment only, unless the vertex is a corner: of two in line or with a convex bend the
 * one approached faster, on a tie the one that ends there. */
static bool yields(const contact *c, dem_index s, dem_index to, vec2 v)
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

/* Whether a node at x is in a corner of two segments, rather than on one nearly straight surface or in a channel:
 * neighbours, which bend up here, form one at their vertex. */
static bool corner(const contact *c, dem_index s, dem_index other, vec2 x, double tolerance)
{
    vec2 vertex;
    if (obstacles_share(&c->scene.model->obstacles, s, other, &vertex))
        return vec2_norm(vec2_sub(x, vertex)) <= 4.0 * tolerance;
    return fabs(vec2_cross(scene_segment(&c->scene, s)->tangent, scene_segment(&c->scene, other)->tangent)) > 0.01;
}

static double approach(const contact *c, dem_index s, vec2 v)
{
    return -vec2_dot(v, scene_segment(&c->scene, s)->normal);
}

/* What a touching node meets: the segment approached fastest, and a second one that forms a corner with it. */
static meeting met(const contact *c, const contact_site *site, const moment *now)
{
    enum { capacity = 8 };
    dem_index hits[capacity];
    meeting out = {0};
    const vec2 x = vec2_at(now->x, site->node), v = vec2_at(now->v, site->node);
    const obstacle_touch touch = {contact_depth(c, site, now), scene_margin(&c->scene), site->behind};
    const int n = obstacles_touching(&c->scene.model->obstacles, x, &touch, hits, capacity);
    for (int k = 0; k < n; k++) {
        bool meets = true;
        for (int q = 0; q < n && meets; q++) meets = !yields(c, hits[k], hits[q], v);
        if (!meets) continue;
        const int place = out.n > 0 && approach(c, hits[k], v) <= approach(c, out.s[0], v) ? 1 : 0;
        if (place == 1 && out.n == 2 && approach(c, hits[k], v) <= approach(c, out.s[1], v)) continue;
        if (place == 0) out.s[1] = out.s[0];
        out.s[place] = hits[k];
        out.n = out.n < 2 ? out.n + 1 : 2;
    }
    if (out.n == 2 && !corner(c, out.s[0], out.s[1], x, touch.tolerance)) out.n = 1;
    return out;
}

static void release(contact *c, contact_site *site, meeting kept)
{
    close_on(c, site, kept);
    c->counts.releases++;
}

/* A node deeper inside than an impact can be has passed round the free end that it is at; else something is wrong. */
static dem_status go_behind(contact *c, contact_site *site, obstacle_gap gap, const moment *now)
{
    const vec2 x = vec2_at(now->x, site->node);
    const segment *s = scene_segment(&c->scene, gap.segment);
    const double place = segment_place(s, x), tolerance = contact_depth(c, site, now);
    const double margin = scene_margin(&c->scene) + tolerance;
    const bool at_free_end = (s->before < 0 && fabs(place) <= fmax(margin, s->buried[0] + tolerance)) ||
                             (s->after < 0 && fabs(place - s->length) <= fmax(margin, s->buried[1] + tolerance));
    CHECK(at_free_end && site->behind < 0, DEM_ERROR_CONTACT,
          "node %lld at (%g, %g) m is %g m inside obstacle %lld at t = %.9g s", (long long)site->node, x.x, x.y,
          -gap.distance, (long long)s->obstacle, now->t);
    site->behind = s->obstacle;
    c->counts.behind++;
    return DEM_OK;
}

/* Free node: is it deep enough to count as touching? */
static dem_status settle_free(contact *c, contact_site *site, moment *now, bool *changed)
{
    const obstacle_gap gap = site_free_gap(&c->scene, site, vec2_at(now->x, site->node));
    if (gap.distance > -touch_share * c->scene.rule.skin) return DEM_OK;
    *changed = true;
    const meeting with = gap.distance >= -contact_depth(c, site, now) ? met(c, site, now) : (meeting){0};
    if (with.n == 0) return go_behind(c, site, gap, now);
    strike(c, site, with, now);
    return DEM_OK;
}

/* A sliding node at the end of its segment: falls free, glides on, or runs into the next segment. */
static void pass(contact *c, contact_site *site, bool backwards, moment *now)
{
    const dem_index here = site->segments[0];
    meeting next = {.n = 1};
    const obstacle_bend bend = obstacles_bend(&c->scene.model->obstacles, here, backwards, &next.s[0]);
    c->counts.passings++;
    if (bend == OBSTACLE_STRAIGHT) {
        close_on(c, site, next);
        move(c, site, way_back(c, next, vec2_at(now->x, site->node)), now);
        vec2_put(now->v, site->node, without_normals(c, site, vec2_at(now->v, site->node)));
    } else if (bend == OBSTACLE_CONCAVE) {
        strike(c, site, (meeting){2, {next.s[0], here}}, now);
    } else {
        release(c, site, (meeting){0});
    }
}

/* Sliding node: release comes first, then the segment's end, then another segment in the way. */
static dem_status settle_sliding(contact *c, contact_site *site, moment *now, bool *changed)
{
    const segment *seg = scene_segment(&c->scene, site->segments[0]);
    const vec2 x = vec2_at(now->x, site->node), f = site_force(&c->scene, site, now->x);
    *changed = true;
    if (vec2_dot(f, seg->normal) >= 0.0) {
        release(c, site, (meeting){0});
        return DEM_OK;
    }
    const int passed = site_end_passed(&c->scene, site, now->x, now->v);
    if (passed != 0) {
        pass(c, site, passed < 0, now);
        return DEM_OK;
    }
    const obstacle_gap other = site_other_gap(&c->scene, site, x);
    if (other.distance < -contact_depth(c, site, now)) return go_behind(c, site, other, now);
    if (other.distance <= -touch_share * c->scene.rule.skin) {
        const bool both = corner(c, other.segment, site->segments[0], x, contact_depth(c, site, now));
        strike(c, site, (meeting){both ? 2 : 1, {other.segment, site->segments[0]}}, now);
        return DEM_OK;
    }
    *changed = false;
    return DEM_OK;
}

/* Held node: a reaction that pulls lets go; what is left then slides or is released in its turn. */
static void settle_held(contact *c, contact_site *site, const moment *now, bool *changed)
{
    meeting kept = {0};
    double reaction[2];
    site_reactions(&c->scene, site, now->x, reaction);
    for (int k = 0; k < 2; k++)
        if (reaction[k] > 0.0) kept.s[kept.n++] = site->segments[k];
    if (kept.n == 2) return;
    *changed = true;
    release(c, site, kept);
}

static dem_status settle(contact *c, contact_site *site, moment *now, bool *changed)
{
    bool here = false;
    if (site->n_closed == 0)
        TRY(settle_free(c, site, now, &here));
    else if (site->n_closed == 1)
        TRY(settle_sliding(c, site, now, &here));
    else
        settle_held(c, site, now, &here);
    if (!here) return DEM_OK;
    *changed = true;
    if (now->t - site->storm_start > c->scene.rule.storm_time) {
        site->storm_start = now->t;
        site->storm = 0;
    }
    CHECK(++site->storm <= c->scene.rule.max_impacts, DEM_ERROR_CONTACT,
          "node %lld at (%g, %g) m had more than %lld contact events within %g s, at t = %.9g s", (long long)site->node,
          now->x[2 * site->node], now->x[2 * site->node + 1], (long long)c->scene.rule.max_impacts,
          c->scene.rule.storm_time, now->t);
    return DEM_OK;
}

static void refresh_forces(contact *c, const double *x)
{
    for (dem_index k = 0; k < c->scene.model->n_sites; k++) {
        contact_site *site = &c->sites[k];
        if (site->n_closed == 0) continue;
        double reaction[2];
        site_reactions(&c->scene, site, x, reaction);
        for (int q = 0; q < site->n_closed; q++) site->closed[q].force = reaction[q];
    }
}

/* A node that came back from behind to the front, or round the free end again, is in front. */
static void refresh_behind(contact *c, const double *x)
{
    for (dem_index k = 0; k < c->scene.model->n_sites && c->counts.behind > 0; k++) {
        contact_site *site = &c->sites[k];
        if (site->behind < 0) continue;
        if (obstacles_gap_of(&c->scene.model->obstacles, vec2_at(x, site->node), scene_margin(&c->scene), site->behind)
                .distance <= 0.0)
            continue;
        site->behind = -1;
        c->counts.behind--;
    }
}

/* Puts closed nodes back where rounding has taken them from. */
static void straighten(contact *c, moment *now)
{
    for (dem_index k = 0; k < c->scene.model->n_sites; k++) {
        const contact_site *site = &c->sites[k];
        const vec2 x = vec2_at(now->x, site->node);
        const meeting on = {site->n_closed, {site->segments[0], site->segments[1]}};
        if (site->n_closed == 2) move(c, site, way_back(c, on, x), now);
        if (site->n_closed != 1) continue;
        const segment *s = scene_segment(&c->scene, on.s[0]);
        move(c, site, vec2_scale(-segment_height(s, x), s->normal), now);
    }
}

/* ---- public ---- */

void contact_guards(const contact *c, const double *y, double *g)
{
    for (dem_index k = 0; k < c->scene.model->n_sites; k++)
        site_guards(&c->scene, &c->sites[k], y, &g[SITE_GUARDS * k]);
}

void contact_constrain(const contact *c, double *a)
{
    for (dem_index k = 0; k < c->scene.model->n_sites; k++) {
        const contact_site *site = &c->sites[k];
        if (site->n_closed == 0) continue;
        const vec2 n = scene_segment(&c->scene, site->segments[0])->normal, free_a = vec2_at(a, site->node);
        const vec2 held = site->n_closed == 2 ? (vec2){0.0, 0.0} : vec2_along(free_a, -vec2_dot(free_a, n), n);
        vec2_put(a, site->node, held);
    }
}

dem_status contact_create(contact *out, const dem_model *model, const contact_rule *rule)
{
    contact c = {.scene = {model, *rule}};
    c.sites = calloc((size_t)model->n_sites + 1, sizeof *c.sites);
    c.impulse = calloc(2 * (size_t)model->obstacles.n + 1, sizeof *c.impulse);
    if (c.sites == NULL || c.impulse == NULL) {
        contact_destroy(&c);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld contact sites", (long long)model->n_sites);
    }
    for (dem_index k = 0; k < model->n_sites; k++) c.sites[k] = (contact_site){.node = model->sites[k], .behind = -1};
    *out = c;
    return DEM_OK;
}

void contact_destroy(contact *c)
{
    free(c->sites);
    free(c->impulse);
    *c = (contact){0};
}

dem_status contact_resolve(contact *c, double t, double *y, const contact_listener *listener)
{
    moment now = {t, y, y + 2 * c->scene.model->lattice.n_nodes, listener, DEM_OK};
    bool changed = true;
    for (c->idle++; changed; c->idle = changed ? 0 : c->idle) {
        changed = false;
        for (dem_index k = 0; k < c->scene.model->n_sites; k++) TRY(settle(c, &c->sites[k], &now, &changed));
    }
    CHECK(c->idle <= c->scene.rule.max_impacts, DEM_ERROR_CONTACT,
          "more than %lld contact events in a row changed nothing, at t = %.9g s", (long long)c->scene.rule.max_impacts,
          t);
    straighten(c, &now);
    refresh_forces(c, now.x);
    return now.told;
}

dem_status contact_admissible(const contact *c, const double *x)
{
    for (dem_index k = 0; k < c->scene.model->n_sites; k++) {
        const vec2 at = vec2_at(x, c->sites[k].node);
        const obstacle_gap gap = site_free_gap(&c->scene, &c->sites[k], at);
        CHECK(gap.distance >= -c->scene.rule.skin, DEM_ERROR_MODEL,
              "node %lld at (%g, %g) m starts %g m inside obstacle %lld, deeper than the skin of %g m",
              (long long)c->sites[k].node, at.x, at.y, -gap.distance,
              (long long)scene_segment(&c->scene, gap.segment)->obstacle, c->scene.rule.skin);
    }
    return DEM_OK;
}

dem_status contact_start(contact *c, double t, double *y, const contact_listener *listener)
{
    moment now = {t, y, y + 2 * c->scene.model->lattice.n_nodes, listener, DEM_OK};
    for (dem_index k = 0; k < c->scene.model->n_sites; k++) {
        contact_site *site = &c->sites[k];
        if (site_free_gap(&c->scene, site, vec2_at(now.x, site->node)).distance > 0.0) continue;
        const meeting with = met(c, site, &now);
        if (with.n > 0) strike(c, site, with, &now);
    }
    const dem_status status = contact_resolve(c, t, y, listener);
    return now.told != DEM_OK ? now.told : status;
}

bool contact_check(contact *c, path *p, bool rooted, double *state)
{
    double first = INFINITY;
    for (dem_index k = 0; k < c->scene.model->n_sites; k++)
        if (c->sites[k].n_closed == 0) first = fmin(first, site_first_crossing(&c->scene, &c->sites[k], p, rooted));
    path_state(p, p->end, state);
    for (dem_index k = 0; k < c->scene.model->n_sites; k++) {
        const contact_site *site = &c->sites[k];
        if (site->n_closed == 0 || !site_due(&c->scene, site, state)) continue;
        const double t = site_first_due(&c->scene, site, p, state);
        if (!rooted || t < p->end) first = fmin(first, t);
        path_state(p, p->end, state);
    }
    if (isinf(first)) return false;
    p->end = first;
    c->counts.late++;
    return true;
}

void contact_follow(contact *c, double h, const double *y)
{
    for (int end = 0; end < 2; end++) { /* trapezoidal rule: forces at the start of the step, then at its end */
        if (end == 1) refresh_forces(c, y);
        for (dem_index k = 0; k < c->scene.model->n_sites; k++)
            for (int q = 0; q < c->sites[k].n_closed; q++) {
                const dem_contact *held = &c->sites[k].closed[q];
                c->impulse[2 * held->obstacle] += 0.5 * h * held->force * held->normal[0];
                c->impulse[2 * held->obstacle + 1] += 0.5 * h * held->force * held->normal[1];
            }
    }
    refresh_behind(c, y);
}

dem_index contact_list(const contact *c, dem_contact *list)
{
    dem_index n = 0;
    for (dem_index k = 0; k < c->scene.model->n_sites; k++)
        for (int q = 0; q < c->sites[k].n_closed; q++) list[n++] = c->sites[k].closed[q];
    return n;
}
