/* SPDX-License-Identifier: BSD-3-Clause */
/* It is about the contact of bodies, which rigid ones cannot do without, or about what is beyond its limit at the
 * start, which lattice files bring along. The library counts bodies from 0. */
#include "refusal.h"

#include <stdio.h>

#include "ask.h"
#include "copies.h"
#include "deck_numbers.h"
#include "outcome.h"

/* Which key a refusal is about, and what helps. */
typedef struct advice {
    namelist_place place;
    const char *remedy;
} advice;

/* Whether the model would be simulated if its bodies did not touch, and so had no friction. */
static bool goes_without_contact(const dem_model *model, dem_options options)
{
    dem_simulation *simulation = NULL;
    options.bodies = DEM_BODIES_NONE;
    options.contact_friction = 0.0;
    options.n_body_frictions = 0;
    const bool goes = dem_simulation_create(&simulation, model, &options) == DEM_OK;
    dem_simulation_destroy(simulation);
    return goes;
}

static advice advise(const deck *d, const schema_instance *body, const dem_model *model, const dem_options *options)
{
    const namelist_place bodies = schema_place(schema_get(&d->groups, "contact", 0), "bodies");
    if (lattice_facts_any_rigid(&d->facts)) return (advice){bodies, ""};
    if (options->bodies != DEM_BODIES_NONE && goes_without_contact(model, *options))
        return (advice){bodies, "; bodies = 'none' in &contact lets bodies overlap"};
    return (advice){schema_place(body, "file"),
                    "; larger limits, or a 'position' that strains it less, are needed in its file"};
}

/* Where the bodies of the deck are those of the model, they get the numbers of the deck. */
void refusal_explain(namelist_errors *errors, const deck *d, const dem_model *model, const dem_options *options)
{
    const schema_deck *groups = &d->groups;
    char reason[OUTCOME_MESSAGE], message[OUTCOME_MESSAGE];
    (void)snprintf(reason, sizeof reason, "%s", dem_status_message()); /* before another simulation is tried */
    const bool known = ask_sizes(model).n_bodies == (dem_index)copies_total(groups);
    const schema_instance *body = known ? deck_numbers_body(reason, groups) : schema_get(groups, "body", 0);
    const advice of = advise(d, body, model, options);
    if (known) deck_numbers_translate(message, sizeof message, reason, groups);
    namelist_errors_add(errors, of.place, "%s%s%s", known ? message : reason,
                        known ? "" : " (bodies are counted from 0 here)", of.remedy);
}
