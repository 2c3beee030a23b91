/* SPDX-License-Identifier: BSD-3-Clause */
/* The contact automaton: states FREE, SLIP and STICK of all candidates, held ones included, and what is done when a
 * change is due (docs/method.md, Contacts that last). Changes are made one at a time, in the order of candidates, until
 * none is due: one change may bring another, as an impact moves nodes that other contacts share. At the start of a run
 * touching is enough. Changes of one candidate are in candidate_resolve.c, what an automaton needs between events in
 * automaton_step.c. All of it depends on (t, x, v) and the forces that follow from these, and not on the integrator. */
#include "contact/automaton.h"

#include <float.h>
#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"
#include "contact/candidate_resolve.h"
#include "contact/early_reflection.h"

/* Called for every evaluation of the right-hand side: forces last solved for are then those of some stage. */
void automaton_constrain(automaton *c, double t, const double *y, double *a)
{
    c->solved = NAN;
    contact_forces_hold(&c->set.forces, automaton_state(c, t, y), a);
}

/* Makes room for so many candidates. */
static dem_status reserve(automaton *c, dem_index n)
{
    TRY(broad_phase_reserve(&c->broad_phase, n));
    CHECK(grow_array((void **)&c->units, &c->capacity, n, CANDIDATE_ROOTS * sizeof *c->units), DEM_ERROR_MEMORY,
          "out of memory for %lld contact candidates", (long long)n);
    return DEM_OK;
}

dem_status automaton_create(automaton *out, const forces *acting, const contact_rule *rule)
{
    *out = (automaton){0};
    TRY(contact_set_create(&out->set, acting, rule));
    dem_status status = rate_sums_create(&out->rates, acting->model->lattice.dim, acting->model->obstacles.n);
    if (status == DEM_OK) status = reserve(out, out->set.n);
    if (status != DEM_OK) automaton_destroy(out);
    return status;
}

void automaton_destroy(automaton *c)
{
    free(c->units);
    rate_sums_free(&c->rates);
    broad_phase_destroy(&c->broad_phase);
    contact_set_destroy(&c->set);
    *c = (automaton){0};
}

/* Room comes first: behind it nothing can fail but the set's own memory, and then nothing has changed. */
dem_status automaton_follow_surface(automaton *c, const surface *to)
{
    TRY(reserve(c, to->n_nodes + to->n_edges));
    TRY(contact_set_follow_surface(&c->set, to));
    broad_phase_list(&c->broad_phase, &c->set);
    c->solved = NAN;
    c->quiet = c->all = false;
    return DEM_OK;
}

dem_status automaton_release_orphans(automaton *c, double t, double *y, const event_listener *listener)
{
    contact_instant now = {t, y, y + state_velocities(scene_layout(&c->set.scene)), listener, DEM_OK};
    contact_set_release_orphans(&c->set, &now);
    return now.listener_status;
}

/* Resolves what is due at the candidates of a node: the node itself and its edges. */
static dem_status settle_node(contact_set *c, dem_index node, contact_instant *now, bool *changed)
{
    if (c->of_node[node] >= 0) TRY(candidate_resolve(c, c->of_node[node], now, changed));
    for (contact_edges e = contact_set_edges_at(c, node); contact_edges_next(&e);)
        TRY(candidate_resolve(c, e.k, now, changed));
    return DEM_OK;
}

static dem_status settle_all(contact_set *c, contact_instant *now, bool *changed)
{
    for (dem_index k = 0; k < c->n; k++) TRY(candidate_resolve(c, k, now, changed));
    return DEM_OK;
}

/* The candidates that share a node with candidate k, itself included: nodes first, then the edges at each. */
static dem_status settle_around(contact_set *c, dem_index k, contact_instant *now, bool *changed)
{
    const contact_candidate *candidate = &c->list[k];
    TRY(settle_node(c, candidate->node, now, changed));
    return candidate_is_edge(candidate) ? settle_node(c, candidate->other, now, changed) : DEM_OK;
}

