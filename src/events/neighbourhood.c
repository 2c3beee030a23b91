/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the nodes round an event, breadth first: ring 0 are the nodes that the event may change at once, ring r + 1 the
 * neighbours of ring r that are in no ring yet. Nodes that closed contacts tie together accelerate each other at once,
 * without a spring between them; a group of them belongs to the ring in which its first node is found. The forces on
 * these nodes are in src/forces/local_springs.c, the motion on them in local_correction.c. */
#include "events/neighbourhood.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

dem_status neighbourhood_create(neighbourhood *out, const state_layout *layout, const local_forces *f,
                                const constraints *c, int n_rings)
{
    neighbourhood b = {.layout = *layout, .n_rings = n_rings, .forces = f, .constraints = c};
    TRY(local_nodes_create(&b.nodes, layout->n_nodes, n_rings));
    *out = b;
    return DEM_OK;
}

void neighbourhood_destroy(neighbourhood *b)
{
    local_nodes_destroy(&b->nodes);
    free(b->groups);
    *b = (neighbourhood){0};
}

/* ---- rings ---- */

/* Lists a group with the ring in which it begins, unless it is listed. There are few: a search of the list is
 * enough. */
static dem_status note_group(neighbourhood *b, dem_index group, int ring, bool *is_new)
{
    *is_new = false;
    for (dem_index g = 0; g < b->n_groups; g++)
        if (b->groups[g].group == group) return DEM_OK;
    CHECK(grow_array((void **)&b->groups, &b->group_capacity, b->n_groups + 1, sizeof *b->groups), DEM_ERROR_MEMORY,
          "out of memory for what is near an event");
    b->groups[b->n_groups++] = (neighbourhood_group){group, ring};
    *is_new = true;
    return DEM_OK;
}

/* Adds the group of constraints at a node, with all its nodes. */
static dem_status add_group(neighbourhood *b, dem_index node, int ring)
{
    const constraints *c = b->constraints;
    const dem_index group = constraints_group_at(c, node);
    bool is_new;
    if (group < 0) return DEM_OK;
    TRY(note_group(b, group, ring, &is_new));
    return is_new ? c->each_node(c->self, group, local_nodes_add_to, &b->nodes) : DEM_OK;
}

/* Ends a ring: the groups of its nodes join it with all their nodes, which may bring further groups. `nodes->n` grows
 * meanwhile. The last ring, whose nodes are read but do not move, needs no groups. */
static dem_status close_ring(neighbourhood *b, int ring)
{
    local_nodes *nodes = &b->nodes;
    for (dem_index j = local_nodes_begin(nodes, ring); j < nodes->n && ring < nodes->n_rings; j++)
        TRY(add_group(b, nodes->list[j], ring));
    nodes->end[ring] = nodes->n;
    return DEM_OK;
}

/* Whether constraints hold none of the nodes that move. */
static bool are_free(const neighbourhood *b)
{
    const local_nodes *nodes = &b->nodes;
    for (dem_index j = 0; j < local_nodes_n_moving(nodes); j++)
        if (constraints_group_at(b->constraints, nodes->list[j]) >= 0) return false;
    return true;
}

/* The rings round a node as they were at an event before, if that is known. Groups change from event to event. */
static bool recall(neighbourhood *b, dem_index node)
{
    const local_forces *f = b->forces;
    b->nodes.n_rings = b->n_rings;
    if (f->recall == NULL || !f->recall(f->self, node, &b->nodes)) return false;
    if (are_free(b)) return true;
    local_nodes_clear(&b->nodes);
    return false;
}

/* Rings 0 to n_rings; then the forces list what acts between the nodes found. Before an event closed contacts at the
 * seeds are stopped, which changes velocities. */
static dem_status find_rings(neighbourhood *b, neighbourhood_seeds seeds)
{
    const local_forces *f = b->forces;
    local_nodes *nodes = &b->nodes;
    for (dem_index j = 0; j < seeds.n; j++) TRY(local_nodes_add(nodes, seeds.list[j]));
    nodes->n_rings = b->n_rings;
    TRY(close_ring(b, 0));
    if (seeds.by_forces && b->n_groups == 0) nodes->n_rings--;
    for (int ring = 1; ring <= nodes->n_rings; ring++) {
        TRY(f->add_neighbours(f->self, nodes, local_nodes_begin(nodes, ring - 1), nodes->end[ring - 1]));
        TRY(close_ring(b, ring));
    }
    return f->gather(f->self, nodes);
}

dem_status neighbourhood_gather(neighbourhood *b, neighbourhood_seeds seeds)
{
    const local_forces *f = b->forces;
    const bool is_impact = seeds.n == 1 && !seeds.by_forces;
    local_nodes_clear(&b->nodes);
    b->n_groups = 0;
    if (is_impact && recall(b, seeds.list[0])) return DEM_OK;
    TRY(find_rings(b, seeds));
    if (is_impact && f->keep != NULL && b->n_groups == 0) f->keep(f->self, seeds.list[0], &b->nodes);
    return DEM_OK;
}

/* An event opens and closes contacts only of nodes that are in the neighbourhood already, so nodes and rings stay; only
 * the groups on them are others. */
dem_status neighbourhood_regroup(neighbourhood *b)
{
    const local_nodes *nodes = &b->nodes;
    bool is_new;
    b->n_groups = 0;
    for (int ring = 0; ring < nodes->n_rings; ring++)
        for (dem_index j = local_nodes_begin(nodes, ring); j < nodes->end[ring]; j++) {
            const dem_index group = constraints_group_at(b->constraints, nodes->list[j]);
            if (group >= 0) TRY(note_group(b, group, ring, &is_new));
        }
    return DEM_OK;
}

/* ---- accelerations ---- */

/* From the local numbers to those of the lattice: the functions that see the state of the whole body read these nodes
 * there. */
void neighbourhood_put(const neighbourhood *b, const local_state *s, dem_index n, double *y)
{
    const state_layout *l = &b->layout;
    double *v = y + state_velocities(l);
    for (dem_index j = 0; j < n; j++) {
        const dem_index to = state_row(l, b->nodes.list[j]), from = state_row(l, j);
        state_copy_row(l, y + to, s->x + from);
        state_copy_row(l, v + to, s->v + from);
    }
}

/* Replaces the accelerations of nodes in groups by those that the closed contacts allow: each group is solved in the
 * state s->y, which leaves its nodes' accelerations in c->a. Those by forces have just been evaluated, and serve where
 * they are those that the group would have evaluated. */
static void constrain(neighbourhood *b, int ring, const local_state *s, double *a)
{
    const constraints *c = b->constraints;
    const state_layout *l = &b->layout;
    const dem_index *list = b->nodes.list;
    const constraint_free known = {b->nodes.number, b->nodes.end[ring], a};
    const bool are_known = b->forces->are_exact(b->forces->self);
    for (dem_index g = 0; g < b->n_groups; g++)
        if (b->groups[g].ring <= ring)
            c->solve(c->self, b->groups[g].group, (constraint_state){s->t, s->y}, are_known ? &known : NULL);
    for (dem_index j = 0; j < b->nodes.end[ring]; j++)
        if ((*c->group_at)[list[j]] >= 0) state_copy_row(l, a + state_row(l, j), *c->a + state_row(l, list[j]));
}

void neighbourhood_accelerate(neighbourhood *b, int ring, const local_state *s, double *a)
{
    b->forces->accelerate(b->forces->self, &b->nodes, ring, s, a);
    if (b->n_groups > 0) constrain(b, ring, s, a);
}
