/* SPDX-License-Identifier: BSD-3-Clause */
/* The broad phase: candidates further off than the next step can take them are inactive, and cost nothing until the
 * bodies may have gone as far (docs/algorithms.md, Broad phase). Instead of each candidate's own way one bound for all
 * is summed up, `travelled`: twice the step times the fastest node. A candidate with a clearance d at travelled = s
 * cannot touch before travelled = s + d. Nodes that have gone round a free end of an obstacle are found here as well,
 * between steps. The exact search within a step is in event_location.c. */
#include "contact/broad_phase.h"

#include "base/grow.h"
#include "base/status.h"

dem_status broad_phase_reserve(broad_phase *w, dem_index n_candidates)
{
    CHECK(grow_array((void **)&w->active, &w->capacity, n_candidates, sizeof *w->active), DEM_ERROR_MEMORY,
          "out of memory for %lld contact candidates", (long long)n_candidates);
    return DEM_OK;
}

void broad_phase_destroy(broad_phase *w)
{
    free(w->active);
    *w = (broad_phase){0};
}

/* The largest square is found first: one square root instead of one for each node. Here and below numbers are compared
 * in place, as a call of fmax() takes longer than all else of a node. */
double broad_phase_speed(const contact_set *c, const double *v)
{
    double square = 0.0;
    for (dem_index k = 0; k < c->surface->n_nodes; k++) {
        const vec2 vi = vec2_at(v, c->list[k].node);
        const double own = vec2_dot(vi, vi);
        if (own > square) square = own;
    }
    return sqrt(square) + surface_speed(&c->scene);
}

/* A node is no longer behind an obstacle once its distance to it is positive, in front of it or beyond its free end. */
static void come_back(contact_set *c, dem_index k, surface_query at)
{
    if (surface_gap_of(&c->scene, at, c->list[k].behind[0]).distance > 0.0) contact_set_pass_behind(c, k, -1);
}

/* Measures the clearance of a candidate, which is inactive if that is more than `reach`. A free node that is inside
 * though it has not used up its clearance cannot have come through the front: it has gone round a free end. Twice the
 * margin of free ends is taken off, to be on the safe side. */
static void look_at(broad_phase *w, contact_set *c, dem_index k, scene_state state, double reach)
{
    contact_candidate *candidate = &c->list[k];
    const candidate_positions spot = candidate_place(candidate, state.t, state.x);
    dem_index nearest;
    double clear = candidate_clearance(&c->scene, candidate, &spot, &nearest);
    const bool untouched = candidate->clearance.inactive
                               ? candidate->clearance.active_from > w->travelled
                               : candidate_moved(&c->scene, candidate, &spot) < candidate->clearance.distance;
    if (clear < 0.0 && untouched && candidate->n_closed == 0 && !candidate_is_edge(candidate)) {
        contact_set_pass_behind(c, k, surface_obstacle(&c->scene, (surface_feature){SURFACE_SEGMENT, nearest}));
        clear = candidate_clearance(&c->scene, candidate, &spot, &nearest);
    }
    clear -= 2.0 * scene_margin(&c->scene);
    candidate->clearance.inactive = clear > reach;
    candidate->clearance.active_from = w->travelled + clear;
    candidate->clearance.distance = fmax(0.0, clear);
    candidate->clearance.t = state.t;
    candidate->clearance.at[0] = spot.a;
    candidate->clearance.at[1] = spot.b;
}

/* Whether a clearance has to be measured again: that of an inactive candidate once it may touch something, that of an
 * active one once it has moved by half of it. */
static bool worth_a_look(const broad_phase *w, const contact_scene *scene, const contact_candidate *candidate,
                         scene_state state, double reach)
{
    if (candidate->clearance.inactive) return candidate->clearance.active_from <= w->travelled + reach;
    const candidate_positions spot = candidate_place(candidate, state.t, state.x);
    return candidate_moved(scene, candidate, &spot) >= 0.5 * candidate->clearance.distance;
}

static inline void list_one(broad_phase *w, const contact_candidate *candidate, dem_index k)
{
    if (candidate->n_closed > 0 || !candidate->clearance.inactive)
        w->active[w->n++] = k;
    else if (candidate->clearance.active_from < w->earliest)
        w->earliest = candidate->clearance.active_from;
}

void broad_phase_list(broad_phase *w, const contact_set *c)
{
    w->n = 0;
    w->earliest = (double)INFINITY;
    for (dem_index k = 0; k < c->n; k++) list_one(w, &c->list[k], k);
}

/* `reach` only chooses which candidates are active: if a step may have taken them further, broad_phase_covers_all()
 * says so, and all are checked. */
void broad_phase_update(broad_phase *w, contact_set *c, scene_state state)
{
    if (broad_phase_is_idle(w, c)) return;
    w->speed = broad_phase_speed(c, state.v);
    const double reach = broad_phase_reach(c, w->speed);
    w->n = 0;
    w->earliest = (double)INFINITY;
    for (dem_index k = 0; k < c->surface->n_nodes && c->ledger.counts.behind > 0; k++)
        if (c->list[k].behind[0] >= 0) come_back(c, k, (surface_query){state.t, vec2_at(state.x, c->list[k].node)});
    for (dem_index k = 0; k < c->n; k++) {
        const contact_candidate *candidate = &c->list[k];
        if (worth_a_look(w, &c->scene, candidate, state, reach)) look_at(w, c, k, state, reach);
        list_one(w, candidate, k);
    }
}
