/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces in closed contacts (docs/method.md, Contacts that last; Contacts that share nodes). A closed contact is a
 * constraint: its normal force N is what makes the normal acceleration of the point the one that keeps it closed.
 * Whether N >= 0 and abs(T) <= mu N hold is not enforced here: the signs are root functions (candidate.c), and where
 * one fails the automaton changes the contact. So each contact has a known state, and the forces of a group of contacts
 * that share nodes solve a linear system. Rows stand in the order of the bodies' boundaries, where contacts that share
 * nodes are near each other: the system is banded, and the cost of solving it grows with the number of contacts, not
 * with its cube. The same system gives the impulses that stop a group and the displacements that put it back on the
 * surfaces. Impacts with rebound are in impact_group.c. */
#include "contact/contact_forces.h"

#include <stdlib.h>
#include <string.h>

#include "base/sorted.h"
#include "base/status.h"

/* Share of a row's own mobility. A pivot below it means that the other rows hold the contact already: its force is not
 * determined, and is taken as 0. */
static const double redundant = 1e-10;

/* Stands for the group of a candidate whose group is to be found again. */
enum { collected = -2 };

/* What the system is solved for: forces, from accelerations; impulses, from velocities; or displacements, from gaps. */
typedef enum aim { FORCE, IMPULSE, SHIFT } aim;

/* ---- groups ---- */

/* The root of a node's tree. Path halving shortens later searches. */
static dem_index root_of(contact_forces *r, dem_index node)
{
    for (; r->root[node] != node; node = r->root[node]) r->root[node] = r->root[r->root[node]];
    return node;
}

/* The lower root stays, so that trees do not depend on the order of joining. */
static void join(contact_forces *r, dem_index a, dem_index b)
{
    const dem_index ra = root_of(r, a), rb = root_of(r, b);
    if (ra < rb)
        r->root[rb] = ra;
    else
        r->root[ra] = rb;
}

/* Half bandwidth of a group's system if all its contacts stuck, with two rows each: the largest distance between rows
 * that share a node. `first` is where a node comes up first; the first pass clears it, the second counts rows. */
