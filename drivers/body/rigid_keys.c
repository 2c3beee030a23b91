/* SPDX-License-Identifier: BSD-3-Clause */
#include "rigid_keys.h"

#include <string.h>

bool rigid_keys_ask(const schema_instance *body)
{
    return schema_real(body, "rigid") != 0.0;
}

dem_index rigid_keys_node(const dem_lattice *lattice)
{
    for (dem_index i = 0; i < lattice->n_nodes && lattice->flags != NULL; i++)
        if (lattice->flags[i] & DEM_NODE_RIGID) return i;
    return -1;
}

/* The component of a velocity that a guide takes away, 0 or 1; -1 without a guide. */
static int across(const schema_instance *body)
{
    if (!schema_given(body, "guide") || schema_is(body, "guide", "none")) return -1;
    return schema_is(body, "guide", "x") ? 1 : 0;
}

static void check_guide(const schema_instance *body, namelist_errors *errors)
{
    const double *velocity = schema_reals(body, "velocity");
    const int gone = across(body);
    if (schema_value_of(body, "guide")->faulty || gone < 0) return;
    if (velocity != NULL && velocity[gone] != 0.0)
        namelist_errors_add(errors, schema_place(body, "velocity"),
                            "'velocity' in &body must be along its guide, '%s', got %g, %g", schema_text(body, "guide"),
                            velocity[0], velocity[1]);
    if (schema_real(body, "spin") != 0.0)
        namelist_errors_add(errors, schema_place(body, "spin"), "'spin' in &body does not go with 'guide', got %g",
                            schema_real(body, "spin"));
}

static void check_body(const schema_deck *groups, const schema_instance *body, namelist_errors *errors)
{
    const bool rigid = rigid_keys_ask(body);
    if (!rigid && schema_given(body, "guide") && !schema_value_of(body, "rigid")->faulty)
        namelist_errors_add(errors, schema_place(body, "guide"), "'guide' in &body is not used without 'rigid'");
    if (rigid && schema_is(schema_get(groups, "contact", 0), "bodies", "none"))
        namelist_errors_add(errors, schema_place(body, "rigid"),
                            "'rigid' in &body needs contact of bodies, but 'bodies' in &contact is 'none'");
    if (rigid) check_guide(body, errors);
}

/* Forces and tractions may act on rigid bodies. */
static void check_boundary(const schema_deck *groups, const schema_instance *boundary, namelist_errors *errors)
{
    const double body = schema_real(boundary, "body");
    const bool moves = !schema_is(boundary, "kind", "force") && !schema_is(boundary, "kind", "traction");
    if (!moves || schema_value_of(boundary, "kind")->faulty || body < 1.0) return;
    if (body <= (double)schema_count(groups, "body") && rigid_keys_ask(schema_get(groups, "body", (size_t)body - 1)))
        namelist_errors_add(errors, boundary->place,
                            "&boundary of kind '%s' is for body %.0f, which is rigid; 'guide' in &body says how it may "
                            "move",
                            schema_text(boundary, "kind"), body);
}

/* Where nothing is elastic nothing says how long steps may be. */
static void check_step(const schema_deck *groups, namelist_errors *errors)
{
    const schema_instance *solver = schema_get(groups, "solver", 0);
    bool all = schema_count(groups, "body") > 0;
    for (size_t k = 0; k < schema_count(groups, "body"); k++)
        all = all && rigid_keys_ask(schema_get(groups, "body", k));
    if (all && !schema_given(solver, "max_step") && !schema_given(solver, "fixed_step"))
        namelist_errors_add(errors, schema_place(schema_get(groups, "body", 0), "rigid"),
                            "'rigid' in &body: all bodies are rigid, so that 'max_step' or 'fixed_step' in &solver "
                            "must be given");
}

void rigid_keys_check(const schema_deck *groups, namelist_errors *errors)
{
    check_step(groups, errors);
    for (size_t k = 0; k < schema_count(groups, "body"); k++) check_body(groups, schema_get(groups, "body", k), errors);
    for (size_t k = 0; k < schema_count(groups, "boundary"); k++)
        check_boundary(groups, schema_get(groups, "boundary", k), errors);
}

void rigid_keys_drop_unused(schema_deck *groups)
{
    for (size_t i = 0; i < groups->n_instances; i++) {
        schema_instance *group = &groups->instances[i];
        if (strcmp(group->group->name, "body") != 0 || rigid_keys_ask(group)) continue;
        schema_drop(group, "rigid");
        schema_drop(group, "guide");
    }
}

dem_status rigid_keys_apply(dem_lattice *lattice, const schema_instance *body)
{
    const int gone = across(body);
    const dem_guide guide = gone < 0 ? DEM_GUIDE_NONE : (gone == 1 ? DEM_GUIDE_X : DEM_GUIDE_Y);
    return rigid_keys_ask(body) ? dem_lattice_stiffen(lattice, guide) : DEM_OK;
}
