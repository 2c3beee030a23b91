/* SPDX-License-Identifier: BSD-3-Clause */
#include "material.h"

#include "conditional_keys.h"

#include <stdio.h>
#include <string.h>

enum { MATERIALS_LISTED = 5 };

const schema_instance *material_find(const schema_deck *groups, const char *name)
{
    for (size_t k = 0; k < schema_count(groups, "material"); k++) {
        const schema_instance *material = schema_get(groups, "material", k);
        if (schema_is(material, "name", name)) return material;
    }
    return NULL;
}

dem_material material_of(const schema_deck *groups, const schema_instance *user)
{
    const schema_instance *m = material_find(groups, schema_text(user, "material"));
    const bool coupled = schema_is(m, "springs", "coupled") && !schema_given(m, "bond_stiffness");
    return (dem_material){.struct_size = sizeof(dem_material),
                          .youngs_modulus = schema_real(m, "youngs_modulus"),
                          .bond_stiffness = schema_real(m, "bond_stiffness"),
                          .poissons_ratio = schema_real(m, "poissons_ratio"),
                          .plane = schema_is(m, "plane", "strain") ? DEM_PLANE_STRAIN : DEM_PLANE_STRESS,
                          .density = schema_real(m, "density"),
                          .thickness = schema_real(m, "thickness"),
                          .guard = schema_real(m, "guard"),
                          .damping_time = schema_real(m, "damping_time"),
                          .springs = coupled ? DEM_SPRINGS_COUPLED : DEM_SPRINGS_INDEPENDENT,
                          .strength = schema_real(m, "strength"),
                          .critical_stretch = schema_real(m, "critical_stretch"),
                          .fracture_energy = schema_real(m, "fracture_energy"),
                          .compressive_strength = schema_real(m, "compressive_strength"),
                          .stress_average = schema_is(m, "stress_average", "element") ? DEM_STRESS_AVERAGE_ELEMENT
                                                                                      : DEM_STRESS_AVERAGE_CORNERS};
}

/* ---- checks ---- */

static const conditional_key limits[] = {{"strength", "stress", false},
                                         {"compressive_strength", "stress", false},
                                         {"fracture_energy", "stress", false},
                                         {"stress_average", "stress", false},
                                         {"critical_stretch", "stretch", true}};
static const conditional_keys by_fracture = {
    .group = "material", .by = "fracture", .keys = limits, .n = sizeof limits / sizeof *limits};

static bool has_faulty_name(const schema_deck *groups)
{
    for (size_t k = 0; k < schema_count(groups, "material"); k++)
        if (schema_value_of(schema_get(groups, "material", k), "name")->faulty) return true;
    return false;
}

/* Writes " (did you mean 'x'?)" or what names there are. */
static void hint(char *out, size_t size, const schema_deck *groups, const char *name)
{
    const char *names[64];
    size_t n = 0, nearest, length = 0;
    const size_t count = schema_count(groups, "material");
    for (; n < count && n < sizeof names / sizeof *names; n++)
        names[n] = schema_text(schema_get(groups, "material", n), "name");
    if (schema_nearest(name, names, n, &nearest)) {
        (void)snprintf(out, size, " (did you mean '%s'?)", names[nearest]);
        return;
    }
    for (size_t k = 0; k < n && k < MATERIALS_LISTED; k++)
        length += (size_t)snprintf(out + length, size - length, "%s'%.40s'", k == 0 ? "; known: " : ", ", names[k]);
    if (count > MATERIALS_LISTED) (void)snprintf(out + length, size - length, ", ...");
}

void material_check_user(const schema_deck *groups, const schema_instance *user, namelist_errors *errors)
{
    const schema_value *value = schema_value_of(user, "material");
    const char *name = schema_text(user, "material");
    char known[64 * (MATERIALS_LISTED + 1)];
    if (value->faulty || value->count == 0 || groups->misspelt || has_faulty_name(groups)) return;
    if (schema_count(groups, "material") == 0 || material_find(groups, name) != NULL) return;
    hint(known, sizeof known, groups, name);
    namelist_errors_add(errors, value->place, "there is no material '%.40s'%s%s", name,
                        value->given ? "" : ", the default of 'material' in &body", known);
}

/* E or E_ij; with that no nu. */
static void check_stiffness(const schema_instance *material, namelist_errors *errors)
{
    static const char *const unused[] = {"youngs_modulus", "poissons_ratio", "plane", "springs"};
    const schema_value *modulus = schema_value_of(material, "youngs_modulus"),
                       *bond = schema_value_of(material, "bond_stiffness");
    if (!bond->given && !modulus->given && !modulus->faulty && !bond->faulty)
        namelist_errors_add(errors, material->place, "'youngs_modulus' or 'bond_stiffness' in &material must be given");
    for (size_t k = 0; bond->given && k < sizeof unused / sizeof *unused; k++)
        if (schema_given(material, unused[k]))
            namelist_errors_add(errors, schema_place(material, unused[k]),
                                "'%s' in &material does not go with 'bond_stiffness'", unused[k]);
}

