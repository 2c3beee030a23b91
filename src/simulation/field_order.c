/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/field_order.h"

#include <stdlib.h>

#include "base/status.h"
#include "simulation/field_rows.h"
#include "simulation/led_run.h"

static dem_status make_and_take(const field_order *o, const void *rows, field_portion *portion)
{
    TRY(field_order_make(o, rows, portion));
    return field_order_take(o, portion);
}

/* Of rows that are all here, a slice for each thread at a time. */
static dem_status carry_out(const field_order *o, const char *rows, dem_index n)
{
    const dem_index at_once = (dem_index)team_threads(o->team) * FIELD_SLICE;
    TRY(field_order_begin(o, 0, 1));
    for (dem_index first = 0; first < n; first += at_once) {
        field_portion portion = {.first = first, .n = n - first < at_once ? n - first : at_once};
        TRY(make_and_take(o, rows + (size_t)first * field_rows_size(o->field), &portion));
    }
    return field_order_end(o, 0);
}

dem_status field_order_give(const dem_simulation *s, const field_order *given)
{
    field_order o = *given;
    void *rows = NULL;
    if (s->leads != NULL) return led_run_order(s, &o);
    o.kept = &((dem_simulation *)s)->kept;
    dem_status status = field_rows_make(s, o.field, &rows);
    if (status == DEM_OK) status = carry_out(&o, rows, field_rows_count(s, o.field));
    free(rows);
    return status;
}
