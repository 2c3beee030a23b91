/* SPDX-License-Identifier: BSD-3-Clause */
/* The candidates of a model, and the bookkeeping of their contacts: closing and opening, groups and corners, forces
 * stored for reports, energies and impulses entered in the ledger. A candidate's number is its place on the surface,
 * nodes first, then edges, whatever has happened before; across surfaces it is known by its nodes (contact_key). What
 * makes a contact close or open is decided in candidate_resolve.c and the impact_*.c files; forces are solved for in
 * contact_forces.c. */
#include "contact/contact_set.h"

#include <stdlib.h>

#include "base/status.h"

static void list_nodes(contact_set *c)
{
    for (dem_index i = 0; i < c->scene.model->lattice.n_nodes; i++) c->of_node[i] = -1;
    for (dem_index k = 0; k < c->surface->n_nodes; k++) {
        c->list[k] = (contact_candidate){
            .node = c->surface->nodes[k], .other = -1, .previous = -1, .next = -1, .behind = {-1, -1}};
        c->of_node[c->surface->nodes[k]] = (int32_t)k;
    }
}

/* An edge knows the nodes before and after it on the boundary: its gap depends on how the body goes on there. */
static void list_edges(contact_set *c)
{
    const surface *s = c->surface;
    for (dem_index e = 0; e < c->n - s->n_nodes; e++) {
        contact_candidate candidate = {.node = s->ends[2 * e], .other = s->ends[2 * e + 1], .behind = {-1, -1}};
        candidate.previous = s->previous[e] >= 0 ? s->ends[2 * s->previous[e]] : -1;
        candidate.next = s->next[e] >= 0 ? s->ends[2 * s->next[e] + 1] : -1;
        c->list[contact_set_of_edge(c, e)] = candidate;
    }
}

/* The candidates of the surface, all free; edges only where there are vertices for them to touch. The forces borrow the
 * scene and the list, so neither may move. */
static dem_status list_candidates(contact_set *c, const contact_scene *scene)
{
    const bool vertices = scene->rule.vertices && scene->model->obstacles.n_vertices > 0;
    c->n = c->surface->n_nodes + (vertices ? c->surface->n_edges : 0);
    c->list = calloc((size_t)c->n + 1, sizeof *c->list);
    c->of_node = malloc((size_t)scene->model->lattice.n_nodes * sizeof *c->of_node);
    c->involved = malloc(((size_t)c->n + 1) * sizeof *c->involved);
    c->impacts = calloc((size_t)c->n + 1, sizeof *c->impacts);
    c->described = calloc(2 * (size_t)c->n + 1, sizeof *c->described);
    CHECK(c->list && c->of_node && c->involved && c->impacts && c->described, DEM_ERROR_MEMORY,
          "out of memory for %lld contact candidates", (long long)c->n);
    list_nodes(c);
    list_edges(c);
    return contact_forces_create(&c->forces, scene, c->list, c->n);
}

static void free_candidates(contact_set *c)
{
    free(c->list);
    free(c->of_node);
    free(c->involved);
    free(c->impacts);
    free(c->described);
    free(c->orphans);
    contact_forces_destroy(&c->forces);
}

dem_status contact_set_create(contact_set *c, const forces *acting, const contact_rule *rule)
{
    *c = (contact_set){.scene = {acting->model, acting, *rule}, .surface = &acting->model->surface};
    dem_status status = list_candidates(c, &c->scene);
    if (status == DEM_OK) status = ledger_create(&c->ledger, acting->model->obstacles.n);
    if (status != DEM_OK) contact_set_destroy(c);
    return status;
}

void contact_set_destroy(contact_set *c)
{
    free_candidates(c);
    ledger_destroy(&c->ledger);
    *c = (contact_set){0};
}

/* ---- another surface ---- */

/* The place on the boundary remains its own. If it goes on otherwise there, what touches the ends may too: clearance is
 * unknown. */
void contact_set_become(contact_set *c, dem_index k, const contact_candidate *was)
{
    contact_candidate *candidate = &c->list[k];
    const dem_index previous = candidate->previous, next = candidate->next;
    *candidate = *was;
    if (previous != was->previous || next != was->next) candidate_forget_clearance(candidate);
    candidate->previous = previous;
    candidate->next = next;
}

