/* SPDX-License-Identifier: BSD-3-Clause */
/* The motions of &obstacle. `motion` lists the kinds, which add up; a velocity alone is a translation, as it was in
 * decks before there were other kinds. Fields of an obstacle have the names of their keys (dem_motion_field_at). */
#include "motion.h"

#include <string.h>

typedef struct motion_key {
    const char *key, *kind; /* "": of any kind */
    bool needed;            /* by the kind */
} motion_key;

static const motion_key keys[] = {{"velocity", "translate", true},
                                  {"amplitude", "oscillate", true},
                                  {"frequency", "oscillate", true},
                                  {"phase", "oscillate", false},
                                  {"pivot", "rotate", false},
                                  {"spin", "rotate", true},
                                  {"ramp", "", false}};

/* Whether a kind is one of the first n. */
static bool has_kind(const schema_value *motion, int n, const char *kind)
{
    for (int k = 0; k < n; k++)
        if (strcmp(motion->texts[k], kind) == 0) return true;
    return false;
}

/* Whether the obstacle moves by a kind, or by any (""). */
static bool moves_by(const schema_instance *obstacle, const char *kind)
{
    const schema_value *motion = schema_value_of(obstacle, "motion");
    const bool any = kind[0] == '\0';
    if (!motion->given) return (any || strcmp(kind, "translate") == 0) && schema_value_of(obstacle, "velocity")->given;
    return any ? motion->count > 1 || !has_kind(motion, motion->count, "fixed") : has_kind(motion, motion->count, kind);
}

static void check_key(const schema_instance *obstacle, const motion_key *row, namelist_errors *errors)
{
    const schema_value *value = schema_value_of(obstacle, row->key);
    const bool moves = moves_by(obstacle, row->kind);
    if (!moves && value->given && row->kind[0] == '\0')
        namelist_errors_add(errors, value->place, "'%s' in &obstacle is given without a motion", row->key);
    else if (!moves && value->given)
        namelist_errors_add(errors, value->place, "'%s' in &obstacle is given without motion = '%s'", row->key,
                            row->kind);
    if (moves && row->needed && !value->given && !value->faulty)
        namelist_errors_add(errors, obstacle->place, "'%s' in &obstacle must be given for motion '%s'", row->key,
                            row->kind);
}

void motion_check(const schema_instance *obstacle, namelist_errors *errors)
{
    const schema_value *motion = schema_value_of(obstacle, "motion");
    if (motion->faulty) return;
    if (motion->count > 1 && has_kind(motion, motion->count, "fixed"))
        namelist_errors_add(errors, motion->place, "'motion' in &obstacle has 'fixed' together with another kind");
    for (int k = 1; k < motion->count; k++)
        if (has_kind(motion, k, motion->texts[k]))
            namelist_errors_add(errors, motion->place, "'motion' in &obstacle has '%s' twice", motion->texts[k]);
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) check_key(obstacle, &keys[k], errors);
}

void motion_drop_unused(schema_deck *groups)
{
    for (size_t k = 0; k < groups->n_instances; k++) {
        schema_instance *group = &groups->instances[k];
        if (strcmp(group->group->name, "obstacle") != 0 || !schema_value_of(group, "motion")->given) continue;
        if (!moves_by(group, "translate")) schema_drop(group, "velocity");
    }
}

void motion_set(dem_obstacle *made, const schema_instance *obstacle)
{
    const dem_motion_field *field;
    for (dem_index k = 0; (field = dem_motion_field_at(k)) != NULL; k++) {
        const double *numbers = schema_reals(obstacle, field->name);
        if (numbers != NULL) memcpy((char *)made + field->offset, numbers, (size_t)field->n * sizeof *numbers);
    }
}
