/* SPDX-License-Identifier: BSD-3-Clause */
#include "loads.h"

#include <stdlib.h>
#include <string.h>

#include <dem/trajectory.h>

#include "namelist.h"

/* The value of a key of a resolved deck, where every key stands once; 0 if it is not given. */
static double find(const namelist *deck, const char *key, size_t k)
{
    for (size_t g = 0; g < deck->n_groups; g++)
        for (size_t j = 0; j < deck->groups[g].n_keys; j++) {
            const namelist_key *found = &deck->groups[g].keys[j];
            if (strcmp(found->name, key) == 0 && k < found->n_values) return found->values[k].real;
        }
    return 0.0;
}

static bool parse(loads *out, const task *t, const char *text)
{
    namelist deck;
    namelist_errors errors = {0};
    const bool parsed = namelist_parse(&deck, text, strlen(text), &errors);
    out->known = parsed && errors.n == 0;
    out->gravity[0] = find(&deck, "gravity", 0);
    out->gravity[1] = find(&deck, "gravity", 1);
    out->mass_damping = find(&deck, "mass_damping", 0);
    namelist_free(&deck);
    namelist_errors_free(&errors);
    if (!parsed) outcome_fail(t->outcome, EXIT_MEMORY, "dem_export", "out of memory");
    return parsed;
}

bool loads_find(loads *out, const task *t)
{
    const size_t size = NAMELIST_MAX_FILE;
    *out = (loads){0};
    char *text = task_allocate(t, (dem_index)size, 1);
    if (text == NULL) return false;
    const bool has_deck = dem_trajectory_read_note(t->input, "resolved", text, size) == DEM_OK;
    const bool good = !has_deck || parse(out, t, text);
    free(text);
    return good;
}
