/* SPDX-License-Identifier: BSD-3-Clause */
/* The motions of &obstacle. `motion` lists the kinds, which add up; a velocity alone is a translation, as it was in
 * decks before there were other kinds. Fields of an obstacle have the names of their keys (dem_motion_field_at). */
#include "motion.h"

#include <stdint.h>
#include <stdlib.h>
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

/* Whether the obstacle moves by a kind, or by any (""). */
static bool moves_by(const schema_instance *obstacle, const char *kind)
{
    const schema_value *motion = schema_value_of(obstacle, "motion");
    const bool any = kind[0] == '\0';
    if (!motion->given) return (any || strcmp(kind, "translate") == 0) && schema_value_of(obstacle, "velocity")->given;
    for (int k = 0; k < motion->count; k++)
        if (any ? strcmp(motion->texts[k], "fixed") != 0 : strcmp(motion->texts[k], kind) == 0) return true;
    return false;
}

static bool is_fixed(const schema_value *motion)
{
    for (int k = 0; k < motion->count; k++)
        if (strcmp(motion->texts[k], "fixed") == 0) return true;
    return false;
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
    if (motion->count > 1 && is_fixed(motion))
        namelist_errors_add(errors, motion->place, "'motion' in &obstacle has 'fixed' together with another kind");
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

/* A copy with points of its own; those are NULL when memory runs out. */
static dem_obstacle still_one(const dem_obstacle *moving)
{
    double *points = malloc(2 * (size_t)moving->n_points * sizeof *points);
    if (points != NULL) (void)dem_obstacle_points(moving, 0.0, points);
    return (dem_obstacle){.struct_size = sizeof(dem_obstacle),
                          .n_points = moving->n_points,
                          .points = points,
                          .restitution = moving->restitution,
                          .friction = moving->friction,
                          .friction_law = moving->friction_law};
}

dem_obstacle *motion_still(const dem_obstacle *list, dem_index n)
{
    bool good = true;
    dem_obstacle *still = calloc((size_t)n + 1, sizeof *still);
    for (dem_index k = 0; k < n && still != NULL; k++) {
        still[k] = still_one(&list[k]);
        good = good && still[k].points != NULL;
    }
    if (good) return still;
    motion_free_still(still, n);
    return NULL;
}

void motion_free_still(dem_obstacle *still, dem_index n)
{
    for (dem_index k = 0; k < n && still != NULL; k++) free((void *)(uintptr_t)still[k].points);
    free(still);
}
