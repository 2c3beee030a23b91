/* SPDX-License-Identifier: BSD-3-Clause */
/* Which reset is due, in which order; what a step leaves in the books. */
#include "contact/automaton.h"

#include <float.h>

#include "base/status.h"
#include "contact/impact_solve.h"

static const double touch_share =
    0.99; /* of the penetration tolerance: as deep counts as touching, so that near ties are taken together */

/* ---- free sites ---- */

static const double *velocities(const automaton *c, const double *y)
{
    return y + scene_velocities(&c->set.scene);
}

/* A node deeper inside than an impact can be has passed round the free end that it is at; else something is wrong. */
static dem_status go_behind(contact_set *c, dem_index k, dem_index feature, double depth, const contact_instant *now)
{
    const vec2 x = vec2_at(now->x, c->list[k].node);
    const segment *s = scene_segment(&c->scene, feature);
    const double place = segment_place(s, x), tolerance = impact_depth(c, k, now);
    const double margin = scene_margin(&c->scene) + tolerance;
    const bool at_free_end = (s->before < 0 && fabs(place) <= fmax(margin, s->buried[0] + tolerance)) ||
                             (s->after < 0 && fabs(place - s->length) <= fmax(margin, s->buried[1] + tolerance));
    CHECK(at_free_end && c->list[k].behind[0] < 0, DEM_ERROR_CONTACT,
          "node %lld at (%g, %g) m is %g m inside obstacle %lld at t = %.9g s", (long long)c->list[k].node, x.x, x.y,
          depth, (long long)s->obstacle, now->t);
    contact_set_pass_behind(c, k, s->obstacle);
    return DEM_OK;
}

/* A node that touches: what it strikes; right on an apex it is the side that comes down on it. */
static dem_status touch_node(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now)
{
    dem_index at;
    const impact_target with =
        gap->distance >= -impact_depth(c, k, now) ? impact_target_of_node(c, k, now) : (impact_target){0};
    if (with.n == 0) return go_behind(c, k, gap->feature, -gap->distance, now);
    const dem_index side = with.n == 1 ? impact_target_edge(c, k, now, &at) : -1;
    return side >= 0 ? impact_solve(c, side, (impact_target){1, {at}}, now) : impact_solve(c, k, with, now);
}

/* An edge that touches a vertex strikes it. */
static dem_status touch_edge(contact_set *c, dem_index k, const contact_gap *gap, contact_instant *now)
{
    const contact_candidate *candidate = &c->list[k];
    const vec2 ab = vec2_sub(vec2_at(now->x, candidate->other), vec2_at(now->x, candidate->node));
    const segment *s = scene_segment(&c->scene, contact_point_segment(&c->scene, candidate, gap->feature));
    CHECK(gap->distance >= -1e-3 * vec2_norm(ab), DEM_ERROR_CONTACT,
          "the vertex at (%g, %g) m of obstacle %lld is %g m inside the body, behind the edge from node %lld to %lld, "
          "at t = %.9g s",
          s->end.x, s->end.y, (long long)s->obstacle, -gap->distance, (long long)candidate->node,
          (long long)candidate->other, now->t);
    return impact_solve(c, k, (impact_target){1, {gap->feature}}, now);
}

static dem_status settle_free(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    const candidate_positions spot = candidate_place(&c->list[k], now->x);
    const contact_gap gap = candidate_gap(&c->scene, &c->list[k], &spot);
    if (gap.distance > -touch_share * c->scene.rule.penetration_tolerance) return DEM_OK;
    *changed = true;
    return candidate_is_edge(&c->list[k]) ? touch_edge(c, k, &gap, now) : touch_node(c, k, &gap, now);
}

/* ---- closed sites ---- */

static dem_status enter(contact_set *c, dem_index k, dem_index feature, dem_event_kind kind, contact_instant *now)
{
    const dem_event event = contact_set_event(c, k, feature, kind, now);
    ledger_enter(&c->ledger, &event, now);
    return DEM_OK;
}

static dem_status release(contact_set *c, dem_index k, int q, contact_instant *now)
{
    const dem_index feature = c->list[k].closed[q].feature;
    TRY(contact_set_open(c, k, q));
    return enter(c, k, feature, DEM_EVENT_RELEASE, now);
}

