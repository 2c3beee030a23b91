/* SPDX-License-Identifier: BSD-3-Clause */
#include "weibull_keys.h"

#include <string.h>

#include "conditional_keys.h"
#include "material.h"

static const conditional_key all[] = {{"weibull", "stress, stretch", false},
                                      {"weibull_volume", "stress, stretch", false},
                                      {"strength_seed", "stress, stretch", false}};
static const conditional_keys by_fracture = {
    .group = "material", .by = "fracture", .keys = all, .n = sizeof all / sizeof *all};

/* Those beside 'weibull' itself. */
static void check_material(const schema_instance *material, namelist_errors *errors)
{
    const schema_value *shape = schema_value_of(material, "weibull"),
                       *volume = schema_value_of(material, "weibull_volume");
    if (schema_is(material, "fracture", "none") || shape->faulty) return;
    if (shape->given && !volume->given && !volume->faulty)
        namelist_errors_add(
            errors, shape->place,
            "'weibull' in &material needs 'weibull_volume', the volume, m^3, of the pieces on which '%s' "
            "was measured",
            schema_is(material, "fracture", "stress") ? "strength" : "critical_stretch");
    if (shape->given && schema_is(material, "fracture", "stress") && !schema_given(material, "strength") &&
        !schema_value_of(material, "strength")->faulty)
        namelist_errors_add(errors, shape->place,
                            "'weibull' in &material needs 'strength', which scatters; that of 'fracture_energy' alone "
                            "is a number of the mesh");
    for (size_t k = 1; k < by_fracture.n && !shape->given; k++)
        if (schema_given(material, all[k].key))
            namelist_errors_add(errors, schema_place(material, all[k].key),
                                "'%s' in &material is not used without 'weibull'", all[k].key);
}

void weibull_keys_check(const schema_deck *groups, namelist_errors *errors)
{
    for (size_t k = 0; k < schema_count(groups, "material"); k++) {
        conditional_keys_check(schema_get(groups, "material", k), &by_fracture, errors);
        check_material(schema_get(groups, "material", k), errors);
    }
}

void weibull_keys_drop_unused(schema_deck *groups)
{
    for (size_t i = 0; i < groups->n_instances; i++) {
        schema_instance *group = &groups->instances[i];
        if (strcmp(group->group->name, "material") == 0 && !schema_given(group, "weibull"))
            schema_drop(group, "strength_seed");
    }
}

dem_weibull weibull_keys_law(const schema_deck *groups, const schema_instance *user)
{
    const schema_instance *material = material_find(groups, schema_text(user, "material"));
    return (dem_weibull){.struct_size = sizeof(dem_weibull),
                         .shape = schema_real(material, "weibull"),
                         .volume = schema_real(material, "weibull_volume"),
                         .seed = (uint64_t)schema_real(material, "strength_seed")};
}
