/* SPDX-License-Identifier: BSD-3-Clause */
/* The impact of a group of contacts that share nodes (docs/method.md, Contacts that share nodes). An impulse at one
 * contact moves the points of others, so the law of one impact cannot be applied to each once. The contacts are put on
 * their surfaces and take their impacts in turn (Gauss-Seidel), each by impact_law.c with its own mobility, until none
 * approaches. With obstacles at rest no single impact gives energy, so no sweep does. Then it is decided which contacts
 * last; if some of these have rebounded, all impulses are taken back and given again with those plastic. What velocity
 * is left in closed contacts is removed by the linear system of contact_forces.c. Forces in lasting contacts are there,
 * too. */
#include "contact/impact_group.h"

#include <stdlib.h>

#include "base/status.h"
#include "contact/impact_rest.h"

/* Sweeps in which the contacts of a group are resolved in turn; those of the second half are without rebound. */
enum { most_sweeps = 200 };

static const double group_noise = 1e-11; /* of the largest speed: slower approaches are left to the group's stop */

/* Moves the nodes to first order so that every gap is 0. A node that two contacts of the group share is moved when it
 * first comes up, and its displacement is then set to 0. */
double impact_group_project(contact_set *c, dem_index group, contact_instant *now)
{
    contact_forces *r = &c->forces;
    double furthest = 0.0;
    const double *shift = contact_forces_shift(r, group, instant_state(now));
    for (dem_index m = group; m >= 0; m = r->next[m]) {
        const contact_candidate *candidate = &c->list[m];
        const dem_index nodes[2] = {candidate->node, candidate->other};
        for (int e = 0; e < (candidate_is_edge(candidate) ? 2 : 1); e++) {
            furthest = fmax(furthest, vec2_norm(vec2_at(shift, nodes[e])));
            contact_set_move(c, nodes[e], vec2_at(shift, nodes[e]), now->x);
            vec2_put(r->a, nodes[e], (vec2){0.0, 0.0});
        }
    }
    return furthest;
}

/* Lists the contacts of the group with their velocities before the impact, absolute ones for reports. Those of a corner
 * take part like others: what it holds is found again when groups are.  \return the largest relative speed, m/s */
static double prepare(contact_set *c, dem_index group, const contact_instant *now)
{
    const contact_forces *r = &c->forces;
    double scale = 0.0;
    c->n_involved = 0;
    for (dem_index m = group; m >= 0; m = r->next[m]) {
        contact_candidate *candidate = &c->list[m];
        c->involved[c->n_involved++] = m;
        c->impacts[m].n = candidate->n_closed;
        for (int q = 0; q < candidate->n_closed; q++) {
            const contact_frame f = contact_frame_at(&c->scene, candidate, q, instant_state(now));
            contact_impact *impact = &c->impacts[m].of[q];
            *impact = (contact_impact){.fresh = impact->fresh, .before = contact_frame_velocity(&f, now->v)};
            candidate->closed[q].held = false;
            scale = fmax(scale, vec2_norm(f.velocity));
        }
    }
    return scale;
}

/* Resolves one contact of the group by itself if it approaches. Its point answers like a mass 1/mobility: a change
 * `kick` of its velocity is the impulse J = kick/mobility, which also changes the velocities of contacts that share its
 * nodes, and takes the energy -J.(v + v')/2.  \return whether it approached by more than the tolerance, m/s */
static bool resolve_approach(contact_set *c, dem_index k, int q, double tolerance, bool plastic, contact_instant *now)
{
    contact_impact *impact = &c->impacts[k].of[q];
    const contact_frame f = contact_frame_at(&c->scene, &c->list[k], q, instant_state(now));
    vec2 kick;
    if (vec2_dot(f.velocity, f.normal) >= -tolerance) return false;
    impact_surface wall = impact_rest_surface(c, k, c->list[k].closed[q].feature, f.normal);
    if (plastic || impact->plastic) wall.restitution = 0.0;
    const vec2 after = impact_law_rebound(&wall, 1, f.velocity, &kick);
    const vec2 impulse = vec2_scale(1.0 / f.mobility, kick);
    contact_set_push(c, &f, impulse, now->v);
    impact->approached = true;
    impact->impulse = vec2_add(impact->impulse, impulse);
    impact->energy -= 0.5 * vec2_dot(impulse, vec2_add(f.velocity, after));
    return true;
}

