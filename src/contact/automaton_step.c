/* SPDX-License-Identifier: BSD-3-Clause */
/* The automaton within a step: when the contacts of a candidate change, and what is refreshed at the end of the step
 * (docs/algorithms.md, Event location). With `local` every candidate's next change is asked for by itself. With `exact`
 * the integrator watches one root function, the lowest of all; automaton_check_step() then finds what a root finder
 * cannot see, a function that dips below zero and comes back, and cuts the step short there. How a root is found is in
 * event_location.c. `solved` is the time for which contact forces are known, `quiet` that no root function was below
 * zero there: together they spare most steps a second search. */
#include "contact/automaton_step.h"

#include "contact/event_location.h"
#include "contact/impact_group.h"

/* Of the root function, for a unit may be no more than rounding and the quotient then huge; a secant from further down
 * would be the same. */
static const double lowest_value = -1e30;

/* Bound of how far any candidate goes in a step of this length, m: twice the way of the fastest at either end. */
static double furthest_by(double h, double speed0, double speed1)
{
    return 2.0 * h * fmax(speed0, speed1);
}

/* The speed at the beginning of a step is that of the last update of the broad phase. */
static double furthest(const automaton *c, const dense_output *p)
{
    if (broad_phase_is_idle(&c->broad_phase, &c->set)) return 0.0;
    return furthest_by(p->t1 - p->t0, c->broad_phase.speed,
                       broad_phase_speed(&c->set, automaton_state(c, p->t1, p->y1).v));
}

/* The state at the end of a step, as far as the forces of a group depend on it: that of the integrator if the step is
 * whole, else put together from the dense output in `state`. */
static scene_state end_of(automaton *c, dem_index group, const dense_output *p, double *state)
{
    if (p->end == p->t1) return automaton_state(c, p->t1, p->y1);
    event_location_state(&c->set.forces, group, p, p->end, state);
    return automaton_state(c, p->end, state);
}

void automaton_solve_group(automaton *c, const dense_output *p, dem_index group, double *state)
{
    contact_forces_solve(&c->set.forces, group, end_of(c, group, p, state));
}

/* Forces of the state are known if it is the one that contacts were solved for last. */
void automaton_begin_roots(automaton *c, double t, const double *y)
{
    const contact_set *s = &c->set;
    const scene_state state = automaton_state(c, t, y);
    if (c->solved != t) contact_set_solve_all(&c->set, state);
    for (dem_index a = 0; a < c->broad_phase.n; a++) {
        const dem_index k = c->broad_phase.active[a];
        candidate_root_functions(&s->scene, &s->list[k], s->forces.force[k], state, &c->units[CANDIDATE_ROOTS * a]);
    }
}

/* The lowest of the root functions of the a-th active candidate in a state, in units of the start of the step. Those
 * that are left out of the minimum still count for `quiet`. */
static double lowest_root(automaton *c, dem_index a, scene_state state)
{
    double g[CANDIDATE_ROOTS];
    const contact_set *s = &c->set;
    const dem_index k = c->broad_phase.active[a];
    candidate_root_functions(&s->scene, &s->list[k], s->forces.force[k], state, g);
    for (int q = 0; q < CANDIDATE_ROOTS; q++) c->quiet = c->quiet && g[q] > 0.0;
    return candidate_lowest_root(g, &c->units[CANDIDATE_ROOTS * a]);
}

/* Continuous in the end of the step where the root functions are, 1 at its start, and 0 where the first of them crosses
 * zero. Forces are solved for first, which fills `state` with all that closed candidates need; free ones need their
 * positions alone. */
double automaton_root_function(automaton *c, const dense_output *p, double *state)
{
    const contact_set *s = &c->set;
    const bool whole = p->end == p->t1;
    const scene_state now = automaton_state(c, p->end, whole ? p->y1 : state);
    double low = 1.0;
    for (dem_index g = 0; g < s->forces.n_groups; g++) automaton_solve_group(c, p, s->forces.groups[g], state);
    c->solved = p->end;
    c->quiet = true;
    for (dem_index a = 0; a < c->broad_phase.n; a++) {
        const contact_candidate *candidate = &s->list[c->broad_phase.active[a]];
        if (!whole && candidate->n_closed == 0) event_location_place(candidate, p, p->end, state);
        low = fmin(low, lowest_root(c, a, now));
    }
    return fmax(low, lowest_value);
}

/* First time at which closed contacts of a candidate change, if they have to at the end of the step; else infinity. The
 * forces are then those of the end again. */
static double next_due(automaton *c, const dense_output *p, dem_index k, double from, double *state)
{
    contact_forces *r = &c->set.forces;
    const contact_candidate *candidate = &c->set.list[k];
    if (c->quiet) return INFINITY;
    if (!candidate_due(&c->set.scene, candidate, r->force[k], end_of(c, r->group[k], p, state))) return INFINITY;
    const double due = event_location_change(r, candidate, p, from, state);
    automaton_solve_group(c, p, r->group[k], state);
    return due;
}

/* If the step ends where contacts were solved for last, the forces are known, and with `quiet` no closed contact is
 * due. */
void automaton_begin_step(automaton *c, const dense_output *p, double *state)
{
    const contact_forces *r = &c->set.forces;
    const bool whole = p->end == p->t1, solved = whole && c->solved == p->t1;
    c->way = furthest(c, p);
    c->all = broad_phase_covers_all(&c->broad_phase, c->way);
    c->quiet = solved && c->quiet;
    for (dem_index g = 0; g < r->n_groups && !solved; g++) automaton_solve_group(c, p, r->groups[g], state);
    if (whole) c->solved = p->t1;
}

/* Whether a free node is inside an obstacle though it has moved less than its clearance: then it has not come through
 * the front, but round a free end, and is marked as behind. */
