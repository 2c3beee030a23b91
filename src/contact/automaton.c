/* SPDX-License-Identifier: BSD-3-Clause */
/* Which reset is due, in which order; what a step leaves in the books. */
#include "contact/automaton.h"

#include <float.h>

#include "base/status.h"
#include "contact/impact_solve.h"

static const double touch_share =
    0.99; /* of the skin: as deep counts as touching, so that near ties are taken together */

/* ---- free sites ---- */

static const double *velocities(const contact *c, const double *y)
{
    return y + scene_velocities(&c->sites.scene);
}

/* A node deeper inside than an impact can be has passed round the free end that it is at; else something is wrong. */
static dem_status go_behind(contact_sites *c, dem_index k, dem_index feature, double depth, const contact_moment *now)
{
    const vec2 x = vec2_at(now->x, c->list[k].node);
    const segment *s = scene_segment(&c->scene, feature);
    const double place = segment_place(s, x), tolerance = strike_depth(c, k, now);
    const double margin = scene_margin(&c->scene) + tolerance;
    const bool at_free_end = (s->before < 0 && fabs(place) <= fmax(margin, s->buried[0] + tolerance)) ||
                             (s->after < 0 && fabs(place - s->length) <= fmax(margin, s->buried[1] + tolerance));
    CHECK(at_free_end && c->list[k].behind[0] < 0, DEM_ERROR_CONTACT,
          "node %lld at (%g, %g) m is %g m inside obstacle %lld at t = %.9g s", (long long)c->list[k].node, x.x, x.y,
          depth, (long long)s->obstacle, now->t);
    sites_go_behind(c, k, s->obstacle);
    return DEM_OK;
}

/* A node that touches: what it strikes; right on an apex it is the side that comes down on it. */
static dem_status touch_node(contact_sites *c, dem_index k, const contact_gap *gap, contact_moment *now)
{
    dem_index at;
    const contact_hit with = gap->distance >= -strike_depth(c, k, now) ? strike_met(c, k, now) : (contact_hit){0};
    if (with.n == 0) return go_behind(c, k, gap->feature, -gap->distance, now);
    const dem_index side = with.n == 1 ? strike_side(c, k, now, &at) : -1;
    return side >= 0 ? strike(c, side, (contact_hit){1, {at}}, now) : strike(c, k, with, now);
}

/* An edge that touches a vertex strikes it. */
static dem_status touch_edge(contact_sites *c, dem_index k, const contact_gap *gap, contact_moment *now)
{
    const contact_site *site = &c->list[k];
    const vec2 ab = vec2_sub(vec2_at(now->x, site->other), vec2_at(now->x, site->node));
    const segment *s = scene_segment(&c->scene, touch_segment(&c->scene, site, gap->feature));
    CHECK(gap->distance >= -1e-3 * vec2_norm(ab), DEM_ERROR_CONTACT,
          "the vertex at (%g, %g) m of obstacle %lld is %g m inside the body, behind the edge from node %lld to %lld, "
          "at t = %.9g s",
          s->end.x, s->end.y, (long long)s->obstacle, -gap->distance, (long long)site->node, (long long)site->other,
          now->t);
    return strike(c, k, (contact_hit){1, {gap->feature}}, now);
}

static dem_status settle_free(contact_sites *c, dem_index k, contact_moment *now, bool *changed)
{
    const contact_spot spot = site_spot(&c->list[k], now->x);
    const contact_gap gap = site_gap(&c->scene, &c->list[k], &spot);
    if (gap.distance > -touch_share * c->scene.rule.skin) return DEM_OK;
    *changed = true;
    return site_is_edge(&c->list[k]) ? touch_edge(c, k, &gap, now) : touch_node(c, k, &gap, now);
}

/* ---- closed sites ---- */

static dem_status enter(contact_sites *c, dem_index k, dem_index feature, dem_event_kind kind, contact_moment *now)
{
    const dem_event event = sites_event(c, k, feature, kind, now);
    books_enter(&c->books, &event, now);
    return DEM_OK;
}

