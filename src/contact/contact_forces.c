/* SPDX-License-Identifier: BSD-3-Clause */
/* Groups of coupled contacts, and their banded systems. */
#include "contact/contact_forces.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

/* Share of a row's own mobility: with a pivot below it the other rows hold the contact already. */
static const double redundant = 1e-10;

/* Stands for the group of a candidate whose group is to be found again. */
enum { collected = -2 };

/* What the system is solved for. */
typedef enum aim { FORCE, IMPULSE, SHIFT } aim;

/* ---- groups ---- */

/* The root of a node's tree. Path halving shortens later searches. */
static dem_index root_of(contact_forces *r, dem_index node)
{
    for (; r->root[node] != node; node = r->root[node]) r->root[node] = r->root[r->root[node]];
    return node;
}

static void join(contact_forces *r, dem_index a, dem_index b)
{
    const dem_index ra = root_of(r, a), rb = root_of(r, b);
    if (ra < rb)
        r->root[rb] = ra;
    else
        r->root[ra] = rb;
}

/* Every candidate in the order of the boundaries: a node before the edge that starts there. */
static void sort_candidates(contact_forces *r)
{
    dem_index n = 0, n_nodes = 0;
    dem_index *candidate_of = r->root; /* of a node, -1: none or done */
    for (dem_index i = 0; i < r->scene->model->lattice.n_nodes; i++) candidate_of[i] = -1;
    for (; n_nodes < r->n_candidates && !candidate_is_edge(&r->candidates[n_nodes]); n_nodes++)
        candidate_of[r->candidates[n_nodes].node] = n_nodes;
    for (dem_index k = n_nodes; k < r->n_candidates; k++) {
        const dem_index a = r->candidates[k].node;
        if (candidate_of[a] >= 0) r->order[n++] = candidate_of[a];
        candidate_of[a] = -1;
        r->order[n++] = k;
    }
    for (dem_index k = 0; k < n_nodes; k++)
        if (candidate_of[r->candidates[k].node] >= 0) r->order[n++] = k;
    for (dem_index p = 0; p < n; p++) r->rank[r->order[p]] = p;
}

/* Half bandwidth of a group's system if all its contacts stuck: the largest distance between rows that share a node. */
static dem_index group_width(contact_forces *r, dem_index group, dem_index *n_rows)
{
    dem_index width = 0;
    *n_rows = 0;
    for (int pass = 0; pass < 2; pass++)
        for (dem_index k = contact_forces_first(r, group); k >= 0; k = r->next[k]) {
            const contact_candidate *s = &r->candidates[k];
            const dem_index nodes[2] = {s->node, candidate_is_edge(s) ? s->other : s->node};
            if (pass == 1) *n_rows += 2 * s->n_closed;
            for (int e = 0; e < 2; e++) {
                dem_index *first = &r->first[nodes[e]];
                if (pass == 0)
                    *first = -1;
                else if (*first < 0)
                    *first = *n_rows - 2 * s->n_closed;
                if (pass == 1 && *n_rows - 1 - *first > width) width = *n_rows - 1 - *first;
            }
        }
    return width;
}

/* Makes room for the band of a group. */
static dem_status reserve(contact_forces *r, dem_index group)
{
    dem_index n;
    const dem_index width = group_width(r, group, &n);
    const size_t size = (size_t)n * (2 * (size_t)width + 1);
    if (size <= r->capacity) return DEM_OK;
    double *band = realloc(r->band, 2 * size * sizeof *band);
    CHECK(band != NULL, DEM_ERROR_MEMORY, "out of memory for %zu coupled contact forces", size);
    r->band = band;
    r->capacity = 2 * size;
    return DEM_OK;
}