static bool come_round(contact_set *c, dem_index k, const candidate_positions *spot)
{
    const contact_candidate *candidate = &c->list[k];
    dem_index nearest;
    if (candidate_is_edge(candidate) || candidate->n_closed > 0 || candidate->behind[0] >= 0) return false;
    if (!(candidate_moved(&c->scene, candidate, spot) < candidate->clearance.distance) ||
        candidate_clearance(&c->scene, candidate, spot, &nearest) >= 0.0)
        return false;
    contact_set_pass_behind(c, k, surface_obstacle(&c->scene, (surface_feature){SURFACE_SEGMENT, nearest}));
    return true;
}

double automaton_crossing(automaton *c, const dense_output *p, dem_index k, double from)
{
    contact_candidate *candidate = &c->set.list[k];
    if (!broad_phase_may_touch(&c->broad_phase, candidate, c->way)) return INFINITY;
    candidate->clearance.inactive = false;
    return candidate->n_closed < 2 ? event_location_crossing(&c->set.scene, candidate, p, from) : INFINITY;
}

/* A node that seems to be inside from the start on may be behind a free end; then its crossing is asked for anew. */
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

/* A change found within four widths of a root is taken to be that root: the step ends there already. `late` counts
 * steps that are cut short here. */
bool automaton_check_step(automaton *c, dense_output *p, bool rooted, double *state)
{
    contact_set *s = &c->set;
    const double last =
        rooted ? p->end - 4.0 * dense_output_resolution(p) : INFINITY; /* a later root is the one already found */
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

/* Whether a contact of a group has opened, or sunk in, by more than a quarter of the penetration tolerance. A node on
 * an obstacle that does not accelerate stays where it is held. */
static bool has_opened(const contact_set *c, dem_index group, const contact_instant *now)
{
    const contact_forces *r = &c->forces;
    const bool nodes_too = surface_acceleration(&c->scene) > 0.0;
    for (dem_index m = group; m >= 0; m = r->next[m]) {
        const contact_candidate *candidate = &c->list[m];
        for (int q = 0; q < candidate->n_closed && (nodes_too || candidate_is_edge(candidate)); q++)
            if (fabs(contact_frame_at(&c->scene, candidate, q, instant_state(now)).gap) >
                0.25 * c->scene.rule.penetration_tolerance)
                return true;
    }
    return false;
}

/* `projected`, the furthest displacement so far, is allowed for in the depth of later impacts. The velocities of these
 * groups are stopped as well. */
bool automaton_project(automaton *c, double t, double *y)
{
    contact_set *s = &c->set;
    contact_instant now = {t, y, y + state_velocities(scene_layout(&s->scene)), NULL, DEM_OK};
    bool any = false;
    if (s->scene.model->obstacles.n == 0) return false;
    for (dem_index g = 0; g < s->forces.n_groups; g++) {
        const dem_index group = s->forces.groups[g];
        if (!has_opened(s, group, &now)) continue;
        s->projected = fmax(s->projected, impact_group_project(s, group, &now));
        impact_group_stop(s, group, &now);
        any = true;
    }
    if (any) c->solved = NAN;
    return any;
}

/* After a whole step the forces are known from its last evaluation; after a cut one they are solved for. */
void automaton_end_step(automaton *c, const dense_output *p, const double *y)
{
    contact_set *s = &c->set;
    c->broad_phase.travelled += c->way;
    const scene_state state = automaton_state(c, p->end, y);
    if (c->solved != p->t1 || p->end < p->t1) contact_set_solve_all(s, state);
    contact_set_store_all(s);
    contact_set_look_at_new(s, state);
    broad_phase_update(&c->broad_phase, s, state);
}

/* ---- free flight ---- */

/* Nothing is near, and nothing has to be measured at the end of the present step. */
static bool is_free(const automaton *c)
{
    const contact_set *s = &c->set;
    return s->forces.n_groups == 0 && s->n_orphans == 0 && !s->has_new && s->ledger.counts.behind == 0 &&
           c->broad_phase.n == 0;
}

bool automaton_may_fly(const automaton *c, double time)
{
    const double speed = c->broad_phase.speed;
    return is_free(c) && !broad_phase_covers_all(&c->broad_phase,
                                                 furthest_by(time, speed, speed) + broad_phase_reach(&c->set, speed));
}

/* Follows a step, if at its end the broad phase would find nothing to measure. */
static bool pass_step(const automaton *c, broad_phase *w, double h, double speed, double *way)
{
    *way = furthest_by(h, w->speed, speed);
    if (broad_phase_covers_all(w, *way)) return false;
    w->travelled += *way;
    w->speed = speed;
    return !broad_phase_covers_all(w, broad_phase_reach(&c->set, speed));
}

/* Follows steps likewise, the last of which goes so far at most, m.  \return whether all can be followed */
static bool pass_steps(const automaton *c, broad_phase *w, const automaton_flight *flight, double *way)
{
    const bool idle = broad_phase_is_idle(w, &c->set);
    for (int k = 0; k < flight->n && !idle; k++) {
        const double speed = sqrt(flight->square[k]) + surface_speed(&c->set.scene);
        if (!pass_step(c, w, flight->t[k + 1] - flight->t[k], speed, way)) return false;
    }
    return true;
}

bool automaton_can_fly(const automaton *c, const automaton_flight *flight)
{
    broad_phase w = c->broad_phase;
    double way;
    return is_free(c) && pass_steps(c, &w, flight, &way);
}

void automaton_fly(automaton *c, const automaton_flight *flight)
{
    double way = 0.0;
    (void)pass_steps(c, &c->broad_phase, flight, &way);
    c->way = way;
    c->all = c->quiet = false;
    c->solved = flight->t[flight->n];
}