static dem_status release(contact_sites *c, dem_index k, int q, contact_moment *now)
{
    const dem_index feature = c->list[k].closed[q].feature;
    TRY(sites_open(c, k, q));
    return enter(c, k, feature, DEM_EVENT_RELEASE, now);
}

/* A node that slides past the end of its segment falls free, glides on, or runs into the next segment. */
static dem_status pass_node(contact_sites *c, dem_index k, bool backwards, contact_moment *now)
{
    contact_site *site = &c->list[k];
    contact_hit next = {.n = 1};
    const dem_index here = site->closed[0].feature;
    const obstacle_bend bend = obstacles_bend(&c->scene.model->obstacles, here, backwards, &next.feature[0]);
    TRY(enter(c, k, here, DEM_EVENT_PASS, now));
    if (bend == OBSTACLE_CONCAVE) return strike(c, k, (contact_hit){2, {next.feature[0], here}}, now);
    if (bend != OBSTACLE_STRAIGHT) return release(c, k, 0, now);
    const segment *s = scene_segment(&c->scene, next.feature[0]);
    const vec2 v = vec2_at(now->v, site->node);
    site->closed[0].feature = next.feature[0];
    sites_move(c, site->node, vec2_scale(-segment_height(s, vec2_at(now->x, site->node)), s->normal), now->x);
    vec2_put(now->v, site->node, vec2_along(v, -vec2_dot(v, s->normal), s->normal));
    return DEM_OK;
}

/* The edge that goes on behind the end of edge k, and could take over its vertex; -1: none. */
static dem_index edge_beyond(const contact_sites *c, dem_index k, bool backwards, dem_index feature)
{
    const surface *s = &c->scene.model->surface;
    const dem_index own = k - c->scene.model->n_sites, beyond = backwards ? s->previous[own] : s->next[own];
    if (beyond < 0) return -1;
    const contact_site *edge = &c->list[sites_of_edge(c, beyond)];
    const bool taken = edge->n_closed == 2 || (edge->n_closed == 1 && edge->closed[0].feature == feature);
    return taken ? -1 : sites_of_edge(c, beyond);
}

/* A vertex that has come to the end of an edge: its node is put there, and the next edge takes over. The vertex
 * strikes that if the body bends in there, and comes to rest in the notch if it would not get far out of it; it glides
 * on, or leaves if the body bends away faster than a hop that counts. */
static dem_status pass_edge(contact_sites *c, dem_index k, int q, bool backwards, contact_moment *now)
{
    const dem_index node = backwards ? c->list[k].node : c->list[k].other, feature = c->list[k].closed[q].feature;
    const dem_index next = edge_beyond(c, k, backwards, feature);
    TRY(enter(c, k, feature, DEM_EVENT_PASS, now));
    if (next < 0) return release(c, k, q, now);
    const vec2 at = c->scene.model->obstacles.vertices[feature].at;
    sites_move(c, node, vec2_sub(at, vec2_at(now->x, node)), now->x);
    if (strike_notch(c, k, next, now)) return strike(c, next, (contact_hit){1, {feature}}, now);
    TRY(release(c, k, q, now));
    return strike(c, next, (contact_hit){1, {feature}}, now);
}

/* A sliding contact that has turned back comes to rest; if it does not stick there it slides the other way. */
static dem_status stop(contact_sites *c, dem_index k, int q, contact_moment *now)
{
    contact_touch *touch = &c->list[k].closed[q];
    const touch_frame f = touch_frame_at(&c->scene, &c->list[k], q, now->x, now->v);
    touch->sign = 0;
    touch->place = f.place;
    strike_stop(c, c->reactions.group[k], now);
    sites_weigh(c, k, now->x, now->v);
    const reaction force = {touch->force, touch->friction};
    if (site_grip(&c->scene, &c->list[k], q, &f, &force, now->x) < 0.0) touch->sign = force.tangent > 0.0 ? -1 : 1;
    return enter(c, k, touch->feature, DEM_EVENT_STICK, now);
}

static dem_status begin_to_slide(contact_sites *c, dem_index k, int q, contact_moment *now)
{
    contact_touch *touch = &c->list[k].closed[q];
    touch->sign = touch->friction > 0.0 ? -1 : 1; /* against what friction holds */
    return enter(c, k, touch->feature, DEM_EVENT_SLIP, now);
}