/* By stress: one of both at least. A fracture energy needs E. */
static void check_limits(const schema_instance *material, namelist_errors *errors)
{
    const schema_value *strength = schema_value_of(material, "strength"),
                       *energy = schema_value_of(material, "fracture_energy");
    if (schema_is(material, "fracture", "stress") && !strength->given && !energy->given && !strength->faulty &&
        !energy->faulty)
        namelist_errors_add(errors, material->place,
                            "'strength' or 'fracture_energy' in &material must be given for fracture 'stress'");
    if (energy->given && schema_given(material, "bond_stiffness"))
        namelist_errors_add(errors, energy->place,
                            "'fracture_energy' in &material does not go with 'bond_stiffness': it needs "
                            "'youngs_modulus'");
}

/* It is a limit of brittle triangles beside their strength, and not below that. */
static void check_compressive(const schema_instance *material, namelist_errors *errors)
{
    const schema_value *strength = schema_value_of(material, "strength"),
                       *energy = schema_value_of(material, "fracture_energy"),
                       *compressive = schema_value_of(material, "compressive_strength");
    const double least = schema_real(material, "strength"), got = schema_real(material, "compressive_strength");
    if (!compressive->given || compressive->faulty || !schema_is(material, "fracture", "stress")) return;
    if (energy->given)
        namelist_errors_add(errors, compressive->place,
                            "'compressive_strength' in &material does not go with 'fracture_energy', which is for "
                            "bodies that break in tension: leave one of them out");
    else if (!strength->given && !strength->faulty)
        namelist_errors_add(errors, compressive->place,
                            "'compressive_strength' in &material needs 'strength', that in tension");
    else if (strength->given && !strength->faulty && got < least)
        namelist_errors_add(errors, compressive->place,
                            "'compressive_strength' in &material must be >= 'strength', %g Pa, got %g Pa", least, got);
}

/* Brittle triangles that their own stress breaks have a toughness that depends on direction and mesh. */
static void check_average(const schema_instance *material, namelist_errors *errors)
{
    const schema_value *strength = schema_value_of(material, "strength"),
                       *energy = schema_value_of(material, "fracture_energy");
    if (!schema_is(material, "stress_average", "element") || !schema_is(material, "fracture", "stress")) return;
    if (strength->faulty || energy->faulty || (strength->given && energy->given)) return;
    namelist_errors_add(errors, schema_place(material, "stress_average"),
                        "'stress_average' in &material is 'element' only with both 'strength' and 'fracture_energy'");
}

static void check_name(const schema_deck *groups, const schema_instance *material, namelist_errors *errors)
{
    const schema_instance *first = material_find(groups, schema_text(material, "name"));
    if (first != material && !has_faulty_name(groups))
        namelist_errors_add(errors, schema_place(material, "name"), "material '%.40s' is given twice, first in line %d",
                            schema_text(material, "name"), first->place.line);
}

/* The table's range is that of plane stress. */
static void check_ratio(const schema_instance *material, namelist_errors *errors)
{
    const double ratio = schema_real(material, "poissons_ratio");
    if (schema_is(material, "plane", "strain") && ratio >= 0.5)
        namelist_errors_add(errors, schema_place(material, "poissons_ratio"),
                            "'poissons_ratio' in &material must be < 0.5 in plane strain, got %g", ratio);
}

void material_check_all(const schema_deck *groups, namelist_errors *errors)
{
    for (size_t k = 0; k < schema_count(groups, "material"); k++) {
        const schema_instance *material = schema_get(groups, "material", k);
        check_name(groups, material, errors);
        check_stiffness(material, errors);
        check_ratio(material, errors);
        conditional_keys_check(material, &by_fracture, errors);
        check_limits(material, errors);
        check_compressive(material, errors);
        check_average(material, errors);
    }
}

void material_drop_unused(schema_deck *groups)
{
    conditional_keys_drop(groups, &by_fracture);
    for (size_t i = 0; i < groups->n_instances; i++) {
        schema_instance *material = &groups->instances[i];
        if (strcmp(material->group->name, "material") != 0 || !schema_given(material, "bond_stiffness")) continue;
        schema_drop(material, "poissons_ratio");
        schema_drop(material, "plane");
        schema_drop(material, "springs");
    }
}
