/* SPDX-License-Identifier: BSD-3-Clause */
/* A break is noted before anything breaks at its instant, so that stresses are those that broke it, and the order in
 * which elements of one instant are listed does not change them. Energies are taken one element after the other: what
 * several hold together goes with the last of them, so that their sum is that of all, to rounding. So it is with
 * fragments. These are found once for all breaks of a step, as all nodes are looked at. */
#include "fracture/break_list.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"
#include "base/union_find.h"
#include "fracture/utilisation.h"
#include "model/fragments.h"
#include "model/node_stress.h"

void break_list_destroy(break_list *b)
{
    free(b->list);
    free(b->split);
    free(b->parent);
    free(b->lowest);
    *b = (break_list){0};
}

/* ---- what a break is ---- */

/* The mean of the corners' effective stresses, or its own, which is what drives a triangle (utilisation.c). */
static void put_stress(dem_break *out, const dem_model *m, const element_state *e, const double *x)
{
    const dem_index *corner = &m->lattice.triangles[3 * out->triangle];
    if (utilisation_by_own_stress(&m->lattice, out->triangle)) {
        node_stress_of_triangle(m, e, out->triangle, x, out->stress);
        return;
    }
    for (int c = 0; c < 3; c++) {
        double stress[3];
        node_stress(m, e, NODE_STRESS_EFFECTIVE, corner[c], x, stress);
        for (int k = 0; k < 3; k++) out->stress[k] += stress[k] / 3.0;
    }
}

static void put_place(dem_break *out, const dem_index *nodes, int n, const double *x)
{
    for (int k = 0; k < n; k++)
        for (int d = 0; d < 2; d++) out->x[d] += x[2 * nodes[k] + d] / n;
}

static bool make_room(break_list *b, dem_index n_nodes)
{
    if (b->parent == NULL) b->parent = malloc((size_t)n_nodes * sizeof *b->parent);
    if (b->lowest == NULL) b->lowest = malloc((size_t)n_nodes * sizeof *b->lowest);
    return b->parent != NULL && b->lowest != NULL &&
           grow_array((void **)&b->list, &b->capacity, b->n + 1, sizeof *b->list) &&
           grow_array((void **)&b->split, &b->split_capacity, b->n + 1, sizeof *b->split);
}

dem_status break_list_note(break_list *b, const dem_model *model, const element_state *elements, dem_index element,
                           double t, const double *x)
{
    const dem_lattice *l = &model->lattice;
    const dem_index spring = element - l->n_triangles;
    const bool alone = spring >= 0;
    const dem_index *nodes = alone ? &l->ends[2 * spring] : &l->triangles[3 * element];
    CHECK(make_room(b, l->n_nodes), DEM_ERROR_MEMORY, "out of memory for what has broken");
    dem_break own = {.struct_size = sizeof own,
                     .t = t,
                     .triangle = alone ? -1 : element,
                     .spring = alone ? spring : -1,
                     .body = l->body[nodes[0]]};
    put_place(&own, nodes, alone ? 2 : 3, x);
    if (!alone) put_stress(&own, model, elements, x);
    b->list[b->n++] = own;
    return DEM_OK;
}

/* ---- its energy ---- */

/* Half of the springs and a third of the triangles at all of the nodes: each element of which all nodes are among them
 * is in it once, and what it has of others does not change. */
double break_list_energy(const dem_index *nodes, dem_index n, const dem_model *m, const element_state *s,
                         const double *x)
{
    double of_springs = 0.0, of_triangles = 0.0;
    for (dem_index j = 0; j < n; j++) {
        const dem_index i = nodes[j];
        of_springs += springs_node_energy(&m->springs, element_state_springs(s), i, x);
        of_triangles += couplings_node_energy(&m->couplings, element_state_triangles(s), i, x) +
                        triangles_node_energy(&m->triangles, element_state_triangles(s), i, x);
    }
    return of_springs / 2.0 + of_triangles / 3.0;
}

enum { MOST_NODES = 8 }; /* three corners, and the far end of a cell's second diagonal */

static bool has(const dem_index *nodes, dem_index n, dem_index node)
{
    while (n > 0 && nodes[n - 1] != node) n--;
    return n > 0;
}

static void add(dem_index *nodes, dem_index *n, dem_index node)
{
    if (!has(nodes, *n, node) && *n < MOST_NODES) nodes[(*n)++] = node;
}

/* All nodes of an element and of the springs that it holds. */
static dem_index list_nodes(const dem_break *b, const element_state *e, dem_index nodes[MOST_NODES])
{
    const dem_lattice *l = e->lattice;
    dem_index n = 0;
    for (int end = 0; end < 2 && b->spring >= 0; end++) add(nodes, &n, l->ends[2 * b->spring + end]);
    if (b->triangle < 0) return n;
    for (int c = 0; c < 3; c++) add(nodes, &n, l->triangles[3 * b->triangle + c]);
    for (dem_index p = e->row[b->triangle]; p < e->row[b->triangle + 1]; p++)
        for (int end = 0; end < 2; end++) add(nodes, &n, l->ends[2 * e->spring[p] + end]);
    return n;
}

void break_list_break(break_list *b, dem_index k, const dem_model *model, element_state *elements, const double *x)
{
    dem_break *own = &b->list[k];
    dem_index nodes[MOST_NODES];
    const dem_index n = list_nodes(own, elements, nodes);
    const double before = break_list_energy(nodes, n, model, elements, x);
    element_state_break(elements, own->triangle >= 0 ? own->triangle : model->lattice.n_triangles + own->spring);
    own->energy = before - break_list_energy(nodes, n, model, elements, x);
}

/* ---- the fragments that it splits off ---- */

/* If a spring is broken, makes the fragments at its ends one again.
 * \return the one that goes; -1: none does */
static dem_index mend_spring(break_list *b, const element_state *e, dem_index spring)
{
    const dem_index *ends = &e->lattice->ends[2 * spring];
    if (!springs_is_broken(element_state_springs(e), spring)) return -1;
    return fragments_unite(b->parent, b->lowest, ends[0], ends[1]);
}

static dem_index lower_of(dem_index a, dem_index b)
{
    return a < 0 || (b >= 0 && b < a) ? b : a;
}

/* The same with what the k-th has held.  \return the lowest one that goes; -1: none does */
static dem_index mend(break_list *b, dem_index k, const element_state *e)
{
    const dem_break *own = &b->list[k];
    dem_index lowest = -1;
    if (own->spring >= 0) lowest = mend_spring(b, e, own->spring);
    if (own->triangle < 0) return lowest;
    for (dem_index p = e->row[own->triangle]; p < e->row[own->triangle + 1]; p++)
        lowest = lower_of(lowest, mend_spring(b, e, e->spring[p]));
    return lowest;
}

/* From the last to the first, each break is taken back: a spring has then been broken by the last of the triangles that
 * held it. */
void break_list_find_split(break_list *b, dem_index from, const dem_model *model, const element_state *elements)
{
    if (from >= b->n) return;
    fragments_begin(&model->lattice, model->domain, element_state_springs(elements).pushed, b->parent, b->lowest);
    for (dem_index k = b->n; k-- > from;) b->split[k] = mend(b, k, elements);
}

dem_break break_list_at(const break_list *b, dem_index k, const dem_model *model)
{
    const domain *d = model->domain;
    dem_break own = b->list[k];
    if (own.triangle >= 0) own.triangle = domain_triangle(d, own.triangle);
    if (own.spring >= 0) own.spring = domain_spring(d, own.spring);
    own.fragment_new = b->split[k];
    return own;
}
