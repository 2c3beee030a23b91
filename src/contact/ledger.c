/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums over contact events: energies taken by impacts and put in by projection, impulses for each obstacle, counts by
 * kind (docs/method.md, The ledger). Work and impulses of lasting contacts are not here: they are integrated with the
 * motion as quadratures (src/base/state.h). Every event of contacts comes through ledger_enter(), which also calls the
 * listener. */
#include "contact/ledger.h"

#include <stdlib.h>

#include "base/status.h"

/* Both arrays of impulses are one block. */
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

/* The block is copied, and stays its own. Most obstacles of many have given no impulse. */
void ledger_copy(contact_ledger *to, const contact_ledger *from, dem_index n_obstacles)
{
    exact_sum_copy(&to->impact, &from->impact);
    exact_sum_copy(&to->projection, &from->projection);
    exact_sum_copy(&to->work, &from->work);
    for (dem_index k = 0; k < 4 * n_obstacles; k++) exact_sum_copy(&to->impulse[k], &from->impulse[k]);
    to->counts = from->counts;
}

void ledger_list_impulses(const contact_ledger *b, dem_index n_obstacles, double *list)
{
    for (dem_index k = 0; k < 4 * n_obstacles; k++) list[k] = exact_sum_value(&b->impulse[k]);
}

void ledger_begin_impulses(contact_ledger *b, dem_index n_obstacles, const double *list)
{
    for (dem_index k = 0; k < 4 * n_obstacles; k++) b->impulse[k] = exact_sum_of(list[k]);
}

void ledger_add_impulse(contact_ledger *b, dem_index obstacle, vec2 impulse, vec2 tangential)
{
    ledger_add_vector(&b->impulse[2 * obstacle], impulse);
    ledger_add_vector(&b->friction_impulse[2 * obstacle], tangential);
}

/* Closings are counted where they are made, as an impact may close a contact without an event of that kind. */
static void count(dem_counts *n, const dem_event *event)
{
    switch (event->kind) {
    case DEM_EVENT_IMPACT:
        n->impacts++;
        n->vertex_impacts += event->other >= 0;
        break;
    case DEM_EVENT_CLOSE:
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

/* A listener that fails does not keep the event from being completed: its first failure is kept for the end of the
 * resolution. */
void ledger_enter(contact_ledger *b, const dem_event *event, contact_instant *now)
{
    count(&b->counts, event);
    if (now->listener->event == NULL) return;
    const dem_status status = now->listener->event(now->listener->context, event);
    if (now->listener_status == DEM_OK) now->listener_status = status;
}