/* Resolves the contacts of a group in turn, those of candidate k first, which has just touched. From the hundredth
 * sweep on there is no rebound, so that contacts between which an impact goes to and fro come to an end.  \return
 * whether none approaches in the end */
static bool sweep(contact_set *c, dem_index k, double tolerance, contact_instant *now)
{
    const contact_forces *r = &c->forces;
    const dem_index group = r->group[k];
    bool approached = true;
    for (int q = 0; q < c->list[k].n_closed; q++)
        (void)resolve_approach(c, k, q, tolerance, false, now); /* it is the first */
    for (int s = 0; s < most_sweeps && approached; s++) {
        approached = false;
        for (dem_index m = group; m >= 0; m = r->next[m])
            for (int q = 0; q < c->list[m].n_closed; q++)
                approached |= resolve_approach(c, m, q, tolerance, 2 * s >= most_sweeps, now);
    }
    return !approached;
}

/* Decides which contacts of the group last, and how they slide. `away` is the normal velocity that is left, `back` the
 * acceleration towards the surface, turning - a.n, which is to bring the contact back. A new contact opens if `away`
 * exceeds the speed that counts as rest; one that was closed must exceed the tolerance of the sweeps, too. Where one
 * begins to stick is its place now. */
static void judge(contact_set *c, dem_index group, double tolerance, const contact_instant *now)
{
    const contact_forces *r = &c->forces;
    const bool shared = r->next[group] >= 0;
    for (dem_index k = group; k >= 0; k = r->next[k]) {
        for (int q = 0; q < c->list[k].n_closed; q++) {
            contact_point *point = &c->list[k].closed[q];
            contact_impact *impact = &c->impacts[k].of[q];
            const contact_frame f = contact_frame_at(&c->scene, &c->list[k], q, instant_state(now));
            const double away = vec2_dot(f.velocity, f.normal), speed = vec2_dot(f.velocity, f.tangent);
            double back = f.turning;
            for (int p = 0; p < f.nodes.n; p++)
                back -= f.nodes.weight[p] *
                        vec2_dot(f.normal, forces_acceleration(c->scene.forces, f.nodes.node[p], now->x, now->v));
            const impact_surface wall = impact_rest_surface(c, k, point->feature, f.normal);
            const double rest = impact_rest_speed(c, vec2_at(now->x, f.nodes.node[0]), back, &wall, shared);
            impact->opens = away > (impact->fresh ? rest : fmax(rest, tolerance));
            impact->rests = rest > 0.0 && away <= rest;
            const int sign = impact_rest_slide(c, k, point->feature, fabs(speed) <= tolerance ? 0.0 : speed);
            if (impact->fresh || point->slide != 0) point->place = fmin(fmax(f.place, 0.0), 1.0);
            point->slide = sign;
        }
    }
}

/* If contacts last that have rebounded, takes all impulses back, so that they are given again with those contacts
 * plastic: a contact that lasts has not rebounded, and its friction follows from the impulse without rebound. Positions
 * have not changed since, so that subtracting the impulses restores the velocities to rounding.  \return whether there
 * were any */