/* A node that slides past the end of its segment falls free, glides on, or runs into the next segment. */
static dem_status pass_node(contact_set *c, dem_index k, bool backwards, contact_instant *now)
{
    contact_candidate *candidate = &c->list[k];
    impact_target next = {.n = 1};
    const dem_index here = candidate->closed[0].feature;
    const obstacle_bend bend = obstacles_bend(&c->scene.model->obstacles, here, backwards, &next.feature[0]);
    TRY(enter(c, k, here, DEM_EVENT_PASS, now));
    if (bend == OBSTACLE_CONCAVE) return impact_solve(c, k, (impact_target){2, {next.feature[0], here}}, now);
    if (bend != OBSTACLE_STRAIGHT) return release(c, k, 0, now);
    const segment *s = scene_segment(&c->scene, next.feature[0]);
    const vec2 v = vec2_at(now->v, candidate->node);
    candidate->closed[0].feature = next.feature[0];
    contact_set_move(c, candidate->node, vec2_scale(-segment_height(s, vec2_at(now->x, candidate->node)), s->normal),
                     now->x);
    vec2_put(now->v, candidate->node, vec2_along(v, -vec2_dot(v, s->normal), s->normal));
    return DEM_OK;
}

/* The edge that goes on behind the end of edge k, and could take over its vertex; -1: none. */
static dem_index edge_beyond(const contact_set *c, dem_index k, bool backwards, dem_index feature)
{
    const surface *s = &c->scene.model->surface;
    const dem_index own = k - c->scene.model->n_contact_nodes, beyond = backwards ? s->previous[own] : s->next[own];
    if (beyond < 0) return -1;
    const contact_candidate *edge = &c->list[contact_set_of_edge(c, beyond)];
    const bool taken = edge->n_closed == 2 || (edge->n_closed == 1 && edge->closed[0].feature == feature);
    return taken ? -1 : contact_set_of_edge(c, beyond);
}

/* A vertex that has come to the end of an edge: its node is put there, and the next edge takes over. The vertex
 * strikes that if the body bends in there, and comes to rest in the notch if it would not get far out of it; it glides
 * on, or leaves if the body bends away faster than a hop that counts. */
static dem_status pass_edge(contact_set *c, dem_index k, int q, bool backwards, contact_instant *now)
{
    const dem_index node = backwards ? c->list[k].node : c->list[k].other, feature = c->list[k].closed[q].feature;
    const dem_index next = edge_beyond(c, k, backwards, feature);
    TRY(enter(c, k, feature, DEM_EVENT_PASS, now));
    if (next < 0) return release(c, k, q, now);
    const vec2 at = c->scene.model->obstacles.vertices[feature].at;
    contact_set_move(c, node, vec2_sub(at, vec2_at(now->x, node)), now->x);
    if (impact_rests_in_notch(c, k, next, now)) return impact_solve(c, next, (impact_target){1, {feature}}, now);
    TRY(release(c, k, q, now));
    return impact_solve(c, next, (impact_target){1, {feature}}, now);
}

/* A sliding contact that has turned back comes to rest; if it does not stick there it slides the other way. */
static dem_status stop(contact_set *c, dem_index k, int q, contact_instant *now)
{
    contact_point *point = &c->list[k].closed[q];
    const contact_frame f = contact_frame_at(&c->scene, &c->list[k], q, now->x, now->v);
    point->slide = 0;
    point->place = f.place;
    impact_stop(c, c->forces.group[k], now);
    contact_set_solve_forces(c, k, now->x, now->v);
    const contact_force force = {point->force, point->friction};
    if (candidate_grip(&c->scene, &c->list[k], q, &f, &force, now->x) < 0.0)
        point->slide = force.tangent > 0.0 ? -1 : 1;
    return enter(c, k, point->feature, DEM_EVENT_STICK, now);
}

static dem_status begin_to_slide(contact_set *c, dem_index k, int q, contact_instant *now)
{
    contact_point *point = &c->list[k].closed[q];
    point->slide = point->friction > 0.0 ? -1 : 1; /* against what friction holds */
    return enter(c, k, point->feature, DEM_EVENT_SLIP, now);
}

