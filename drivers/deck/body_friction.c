/* SPDX-License-Identifier: BSD-3-Clause */
/* A file has no material, and may have several bodies: they all have the friction of &contact. */
#include "body_friction.h"

#include <stdlib.h>

#include "material.h"

static const schema_instance *contact_of(const schema_deck *groups)
{
    return schema_get(groups, "contact", 0);
}

void body_friction_check(const schema_deck *groups, namelist_errors *errors)
{
    if (!schema_is(contact_of(groups), "bodies", "none")) return;
    for (size_t k = 0; k < schema_count(groups, "material"); k++) {
        const schema_value *friction = schema_value_of(schema_get(groups, "material", k), "friction");
        if (friction->given)
            namelist_errors_add(errors, friction->place,
                                "'friction' in &material is not used by bodies 'none' in &contact");
    }
}

static bool any_material_has(const schema_deck *groups)
{
    bool any = false;
    for (size_t k = 0; k < schema_count(groups, "material"); k++)
        any = any || schema_given(schema_get(groups, "material", k), "friction");
    return any;
}

/* Of a &body. */
static double friction_of(const schema_deck *groups, const schema_instance *body)
{
    const schema_instance *material =
        schema_is(body, "shape", "file") ? NULL : material_find(groups, schema_text(body, "material"));
    const bool own = material != NULL && schema_given(material, "friction");
    return schema_real(own ? material : contact_of(groups), "friction");
}

bool body_friction_make(double **out, dem_options *options, const schema_deck *groups, const dem_lattice *l,
                        const placement *places)
{
    dem_index n = 0;
    *out = NULL;
    if (!any_material_has(groups)) return true;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->body[i] >= n) n = l->body[i] + 1;
    *out = calloc((size_t)n + 1, sizeof **out);
    if (*out == NULL) return false;
    for (size_t k = 0; k < schema_count(groups, "body"); k++)
        for (dem_index i = places[k].first; i < places[k].first + places[k].n_nodes; i++)
            (*out)[l->body[i]] = friction_of(groups, schema_get(groups, "body", k));
    options->body_friction = *out;
    options->n_body_frictions = n;
    return true;
}