/* The forces go along as they were last solved for. */
static void carry_over(const contact_set *from, dem_index was, contact_set *to, dem_index k)
{
    contact_set_become(to, k, &from->list[was]);
    for (int q = 0; q < 2; q++) to->forces.force[k][q] = from->forces.force[was][q];
}

/* A new edge is behind what its nodes are behind; of a new node that is not known without a state. */
static void begin(contact_set *c, dem_index k)
{
    contact_candidate *edge = &c->list[k];
    edge->is_new = !candidate_is_edge(edge);
    c->has_new = c->has_new || edge->is_new;
    if (edge->is_new) return;
    const dem_index ends[2] = {c->of_node[edge->node], c->of_node[edge->other]};
    for (int e = 0; e < 2; e++)
        if (ends[e] >= 0) edge->behind[e] = c->list[ends[e]].behind[0];
}

/* Adds a candidate to the orphans unless it is one of the surface. */
static void keep_orphan(contact_set *next, const contact_candidate *was)
{
    if (was->n_closed > 0 && contact_set_find(next, candidate_key(was)) < 0) next->orphans[next->n_orphans++] = *was;
}

/* Those that have not been released yet come first; one whose surface has come back is none. */
static dem_status list_orphans(const contact_set *c, contact_set *next)
{
    dem_index most = c->n_orphans;
    for (dem_index k = 0; k < c->n; k++) most += c->list[k].n_closed > 0;
    next->orphans = malloc(((size_t)most + 1) * sizeof *next->orphans);
    CHECK(next->orphans != NULL, DEM_ERROR_MEMORY, "out of memory for contacts that go with their surface");
    for (dem_index k = 0; k < c->n_orphans; k++) keep_orphan(next, &c->orphans[k]);
    for (dem_index k = 0; k < c->n; k++) keep_orphan(next, &c->list[k]);
    return DEM_OK;
}

/* The new set is complete before the old one is given up, so that after a failure nothing has changed. Ledger and scene
 * are handed on, not copied. */
dem_status contact_set_follow_surface(contact_set *c, const surface *to)
{
    contact_set next = {.scene = c->scene,
                        .surface = to,
                        .ledger = c->ledger,
                        .projected = c->projected,
                        .has_new = c->has_new,
                        .burials = c->burials};
    dem_status status = list_candidates(&next, &c->scene);
    if (status == DEM_OK) status = list_orphans(c, &next);
    for (dem_index k = 0; k < next.n && status == DEM_OK; k++) {
        const dem_index was = contact_set_find(c, candidate_key(&next.list[k]));
        if (was >= 0)
            carry_over(c, was, &next, k);
        else
            begin(&next, k);
    }
    if (status == DEM_OK) status = contact_set_regroup(&next);
    free_candidates(status == DEM_OK ? c : &next);
    if (status != DEM_OK) return status;
    *c = next;
    contact_set_count_behind(c);
    return DEM_OK;
}

void contact_set_count_behind(contact_set *c)
{
    c->ledger.counts.behind = 0;
    for (dem_index k = 0; k < c->surface->n_nodes; k++) c->ledger.counts.behind += c->list[k].behind[0] >= 0;
}

static void note_burial(contact_burials *b, dem_index node, scene_state state)
{
    if (b->n++ > 0) return;
    b->node = node;
    b->t = state.t;
    vec2_put(b->x, 0, vec2_at(state.x, node));
}

/* What is not as deep as an impact is, takes one. */
static void look_at_new(contact_set *c, dem_index k, scene_state state)
{
    contact_candidate *candidate = &c->list[k];
    const candidate_positions spot = candidate_place(candidate, state.t, state.x);
    const contact_gap gap = candidate_gap(&c->scene, candidate, &spot);
    candidate->is_new = false;
    if (gap.distance >= -c->scene.rule.penetration_tolerance) return;
    contact_set_pass_behind(c, k, surface_obstacle(&c->scene, (surface_feature){SURFACE_SEGMENT, gap.feature}));
    note_burial(&c->burials, candidate->node, state);
}

void contact_set_look_at_new(contact_set *c, scene_state state)
{
    for (dem_index k = 0; k < c->surface->n_nodes && c->has_new; k++)
        if (c->list[k].is_new) look_at_new(c, k, state);
    c->has_new = false;
}

/* ---- what is beside a candidate ---- */

