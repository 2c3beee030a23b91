/* SPDX-License-Identifier: BSD-3-Clause */
/* Closed contacts as the constraints of src/events/constraints.h, by which the local correction solves groups of
 * contacts without knowing what a contact is. Each function hands on to contact_forces.c, contact_set.c or
 * impact_group.c. The quadratures that belong to contacts, impulses of obstacles and work of friction, get their rates
 * here too. */
#include "contact/contact_constraints.h"

#include "base/status.h"
#include "contact/impact_group.h"

static scene_state state_of(const contact_set *c, constraint_state at)
{
    return scene_state_at(&c->scene, at.t, at.y);
}

/* The nodes of a group; one that several of its contacts share comes several times. */
static dem_status contact_each_node(const void *self, dem_index group, dem_status (*add)(void *context, dem_index node),
                                    void *context)
{
    const contact_set *c = &((const automaton *)self)->set;
    const contact_forces *r = &c->forces;
    for (dem_index m = group; m >= 0; m = r->next[m]) {
        const contact_candidate *candidate = &c->list[m];
        TRY(add(context, candidate->node));
        if (candidate_is_edge(candidate)) TRY(add(context, candidate->other));
    }
    return DEM_OK;
}

static dem_index contact_groups_at(void *self, const dem_index *nodes, dem_index n, const dem_index **list)
{
    return contact_forces_groups_at(&((automaton *)self)->set.forces, nodes, n, list);
}

static dem_status contact_each_held(const void *self, dem_status (*add)(void *context, dem_index node), void *context)
{
    const contact_forces *r = &((const automaton *)self)->set.forces;
    for (dem_index g = 0; g < r->n_groups; g++) TRY(contact_each_node(self, r->groups[g], add, context));
    return DEM_OK;
}

static void contact_solve(void *self, dem_index group, constraint_state at, const constraint_free *known)
{
    contact_set *c = &((automaton *)self)->set;
    contact_forces_solve_free(&c->forces, group, state_of(c, at), known);
}

/* ---- rates ---- */

/* What one contact adds: force and friction to the rows of its obstacle, N, powers to the totals, W. */
static dem_status add_contribution(const contact_set *c, const contact_contribution *of, const constraint_rates *to)
{
    const state_layout *l = scene_layout(&c->scene);
    const double force[2] = {of->force.x, of->force.y}, friction[2] = {of->friction.x, of->friction.y};
    TRY(to->add(to->context, state_impulse(l, of->obstacle), force));
    TRY(to->add(to->context, state_friction_impulse(l, of->obstacle), friction));
    to->totals[STATE_FRICTION] += of->power;
    to->totals[STATE_OBSTACLE] += of->work;
    return DEM_OK;
}

static dem_status contact_add_rates(const void *self, dem_index group, constraint_state at, const constraint_rates *to)
{
    const contact_set *c = &((const automaton *)self)->set;
    const contact_forces *r = &c->forces;
    for (dem_index m = group; m >= 0; m = r->next[m])
        for (int q = 0; q < c->list[m].n_closed; q++) {
            const contact_contribution of = contact_set_contribution(c, m, q, state_of(c, at));
            TRY(add_contribution(c, &of, to));
        }
    return DEM_OK;
}

/* As the right-hand side does. The forces are then known to be those of the end of the step, unless its rigid bodies
 * are put back into their shapes. */
static void contact_add_all_rates(void *self, constraint_state at, double *a)
{
    automaton *c = self;
    automaton_add_rates(c, at.t, at.y, a);
    if (c->set.scene.model->rigid.n == 0) c->solved = at.t;
}

/* ---- the end of a step ---- */

/* Contacts are put back on their surfaces and stopped there; the ledger has both as projection and impact. */
static void contact_settle(void *self, dem_index group, double t, double *y)
{
    contact_set *c = &((automaton *)self)->set;
    contact_instant now = {t, y, y + state_velocities(scene_layout(&c->scene)), NULL, DEM_OK};
    (void)impact_group_project(c, group, &now);
    impact_group_stop(c, group, &now);
}

constraints contact_constraints_of(automaton *c)
{
    return (constraints){.self = c,
                         .group_at = &c->set.forces.at_node,
                         .a = &c->set.forces.a,
                         .each_node = contact_each_node,
                         .groups_at = contact_groups_at,
                         .each_held = contact_each_held,
                         .solve = contact_solve,
                         .add_rates = contact_add_rates,
                         .settle = contact_settle,
                         .add_all_rates = contact_add_all_rates};
}