/* Makes the changes that are due, of all candidates, until a round changes nothing. `idle` counts events in a row at
 * which the first round found nothing to change: more than most_in_step of them ask for a shorter step, or else more
 * than max_impacts are an error, as the run would stand still. */
static dem_status settle_until_done(automaton *c, contact_instant *now)
{
    contact_set *s = &c->set;
    const contact_rule *rule = &s->scene.rule;
    const dem_index most = rule->most_in_step > 0 ? rule->most_in_step : rule->max_impacts;
    bool changed = true;
    c->solved = NAN;
    for (c->idle++; changed; c->idle = changed ? 0 : c->idle) {
        changed = false;
        TRY(settle_all(s, now, &changed));
    }
    CHECK(c->idle <= most, DEM_ERROR_CONTACT, "more than %lld contact events in a row changed nothing, at t = %.9g s",
          (long long)most, now->t);
    return DEM_OK;
}

/* The same of candidate k and those around it. */
static dem_status settle_around_until_done(automaton *c, dem_index k, contact_instant *now)
{
    bool changed = true, any = false;
    c->solved = NAN;
    for (; changed; any = any || changed) {
        changed = false;
        TRY(settle_around(&c->set, k, now, &changed));
    }
    return any ? DEM_OK : candidate_count_idle(&c->set, k, now);
}

dem_status automaton_resolve_near(automaton *c, dem_index k, double t, double *y, const event_listener *listener)
{
    contact_instant now = {t, y, y + state_velocities(scene_layout(&c->set.scene)), listener, DEM_OK};
    TRY(settle_around_until_done(c, k, &now));
    return now.listener_status;
}

/* Puts nodes in contact back on their segments, from which rounding has moved them. Edges on vertices are drawn back by
 * their constraint, or put back by automaton_project(). */
static void project_nodes(contact_set *c, double t, double *x)
{
    for (dem_index k = 0; k < c->surface->n_nodes; k++) {
        const contact_candidate *candidate = &c->list[k];
        for (int q = 0; q < candidate->n_closed; q++) {
            const surface_line line = surface_line_at(&c->scene, candidate->closed[q].feature, t);
            contact_set_move(c, candidate->node,
                             vec2_scale(-surface_height(&line, vec2_at(x, candidate->node)), line.normal), x);
        }
    }
}

/* An event at which the whole body stops: changes, reflections within the window if there was an impact, nodes put
 * back, forces and clearances of the new state. */
dem_status automaton_resolve(automaton *c, double t, double *y, const event_listener *listener)
{
    contact_set *s = &c->set;
    contact_instant now = {t, y, y + state_velocities(scene_layout(&s->scene)), listener, DEM_OK};
    const dem_index impacts = s->ledger.counts.impacts;
    TRY(settle_until_done(c, &now));
    if (s->scene.rule.window > 0.0 && s->ledger.counts.impacts > impacts) early_reflection(s, &now);
    project_nodes(s, t, now.x);
    contact_set_solve_all(s, instant_state(&now));
    contact_set_store_all(s);
    broad_phase_update(&c->broad_phase, s, instant_state(&now));
    return now.listener_status;
}

/* Nodes and vertices: each candidate is taken as free and without a clearance, so that its gap is exact. */
static dem_status check_depth(const automaton *c, dem_index k, double t, const double *x)
{
    const contact_scene *scene = &c->set.scene;
    const contact_candidate candidate = candidate_reset(&c->set.list[k]);
    const candidate_positions spot = candidate_place(&candidate, t, x);
    const contact_gap gap = candidate_gap(scene, &candidate, &spot);
    if (gap.distance >= -scene->rule.penetration_tolerance) return DEM_OK;
    const surface_feature feature = contact_point_feature(&candidate, gap.feature);
    const long long obstacle = surface_obstacle(scene, feature);
    const vec2 end = surface_line_at(scene, surface_segment(scene, feature), t).end;
    CHECK(candidate_is_edge(&candidate), DEM_ERROR_MODEL,
          "node %lld at (%g, %g) m starts %g m inside obstacle %lld, deeper than the penetration tolerance of %g m",
          scene_node(scene, candidate.node), spot.a.x, spot.a.y, -gap.distance, obstacle,
          scene->rule.penetration_tolerance);
    return status_fail(DEM_ERROR_MODEL,
                       "the vertex at (%g, %g) m of obstacle %lld starts %g m inside the body, deeper than the "
                       "penetration tolerance of %g m",
                       end.x, end.y, obstacle, -gap.distance, scene->rule.penetration_tolerance);
}