/* Closed contact q: release comes first, then stick and slip, then the end of the segment or edge. */
static dem_status settle_contact(contact_sites *c, dem_index k, int q, contact_moment *now, bool *changed)
{
    const contact_site *site = &c->list[k];
    const touch_frame f = touch_frame_at(&c->scene, site, q, now->x, now->v);
    const reaction force = {site->closed[q].force, site->closed[q].friction};
    *changed = true;
    if (force.normal <= 0.0) return release(c, k, q, now);
    const bool held = site->closed[q].held;
    if (!held && site_turns(&c->scene, site, q, &f, now->v)) return stop(c, k, q, now);
    if (!held && site_grip(&c->scene, site, q, &f, &force, now->x) < 0.0) return begin_to_slide(c, k, q, now);
    const int passed = held ? 0 : site_end_passed(&c->scene, site, q, now->x, now->v);
    if (passed != 0 && site_is_edge(site)) return pass_edge(c, k, q, passed < 0, now);
    if (passed != 0) return pass_node(c, k, passed < 0, now);
    *changed = false;
    return DEM_OK;
}

/* Something else in the way of a site with one closed contact. */
static dem_status settle_other(contact_sites *c, dem_index k, contact_moment *now, bool *changed)
{
    const contact_site *site = &c->list[k];
    const contact_spot spot = site_spot(site, now->x);
    const contact_gap gap = site_gap(&c->scene, site, &spot);
    if (gap.distance > -touch_share * c->scene.rule.skin) return DEM_OK;
    *changed = true;
    if (site_is_edge(site)) return touch_edge(c, k, &gap, now);
    const double depth = strike_depth(c, k, now);
    if (gap.distance < -depth) return go_behind(c, k, gap.feature, -gap.distance, now);
    const dem_index here = site->closed[0].feature;
    const bool both = strike_corner(c, gap.feature, here, vec2_at(now->x, site->node), depth);
    return strike(c, k, (contact_hit){both ? 2 : 1, {gap.feature, here}}, now);
}

static dem_status settle_closed(contact_sites *c, dem_index k, contact_moment *now, bool *changed)
{
    sites_weigh(c, k, now->x, now->v);
    for (int q = 0; q < c->list[k].n_closed && !*changed; q++) TRY(settle_contact(c, k, q, now, changed));
    if (*changed || c->list[k].n_closed == 2) return DEM_OK;
    return settle_other(c, k, now, changed);
}

static dem_status settle(contact_sites *c, dem_index k, contact_moment *now, bool *changed)
{
    bool here = false;
    contact_site *site = &c->list[k];
    if (site->asleep && site->n_closed == 0) return DEM_OK;
    TRY(site->n_closed == 0 ? settle_free(c, k, now, &here) : settle_closed(c, k, now, &here));
    if (!here) return DEM_OK;
    *changed = true;
    if (now->t - site->storm_start > c->scene.rule.storm_time) {
        site->storm_start = now->t;
        site->storm = 0;
    }
    CHECK(++site->storm <= c->scene.rule.max_impacts, DEM_ERROR_CONTACT,
          "%s %lld at (%g, %g) m had more than %lld contact events within %g s, at t = %.9g s",
          site_is_edge(site) ? "the edge from node" : "node", (long long)site->node, now->x[2 * site->node],
          now->x[2 * site->node + 1], (long long)c->scene.rule.max_impacts, c->scene.rule.storm_time, now->t);
    return DEM_OK;
}

/* ---- all sites ---- */

static void solve_all(contact_sites *c, const double *x, const double *v)
{
    for (dem_index g = 0; g < c->reactions.n_groups; g++) reactions_solve(&c->reactions, g, x, v);
}

/* A force without what should come from outside is none: the last known stays. */
static void store_all(contact_sites *c)
{
    if (external_force_failed(c->scene.rule.load.external)) return;
    for (dem_index m = 0; m < c->reactions.row[c->reactions.n_groups]; m++) sites_store(c, c->reactions.members[m]);
}

