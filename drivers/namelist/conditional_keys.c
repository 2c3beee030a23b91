/* SPDX-License-Identifier: BSD-3-Clause */
#include "conditional_keys.h"

#include <string.h>

void conditional_keys_check(const schema_instance *group, const conditional_keys *table, namelist_errors *errors)
{
    const char *wanted = schema_text(group, table->by);
    if (wanted[0] == '\0' || schema_value_of(group, table->by)->faulty) return;
    for (size_t k = 0; k < table->n; k++) {
        const conditional_key *row = &table->keys[k];
        const schema_value *value = schema_value_of(group, row->key);
        const bool used = strstr(row->choices, wanted) != NULL;
        if (used && row->needed && !value->given && !value->faulty)
            namelist_errors_add(errors, group->place, "'%s' in &%s must be given for %s '%s'", row->key, table->group,
                                table->by, wanted);
        if (!used && value->given)
            namelist_errors_add(errors, value->place, "'%s' in &%s is not used by %s '%s'", row->key, table->group,
                                table->by, wanted);
    }
}

void conditional_keys_drop(schema_deck *groups, const conditional_keys *table)
{
    for (size_t i = 0; i < groups->n_instances; i++) {
        schema_instance *group = &groups->instances[i];
        if (strcmp(group->group->name, table->group) != 0) continue;
        for (size_t k = 0; k < table->n; k++)
            if (strstr(table->keys[k].choices, schema_text(group, table->by)) == NULL)
                schema_drop(group, table->keys[k].key);
    }
}