/* Closed contact q: release comes first, then stick and slip, then the end of the segment or edge. */
static dem_status settle_contact(contact_set *c, dem_index k, int q, contact_instant *now, bool *changed)
{
    const contact_candidate *candidate = &c->list[k];
    const contact_frame f = contact_frame_at(&c->scene, candidate, q, now->x, now->v);
    const contact_force force = {candidate->closed[q].force, candidate->closed[q].friction};
    *changed = true;
    if (force.normal <= 0.0) return release(c, k, q, now);
    const bool held = candidate->closed[q].held;
    if (!held && candidate_turns(&c->scene, candidate, q, &f, now->v)) return stop(c, k, q, now);
    if (!held && candidate_grip(&c->scene, candidate, q, &f, &force, now->x) < 0.0) return begin_to_slide(c, k, q, now);
    const int passed = held ? 0 : candidate_end_passed(&c->scene, candidate, q, now->x, now->v);
    if (passed != 0 && candidate_is_edge(candidate)) return pass_edge(c, k, q, passed < 0, now);
    if (passed != 0) return pass_node(c, k, passed < 0, now);
    *changed = false;
    return DEM_OK;
}

/* Something else in the way of a site with one closed contact. */
static dem_status settle_other(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    const contact_candidate *candidate = &c->list[k];
    const candidate_positions spot = candidate_place(candidate, now->x);
    const contact_gap gap = candidate_gap(&c->scene, candidate, &spot);
    if (gap.distance > -touch_share * c->scene.rule.penetration_tolerance) return DEM_OK;
    *changed = true;
    if (candidate_is_edge(candidate)) return touch_edge(c, k, &gap, now);
    const double depth = impact_depth(c, k, now);
    if (gap.distance < -depth) return go_behind(c, k, gap.feature, -gap.distance, now);
    const dem_index here = candidate->closed[0].feature;
    const bool both = impact_is_corner(c, gap.feature, here, vec2_at(now->x, candidate->node), depth);
    return impact_solve(c, k, (impact_target){both ? 2 : 1, {gap.feature, here}}, now);
}

static dem_status settle_closed(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    contact_set_solve_forces(c, k, now->x, now->v);
    for (int q = 0; q < c->list[k].n_closed && !*changed; q++) TRY(settle_contact(c, k, q, now, changed));
    if (*changed || c->list[k].n_closed == 2) return DEM_OK;
    return settle_other(c, k, now, changed);
}

static dem_status settle(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    bool here = false;
    contact_candidate *candidate = &c->list[k];
    if (candidate->inactive && candidate->n_closed == 0) return DEM_OK;
    TRY(candidate->n_closed == 0 ? settle_free(c, k, now, &here) : settle_closed(c, k, now, &here));
    if (!here) return DEM_OK;
    *changed = true;
    if (now->t - candidate->storm_start > c->scene.rule.storm_time) {
        candidate->storm_start = now->t;
        candidate->storm = 0;
    }
    CHECK(++candidate->storm <= c->scene.rule.max_impacts, DEM_ERROR_CONTACT,
          "%s %lld at (%g, %g) m had more than %lld contact events within %g s, at t = %.9g s",
          candidate_is_edge(candidate) ? "the edge from node" : "node", (long long)candidate->node,
          now->x[2 * candidate->node], now->x[2 * candidate->node + 1], (long long)c->scene.rule.max_impacts,
          c->scene.rule.storm_time, now->t);
    return DEM_OK;
}

/* ---- all sites ---- */

static void solve_all(contact_set *c, const double *x, const double *v)
{
    for (dem_index g = 0; g < c->forces.n_groups; g++) contact_forces_solve(&c->forces, g, x, v);
}

/* A force without what should come from outside is none: the last known stays. */
static void store_all(contact_set *c)
{
    if (external_force_failed(c->scene.rule.load.external)) return;
    for (dem_index m = 0; m < c->forces.row[c->forces.n_groups]; m++) contact_set_store_forces(c, c->forces.members[m]);
}

