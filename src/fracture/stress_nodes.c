/* SPDX-License-Identifier: BSD-3-Clause */
/* A node has one place, by the last digits of its number. */
#include "fracture/stress_nodes.h"

#include <stdlib.h>

#include "base/status.h"

enum { N_SLOTS = 64 }; /* a power of 2 */

dem_status stress_nodes_create(stress_nodes *out, const dem_model *model, const element_state *elements)
{
    stress_nodes s = {.model = model, .elements = elements, .slots = malloc(N_SLOTS * sizeof *s.slots)};
    CHECK_MEMORY(s.slots);
    for (int k = 0; k < N_SLOTS; k++) s.slots[k].node = -1;
    *out = s;
    return DEM_OK;
}

void stress_nodes_destroy(stress_nodes *s)
{
    free(s->slots);
    *s = (stress_nodes){0};
}

void stress_nodes_visit(const stress_nodes *s, dem_index i, stress_nodes_visitor *visit, void *context)
{
    const element_state *e = s->elements;
    const stress_rows *r = s->model->stress.rows;
    visit(context, i);
    for (dem_index p = e->at_row[i]; p < e->at_row[i + 1]; p++)
        for (int c = 0; c < 3; c++) visit(context, e->lattice->triangles[3 * e->at[p] + c]);
    for (dem_index p = r->row[i]; p < r->row[i + 1]; p++)
        for (int end = 0; end < 2; end++) visit(context, e->lattice->ends[2 * r->spring[p] + end]);
}

static void list_once(void *context, dem_index node)
{
    stress_nodes_slot *to = context;
    for (int k = 0; k < to->n && k < STRESS_NODES_MOST; k++)
        if (to->list[k] == node) return;
    if (to->n < STRESS_NODES_MOST) to->list[to->n] = (int32_t)node;
    if (to->n <= STRESS_NODES_MOST) to->n++;
}

const stress_nodes_slot *stress_nodes_find(stress_nodes *s, dem_index i)
{
    stress_nodes_slot *slot = &s->slots[i & (N_SLOTS - 1)];
    if (slot->node != i) {
        slot->node = (int32_t)i;
        slot->n = 0;
        stress_nodes_visit(s, i, list_once, slot);
    }
    return slot;
}