dem_index contact_set_find(const contact_set *c, contact_key key)
{
    if (key.other < 0) return c->of_node[key.node];
    for (contact_edges e = contact_set_edges_at(c, key.node); contact_edges_next(&e);)
        if (contact_key_equal(candidate_key(&c->list[e.k]), key)) return e.k;
    return -1;
}

/* An impact of a group may move nodes of contacts that are coupled by further edges; those are found by their group,
 * which is in the neighbourhood as a whole. */
dem_index contact_set_seeds(const contact_set *c, dem_index k, dem_index *nodes, dem_index capacity)
{
    const contact_candidate *candidate = &c->list[k];
    const dem_index own[2] = {candidate->node, candidate->other};
    dem_index n = 0;
    for (int e = 0; e < (candidate_is_edge(candidate) ? 2 : 1); e++) {
        if (n < capacity) nodes[n] = own[e];
        n++;
        for (contact_edges p = contact_set_edges_at(c, own[e]); contact_edges_next(&p);)
            for (int end = 0; end < 2; end++, n++)
                if (n < capacity) nodes[n] = end == 0 ? c->list[p.k].node : c->list[p.k].other;
    }
    return n;
}

/* Whether an edge at the node, other than candidate k, has closed contacts. */
static bool edge_closed(const contact_set *c, dem_index node, dem_index k)
{
    for (contact_edges e = contact_set_edges_at(c, node); contact_edges_next(&e);)
        if (e.k != k && c->list[e.k].n_closed > 0) return true;
    return false;
}

static bool node_closed(const contact_set *c, dem_index node)
{
    return c->of_node[node] >= 0 && c->list[c->of_node[node]].n_closed > 0;
}

/* A node is in contacts of its edges, an edge also in those of its nodes. */
bool contact_set_coupled(const contact_set *c, dem_index k)
{
    const contact_candidate *s = &c->list[k];
    if (!candidate_is_edge(s)) return edge_closed(c, s->node, k);
    return edge_closed(c, s->node, k) || edge_closed(c, s->other, k) || node_closed(c, s->node) ||
           node_closed(c, s->other);
}

/* Gaps leave out what is behind; so clearances measured before no longer hold. */
void contact_set_pass_behind(contact_set *c, dem_index k, dem_index obstacle)
{
    const dem_index node = c->list[k].node;
    c->ledger.counts.behind += obstacle >= 0 ? 1 : -1;
    c->list[k].behind[0] = obstacle;
    candidate_forget_clearance(&c->list[k]);
    for (contact_edges e = contact_set_edges_at(c, node); contact_edges_next(&e);) {
        contact_candidate *edge = &c->list[e.k];
        edge->behind[edge->node == node ? 0 : 1] = obstacle;
        candidate_forget_clearance(edge);
    }
}

/* Whether an edge at the node, other than candidate k, has closed a contact with the vertex. */
static bool shared(const contact_set *c, dem_index node, dem_index k, dem_index feature)
{
    for (contact_edges e = contact_set_edges_at(c, node); contact_edges_next(&e);)
        if (e.k != k && candidate_point_on(&c->list[e.k], feature) >= 0) return true;
    return false;
}

/* Marks the contacts of corners: both of a node on two segments, and those of a vertex with two edges that meet at it.
 * A contact that is no longer of a corner is at rest: it sticks if there is friction, else it slides either way. */
static void mark_corners(contact_set *c, dem_index k)
{
    contact_candidate *candidate = &c->list[k];
    for (int q = 0; q < candidate->n_closed; q++) {
        contact_point *point = &candidate->closed[q];
        const bool held = candidate_is_edge(candidate) ? shared(c, candidate->node, k, point->feature) ||
                                                             shared(c, candidate->other, k, point->feature)
                                                       : candidate->n_closed == 2;
        if (point->held && !held)
            point->slide = contact_point_friction(&c->scene, candidate, point->feature) > 0.0 ? 0 : 1;
        if (held) point->slide = 1;
        point->held = held;
    }
}

/* The same for an edge and those that share a node with it, which may be of one corner with it. */
static void mark_around(contact_set *c, dem_index k)
{
    const dem_index nodes[2] = {c->list[k].node, c->list[k].other};
    for (int n = 0; n < 2; n++)
        for (contact_edges e = contact_set_edges_at(c, nodes[n]); contact_edges_next(&e);) mark_corners(c, e.k);
}

