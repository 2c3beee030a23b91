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
    const dem_index at_once = (dem_index)team_threads(o->team) * ROWS_CHUNK;
    TRY(field_order_begin(o, 0, 1));
    for (dem_index first = 0; first < n; first += at_once) {
        field_portion portion = {.first = first, .n = n - first < at_once ? n - first : at_once};
        TRY(make_and_take(o, rows + (size_t)first * field_rows_size(o->field), &portion));
    }
    return field_order_end(o, 0);
}

dem_status field_order_give(const dem_simulation *simulation, const field_order *o)
{
    field_order own = *o;
    void *rows = NULL;
    if (simulation->leads != NULL) return led_run_order(simulation, o);
    own.kept = &((dem_simulation *)simulation)->kept;
    dem_status status = field_rows_make(simulation, o->field, &rows);
    if (status == DEM_OK) status = carry_out(&own, rows, field_rows_count(simulation, o->field));
    free(rows);
    return status;
}