/* Puts closed nodes back where rounding has taken them from. */
static void straighten_nodes(contact_sites *c, double *x)
{
    for (dem_index k = 0; k < c->scene.model->n_sites; k++) {
        const contact_site *site = &c->list[k];
        for (int q = 0; q < site->n_closed; q++) {
            const segment *s = scene_segment(&c->scene, site->closed[q].feature);
            sites_move(c, site->node, vec2_scale(-segment_height(s, vec2_at(x, site->node)), s->normal), x);
        }
    }
}

/* Whether a site may come to touch within the window: what it is known to be clear of may be further than it gets. */
static bool may_arrive(const contact_sites *c, const contact_site *site, const contact_spot *x, const contact_spot *v)
{
    const double way = c->scene.rule.window * fmax(vec2_norm(v->a), vec2_norm(v->b));
    return site->clear - site_moved(site, x) < way;
}

/* Whether a site comes to touch within the window if it goes on straight: near a vertex it may pass by. */
static bool arrives(const contact_sites *c, const contact_site *site, const contact_spot *x, const contact_spot *v)
{
    const double window = c->scene.rule.window;
    const contact_spot ahead = {vec2_along(x->a, window, v->a), vec2_along(x->b, window, v->b),
                                vec2_along(x->previous, window, v->previous), vec2_along(x->next, window, v->next)};
    return site_gap(&c->scene, site, &ahead).distance < -c->scene.rule.skin;
}

/* Reflects now what would touch within the window. */
static void reflect_early(contact_sites *c, contact_moment *now)
{
    for (dem_index k = 0; k < c->n; k++) {
        contact_site site = c->list[k];
        const contact_spot spot = site_spot(&site, now->x), v = site_spot(&site, now->v);
        if (site.n_closed > 0 || sites_coupled(c, k) || !may_arrive(c, &site, &spot, &v)) continue;
        sites_disturb(&site); /* its true gap */
        const contact_gap gap = site_gap(&c->scene, &site, &spot);
        if (gap.feature < 0) continue;
        const vec2 at = vec2_add(vec2_scale(1.0 - gap.place, v.a), vec2_scale(gap.place, v.b));
        const double speed = -vec2_dot(at, gap.normal);
        if (speed > 0.0 && gap.distance + c->scene.rule.skin < speed * c->scene.rule.window &&
            arrives(c, &site, &spot, &v))
            strike_early(c, k, &gap, now);
    }
}

/* ---- public ---- */

void contact_guards(contact *c, double t, const double *y, double *g)
{
    contact_sites *s = &c->sites;
    solve_all(s, y, velocities(c, y));
    c->solved = t;
    c->quiet = true;
    for (dem_index k = 0; k < SITE_GUARDS * s->n; k++) g[k] = 1.0;
    for (dem_index a = 0; a < c->watch.n; a++) {
        const dem_index k = c->watch.awake[a];
        double *of_site = &g[SITE_GUARDS * k];
        site_guards(&s->scene, &s->list[k], s->reactions.force[k], y, velocities(c, y), of_site);
        for (int q = 0; q < SITE_GUARDS; q++) c->quiet = c->quiet && of_site[q] > 0.0;
    }
}

void contact_constrain(contact *c, const double *y, double *a)
{
    c->solved = NAN;
    reactions_hold(&c->sites.reactions, y, velocities(c, y), a);
}

dem_status contact_create(contact *out, const dem_model *model, const contact_rule *rule)
{
    *out = (contact){0};
    TRY(sites_create(&out->sites, model, rule));
    const dem_status status = watch_create(&out->watch, out->sites.n);
    if (status != DEM_OK) sites_destroy(&out->sites);
    return status;
}

void contact_destroy(contact *c)
{
    watch_destroy(&c->watch);
    sites_destroy(&c->sites);
}

/* The sites at a node: itself and its edges. */
static dem_status settle_node(contact_sites *c, dem_index node, contact_moment *now, bool *changed)
{
    const surface *s = &c->scene.model->surface;
    if (c->of_node[node] >= 0) TRY(settle(c, c->of_node[node], now, changed));
    for (dem_index p = s->row[node]; p < s->row[node + 1] && c->n > c->scene.model->n_sites; p++)
        TRY(settle(c, sites_of_edge(c, s->at[p]), now, changed));
    return DEM_OK;
}