/* Edges: an obstacle may go through one into a void of the body, with its vertex in the open. A fixed node is no
 * candidate, and its edges may begin inside an obstacle that holds it. */
static dem_status check_crossing(const automaton *c, dem_index k, double t, const double *x)
{
    const contact_scene *scene = &c->set.scene;
    const contact_candidate *candidate = &c->set.list[k];
    if (!candidate_is_edge(candidate)) return DEM_OK;
    if (c->set.of_node[candidate->node] < 0 || c->set.of_node[candidate->other] < 0) return DEM_OK;
    const vec2 edge[2] = {vec2_at(x, candidate->node), vec2_at(x, candidate->other)};
    const obstacle_crossing at = surface_crossing_of(scene, t, edge, candidate->behind);
    CHECK(at.depth <= scene->rule.penetration_tolerance, DEM_ERROR_MODEL,
          "obstacle %lld starts across the edge between nodes %lld and %lld near (%g, %g) m, %g m deep, more than the "
          "penetration tolerance of %g m",
          (long long)scene->model->obstacles.segments[at.segment].obstacle, scene_node(scene, candidate->node),
          scene_node(scene, candidate->other), edge[0].x, edge[0].y, at.depth, scene->rule.penetration_tolerance);
    return DEM_OK;
}

dem_status automaton_check_start(const automaton *c, double t, const double *x)
{
    for (dem_index k = 0; k < c->set.n; k++) {
        TRY(check_depth(c, k, t, x));
        TRY(check_crossing(c, k, t, x));
    }
    return DEM_OK;
}

/* Largest coordinate that enters a gap, m: the gap has the rounding of a number of that size. */
static double extent(const contact_set *c, dem_index k, dem_index feature, const candidate_positions *spot)
{
    const dem_index id = surface_segment(&c->scene, contact_point_feature(&c->list[k], feature));
    const surface_line line = surface_line_at(&c->scene, id, spot->t);
    return fmax(vec2_norm(spot->a), fmax(vec2_norm(line.start), vec2_norm(line.end)));
}

/* Closes the contacts of all candidates whose gap is 0 to 64 roundings, whether they approach or are only pressed. An
 * edge may touch two vertices: it is asked again once the first contact has closed. */
static dem_status touch_all(contact_set *s, contact_instant *now)
{
    for (dem_index k = 0; k < s->n; k++)
        for (int q = 0; q < 2; q++) {
            const candidate_positions spot = candidate_place(&s->list[k], now->t, now->x);
            const contact_gap gap = candidate_gap(&s->scene, &s->list[k], &spot);
            if (gap.feature < 0 || gap.distance > 64.0 * DBL_EPSILON * extent(s, k, gap.feature, &spot)) break;
            TRY(candidate_resolve_touch(s, k, &gap, now));
            if (!candidate_is_edge(&s->list[k]) || s->list[k].n_closed != 1) break;
        }
    return DEM_OK;
}

/* The listener's first failure counts, that of the touching contacts before that of what follows. */
dem_status automaton_start(automaton *c, double t, double *y, const event_listener *listener)
{
    contact_set *s = &c->set;
    contact_instant now = {t, y, y + state_velocities(scene_layout(&s->scene)), listener, DEM_OK};
    contact_set_look_at_new(s, instant_state(&now));
    TRY(touch_all(s, &now));
    const dem_status status = automaton_resolve(c, t, y, listener);
    return now.listener_status != DEM_OK ? now.listener_status : status;
}

dem_status automaton_open_all(automaton *c)
{
    c->solved = NAN;
    c->quiet = c->all = false;
    for (dem_index k = 0; k < c->set.n; k++) c->set.list[k] = candidate_reset(&c->set.list[k]);
    c->set.n_orphans = 0;
    return contact_set_regroup(&c->set);
}