static bool take_back(contact_set *c, dem_index group, contact_instant *now)
{
    const contact_forces *r = &c->forces;
    bool any = false;
    for (dem_index m = group; m >= 0; m = r->next[m])
        for (int q = 0; q < c->list[m].n_closed; q++) {
            contact_impact *impact = &c->impacts[m].of[q];
            impact->plastic = impact->approached && impact->rests;
            any |= impact->plastic;
        }
    for (dem_index m = group; m >= 0 && any; m = r->next[m])
        for (int q = 0; q < c->list[m].n_closed; q++) {
            contact_impact *impact = &c->impacts[m].of[q];
            const contact_frame f = contact_frame_at(&c->scene, &c->list[m], q, instant_state(now));
            contact_set_push(c, &f, vec2_scale(-1.0, impact->impulse), now->v);
            impact->impulse = (vec2){0.0, 0.0};
            impact->energy = 0.0;
            impact->approached = false;
        }
    return any;
}

/* Keeps contacts closed for now that still approach after all sweeps: they stop with the others by one linear system,
 * and open if nothing presses them. */
static void keep_approaching(contact_set *c, dem_index group)
{
    const contact_forces *r = &c->forces;
    for (dem_index m = group; m >= 0; m = r->next[m])
        for (int q = 0; q < c->list[m].n_closed; q++)
            if (c->impacts[m].of[q].approached) c->impacts[m].of[q].opens = false;
}

/* Takes the contacts that open out of a candidate's closed ones, but keeps them in the list behind these, for the
 * report: of two, the one that stays is moved to the front. */
static void part(contact_candidate *candidate, candidate_impact *impact)
{
    candidate_forget_clearance(candidate);
    if (candidate->n_closed == 2 && impact->of[0].opens && !impact->of[1].opens) {
        const contact_point first = candidate->closed[0];
        const contact_impact its = impact->of[0];
        candidate->closed[0] = candidate->closed[1];
        candidate->closed[1] = first;
        impact->of[0] = impact->of[1];
        impact->of[1] = its;
    }
    while (candidate->n_closed > 0 && impact->of[candidate->n_closed - 1].opens) candidate->n_closed--;
}

/* The energy that stopping takes counts as impact, its impulses as those of the obstacles. */
void impact_group_stop(contact_set *c, dem_index group, contact_instant *now)
{
    const contact_forces *r = &c->forces;
    exact_sum_add(&c->ledger.impact, contact_set_stop(c, group, now));
    for (dem_index m = group; m >= 0; m = r->next[m]) {
        const contact_candidate *candidate = &c->list[m];
        for (int q = 0; q < candidate->n_closed; q++) {
            const contact_frame f = contact_frame_at(&c->scene, candidate, q, instant_state(now));
            const surface_feature on = contact_point_feature(candidate, candidate->closed[q].feature);
            contact_set_add_impulse(c, surface_obstacle(&c->scene, on), c->impacts[m].of[q].stop, f.normal, f.wall);
        }
    }
}

/* Stops the groups that share a node with a candidate, before it takes its impact: velocities that the integrator's
 * error has left in them are no approach. */
static void stop_around(contact_set *c, dem_index k, contact_instant *now)
{
    const dem_index nodes[2] = {c->list[k].node, c->list[k].other};
    for (int n = 0; n < (candidate_is_edge(&c->list[k]) ? 2 : 1); n++) {
        const dem_index own = c->of_node[nodes[n]];
        if (own >= 0 && c->list[own].n_closed > 0) impact_group_stop(c, c->forces.group[own], now);
        for (contact_edges e = contact_set_edges_at(c, nodes[n]); contact_edges_next(&e);)
            if (c->list[e.k].n_closed > 0) impact_group_stop(c, c->forces.group[e.k], now);
    }
}

/* Takes away what the sweeps have left of velocities that closed contacts do not allow, group by group of those that
 * are left, each once: with its first candidate. The impulses count with those of the sweeps. */
static void settle_velocities(contact_set *c, contact_instant *now)
{
    const contact_forces *r = &c->forces;
    for (dem_index p = 0; p < c->n_involved; p++) {
        const dem_index k = c->involved[p], group = r->group[k];
        if (group < 0 || group != k) continue;
        exact_sum_add(&c->ledger.impact, contact_set_stop(c, group, now));
        for (dem_index m = group; m >= 0; m = r->next[m]) {
            contact_impact *impact = c->impacts[m].of;
            for (int q = 0; q < c->list[m].n_closed; q++)
                impact[q].impulse = vec2_add(impact[q].impulse, impact[q].stop);
        }
    }
}