static dem_status settle_all(contact_sites *c, contact_moment *now, bool *changed)
{
    for (dem_index k = 0; k < c->n; k++) TRY(settle(c, k, now, changed));
    return DEM_OK;
}

static dem_status settle_around(contact_sites *c, dem_index k, contact_moment *now, bool *changed)
{
    const contact_site *site = &c->list[k];
    TRY(settle_node(c, site->node, now, changed));
    return site_is_edge(site) ? settle_node(c, site->other, now, changed) : DEM_OK;
}

/* Makes the changes that are due, of all sites or around one, until there are none. */
static dem_status settle_until_done(contact *c, dem_index around, contact_moment *now)
{
    contact_sites *s = &c->sites;
    bool changed = true;
    c->solved = NAN;
    for (c->idle++; changed; c->idle = changed ? 0 : c->idle) {
        changed = false;
        TRY(around < 0 ? settle_all(s, now, &changed) : settle_around(s, around, now, &changed));
    }
    CHECK(c->idle <= s->scene.rule.max_impacts, DEM_ERROR_CONTACT,
          "more than %lld contact events in a row changed nothing, at t = %.9g s", (long long)s->scene.rule.max_impacts,
          now->t);
    return DEM_OK;
}

dem_status contact_resolve_at(contact *c, dem_index k, double t, double *y, const contact_listener *listener)
{
    contact_moment now = {t, y, y + scene_velocities(&c->sites.scene), listener, DEM_OK};
    TRY(settle_until_done(c, k, &now));
    return now.told;
}

dem_status contact_resolve(contact *c, double t, double *y, const contact_listener *listener)
{
    contact_sites *s = &c->sites;
    contact_moment now = {t, y, y + scene_velocities(&s->scene), listener, DEM_OK};
    const dem_index impacts = s->books.counts.impacts;
    TRY(settle_until_done(c, -1, &now));
    if (s->scene.rule.window > 0.0 && s->books.counts.impacts > impacts) reflect_early(s, &now);
    straighten_nodes(s, now.x);
    solve_all(s, now.x, now.v);
    store_all(s);
    watch_look(&c->watch, s, now.x, now.v);
    return now.told;
}

dem_status contact_admissible(const contact *c, const double *x)
{
    const contact_scene *scene = &c->sites.scene;
    for (dem_index k = 0; k < c->sites.n; k++) {
        const contact_site site = sites_anew(&c->sites.list[k]);
        const contact_spot spot = site_spot(&site, x);
        const contact_gap gap = site_gap(scene, &site, &spot);
        if (gap.distance >= -scene->rule.skin) continue;
        const segment *s = scene_segment(scene, touch_segment(scene, &site, gap.feature));
        CHECK(site_is_edge(&site), DEM_ERROR_MODEL,
              "node %lld at (%g, %g) m starts %g m inside obstacle %lld, deeper than the skin of %g m",
              (long long)site.node, spot.a.x, spot.a.y, -gap.distance, (long long)s->obstacle, scene->rule.skin);
        return status_fail(DEM_ERROR_MODEL,
                           "the vertex at (%g, %g) m of obstacle %lld starts %g m inside the body, deeper than the "
                           "skin of %g m",
                           s->end.x, s->end.y, (long long)s->obstacle, -gap.distance, scene->rule.skin);
    }
    return DEM_OK;
}

/* Largest coordinate that a gap is made of, m. */
static double extent(const contact_sites *c, dem_index k, dem_index feature, vec2 x)
{
    const segment *s = scene_segment(&c->scene, touch_segment(&c->scene, &c->list[k], feature));
    return fmax(vec2_norm(x), fmax(vec2_norm(s->start), vec2_norm(s->end)));
}