/* All that the checkpoint does not hold is found again from the state, the same whether the run wrote the checkpoint
 * just now or is resumed from it: both go on to the same bits. `travelled` begins at 0 in both. */
dem_status automaton_restore(automaton *c, double t, const double *y)
{
    contact_set *s = &c->set;
    const scene_state state = automaton_state(c, t, y);
    TRY(contact_set_regroup(s));
    c->solved = NAN;
    c->quiet = c->all = false;
    c->way = c->broad_phase.travelled = 0.0;
    s->n_orphans = 0;
    contact_set_count_behind(s);
    contact_set_solve_all(s, state);
    contact_set_store_all(s);
    broad_phase_update(&c->broad_phase, s, state);
    return DEM_OK;
}

/* What contacts with one obstacle add to its rates and to the totals, collected to be added together. */
typedef struct rate_terms {
    dem_index obstacle;
    int n;                                                    /* contacts */
    double force[EXACT_SUM_BLOCK], friction[EXACT_SUM_BLOCK]; /* N, [n][2] for impulses: all, and friction's */
    double power[EXACT_SUM_BLOCK], work[EXACT_SUM_BLOCK];     /* W, [n] that friction takes, obstacles do */
} rate_terms;

static void add_terms(const automaton *c, rate_terms *of)
{
    const state_layout *l = scene_layout(&c->set.scene);
    if (of->n == 0) return;
    rate_sums_add_pairs(&c->rates, l, state_row(l, state_impulse(l, of->obstacle)), of->force, 2 * of->n);
    rate_sums_add_pairs(&c->rates, l, state_row(l, state_friction_impulse(l, of->obstacle)), of->friction, 2 * of->n);
    rate_sums_add_terms(&c->rates, l, state_total_index(l, STATE_FRICTION), of->power, of->n);
    if (state_has_total(l, STATE_OBSTACLE))
        rate_sums_add_terms(&c->rates, l, state_total_index(l, STATE_OBSTACLE), of->work, of->n);
    of->n = 0;
}

/* Collects the rates of one candidate's closed contacts. */
static void collect_rates(const automaton *c, dem_index k, scene_state state, rate_terms *terms)
{
    for (int q = 0; q < c->set.list[k].n_closed; q++) {
        const contact_contribution of = contact_set_contribution(&c->set, k, q, state);
        if (of.obstacle != terms->obstacle || terms->n == EXACT_SUM_BLOCK / 2) add_terms(c, terms);
        terms->obstacle = of.obstacle;
        vec2_put(terms->force, terms->n, of.force);
        vec2_put(terms->friction, terms->n, of.friction);
        terms->power[terms->n] = of.power;
        terms->work[terms->n++] = of.work;
    }
}

/* The sums are exact, so that the order of groups does not matter. Where nothing is closed there is nothing to add.
 * Every rank has all contacts. */
void automaton_add_rates(const automaton *c, double t, const double *y, double *a)
{
    const scene_state state = automaton_state(c, t, y);
    const contact_forces *r = &c->set.forces;
    rate_terms terms;
    terms.n = 0;
    terms.obstacle = -1;
    if (r->n_groups == 0) return;
    for (dem_index g = 0; g < r->n_groups; g++)
        for (dem_index k = r->groups[g]; k >= 0; k = r->next[k]) collect_rates(c, k, state, &terms);
    add_terms(c, &terms);
    rate_sums_take(&c->rates, scene_layout(&c->set.scene), a);
}

/* Forces are those stored at the last accepted step or event; frames are those of the positions given. */
const dem_contact *automaton_list(const automaton *c, double t, const double *x, dem_index *n)
{
    *n = 0;
    for (dem_index k = 0; k < c->set.n; k++)
        for (int q = 0; q < c->set.list[k].n_closed; q++)
            c->set.described[(*n)++] = contact_point_describe(&c->set.scene, &c->set.list[k], q, t, x);
    return c->set.described;
}