/* Enters in the ledger, and reports, the impulses and changes of a candidate's contacts. */
static void report_candidate(contact_set *c, dem_index k, contact_instant *now)
{
    const contact_candidate *candidate = &c->list[k];
    for (int q = 0; q < c->impacts[k].n; q++) {
        const contact_impact *impact = &c->impacts[k].of[q];
        const dem_index feature = candidate->closed[q].feature;
        const bool kept = q < candidate->n_closed;
        dem_event event = contact_set_event(c, k, feature, DEM_EVENT_IMPACT, now);
        c->ledger.counts.closings += impact->fresh && kept;
        const dem_index id = surface_segment(&c->scene, contact_point_feature(candidate, feature));
        const obstacle_motion wall = surface_motion(&c->scene, id, (surface_query){now->t, vec2_at(event.x, 0)});
        contact_set_add_impulse(c, event.obstacle, impact->impulse, vec2_at(event.normal, 0), wall.velocity);
        if (impact->approached) {
            vec2_put(event.before, 0, impact->before);
            contact_set_enter_impact(c, &event, impact->energy, impact->impulse, now);
        }
        if (kept == !impact->fresh || (impact->approached && kept)) continue;
        event = contact_set_event(c, k, feature, kept ? DEM_EVENT_CLOSE : DEM_EVENT_RELEASE, now);
        ledger_enter(&c->ledger, &event, now);
    }
    c->impacts[k] = (candidate_impact){0};
}

/* Adds the contact that hits to the closed ones of the candidate, in place of those that it cannot be closed together
 * with: a node on one segment that hits another, without a corner, leaves the first. */
static dem_status take_up(contact_set *c, dem_index k, impact_target hit)
{
    contact_candidate *candidate = &c->list[k];
    c->impacts[k] = (candidate_impact){0};
    if (!candidate_is_edge(candidate) && candidate->n_closed == 1 && hit.n == 1) candidate->n_closed = 0;
    for (int h = 0; h < hit.n && candidate->n_closed < 2; h++) {
        if (candidate_point_on(candidate, hit.feature[h]) >= 0) continue;
        c->impacts[k].of[candidate->n_closed].fresh = true;
        TRY(contact_set_close(c, k, (contact_point){.feature = hit.feature[h], .slide = 1}));
    }
    return DEM_OK;
}

static int by_number(const void *a, const void *b)
{
    const dem_index x = *(const dem_index *)a, y = *(const dem_index *)b;
    return (x > y) - (x < y);
}

/* The group is that of candidate k with its new contact. Reports go in the order of candidates, not of the group. */
dem_status impact_group_solve(contact_set *c, dem_index k, impact_target hit, contact_instant *now)
{
    stop_around(c, k, now);
    TRY(take_up(c, k, hit));
    const dem_index group = c->forces.group[k];
    (void)impact_group_project(c, group, now);
    const double tolerance = group_noise * prepare(c, group, now);
    bool done = sweep(c, k, tolerance, now);
    judge(c, group, tolerance, now);
    if (take_back(c, group, now)) {
        done = sweep(c, k, tolerance, now);
        judge(c, group, tolerance, now);
    }
    if (!done) keep_approaching(c, group);
    for (dem_index p = 0; p < c->n_involved; p++) part(&c->list[c->involved[p]], &c->impacts[c->involved[p]]);
    TRY(contact_set_regroup_some(c, c->involved, c->n_involved));
    settle_velocities(c, now);
    qsort(c->involved, (size_t)c->n_involved, sizeof *c->involved, by_number);
    for (dem_index p = 0; p < c->n_involved; p++) report_candidate(c, c->involved[p], now);
    return DEM_OK;
}