dem_status contact_set_regroup(contact_set *c)
{
    for (dem_index k = 0; k < c->n; k++) mark_corners(c, k);
    return contact_forces_regroup(&c->forces);
}

dem_status contact_set_regroup_some(contact_set *c, const dem_index *changed, dem_index n)
{
    for (dem_index m = 0; m < n; m++)
        if (candidate_is_edge(&c->list[changed[m]]))
            mark_around(c, changed[m]);
        else
            mark_corners(c, changed[m]);
    return contact_forces_regroup_some(&c->forces, changed, n);
}

dem_status contact_set_close(contact_set *c, dem_index k, contact_point point)
{
    contact_candidate *candidate = &c->list[k];
    candidate->closed[candidate->n_closed++] = point;
    candidate_forget_clearance(candidate);
    return contact_set_regroup_some(c, &k, 1);
}

/* The other contact, if there is one, moves up. */
dem_status contact_set_open(contact_set *c, dem_index k, int q)
{
    contact_candidate *candidate = &c->list[k];
    if (q == 0) candidate->closed[0] = candidate->closed[1];
    candidate->n_closed--;
    candidate_forget_clearance(candidate);
    return contact_set_regroup_some(c, &k, 1);
}

/* Nodes are moved one at a time: the energy of each shift counts with the others where they are then. */
void contact_set_move(contact_set *c, dem_index i, vec2 shift, double *x)
{
    const double before = forces_node_energy(c->scene.forces, i, x);
    vec2_put(x, i, vec2_add(vec2_at(x, i), shift));
    exact_sum_add(&c->ledger.projection, forces_node_energy(c->scene.forces, i, x) - before);
}

void contact_set_store_forces(contact_set *c, dem_index k)
{
    for (int q = 0; q < c->list[k].n_closed; q++) {
        c->list[k].closed[q].force = c->forces.force[k][q].normal;
        c->list[k].closed[q].friction = c->forces.force[k][q].tangent;
    }
}

void contact_set_solve_forces(contact_set *c, dem_index k, scene_state state)
{
    contact_forces_solve(&c->forces, c->forces.group[k], state);
    contact_set_store_forces(c, k);
}

void contact_set_solve_all(contact_set *c, scene_state state)
{
    for (dem_index g = 0; g < c->forces.n_groups; g++) contact_forces_solve(&c->forces, c->forces.groups[g], state);
}

/* After a failure of the external force, or of the motion of an obstacle, the contact forces would be wrong: the last
 * ones are kept. */
void contact_set_store_all(contact_set *c)
{
    if (external_force_failed(c->scene.forces->external) || surface_failed(&c->scene)) return;
    const contact_forces *r = &c->forces;
    for (dem_index g = 0; g < r->n_groups; g++)
        for (dem_index k = r->groups[g]; k >= 0; k = r->next[k]) contact_set_store_forces(c, k);
}

/* What the stop gave to a contact: its impulse, and the energy -J.(v + v')/2 that this takes, J. */
static double note_stop(const contact_set *c, dem_index k, int q, scene_state state)
{
    contact_impact *impact = &c->impacts[k].of[q];
    const contact_frame f = contact_frame_at(&c->scene, &c->list[k], q, state);
    const contact_force got = c->forces.force[k][q];
    impact->stop = vec2_along(vec2_scale(got.normal, f.normal), got.tangent, f.tangent);
    return -0.5 * vec2_dot(impact->stop, vec2_add(impact->unstopped, f.velocity));
}

/* Frames before and after the stop differ in velocity only. */
double contact_set_stop(contact_set *c, dem_index group, const contact_instant *now)
{
    contact_forces *r = &c->forces;
    const scene_state state = instant_state(now);
    double energy = 0.0;
    for (dem_index k = group; k >= 0; k = r->next[k])
        for (int q = 0; q < c->list[k].n_closed; q++)
            c->impacts[k].of[q].unstopped = contact_frame_at(&c->scene, &c->list[k], q, state).velocity;
    contact_forces_stop(r, group, state, now->v);
    for (dem_index k = group; k >= 0; k = r->next[k])
        for (int q = 0; q < c->list[k].n_closed; q++) energy += note_stop(c, k, q, state);
    return energy;
}

/* Friction takes the power -T v_t, >= 0 as it opposes the sliding; one that sticks takes none. The obstacle does the
 * work F.w with all of the force. */