static dem_index group_width(contact_forces *r, dem_index group, dem_index *n_rows)
{
    dem_index width = 0;
    *n_rows = 0;
    for (int pass = 0; pass < 2; pass++)
        for (dem_index k = group; k >= 0; k = r->next[k]) {
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

/* Makes room for the band of a group, when it is found: solving, which happens within the right-hand side, cannot then
 * fail for want of memory. */
static dem_status reserve(contact_forces *r, dem_index group)
{
    dem_index n;
    const dem_index width = group_width(r, group, &n);
    const size_t size = (size_t)n * (2 * (size_t)width + 1);
    if (size <= r->capacity) return DEM_OK;
    double *band = realloc(r->band, 2 * size * sizeof *band);
    CHECK(band != NULL, DEM_ERROR_MEMORY, "out of memory for %lld coupled contact forces", (long long)n);
    r->band = band;
    r->capacity = 2 * size;
    return DEM_OK;
}

/* Where a group is, or would be, in the list of all, which ascends by what their first candidates are: by bisection. */
static dem_index place_of(const contact_forces *r, dem_index group)
{
    dem_index low = 0, high = r->n_groups;
    while (low < high) {
        const dem_index middle = low + (high - low) / 2;
        if (candidate_is_before(&r->candidates[r->groups[middle]], &r->candidates[group]))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Groups are solved in the order of the list, which must not depend on the order of events, nor on where a surface
 * begins: it is kept sorted. */
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
    r->at_node[r->candidates[k].node] = (int32_t)group;
    if (candidate_is_edge(&r->candidates[k])) r->at_node[r->candidates[k].other] = (int32_t)group;
}

/* Adds a candidate to the n whose groups are to be found, unless it is there or has no closed contact. */
static dem_index collect(contact_forces *r, dem_index k, dem_index n)
{
    if (r->candidates[k].n_closed == 0 || r->group[k] == collected) return n;
    r->group[k] = collected;
    r->members[n] = k;
    return n + 1;
}

/* Takes a group off the list and collects all its candidates. */
static dem_index dissolve(contact_forces *r, dem_index group, dem_index n)
{
    if (group < 0) return n;
    delist_group(r, group);
    for (dem_index k = group; k >= 0; k = r->next[k]) {
        r->group[k] = -1;
        set_at_nodes(r, k, -1);
        n = collect(r, k, n);
    }
    return n;
}

/* Union-find over the nodes of the collected candidates: each edge joins its two nodes, so that candidates of a group
 * have one root. Candidates that share a node have it anyway. */
static void join_nodes(contact_forces *r, dem_index n)
{
    for (dem_index p = 0; p < n; p++) {
        const contact_candidate *s = &r->candidates[r->members[p]];
        r->root[s->node] = s->node;
        if (candidate_is_edge(s)) r->root[s->other] = s->other;
    }
    for (dem_index p = 0; p < n; p++) {
        const contact_candidate *s = &r->candidates[r->members[p]];
        if (candidate_is_edge(s)) join(r, s->node, s->other);
    }
}

/* Makes groups of the collected candidates. They are put to the front of their group's list from the last of the walk
 * to the first, so that the list goes along it. The first member is the number of the group. */
static void make_groups(contact_forces *r, dem_index n)
{
    const dem_index *walk = r->walk.list;
    for (dem_index p = 0; p < n; p++) r->first[root_of(r, r->candidates[walk[p]].node)] = -1;
    for (dem_index p = n - 1; p >= 0; p--) {
        dem_index *first = &r->first[root_of(r, r->candidates[walk[p]].node)];
        r->next[walk[p]] = *first;
        *first = walk[p];
    }
    for (dem_index p = 0; p < n; p++) {
        const dem_index k = walk[p];
        r->group[k] = r->first[root_of(r, r->candidates[k].node)];
        set_at_nodes(r, k, r->group[k]);
        if (k == r->group[k]) list_group(r, k);
    }
}

/* Finds the groups of the n candidates that were collected. */
static dem_status group_collected(contact_forces *r, dem_index n)
{
    group_walk_take(&r->walk, r->members, n);
    join_nodes(r, n);
    make_groups(r, n);
    for (dem_index p = 0; p < n; p++)
        if (r->group[r->members[p]] == r->members[p]) TRY(reserve(r, r->members[p]));
    return DEM_OK;
}

/* The groups at the nodes of changed candidates are dissolved, and found again from what they held and from the changed
 * ones. Others have no node in common with these, and stay. A candidate that has opened is still in its old list, but
 * has no closed contact, and is not collected. */
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

/* Their places in the list of all are put in order. There are two nodes for each candidate at most. */
dem_index contact_forces_groups_at(contact_forces *r, const dem_index *nodes, dem_index n, const dem_index **list)
{
    dem_index n_found = 0;
    for (dem_index j = 0; j < n; j++)
        if (r->at_node[nodes[j]] >= 0) r->members[n_found++] = place_of(r, r->at_node[nodes[j]]);
    n_found = sorted_make(r->members, n_found);
    for (dem_index g = 0; g < n_found; g++) r->members[g] = r->groups[r->members[g]];
    *list = r->members;
    return n_found;
}

/* ---- one contact by itself ---- */

/* sign mu, so that T = -sign mu N opposes the sliding; 0 in a corner and under the paper's law. */
static double sliding_friction(const contact_forces *r, const contact_candidate *candidate, int q)
{
    if (candidate->closed[q].held) return 0.0;
    return candidate->closed[q].slide * contact_point_friction(r->scene, candidate, candidate->closed[q].feature);
}

/* Acceleration a_w with which a node stays on a segment that moves. */
static vec2 kept_acceleration(const contact_scene *scene, const contact_candidate *candidate, const surface_line *line,
                              scene_state state)
{
    const surface_query at = {state.t, vec2_at(state.x, candidate->node)};
    const obstacle_motion wall = surface_motion(scene, candidate->closed[0].feature, at);
    return contact_point_keep(scene, candidate->node, line, &wall, state);
}

/* A node on one segment, by itself: the system has one row or two and is solved by hand. From m a' = m a + N n + T t,
 * with a the acceleration without contact and a_w the one with which the node stays on the segment (0 if that is at
 * rest),
 *   (a' - a_w).n = 0:                        N = -m (a - a_w).n,
 *   sticks, (a' - a_w).t = 0:                T = -m (a - a_w).t,   a' = a_w,
 *   slides along sign t:                     T = -sign mu N,
 * where a' - a_w is the tangential part of a - a_w plus T/m t. */
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

/* A node in a corner of two segments goes with the corner: N_1 n_1 + N_2 n_2 = -m (a - a_c), two equations for both
 * forces. There is no friction in a corner. */
static void hold_corner(contact_forces *r, dem_index k, const scene_state *state, double *a)
{
    const contact_candidate *candidate = &r->candidates[k];
    double part[2];
    const surface_line lines[2] = {surface_line_at(r->scene, candidate->closed[0].feature, state->t),
                                   surface_line_at(r->scene, candidate->closed[1].feature, state->t)};
    const obstacle_motion corner = corner_motion(r, candidate, state);
    const vec2 carried = contact_point_keep_corner(r->scene, candidate->node, lines, &corner, *state);
    const vec2 f =
        vec2_scale(-r->scene->model->lattice.mass[candidate->node], vec2_sub(vec2_at(a, candidate->node), carried));
    vec2_parts(f, lines[0].normal, lines[1].normal, part);
    for (int q = 0; q < 2; q++) r->force[k][q] = (contact_force){part[q], 0.0};
    vec2_put(a, candidate->node, carried);
}

/* ---- the banded system of a group ---- */

/* One equation more: along the normal, or along the tangent for a contact that sticks. */
static void add_row(contact_forces *r, dem_index *n, dem_index k, int q, const contact_frame *f, bool tangential)
{
    contact_equation *row = &r->rows[(*n)++];
    *row = (contact_equation){.candidate = k, .q = q, .tangential = tangential, .nodes = f->nodes};
    row->direction = row->push = tangential ? f->tangent : f->normal;
}

/* Velocity of an obstacle along a direction, m/s; 0 without arithmetic where none moves. */
static double along(const contact_forces *r, vec2 wall, vec2 direction)
{
    return surface_speed(r->scene) > 0.0 ? vec2_dot(wall, direction) : 0.0;
}

/* Sets the equations of a group. Row j is a contact with weights w_p on its nodes, and asks that its point moves along
 * a direction d_j by as much as wanted:
 *   sum of A_jk f_k = wanted_j - sum of w_p u_p.d_j,
 * with u [n][2] the free accelerations or velocities. Wanted is, along the normal and the tangent, the acceleration
 * that keeps the contact (FORCE), the velocity of the obstacle (IMPULSE), or minus the gap (SHIFT, normal only). The
 * unknown f_k acts along push_k: the normal or, for a contact that slides under a force, n - sign mu t, by which
 * friction is part of the same unknown. A contact that sticks has a second row along t.  \return the number of rows */
static dem_index set_rows(contact_forces *r, dem_index group, aim to, scene_state state, const double *u)
{
    dem_index n = 0;
    for (dem_index k = group; k >= 0; k = r->next[k]) {
        const contact_candidate *candidate = &r->candidates[k];
        for (int q = 0; q < candidate->n_closed; q++) {
            const contact_frame f = contact_frame_at(r->scene, candidate, q, state);
            add_row(r, &n, k, q, &f, false);
            r->rows[n - 1].wanted = to == FORCE ? f.keep[0] : (to == SHIFT ? -f.gap : along(r, f.wall, f.normal));
            if (to == SHIFT) continue;
            if (to == FORCE) r->rows[n - 1].push = vec2_along(f.normal, -sliding_friction(r, candidate, q), f.tangent);
            if (!contact_point_sticks(&candidate->closed[q])) continue;
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

/* Half bandwidth of the rows set: the largest distance between rows that share a node. */
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

/* A_jk, motion along the direction of row j per unit of the unknown of row k: (sum of w_jp w_kp/m_p over shared nodes)
 * times d_j.push_k. It is not symmetric where contacts slide with friction. */
static double entry(const contact_forces *r, const contact_equation *j, const contact_equation *k)
{
    const double mobility = contact_nodes_coupling(&j->nodes, &k->nodes, r->scene->model->inverse_mass);
    return mobility * vec2_dot(j->direction, k->push);
}

/* Gaussian elimination of the band without pivoting, as exchanging rows would widen the band, and then back
 * substitution: `wanted` then holds the unknowns. Without friction the matrix is symmetric and has no negative
 * eigenvalue, for which the order of elimination does not matter. A pivot that is no more than a rounding of the row's
 * own mobility belongs to a contact that the rows before it hold already: its unknown is 0, and it takes no part. The
 * arguments of AT are row and column. */
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

/* Solves for the unknowns of a group and adds what they do to u. The forces of contacts are stored; the friction of one
 * that slides is -sign mu N. */
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

/* Whether a group is one node: the most frequent case, which needs no system. */
static bool alone(const contact_forces *r, dem_index group)
{
    const dem_index first = group;
    return r->next[first] < 0 && !candidate_is_edge(&r->candidates[first]);
}

static inline void hold(contact_forces *r, dem_index group, const scene_state *state, double *a)
{
    const dem_index k = group;
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
static void set_free(contact_forces *r, dem_index node, scene_state state, const constraint_free *known)
{
    if (r->first[node] == 0) return;
    r->first[node] = 0;
    const dem_index number = known != NULL && known->number[node] < known->n ? known->number[node] : -1;
    vec2_put(r->a, node,
             number >= 0 ? vec2_at(known->a, number) : forces_acceleration(r->scene->forces, node, state.x, state.v));
}

/* Free accelerations are computed for the nodes of the group only, once each; `first` marks those that are done. */
void contact_forces_solve_free(contact_forces *r, dem_index group, scene_state state, const constraint_free *known)
{
    for (dem_index k = group; k >= 0; k = r->next[k]) {
        const contact_candidate *candidate = &r->candidates[k];
        r->first[candidate->node] = -1;
        if (candidate_is_edge(candidate)) r->first[candidate->other] = -1;
    }
    for (dem_index k = group; k >= 0; k = r->next[k]) {
        const contact_candidate *candidate = &r->candidates[k];
        set_free(r, candidate->node, state, known);
        if (candidate_is_edge(candidate)) set_free(r, candidate->other, state, known);
    }
    hold(r, group, &state, r->a);
}

void contact_forces_solve(contact_forces *r, dem_index group, scene_state state)
{
    contact_forces_solve_free(r, group, state, NULL);
}

/* A node by itself gets the velocity of the obstacle exactly, without the linear system: all of it if it sticks or is
 * in a corner, else along the normal. A node that rests on an obstacle at rest thus has a velocity of 0. */
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
        stop_node(r, group, state, v);
    else
        solve(r, group, IMPULSE, state, v);
}

/* Displacements start from 0; those of nodes that are not in the group are not set. */
const double *contact_forces_shift(contact_forces *r, dem_index group, scene_state state)
{
    for (dem_index k = group; k >= 0; k = r->next[k]) {
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
    r.groups = malloc(n * sizeof *r.groups);
    r.group = malloc(n * sizeof *r.group);
    r.next = malloc(n * sizeof *r.next);
    r.at_node = malloc(n_nodes * sizeof *r.at_node);
    r.members = malloc(2 * n * sizeof *r.members);
    r.force = calloc(n, sizeof *r.force);
    r.root = malloc(n_nodes * sizeof *r.root);
    r.first = malloc(n_nodes * sizeof *r.first);
    r.a = malloc(2 * n_nodes * sizeof *r.a); /* not cleared: of a large body few pages are ever touched */
    r.rows = malloc(4 * n * sizeof *r.rows);
    const bool grouped = r.groups && r.group && r.next && r.at_node && r.members;
    if (!(grouped && r.force && r.root && r.first && r.a && r.rows)) {
        contact_forces_destroy(&r);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld contact candidates", (long long)n_candidates);
    }
    const dem_status status = group_walk_create(&r.walk, candidates, n_candidates, (dem_index *[]){r.first, r.root});
    if (status != DEM_OK) {
        contact_forces_destroy(&r);
        return status;
    }
    for (dem_index k = 0; k < n_candidates; k++) r.group[k] = -1;
    for (size_t i = 0; i < n_nodes; i++) r.at_node[i] = -1;
    *out = r;
    return DEM_OK;
}

void contact_forces_destroy(contact_forces *r)
{
    free(r->groups);
    free(r->group);
    free(r->next);
    free(r->at_node);
    free(r->members);
    group_walk_destroy(&r->walk);
    free(r->force);
    free(r->root);
    free(r->first);
    free(r->a);
    free(r->rows);
    free(r->band);
    *r = (contact_forces){0};
}