dem_status contact_start(contact *c, double t, double *y, const contact_listener *listener)
{
    contact_sites *s = &c->sites;
    contact_moment now = {t, y, y + scene_velocities(&s->scene), listener, DEM_OK};
    for (dem_index k = 0; k < s->n; k++)
        for (int q = 0; q < 2; q++) { /* an edge may touch two vertices */
            const contact_spot spot = site_spot(&s->list[k], now.x);
            const contact_gap gap = site_gap(&s->scene, &s->list[k], &spot);
            if (gap.feature < 0 || gap.distance > 64.0 * DBL_EPSILON * extent(s, k, gap.feature, spot.a)) break;
            TRY(site_is_edge(&s->list[k]) ? touch_edge(s, k, &gap, &now) : touch_node(s, k, &gap, &now));
            if (!site_is_edge(&s->list[k]) || s->list[k].n_closed != 1) break;
        }
    const dem_status status = contact_resolve(c, t, y, listener);
    return now.told != DEM_OK ? now.told : status;
}

dem_status contact_forget(contact *c)
{
    c->solved = NAN;
    c->quiet = c->all = false;
    for (dem_index k = 0; k < c->sites.n; k++) c->sites.list[k] = sites_anew(&c->sites.list[k]);
    return sites_regroup(&c->sites);
}

dem_status contact_renew(contact *c, const double *y)
{
    contact_sites *s = &c->sites;
    const double *v = velocities(c, y);
    TRY(sites_regroup(s));
    c->solved = NAN;
    c->quiet = c->all = false;
    c->way = c->watch.travelled = 0.0;
    s->books.counts.behind = 0;
    for (dem_index k = 0; k < s->scene.model->n_sites; k++) s->books.counts.behind += s->list[k].behind[0] >= 0;
    solve_all(s, y, v);
    store_all(s);
    watch_look(&c->watch, s, y, v);
    return DEM_OK;
}

/* No node that may touch goes further in the step, which begins where the last look was. */
static double furthest(const contact *c, const dense_output *p)
{
    return 2.0 * (p->t1 - p->t0) * fmax(c->watch.speed, watch_speed(&c->sites, velocities(c, p->y1)));
}

/* The state at the end of a step, as far as the forces of a group depend on it. */
static const double *end_of(contact *c, dem_index group, const dense_output *p, double *state)
{
    if (p->end == p->t1) return p->y1;
    search_state(&c->sites.reactions, group, p, p->end, state);
    return state;
}

void contact_weigh(contact *c, const dense_output *p, dem_index group, double *state)
{
    const double *y = end_of(c, group, p, state);
    reactions_solve(&c->sites.reactions, group, y, velocities(c, y));
}

/* First time at which closed contacts of a site have to change that have to at the end of the step. */
static double next_due(contact *c, const dense_output *p, dem_index k, double from, double *state)
{
    reactions *r = &c->sites.reactions;
    const contact_site *site = &c->sites.list[k];
    if (c->quiet) return INFINITY;
    const double *y = end_of(c, r->group[k], p, state);
    if (!site_due(&c->sites.scene, site, r->force[k], y, velocities(c, y))) return INFINITY;
    const double due = search_due(r, site, p, from, state);
    contact_weigh(c, p, r->group[k], state);
    return due;
}

void contact_expect(contact *c, const dense_output *p, double *state)
{
    const reactions *r = &c->sites.reactions;
    const bool whole = p->end == p->t1, solved = whole && c->solved == p->t1;
    c->way = furthest(c, p);
    c->all = watch_asks_all(&c->watch, c->way);
    c->quiet = solved && c->quiet;
    for (dem_index g = 0; g < r->n_groups && !solved; g++) contact_weigh(c, p, g, state);
    if (whole) c->solved = p->t1;
}

/* A free node that has not moved as far as it was clear, and yet is inside: it has passed a free end of the obstacle at
 * a distance, and is behind it. */
static bool come_round(contact_sites *c, dem_index k, const contact_spot *spot)
{
    const contact_site *site = &c->list[k];
    dem_index nearest;
    if (site_is_edge(site) || site->n_closed > 0 || site->behind[0] >= 0) return false;
    if (!(site_moved(site, spot) < site->clear) || site_clearance(&c->scene, site, spot, &nearest) >= 0.0) return false;
    sites_go_behind(c, k, scene_segment(&c->scene, nearest)->obstacle);
    return true;
}

