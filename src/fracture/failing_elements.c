/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of elements that break at one instant. Its order is that of their numbers, whatever order they were found
 * in, so that sums over them have the same bits. */
#include "fracture/failing_elements.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/sorted.h"
#include "base/status.h"

void failing_elements_destroy(failing_elements *f)
{
    free(f->list);
    free(f->nodes);
    *f = (failing_elements){0};
}

void failing_elements_clear(failing_elements *f)
{
    f->n = f->n_nodes = 0;
    f->status = DEM_OK;
}

/* ---- which elements ---- */

static void append(failing_elements *f, dem_index **list, dem_index *n, dem_index *capacity, dem_index number)
{
    if (grow_array((void **)list, capacity, *n + 1, sizeof **list))
        (*list)[(*n)++] = number;
    else
        f->status = status_fail(DEM_ERROR_MEMORY, "out of memory for elements that break");
}

static bool is_corner(const dem_lattice *l, dem_index triangle, dem_index node)
{
    const dem_index *corner = &l->triangles[3 * triangle];
    return node == corner[0] || node == corner[1] || node == corner[2];
}

/* The other half of a cell holds the second diagonal, too, whose ends are no corners of both: as long as it is whole. */
static void add_other_half(failing_elements *f, const element_state *s, dem_index triangle, dem_index diagonal)
{
    for (int end = 0; end < 2; end++) {
        const dem_index i = s->lattice->ends[2 * diagonal + end];
        if (is_corner(s->lattice, triangle, i)) continue;
        for (dem_index p = s->at_row[i]; p < s->at_row[i + 1]; p++)
            if (element_state_holds(s, s->at[p], diagonal)) append(f, &f->list, &f->n, &f->capacity, s->at[p]);
    }
}

static void add_triangle(failing_elements *f, const element_state *s, dem_index triangle)
{
    append(f, &f->list, &f->n, &f->capacity, triangle);
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) add_other_half(f, s, triangle, s->spring[p]);
}

/* A triangle that holds a spring has at least one of its ends as a corner. */
static void add_holders(failing_elements *f, const element_state *s, dem_index spring)
{
    for (int end = 0; end < 2; end++) {
        const dem_index i = s->lattice->ends[2 * spring + end];
        for (dem_index p = s->at_row[i]; p < s->at_row[i + 1]; p++)
            if (element_state_holds(s, s->at[p], spring)) add_triangle(f, s, s->at[p]);
    }
}

void failing_elements_add(failing_elements *f, const element_state *s, dem_index element)
{
    const dem_index spring = element - s->lattice->n_triangles;
    if (spring < 0)
        add_triangle(f, s, element);
    else if (s->held[spring])
        add_holders(f, s, spring);
    else
        append(f, &f->list, &f->n, &f->capacity, element);
}

/* ---- in order ---- */

static int compare(const void *a, const void *b)
{
    const dem_index first = *(const dem_index *)a, second = *(const dem_index *)b;
    return (first > second) - (first < second);
}

/* Ascending, each number once.  \return how many there are */
static dem_index sort(dem_index *list, dem_index n)
{
    dem_index kept = 0;
    if (n > 0) qsort(list, (size_t)n, sizeof *list, compare);
    for (dem_index k = 0; k < n; k++)
        if (kept == 0 || list[k] != list[kept - 1]) list[kept++] = list[k];
    return kept;
}

void failing_elements_complete(failing_elements *f, const dem_lattice *l)
{
    f->n = sort(f->list, f->n);
    for (dem_index k = 0; k < f->n; k++) {
        const dem_index spring = f->list[k] - l->n_triangles;
        const dem_index *corner = spring < 0 ? &l->triangles[3 * f->list[k]] : &l->ends[2 * spring];
        for (int c = 0; c < (spring < 0 ? 3 : 2); c++) append(f, &f->nodes, &f->n_nodes, &f->node_capacity, corner[c]);
    }
    f->n_nodes = sort(f->nodes, f->n_nodes);
}

bool failing_elements_have(const failing_elements *f, dem_index node)
{
    return sorted_find(f->nodes, f->n_nodes, node) >= 0;
}

/* ---- their end ---- */

/* Half of the springs and a third of the triangles at all of the nodes: each element of which all nodes are among them
 * is in it once, and what it has of others does not change. */
static double energy(const failing_elements *f, const dem_model *m, const element_state *s, const double *x)
{
    double of_springs = 0.0, of_triangles = 0.0;
    for (dem_index j = 0; j < f->n_nodes; j++) {
        const dem_index i = f->nodes[j];
        of_springs += springs_node_energy(&m->springs, element_state_springs(s), i, x);
        of_triangles += couplings_node_energy(&m->couplings, element_state_triangles(s), i, x) +
                        triangles_node_energy(&m->triangles, element_state_triangles(s), i, x);
    }
    return of_springs / 2.0 + of_triangles / 3.0;
}

/* A cell breaks if one of its triangles does. */
static bool breaks(const element_state *s, dem_index element)
{
    if (element >= s->lattice->n_triangles || element_state_is_last(s, element)) return true;
    return is_of_cell(s, element) && element_state_is_last(s, element ^ 1);
}

dem_index failing_elements_n_breaking(const failing_elements *f, const element_state *s)
{
    dem_index n = 0;
    for (dem_index k = 0; k < f->n; k++) n += breaks(s, f->list[k]);
    return n;
}

/* The triangles of a cell follow each other, and the first one must not decide before the second one has. */
static void fail(element_state *s, const dem_index *list, dem_index n)
{
    bool last[2] = {false, false};
    for (dem_index k = 0; k < n; k++) last[k] = breaks(s, list[k]);
    for (dem_index k = 0; k < n; k++) {
        if (last[k])
            element_state_break(s, list[k]);
        else
            element_state_soften(s, list[k]);
    }
}

double failing_elements_fail(const failing_elements *f, const dem_model *model, element_state *s, const double *x)
{
    const double before = energy(f, model, s, x);
    for (dem_index k = 0, n; k < f->n; k += n) {
        n = k + 1 < f->n && f->list[k + 1] == (f->list[k] ^ 1) ? 2 : 1;
        fail(s, f->list + k, n);
    }
    return before - energy(f, model, s, x);
}