/* Puts closed nodes back where rounding has taken them from. */
static void straighten_nodes(contact_set *c, double *x)
{
    for (dem_index k = 0; k < c->scene.model->n_contact_nodes; k++) {
        const contact_candidate *candidate = &c->list[k];
        for (int q = 0; q < candidate->n_closed; q++) {
            const segment *s = scene_segment(&c->scene, candidate->closed[q].feature);
            contact_set_move(c, candidate->node, vec2_scale(-segment_height(s, vec2_at(x, candidate->node)), s->normal),
                             x);
        }
    }
}

/* Whether a site may come to touch within the window: what it is known to be clear of may be further than it gets. */
static bool may_arrive(const contact_set *c, const contact_candidate *candidate, const candidate_positions *x,
                       const candidate_positions *v)
{
    const double way = c->scene.rule.window * fmax(vec2_norm(v->a), vec2_norm(v->b));
    return candidate->clear - candidate_moved(candidate, x) < way;
}

/* Whether a site comes to touch within the window if it goes on straight: near a vertex it may pass by. */
static bool arrives(const contact_set *c, const contact_candidate *candidate, const candidate_positions *x,
                    const candidate_positions *v)
{
    const double window = c->scene.rule.window;
    const candidate_positions ahead = {vec2_along(x->a, window, v->a), vec2_along(x->b, window, v->b),
                                       vec2_along(x->previous, window, v->previous),
                                       vec2_along(x->next, window, v->next)};
    return candidate_gap(&c->scene, candidate, &ahead).distance < -c->scene.rule.penetration_tolerance;
}

/* Reflects now what would touch within the window. */
static void reflect_early(contact_set *c, contact_instant *now)
{
    for (dem_index k = 0; k < c->n; k++) {
        contact_candidate candidate = c->list[k];
        const candidate_positions spot = candidate_place(&candidate, now->x), v = candidate_place(&candidate, now->v);
        if (candidate.n_closed > 0 || contact_set_coupled(c, k) || !may_arrive(c, &candidate, &spot, &v)) continue;
        candidate_forget_clearance(&candidate); /* its true gap */
        const contact_gap gap = candidate_gap(&c->scene, &candidate, &spot);
        if (gap.feature < 0) continue;
        const vec2 at = vec2_add(vec2_scale(1.0 - gap.place, v.a), vec2_scale(gap.place, v.b));
        const double speed = -vec2_dot(at, gap.normal);
        if (speed > 0.0 && gap.distance + c->scene.rule.penetration_tolerance < speed * c->scene.rule.window &&
            arrives(c, &candidate, &spot, &v))
            impact_early(c, k, &gap, now);
    }
}

/* ---- public ---- */

void automaton_root_functions(automaton *c, double t, const double *y, double *g)
{
    contact_set *s = &c->set;
    solve_all(s, y, velocities(c, y));
    c->solved = t;
    c->quiet = true;
    for (dem_index k = 0; k < CANDIDATE_ROOTS * s->n; k++) g[k] = 1.0;
    for (dem_index a = 0; a < c->broad_phase.n; a++) {
        const dem_index k = c->broad_phase.active[a];
        double *of_site = &g[CANDIDATE_ROOTS * k];
        candidate_root_functions(&s->scene, &s->list[k], s->forces.force[k], y, velocities(c, y), of_site);
        for (int q = 0; q < CANDIDATE_ROOTS; q++) c->quiet = c->quiet && of_site[q] > 0.0;
    }
}

void automaton_constrain(automaton *c, const double *y, double *a)
{
    c->solved = NAN;
    contact_forces_hold(&c->set.forces, y, velocities(c, y), a);
}

dem_status automaton_create(automaton *out, const dem_model *model, const contact_rule *rule)
{
    *out = (automaton){0};
    TRY(contact_set_create(&out->set, model, rule));
    const dem_status status = broad_phase_create(&out->broad_phase, out->set.n);
    if (status != DEM_OK) contact_set_destroy(&out->set);
    return status;
}

void automaton_destroy(automaton *c)
{
    broad_phase_destroy(&c->broad_phase);
    contact_set_destroy(&c->set);
}