/* Where a group is, or would be, in the list of all. */
static dem_index place_of(const contact_forces *r, dem_index group)
{
    dem_index low = 0, high = r->n_groups;
    while (low < high) {
        const dem_index middle = low + (high - low) / 2;
        if (r->groups[middle] < group)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void list_group(contact_forces *r, dem_index group)
{
    const dem_index at = place_of(r, group);
    memmove(&r->groups[at + 1], &r->groups[at], (size_t)(r->n_groups++ - at) * sizeof *r->groups);
    r->groups[at] = group;
}

static void delist_group(contact_forces *r, dem_index group)
{
    const dem_index at = place_of(r, group);
    memmove(&r->groups[at], &r->groups[at + 1], (size_t)(--r->n_groups - at) * sizeof *r->groups);
}

/* Sets the group at the nodes of a candidate. */
static void set_at_nodes(contact_forces *r, dem_index k, dem_index group)
{
    r->at_node[r->candidates[k].node] = group;
    if (candidate_is_edge(&r->candidates[k])) r->at_node[r->candidates[k].other] = group;
}

/* Adds a candidate to the n whose groups are to be found, unless it is there or has no closed contact. */
static dem_index collect(contact_forces *r, dem_index k, dem_index n)
{
    if (r->candidates[k].n_closed == 0 || r->group[k] == collected) return n;
    r->group[k] = collected;
    r->ranks[n] = r->rank[k];
    return n + 1;
}

/* Takes a group off the list and collects all its candidates. */
static dem_index dissolve(contact_forces *r, dem_index group, dem_index n)
{
    if (group < 0) return n;
    delist_group(r, group);
    for (dem_index k = contact_forces_first(r, group); k >= 0; k = r->next[k]) {
        r->group[k] = -1;
        set_at_nodes(r, k, -1);
        n = collect(r, k, n);
    }
    return n;
}

/* Joins the nodes of the collected candidates, so that those of a group have one root. */
static void join_nodes(contact_forces *r, dem_index n)
{
    for (dem_index p = 0; p < n; p++) {
        const contact_candidate *s = &r->candidates[r->order[r->ranks[p]]];
        r->root[s->node] = s->node;
        if (candidate_is_edge(s)) r->root[s->other] = s->other;
    }
    for (dem_index p = 0; p < n; p++) {
        const contact_candidate *s = &r->candidates[r->order[r->ranks[p]]];
        if (candidate_is_edge(s)) join(r, s->node, s->other);
    }
}

/* Makes groups of the collected candidates, from the last to the first, so that the last one put into a group is the
 * first of it. */
static void make_groups(contact_forces *r, dem_index n)
{
    for (dem_index p = 0; p < n; p++) r->first[root_of(r, r->candidates[r->order[r->ranks[p]]].node)] = -1;
    for (dem_index p = n - 1; p >= 0; p--) {
        const dem_index k = r->order[r->ranks[p]];
        dem_index *first = &r->first[root_of(r, r->candidates[k].node)];
        r->next[k] = *first;
        *first = k;
    }
    for (dem_index p = 0; p < n; p++) {
        const dem_index k = r->order[r->ranks[p]], first = r->first[root_of(r, r->candidates[k].node)];
        r->group[k] = r->rank[first];
        set_at_nodes(r, k, r->group[k]);
        if (k == first) list_group(r, r->group[k]);
    }
}

static int by_rank(const void *a, const void *b)
{
    const dem_index x = *(const dem_index *)a, y = *(const dem_index *)b;
    return (x > y) - (x < y);
}

/* Finds the groups of the n candidates that were collected. */
static dem_status group_collected(contact_forces *r, dem_index n)
{
    if (n > 1) qsort(r->ranks, (size_t)n, sizeof *r->ranks, by_rank);
    join_nodes(r, n);
    make_groups(r, n);
    for (dem_index p = 0; p < n; p++)
        if (r->group[r->order[r->ranks[p]]] == r->ranks[p]) TRY(reserve(r, r->ranks[p]));
    return DEM_OK;
}

dem_status contact_forces_regroup_some(contact_forces *r, const dem_index *changed, dem_index n)
{
    dem_index n_collected = 0;
    for (dem_index c = 0; c < n; c++) {
        const contact_candidate *s = &r->candidates[changed[c]];
        n_collected = dissolve(r, r->at_node[s->node], n_collected);
        if (candidate_is_edge(s)) n_collected = dissolve(r, r->at_node[s->other], n_collected);
        n_collected = collect(r, changed[c], n_collected);
    }
    return group_collected(r, n_collected);
}

dem_status contact_forces_regroup(contact_forces *r)
{
    dem_index n_collected = 0;
    r->n_groups = 0;
    for (dem_index i = 0; i < r->scene->model->lattice.n_nodes; i++) r->at_node[i] = -1;
    for (dem_index k = 0; k < r->n_candidates; k++) {
        r->group[k] = -1;
        n_collected = collect(r, k, n_collected);
    }
    return group_collected(r, n_collected);
}

/* ---- one contact by itself ---- */

/* Whether a contact resists sliding with a force of its own. */
static bool resists(const contact_candidate *candidate, int q)
{
    return candidate->closed[q].slide == 0 && !candidate->closed[q].held;
}

static double sliding_friction(const contact_forces *r, const contact_candidate *candidate, int q)
{
    if (candidate->closed[q].held) return 0.0;
    return candidate->closed[q].slide * contact_point_friction(r->scene, candidate, candidate->closed[q].feature);
}

/* Acceleration with which a node stays on a segment that moves. */
static vec2 kept_acceleration(const contact_scene *scene, const contact_candidate *candidate, const surface_line *line,
                              scene_state state)
{
    const surface_query at = {state.t, vec2_at(state.x, candidate->node)};
    const obstacle_motion wall = surface_motion(scene, candidate->closed[0].feature, at);
    return contact_point_keep(scene, candidate->node, line, &wall, state);
}

/* A node on one segment, a_w the acceleration with which it would stay on it (0 if that is at rest):
 * N = -m (a - a_w).n; T = -m (a - a_w).t if it sticks, -sign mu N if it slides. */
static inline void hold_node(contact_forces *r, dem_index k, const scene_state *state, double *a)
{
    const contact_candidate *candidate = &r->candidates[k];
    const dem_index feature = candidate->closed[0].feature;
    const surface_line line = surface_line_at(r->scene, feature, state->t);
    const bool moves = surface_moves(r->scene, feature);
    const vec2 carried = moves ? kept_acceleration(r->scene, candidate, &line, *state) : (vec2){0.0, 0.0};
    const double m = r->scene->model->lattice.mass[candidate->node];
    const vec2 free_a = vec2_sub(vec2_at(a, candidate->node), carried);
    contact_force *f = &r->force[k][0];
    f->normal = -m * vec2_dot(free_a, line.normal);
    if (candidate->closed[0].slide == 0) {
        f->tangent = -m * vec2_dot(free_a, line.tangent);
        vec2_put(a, candidate->node, carried);
        return;
    }
    f->tangent = -sliding_friction(r, candidate, 0) * f->normal;
    const vec2 along = vec2_along(free_a, -vec2_dot(free_a, line.normal), line.normal);
    const vec2 held = vec2_along(along, f->tangent / m, line.tangent);
    vec2_put(a, candidate->node, moves ? vec2_add(held, carried) : held);
}

static obstacle_motion corner_motion(const contact_forces *r, const contact_candidate *candidate,
                                     const scene_state *state)
{
    const dem_index features[2] = {candidate->closed[0].feature, candidate->closed[1].feature};
    return surface_corner_motion(r->scene, features, (surface_query){state->t, vec2_at(state->x, candidate->node)});
}

/* A node in a corner of two segments: at rest in it. */
static void hold_corner(contact_forces *r, dem_index k, const scene_state *state, double *a)
{
    const contact_candidate *candidate = &r->candidates[k];
    double part[2];
    const vec2 carried = corner_motion(r, candidate, state).acceleration;
    const vec2 f =
        vec2_scale(-r->scene->model->lattice.mass[candidate->node], vec2_sub(vec2_at(a, candidate->node), carried));
    vec2_parts(f, surface_line_at(r->scene, candidate->closed[0].feature, state->t).normal,
               surface_line_at(r->scene, candidate->closed[1].feature, state->t).normal, part);
    for (int q = 0; q < 2; q++) r->force[k][q] = (contact_force){part[q], 0.0};
    vec2_put(a, candidate->node, carried);
}

/* ---- the banded system of a group ---- */

static void add_row(contact_forces *r, dem_index *n, dem_index k, int q, const contact_frame *f, bool tangential)
{
    contact_equation *row = &r->rows[(*n)++];
    *row = (contact_equation){.candidate = k, .q = q, .tangential = tangential, .nodes = f->nodes};
    row->direction = row->push = tangential ? f->tangent : f->normal;
}

/* How fast an obstacle moves along a direction. */
static double along(const contact_forces *r, vec2 wall, vec2 direction)
{
    return surface_speed(r->scene) > 0.0 ? vec2_dot(wall, direction) : 0.0;
}

/* Sets the equations of a group: the motion that each asks for, less that of u [n][2], which are free accelerations or
 * velocities.  \return their number */
static dem_index set_rows(contact_forces *r, dem_index group, aim to, scene_state state, const double *u)
{
    dem_index n = 0;
    for (dem_index k = contact_forces_first(r, group); k >= 0; k = r->next[k]) {
        const contact_candidate *candidate = &r->candidates[k];
        for (int q = 0; q < candidate->n_closed; q++) {
            const contact_frame f = contact_frame_at(r->scene, candidate, q, state);
            add_row(r, &n, k, q, &f, false);
            r->rows[n - 1].wanted = to == FORCE ? f.keep[0] : (to == SHIFT ? -f.gap : along(r, f.wall, f.normal));
            if (to == SHIFT) continue;
            if (to == FORCE) r->rows[n - 1].push = vec2_along(f.normal, -sliding_friction(r, candidate, q), f.tangent);
            if (!resists(candidate, q)) continue;
            add_row(r, &n, k, q, &f, true);
            r->rows[n - 1].wanted = to == FORCE ? f.keep[1] : along(r, f.wall, f.tangent);
        }
    }
    for (dem_index j = 0; j < n && to != SHIFT; j++) {
        contact_equation *row = &r->rows[j];
        for (int p = 0; p < row->nodes.n; p++)
            row->wanted -= row->nodes.weight[p] * vec2_dot(vec2_at(u, row->nodes.node[p]), row->direction);
    }
    return n;
}

/* Half bandwidth: the largest distance between rows that share a node. */
static dem_index band_width(contact_forces *r, dem_index n)
{
    dem_index width = 0;
    for (dem_index j = 0; j < n; j++)
        for (int p = 0; p < r->rows[j].nodes.n; p++) r->first[r->rows[j].nodes.node[p]] = -1;
    for (dem_index j = 0; j < n; j++)
        for (int p = 0; p < r->rows[j].nodes.n; p++) {
            dem_index *first = &r->first[r->rows[j].nodes.node[p]];
            if (*first < 0) *first = j;
            if (j - *first > width) width = j - *first;
        }
    return width;
}

/* Motion along the direction of row j per unit of the force of row k. */
static double entry(const contact_forces *r, const contact_equation *j, const contact_equation *k)
{
    const double mobility = contact_nodes_coupling(&j->nodes, &k->nodes, r->scene->model->inverse_mass);
    return mobility * vec2_dot(j->direction, k->push);
}

/* Gaussian elimination without pivoting, after which `wanted` holds the unknowns. One whose contact the other rows hold
 * already is 0. */
static void eliminate(contact_forces *r, dem_index n, dem_index width)
{
    const dem_index line = 2 * width + 1;
    double *band = r->band;
#define AT(j, k) band[(j)*line + (k) - (j) + width]
    for (dem_index j = 0; j < n; j++)
        for (dem_index k = j - width; k <= j + width; k++)
            AT(j, k) = k >= 0 && k < n ? entry(r, &r->rows[j], &r->rows[k]) : 0.0;
    for (dem_index j = 0; j < n; j++) {
        const dem_index last = j + width < n ? j + width : n - 1;
        const bool dead = fabs(AT(j, j)) <= redundant * entry(r, &r->rows[j], &r->rows[j]);
        for (dem_index k = j + 1; k <= last; k++) {
            const double factor = dead ? 0.0 : AT(k, j) / AT(j, j);
            for (dem_index q = j + 1; q <= last && factor != 0.0; q++) AT(k, q) -= factor * AT(j, q);
            r->rows[k].wanted -= factor * r->rows[j].wanted;
        }
        if (dead) AT(j, j) = 0.0;
    }
    for (dem_index j = n - 1; j >= 0; j--) {
        double sum = r->rows[j].wanted;
        for (dem_index k = j + 1; k <= j + width && k < n; k++) sum -= AT(j, k) * r->rows[k].wanted;
        r->rows[j].wanted = AT(j, j) != 0.0 ? sum / AT(j, j) : 0.0;
    }
#undef AT
}

/* Solves for the unknowns of a group and adds what they do to u. */
static void solve(contact_forces *r, dem_index group, aim to, scene_state state, double *u)
{
    const dem_index n = set_rows(r, group, to, state, u), width = band_width(r, n);
    eliminate(r, n, width);
    for (dem_index j = 0; j < n; j++)
        contact_nodes_push(&r->rows[j].nodes, r->scene->model->inverse_mass, r->rows[j].wanted, r->rows[j].push, u);
    for (dem_index j = 0; j < n && to != SHIFT; j++) {
        const contact_equation *row = &r->rows[j];
        contact_force *f = &r->force[row->candidate][row->q];
        if (row->tangential)
            f->tangent = row->wanted;
        else
            *f = (contact_force){
                row->wanted,
                to == FORCE ? -sliding_friction(r, &r->candidates[row->candidate], row->q) * row->wanted : 0.0};
    }
}

/* Whether a group is one node. */
static bool alone(const contact_forces *r, dem_index group)
{
    const dem_index first = contact_forces_first(r, group);
    return r->next[first] < 0 && !candidate_is_edge(&r->candidates[first]);
}

static inline void hold(contact_forces *r, dem_index group, const scene_state *state, double *a)
{
    const dem_index k = contact_forces_first(r, group);
    if (!alone(r, group))
        solve(r, group, FORCE, *state, a);
    else if (r->candidates[k].n_closed == 2)
        hold_corner(r, k, state, a);
    else
        hold_node(r, k, state, a);
}

/* ---- public ---- */

void contact_forces_hold(contact_forces *r, scene_state state, double *a)
{
    for (dem_index g = 0; g < r->n_groups; g++) hold(r, r->groups[g], &state, a);
}

/* The free acceleration of a node, once for all contacts that share it. */
static void set_free(contact_forces *r, dem_index node, scene_state state)
{
    if (r->first[node] == 0) return;
    r->first[node] = 0;
    vec2_put(r->a, node, forces_acceleration(r->scene->forces, node, state.x, state.v));
}

void contact_forces_solve(contact_forces *r, dem_index group, scene_state state)
{
    for (dem_index k = contact_forces_first(r, group); k >= 0; k = r->next[k]) {
        const contact_candidate *candidate = &r->candidates[k];
        r->first[candidate->node] = -1;
        if (candidate_is_edge(candidate)) r->first[candidate->other] = -1;
    }
    for (dem_index k = contact_forces_first(r, group); k >= 0; k = r->next[k]) {
        const contact_candidate *candidate = &r->candidates[k];
        set_free(r, candidate->node, state);
        if (candidate_is_edge(candidate)) set_free(r, candidate->other, state);
    }
    hold(r, group, &state, r->a);
}

/* A node by itself gets the velocity of the obstacle exactly, without the linear system. */
static void stop_node(contact_forces *r, dem_index k, scene_state state, double *v)
{
    const contact_candidate *candidate = &r->candidates[k];
    const dem_index feature = candidate->closed[0].feature;
    const surface_line line = surface_line_at(r->scene, feature, state.t);
    const vec2 vi = vec2_at(v, candidate->node);
    const bool cornered = candidate->n_closed == 2, rests = cornered || candidate->closed[0].slide == 0;
    const surface_query at = {state.t, vec2_at(state.x, candidate->node)};
    const obstacle_motion wall = cornered ? corner_motion(r, candidate, &state) : surface_motion(r->scene, feature, at);
    const double towards = vec2_dot(obstacle_motion_relative(&wall, vi), line.normal);
    const vec2 after = rests ? wall.velocity : vec2_along(vi, -towards, line.normal);
    const vec2 impulse = vec2_scale(r->scene->model->lattice.mass[candidate->node], vec2_sub(after, vi));
    r->force[k][0] = (contact_force){vec2_dot(impulse, line.normal), vec2_dot(impulse, line.tangent)};
    r->force[k][1] = (contact_force){0.0, 0.0};
    vec2_put(v, candidate->node, after);
}

void contact_forces_stop(contact_forces *r, dem_index group, scene_state state, double *v)
{
    if (alone(r, group))
        stop_node(r, contact_forces_first(r, group), state, v);
    else
        solve(r, group, IMPULSE, state, v);
}

const double *contact_forces_shift(contact_forces *r, dem_index group, scene_state state)
{
    for (dem_index k = contact_forces_first(r, group); k >= 0; k = r->next[k]) {
        const contact_candidate *candidate = &r->candidates[k];
        vec2_put(r->a, candidate->node, (vec2){0.0, 0.0});
        if (candidate_is_edge(candidate)) vec2_put(r->a, candidate->other, (vec2){0.0, 0.0});
    }
    solve(r, group, SHIFT, state, r->a);
    return r->a;
}

dem_status contact_forces_create(contact_forces *out, const contact_scene *scene, const contact_candidate *candidates,
                                 dem_index n_candidates)
{
    const size_t n = (size_t)n_candidates + 1, n_nodes = (size_t)scene->model->lattice.n_nodes;
    contact_forces r = {.scene = scene, .candidates = candidates, .n_candidates = n_candidates};
    r.order = malloc(n * sizeof *r.order);
    r.rank = malloc(n * sizeof *r.rank);
    r.groups = malloc(n * sizeof *r.groups);
    r.group = malloc(n * sizeof *r.group);
    r.next = malloc(n * sizeof *r.next);
    r.at_node = malloc(n_nodes * sizeof *r.at_node);
    r.ranks = malloc(n * sizeof *r.ranks);
    r.force = calloc(n, sizeof *r.force);
    r.root = malloc(n_nodes * sizeof *r.root);
    r.first = malloc(n_nodes * sizeof *r.first);
    r.a = calloc(2 * n_nodes, sizeof *r.a);
    r.rows = malloc(4 * n * sizeof *r.rows);
    const bool grouped = r.order && r.rank && r.groups && r.group && r.next && r.at_node && r.ranks;
    if (!(grouped && r.force && r.root && r.first && r.a && r.rows)) {
        contact_forces_destroy(&r);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld contact candidates", (long long)n_candidates);
    }
    sort_candidates(&r);
    for (dem_index k = 0; k < n_candidates; k++) r.group[k] = -1;
    for (size_t i = 0; i < n_nodes; i++) r.at_node[i] = -1;
    *out = r;
    return DEM_OK;
}

void contact_forces_destroy(contact_forces *r)
{
    free(r->order);
    free(r->rank);
    free(r->groups);
    free(r->group);
    free(r->next);
    free(r->at_node);
    free(r->ranks);
    free(r->force);
    free(r->root);
    free(r->first);
    free(r->a);
    free(r->rows);
    free(r->band);
    *r = (contact_forces){0};
}
