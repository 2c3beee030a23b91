/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums of what contacts do. */
#include "contact/ledger.h"

#include <stdlib.h>

#include "base/status.h"

dem_status ledger_create(contact_ledger *out, dem_index n_obstacles)
{
    contact_ledger b = {0};
    b.impulse = calloc(4 * (size_t)n_obstacles + 1, sizeof *b.impulse);
    CHECK(b.impulse != NULL, DEM_ERROR_MEMORY, "out of memory for the impulses of %lld obstacles",
          (long long)n_obstacles);
    b.friction_impulse = b.impulse + 2 * n_obstacles;
    *out = b;
    return DEM_OK;
}

void ledger_destroy(contact_ledger *b)
{
    free(b->impulse);
    *b = (contact_ledger){0};
}

void ledger_add_impulse(contact_ledger *b, dem_index obstacle, vec2 impulse, vec2 tangential)
{
    vec2_put(b->impulse, obstacle, vec2_add(vec2_at(b->impulse, obstacle), impulse));
    vec2_put(b->friction_impulse, obstacle, vec2_add(vec2_at(b->friction_impulse, obstacle), tangential));
}

static void count(dem_counts *n, const dem_event *event)
{
    switch (event->kind) {
    case DEM_EVENT_IMPACT:
        n->impacts++;
        n->vertex_impacts += event->other >= 0;
        break;
    case DEM_EVENT_CLOSE: /* with or without an impact: counted where it is done */
        break;
    case DEM_EVENT_RELEASE:
        n->releases++;
        break;
    case DEM_EVENT_SLIP:
        n->slips++;
        break;
    case DEM_EVENT_STICK:
        n->sticks++;
        break;
    case DEM_EVENT_PASS:
        n->passings++;
        break;
    }
}

void ledger_enter(contact_ledger *b, const dem_event *event, contact_instant *now)
{
    count(&b->counts, event);
    if (now->listener->event == NULL) return;
    const dem_status status = now->listener->event(now->listener->context, event);
    if (now->listener_status == DEM_OK) now->listener_status = status;
}
