/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of the sources of events, in the order in which they were added. That order is the kind of an event, the
 * third part of the key (time, generation, kind, number) by which the queue orders events: it must be the same in every
 * run. Which sources there are is decided in src/simulation/setup.c. */
#include "events/source_list.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

dem_status source_list_add(source_list *s, event_source source)
{
    CHECK(grow_array((void **)&s->list, &s->capacity, s->n + 1, sizeof *s->list), DEM_ERROR_MEMORY,
          "out of memory for a source of events");
    s->list[s->n++] = source;
    return DEM_OK;
}

void source_list_destroy(source_list *s)
{
    free(s->list);
    *s = (source_list){0};
}

dem_status source_list_save(const source_list *s, dem_checkpoint *checkpoint)
{
    for (dem_index k = 0; k < s->n; k++) TRY(s->list[k].save(s->list[k].self, checkpoint));
    return DEM_OK;
}

dem_status source_list_restore(const source_list *s, const dem_checkpoint *checkpoint, double t, const double *y)
{
    for (dem_index k = 0; k < s->n; k++) TRY(s->list[k].restore(s->list[k].self, checkpoint, t, y));
    return DEM_OK;
}