/* The sites at a node: itself and its edges. */
static dem_status settle_node(contact_set *c, dem_index node, contact_instant *now, bool *changed)
{
    const surface *s = &c->scene.model->surface;
    if (c->of_node[node] >= 0) TRY(settle(c, c->of_node[node], now, changed));
    for (dem_index p = s->row[node]; p < s->row[node + 1] && c->n > c->scene.model->n_contact_nodes; p++)
        TRY(settle(c, contact_set_of_edge(c, s->at[p]), now, changed));
    return DEM_OK;
}

static dem_status settle_all(contact_set *c, contact_instant *now, bool *changed)
{
    for (dem_index k = 0; k < c->n; k++) TRY(settle(c, k, now, changed));
    return DEM_OK;
}

static dem_status settle_around(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    const contact_candidate *candidate = &c->list[k];
    TRY(settle_node(c, candidate->node, now, changed));
    return candidate_is_edge(candidate) ? settle_node(c, candidate->other, now, changed) : DEM_OK;
}

/* Makes the changes that are due, of all sites or around one, until there are none. */
static dem_status settle_until_done(automaton *c, dem_index around, contact_instant *now)
{
    contact_set *s = &c->set;
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

dem_status automaton_resolve_near(automaton *c, dem_index k, double t, double *y, const event_listener *listener)
{
    contact_instant now = {t, y, y + scene_velocities(&c->set.scene), listener, DEM_OK};
    TRY(settle_until_done(c, k, &now));
    return now.told;
}

dem_status automaton_resolve(automaton *c, double t, double *y, const event_listener *listener)
{
    contact_set *s = &c->set;
    contact_instant now = {t, y, y + scene_velocities(&s->scene), listener, DEM_OK};
    const dem_index impacts = s->ledger.counts.impacts;
    TRY(settle_until_done(c, -1, &now));
    if (s->scene.rule.window > 0.0 && s->ledger.counts.impacts > impacts) reflect_early(s, &now);
    straighten_nodes(s, now.x);
    solve_all(s, now.x, now.v);
    store_all(s);
    broad_phase_update(&c->broad_phase, s, now.x, now.v);
    return now.told;
}

dem_status automaton_check_start(const automaton *c, const double *x)
{
    const contact_scene *scene = &c->set.scene;
    for (dem_index k = 0; k < c->set.n; k++) {
        const contact_candidate candidate = candidate_reset(&c->set.list[k]);
        const candidate_positions spot = candidate_place(&candidate, x);
        const contact_gap gap = candidate_gap(scene, &candidate, &spot);
        if (gap.distance >= -scene->rule.penetration_tolerance) continue;
        const segment *s = scene_segment(scene, contact_point_segment(scene, &candidate, gap.feature));
        CHECK(candidate_is_edge(&candidate), DEM_ERROR_MODEL,
              "node %lld at (%g, %g) m starts %g m inside obstacle %lld, deeper than the penetration tolerance of %g m",
              (long long)candidate.node, spot.a.x, spot.a.y, -gap.distance, (long long)s->obstacle,
              scene->rule.penetration_tolerance);
        return status_fail(DEM_ERROR_MODEL,
                           "the vertex at (%g, %g) m of obstacle %lld starts %g m inside the body, deeper than the "
                           "penetration tolerance of %g m",
                           s->end.x, s->end.y, (long long)s->obstacle, -gap.distance,
                           scene->rule.penetration_tolerance);
    }
    return DEM_OK;
}

/* Largest coordinate that a gap is made of, m. */
static double extent(const contact_set *c, dem_index k, dem_index feature, vec2 x)
{
    const segment *s = scene_segment(&c->scene, contact_point_segment(&c->scene, &c->list[k], feature));
    return fmax(vec2_norm(x), fmax(vec2_norm(s->start), vec2_norm(s->end)));
}

dem_status automaton_start(automaton *c, double t, double *y, const event_listener *listener)
{
    contact_set *s = &c->set;
    contact_instant now = {t, y, y + scene_velocities(&s->scene), listener, DEM_OK};
    for (dem_index k = 0; k < s->n; k++)
        for (int q = 0; q < 2; q++) { /* an edge may touch two vertices */
            const candidate_positions spot = candidate_place(&s->list[k], now.x);
            const contact_gap gap = candidate_gap(&s->scene, &s->list[k], &spot);
            if (gap.feature < 0 || gap.distance > 64.0 * DBL_EPSILON * extent(s, k, gap.feature, spot.a)) break;
            TRY(candidate_is_edge(&s->list[k]) ? touch_edge(s, k, &gap, &now) : touch_node(s, k, &gap, &now));
            if (!candidate_is_edge(&s->list[k]) || s->list[k].n_closed != 1) break;
        }
    const dem_status status = automaton_resolve(c, t, y, listener);
    return now.told != DEM_OK ? now.told : status;
}

dem_status automaton_open_all(automaton *c)
{
    c->solved = NAN;
    c->quiet = c->all = false;
    for (dem_index k = 0; k < c->set.n; k++) c->set.list[k] = candidate_reset(&c->set.list[k]);
    return contact_set_regroup(&c->set);
}

dem_status automaton_restore(automaton *c, const double *y)
{
    contact_set *s = &c->set;
    const double *v = velocities(c, y);
    TRY(contact_set_regroup(s));
    c->solved = NAN;
    c->quiet = c->all = false;
    c->way = c->broad_phase.travelled = 0.0;
    s->ledger.counts.behind = 0;
    for (dem_index k = 0; k < s->scene.model->n_contact_nodes; k++)
        s->ledger.counts.behind += s->list[k].behind[0] >= 0;
    solve_all(s, y, v);
    store_all(s);
    broad_phase_update(&c->broad_phase, s, y, v);
    return DEM_OK;
}

/* No node that may touch goes further in the step, which begins where the last look was. */
static double furthest(const automaton *c, const dense_output *p)
{
    return 2.0 * (p->t1 - p->t0) * fmax(c->broad_phase.speed, broad_phase_speed(&c->set, velocities(c, p->y1)));
}

/* The state at the end of a step, as far as the forces of a group depend on it. */
static const double *end_of(automaton *c, dem_index group, const dense_output *p, double *state)
{
    if (p->end == p->t1) return p->y1;
    event_location_state(&c->set.forces, group, p, p->end, state);
    return state;
}

void automaton_solve_group(automaton *c, const dense_output *p, dem_index group, double *state)
{
    const double *y = end_of(c, group, p, state);
    contact_forces_solve(&c->set.forces, group, y, velocities(c, y));
}

/* First time at which closed contacts of a site have to change that have to at the end of the step. */
static double next_due(automaton *c, const dense_output *p, dem_index k, double from, double *state)
{
    contact_forces *r = &c->set.forces;
    const contact_candidate *candidate = &c->set.list[k];
    if (c->quiet) return INFINITY;
    const double *y = end_of(c, r->group[k], p, state);
    if (!candidate_due(&c->set.scene, candidate, r->force[k], y, velocities(c, y))) return INFINITY;
    const double due = event_location_change(r, candidate, p, from, state);
    automaton_solve_group(c, p, r->group[k], state);
    return due;
}

void automaton_begin_step(automaton *c, const dense_output *p, double *state)
{
    const contact_forces *r = &c->set.forces;
    const bool whole = p->end == p->t1, solved = whole && c->solved == p->t1;
    c->way = furthest(c, p);
    c->all = broad_phase_covers_all(&c->broad_phase, c->way);
    c->quiet = solved && c->quiet;
    for (dem_index g = 0; g < r->n_groups && !solved; g++) automaton_solve_group(c, p, g, state);
    if (whole) c->solved = p->t1;
}

/* A free node that has not moved as far as it was clear, and yet is inside: it has passed a free end of the obstacle at
 * a distance, and is behind it. */
static bool come_round(contact_set *c, dem_index k, const candidate_positions *spot)
{
    const contact_candidate *candidate = &c->list[k];
    dem_index nearest;
    if (candidate_is_edge(candidate) || candidate->n_closed > 0 || candidate->behind[0] >= 0) return false;
    if (!(candidate_moved(candidate, spot) < candidate->clear) ||
        candidate_clearance(&c->scene, candidate, spot, &nearest) >= 0.0)
        return false;
    contact_set_pass_behind(c, k, scene_segment(&c->scene, nearest)->obstacle);
    return true;
}

double automaton_crossing(automaton *c, const dense_output *p, dem_index k, double from)
{
    contact_candidate *candidate = &c->set.list[k];
    if (!broad_phase_may_touch(&c->broad_phase, candidate, c->way)) return INFINITY;
    candidate->inactive = false;
    return candidate->n_closed < 2 ? event_location_crossing(&c->set.scene, candidate, p, from) : INFINITY;
}

double automaton_next_change(automaton *c, const dense_output *p, dem_index k, double from, double *state)
{
    const contact_candidate *candidate = &c->set.list[k];
    const double due = candidate->n_closed > 0 ? next_due(c, p, k, from, state) : INFINITY;
    double crossing = automaton_crossing(c, p, k, from);
    if (crossing <= from) {
        const candidate_positions spot = candidate_place_at(candidate, p, from);
        if (come_round(&c->set, k, &spot)) crossing = automaton_crossing(c, p, k, from);
    }
    return fmin(due, crossing);
}

bool automaton_check_step(automaton *c, dense_output *p, bool rooted, double *state)
{
    contact_set *s = &c->set;
    const double last =
        rooted ? p->end - 4.0 * event_location_resolution(p) : INFINITY; /* later it is the root found */
    double first = INFINITY;
    automaton_begin_step(c, p, state);
    for (dem_index a = 0; a < automaton_n_active(c); a++)
        first = fmin(first, automaton_next_change(c, p, automaton_active_candidate(c, a), p->t0, state));
    if (isfinite(first) || p->end < p->t1) c->solved = NAN;
    if (!(first < last)) return false;
    p->end = first;
    s->ledger.counts.late++;
    return true;
}

/* Whether an edge of a group has opened, or sunk in, by more than a quarter of the penetration tolerance. */
static bool has_opened(const contact_set *c, dem_index group, const contact_instant *now)
{
    const contact_forces *r = &c->forces;
    for (dem_index m = r->row[group]; m < r->row[group + 1]; m++) {
        const contact_candidate *candidate = &c->list[r->members[m]];
        for (int q = 0; q < candidate->n_closed && candidate_is_edge(candidate); q++)
            if (fabs(contact_frame_at(&c->scene, candidate, q, now->x, now->v).gap) >
                0.25 * c->scene.rule.penetration_tolerance)
                return true;
    }
    return false;
}

bool automaton_project(automaton *c, double t, double *y)
{
    contact_set *s = &c->set;
    contact_instant now = {t, y, y + scene_velocities(&s->scene), NULL, DEM_OK};
    bool any = false;
    for (dem_index g = 0; g < s->forces.n_groups; g++) {
        if (!has_opened(s, g, &now)) continue;
        s->straightened = fmax(s->straightened, impact_project(s, g, &now));
        impact_stop(s, g, &now);
        any = true;
    }
    if (any) c->solved = NAN;
    return any;
}

void automaton_end_step(automaton *c, const dense_output *p, const double *y)
{
    contact_set *s = &c->set;
    c->broad_phase.travelled += c->way;
    if (c->solved != p->t1 || p->end < p->t1) solve_all(s, y, velocities(c, y));
    store_all(s);
    broad_phase_update(&c->broad_phase, s, y, velocities(c, y));
}

void automaton_add_rates(const automaton *c, const double *y, double *rate)
{
    const contact_set *s = &c->set;
    double *friction = rate + 2 * s->scene.model->obstacles.n, *power = rate + 4 * s->scene.model->obstacles.n;
    for (dem_index m = 0; m < s->forces.row[s->forces.n_groups]; m++) {
        const dem_index k = s->forces.members[m];
        for (int q = 0; q < s->list[k].n_closed; q++) {
            const contact_contribution of = contact_set_contribution(s, k, q, y, velocities(c, y));
            vec2_put(rate, of.obstacle, vec2_add(vec2_at(rate, of.obstacle), of.force));
            vec2_put(friction, of.obstacle, vec2_add(vec2_at(friction, of.obstacle), of.friction));
            *power += of.power;
        }
    }
}

dem_index automaton_list(const automaton *c, const double *x, dem_contact *list)
{
    dem_index n = 0;
    for (dem_index k = 0; k < c->set.n; k++)
        for (int q = 0; q < c->set.list[k].n_closed; q++)
            list[n++] = contact_point_describe(&c->set.scene, &c->set.list[k], q, x);
    return n;
}