contact_contribution contact_set_contribution(const contact_set *c, dem_index k, int q, scene_state state)
{
    const contact_candidate *candidate = &c->list[k];
    const contact_force *force = &c->forces.force[k][q];
    const contact_frame f = contact_frame_at(&c->scene, candidate, q, state);
    const vec2 along = vec2_scale(force->tangent, f.tangent);
    const bool slides = candidate->closed[q].slide != 0;
    contact_contribution out = {
        .obstacle = surface_obstacle(&c->scene, contact_point_feature(candidate, candidate->closed[q].feature)),
        .force = vec2_along(along, force->normal, f.normal),
        .friction = along,
        .power = slides ? -force->tangent * vec2_dot(f.velocity, f.tangent) : 0.0};
    if (surface_speed(&c->scene) > 0.0) out.work = vec2_dot(out.force, f.wall);
    return out;
}

/* Velocity before and after is the present one, until an impact puts its own in place. Reports have velocities as they
 * are, not relative to the wall. */
static dem_event event_of(const contact_set *c, const contact_candidate *candidate, dem_index feature,
                          dem_event_kind kind, const contact_instant *now)
{
    const contact_frame f = contact_frame_on(&c->scene, candidate, feature, instant_state(now));
    const surface_feature on = contact_point_feature(candidate, feature);
    const vec2 v = contact_frame_velocity(&f, now->v);
    const vec2 at =
        candidate_is_edge(candidate) ? surface_vertex_at(&c->scene, feature, now->t) : vec2_at(now->x, candidate->node);
    dem_event event = {.struct_size = sizeof event,
                       .t = now->t,
                       .kind = kind,
                       .node = model_node(c->scene.model, candidate->node),
                       .other = candidate_is_edge(candidate) ? model_node(c->scene.model, candidate->other) : -1,
                       .weight = candidate_is_edge(candidate) ? f.place : 0.0,
                       .body = c->scene.model->lattice.body[candidate->node],
                       .other_body = -1,
                       .obstacle = surface_obstacle(&c->scene, on),
                       .segment = surface_segment_index(&c->scene, on),
                       .x = {at.x, at.y},
                       .normal = {f.normal.x, f.normal.y},
                       .before = {v.x, v.y},
                       .after = {v.x, v.y}};
    const int q = candidate_point_on(candidate, feature);
    if (q >= 0) event.state = contact_point_state(&candidate->closed[q]);
    return event;
}

dem_event contact_set_event(const contact_set *c, dem_index k, dem_index feature, dem_event_kind kind,
                            const contact_instant *now)
{
    return event_of(c, &c->list[k], feature, kind, now);
}

/* They have no state any more, as a contact that has opened. */
void contact_set_release_orphans(contact_set *c, contact_instant *now)
{
    for (dem_index k = 0; k < c->n_orphans; k++) {
        const contact_candidate *was = &c->orphans[k], open = candidate_reset(was);
        for (int q = 0; q < was->n_closed; q++) {
            const dem_event event = event_of(c, &open, was->closed[q].feature, DEM_EVENT_RELEASE, now);
            ledger_enter(&c->ledger, &event, now);
        }
    }
    c->n_orphans = 0;
}

void contact_set_push(const contact_set *c, const contact_frame *f, vec2 impulse, double *v)
{
    contact_nodes_push(&f->nodes, c->scene.model->inverse_mass, 1.0, impulse, v);
}

/* Without friction all of it counts as normal, so that rounding leaves no friction in the sums. */
void contact_set_add_impulse(contact_set *c, dem_index obstacle, vec2 impulse, vec2 normal, vec2 carried)
{
    const contact_law law = contact_law_of(&c->scene, obstacle);
    const bool smooth = law.friction == 0.0 && law.friction_law == DEM_FRICTION_COULOMB;
    const vec2 along = smooth ? impulse : vec2_scale(vec2_dot(impulse, normal), normal);
    ledger_add_impulse(&c->ledger, obstacle, impulse, vec2_sub(impulse, along));
    exact_sum_add(&c->ledger.work, vec2_dot(impulse, carried));
}

void contact_set_enter_impact(contact_set *c, dem_event *event, double energy, vec2 impulse, contact_instant *now)
{
    event->impulse[0] = impulse.x;
    event->impulse[1] = impulse.y;
    event->energy = energy;
    exact_sum_add(&c->ledger.impact, energy);
    ledger_enter(&c->ledger, event, now);
}