double contact_crossing(contact *c, const dense_output *p, dem_index k, double from)
{
    contact_site *site = &c->sites.list[k];
    if (!watch_wakes(&c->watch, site, c->way)) return INFINITY;
    site->asleep = false;
    return site->n_closed < 2 ? search_crossing(&c->sites.scene, site, p, from) : INFINITY;
}

double contact_next(contact *c, const dense_output *p, dem_index k, double from, double *state)
{
    const contact_site *site = &c->sites.list[k];
    const double due = site->n_closed > 0 ? next_due(c, p, k, from, state) : INFINITY;
    double crossing = contact_crossing(c, p, k, from);
    if (crossing <= from) {
        const contact_spot spot = site_spot_on(site, p, from);
        if (come_round(&c->sites, k, &spot)) crossing = contact_crossing(c, p, k, from);
    }
    return fmin(due, crossing);
}

bool contact_check(contact *c, dense_output *p, bool rooted, double *state)
{
    contact_sites *s = &c->sites;
    const double last = rooted ? p->end - 4.0 * search_resolution(p) : INFINITY; /* later it is the root found */
    double first = INFINITY;
    contact_expect(c, p, state);
    for (dem_index a = 0; a < contact_watched(c); a++)
        first = fmin(first, contact_next(c, p, contact_at_watch(c, a), p->t0, state));
    if (isfinite(first) || p->end < p->t1) c->solved = NAN;
    if (!(first < last)) return false;
    p->end = first;
    s->books.counts.late++;
    return true;
}

/* Whether an edge of a group has opened, or sunk in, by more than a quarter of the skin. */
static bool has_opened(const contact_sites *c, dem_index group, const contact_moment *now)
{
    const reactions *r = &c->reactions;
    for (dem_index m = r->row[group]; m < r->row[group + 1]; m++) {
        const contact_site *site = &c->list[r->members[m]];
        for (int q = 0; q < site->n_closed && site_is_edge(site); q++)
            if (fabs(touch_frame_at(&c->scene, site, q, now->x, now->v).gap) > 0.25 * c->scene.rule.skin) return true;
    }
    return false;
}

bool contact_straighten(contact *c, double t, double *y)
{
    contact_sites *s = &c->sites;
    contact_moment now = {t, y, y + scene_velocities(&s->scene), NULL, DEM_OK};
    bool any = false;
    for (dem_index g = 0; g < s->reactions.n_groups; g++) {
        if (!has_opened(s, g, &now)) continue;
        s->straightened = fmax(s->straightened, strike_straighten(s, g, &now));
        strike_stop(s, g, &now);
        any = true;
    }
    if (any) c->solved = NAN;
    return any;
}

void contact_follow(contact *c, const dense_output *p, const double *y)
{
    contact_sites *s = &c->sites;
    c->watch.travelled += c->way;
    if (c->solved != p->t1 || p->end < p->t1) solve_all(s, y, velocities(c, y));
    store_all(s);
    watch_look(&c->watch, s, y, velocities(c, y));
}

void contact_account(const contact *c, const double *y, double *rate)
{
    const contact_sites *s = &c->sites;
    double *friction = rate + 2 * s->scene.model->obstacles.n, *power = rate + 4 * s->scene.model->obstacles.n;
    for (dem_index m = 0; m < s->reactions.row[s->reactions.n_groups]; m++) {
        const dem_index k = s->reactions.members[m];
        for (int q = 0; q < s->list[k].n_closed; q++) {
            const sites_share of = sites_share_of(s, k, q, y, velocities(c, y));
            vec2_put(rate, of.obstacle, vec2_add(vec2_at(rate, of.obstacle), of.force));
            vec2_put(friction, of.obstacle, vec2_add(vec2_at(friction, of.obstacle), of.friction));
            *power += of.power;
        }
    }
}

dem_index contact_list(const contact *c, const double *x, dem_contact *list)
{
    dem_index n = 0;
    for (dem_index k = 0; k < c->sites.n; k++)
        for (int q = 0; q < c->sites.list[k].n_closed; q++)
            list[n++] = touch_describe(&c->sites.scene, &c->sites.list[k], q, x);
    return n;
}
