/* SPDX-License-Identifier: BSD-3-Clause */
/* Asks for the external force on the nodes with prescribed components, in one state. The reaction of such a node is m
 * (a - a_free), and the external force is part of a_free. It is asked for when a state is about to be shown, since a
 * query of a simulation must not call the program's function. How the force is used is in diagnostics.c. */
#include "forces/held_forces.h"

#include <stdlib.h>

#include "base/status.h"

/* Number of nodes that are integrated here and have a prescribed component. */
static dem_index count(const boundary_conditions *b, const external_force *external)
{
    dem_index n = 0;
    for (dem_index k = 0; b->held != NULL && k < external->n_all; k++) n += b->held[external->all[k]] != 0;
    return n;
}

static dem_status allocate(held_forces *h, const state_layout *layout)
{
    const size_t n = (size_t)h->n, row = (size_t)layout->dim * sizeof(double);
    h->nodes = malloc(n * sizeof *h->nodes);
    h->x = malloc(n * row);
    h->v = malloc(n * row);
    h->asked = malloc(n * row);
    h->force = calloc((size_t)layout->n_nodes, row);
    CHECK(h->nodes && h->x && h->v && h->asked && h->force, DEM_ERROR_MEMORY,
          "out of memory for the external force on %lld nodes", (long long)h->n);
    return DEM_OK;
}

/* Nodes are listed once; without an external force there is nothing to ask for. */
dem_status held_forces_create(held_forces *out, const boundary_conditions *b, const external_force *external,
                              const state_layout *layout)
{
    *out = (held_forces){.n = external != NULL ? count(b, external) : 0};
    if (out->n == 0) return DEM_OK;
    const dem_status status = allocate(out, layout);
    if (status != DEM_OK) {
        held_forces_destroy(out);
        return status;
    }
    /* Ascending, so that the external force sees the nodes in the same order in every run. */
    dem_index *next = out->nodes;
    for (dem_index k = 0; k < external->n_all; k++)
        if (b->held[external->all[k]] != 0) *next++ = external->all[k];
    return DEM_OK;
}

void held_forces_destroy(held_forces *h)
{
    free(h->nodes);
    free(h->x);
    free(h->v);
    free(h->asked);
    free(h->force);
    *h = (held_forces){0};
}

/* The caller's function sees the nodes side by side; the answers go to their places among all nodes. */
void held_forces_ask(held_forces *h, external_force *external, const state_layout *layout, const double *y)
{
    if (h->n == 0) {
        external_force_pass_over(external);
        return;
    }
    for (dem_index k = 0; k < h->n; k++) {
        state_copy_row(layout, h->x + state_row(layout, k), state_x(layout, y, h->nodes[k]));
        state_copy_row(layout, h->v + state_row(layout, k), state_v(layout, y, h->nodes[k]));
    }
    external_force_ask(external, &(dem_force_query){state_time(layout, y), h->n, h->nodes, h->x, h->v}, h->asked);
    for (dem_index k = 0; k < h->n; k++)
        state_copy_row(layout, h->force + state_row(layout, h->nodes[k]), h->asked + state_row(layout, k));
}
