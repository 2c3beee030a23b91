/* SPDX-License-Identifier: BSD-3-Clause */
#include "domain/migration.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

dem_status migration_begin(migrating_rows *out, const gather_items *items, size_t size, const void *rows)
{
    dem_index first = 0, end = items->n;
    while (first < end && !gather_owns(items, first)) first++;
    while (end > first && !gather_owns(items, end - 1)) end--;
    *out = (migrating_rows){.owned = {.n = end - first, .n_whole = items->n_whole}};
    if (first < end) out->owned.first = gather_number(items, first);
    out->rows = malloc((size_t)(end - first) * size + 1);
    CHECK(out->rows != NULL, DEM_ERROR_MEMORY, "out of memory for %lld rows that go to other ranks",
          (long long)(end - first));
    memcpy(out->rows, (const unsigned char *)rows + (size_t)first * size, (size_t)(end - first) * size);
    out->size = size;
    return DEM_OK;
}

void migration_free(migrating_rows *m)
{
    free(m->rows);
    *m = (migrating_rows){0};
}

dem_status migration_end(migrating_rows *m, const ranks *r, const gather_items *items, void *to)
{
    const dem_status status = gather_migrate(r, &m->owned, m->size, m->rows, items, to);
    migration_free(m);
    return status;
}
