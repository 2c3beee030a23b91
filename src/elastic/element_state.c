/* SPDX-License-Identifier: BSD-3-Clause */
/* Which springs and triangles of a simulation are broken: a flag for each element, a flag for each node beside a broken
 * one, and the list of these nodes. The model stays as it is, so several simulations of one model may have different
 * states. The flags of nodes let the force on an intact node skip the flags of its elements, and the list tells the
 * sweep over all nodes which of them to evaluate once more, one by one (accelerate_rest() in forces/kernel.c). When an
 * element breaks is decided elsewhere: nothing does so yet. */
#include "elastic/element_state.h"

#include <stdlib.h>

#include "base/status.h"

/* One more item than needed in each array, so that no allocation is of no bytes. */
dem_status element_state_create(element_state *out, const dem_lattice *lattice)
{
    const size_t n = (size_t)lattice->n_nodes;
    element_state s = {.spring = calloc((size_t)lattice->n_springs + 1, sizeof *s.spring),
                       .triangle = calloc((size_t)lattice->n_triangles + 1, sizeof *s.triangle),
                       .node = calloc(n + 1, sizeof *s.node),
                       .damaged = malloc((n + 1) * sizeof *s.damaged)};
    if (s.spring == NULL || s.triangle == NULL || s.node == NULL || s.damaged == NULL) {
        element_state_destroy(&s);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for the state of %lld springs",
                           (long long)lattice->n_springs);
    }
    *out = s;
    return DEM_OK;
}

void element_state_destroy(element_state *s)
{
    free(s->spring);
    free(s->triangle);
    free(s->node);
    free(s->damaged);
    *s = (element_state){0};
}

/* Notes a node beside a broken element, once. The list cannot overflow, since each node enters it at most once. */
static void damage(element_state *s, dem_index node)
{
    if (s->node[node]) return;
    s->node[node] = 1;
    s->damaged[s->n_damaged++] = node;
}

/* The element keeps its place in all arrays; those who read its numbers ask for its flag. */
void element_state_break_spring(element_state *s, const dem_lattice *lattice, dem_index spring)
{
    s->spring[spring] = 1;
    for (int end = 0; end < 2; end++) damage(s, lattice->ends[2 * spring + end]);
}

void element_state_break_triangle(element_state *s, const dem_lattice *lattice, dem_index triangle)
{
    s->triangle[triangle] = 1;
    for (int corner = 0; corner < 3; corner++) damage(s, lattice->triangles[3 * triangle + corner]);
}
