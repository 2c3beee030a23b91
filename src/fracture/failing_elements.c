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
    free(f->breaks);
    free(f->forced);
    *f = (failing_elements){0};
}

void failing_elements_clear(failing_elements *f)
{
    f->n = f->n_nodes = f->n_forced = f->n_breaking = 0;
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

/* The other half of the cell of a triangle of which the spring in slot p is the second diagonal: that ends at another
 * node. -1: the triangle is none, the spring another one, or the other half is broken. */
static dem_index other_half(const element_state *s, dem_index triangle, dem_index p)
{
    for (int end = 0; end < 2; end++) {
        const dem_index i = s->lattice->ends[2 * s->spring[p] + end];
        if (element_state_is_corner(s, triangle, i)) continue;
        for (dem_index q = s->at_row[i]; q < s->at_row[i + 1]; q++)
            if (element_state_holds(s, s->at[q], s->spring[p])) return s->at[q];
    }
    return -1;
}

static void add_triangle(failing_elements *f, const element_state *s, dem_index triangle)
{
    append(f, &f->list, &f->n, &f->capacity, triangle);
    for (dem_index p = s->row[triangle]; p < s->row[triangle + 1]; p++) {
        const dem_index half = other_half(s, triangle, p);
        if (half >= 0) append(f, &f->list, &f->n, &f->capacity, half);
    }
}

/* A triangle that holds a spring has at least one of its ends as a corner. */
static void add_holders(failing_elements *f, const element_state *s, dem_index spring)
{
    for (int end = 0; end < 2; end++) {
        const dem_index i = s->lattice->ends[2 * spring + end];
        for (dem_index p = s->at_row[i]; p < s->at_row[i + 1]; p++)
            if (element_state_holds(s, s->at[p], spring)) {
                add_triangle(f, s, s->at[p]);
                append(f, &f->forced, &f->n_forced, &f->forced_capacity, s->at[p]);
            }
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

/* Whether a triangle breaks for its own part. */
static bool breaks_alone(const failing_elements *f, const element_state *s, dem_index triangle)
{
    return element_state_is_last(s, triangle) || sorted_find(f->forced, f->n_forced, triangle) >= 0;
}

/* Whether an element breaks, and does not soften: a cell does if one of its halves does. */
static bool breaks(const failing_elements *f, const element_state *s, dem_index element)
{
    if (element >= s->lattice->n_triangles || breaks_alone(f, s, element)) return true;
    for (dem_index p = s->row[element]; p < s->row[element + 1]; p++) {
        const dem_index half = other_half(s, element, p);
        if (half >= 0 && breaks_alone(f, s, half)) return true;
    }
    return false;
}

/* The ends of all springs that triangles hold are among them, and so the far end of a second diagonal. */
static void find_nodes(failing_elements *f, const element_state *s)
{
    const dem_lattice *l = s->lattice;
    for (dem_index k = 0; k < f->n; k++) {
        const dem_index t = f->list[k], spring = t - l->n_triangles;
        const dem_index *corner = spring < 0 ? &l->triangles[3 * t] : &l->ends[2 * spring];
        for (int c = 0; c < (spring < 0 ? 3 : 2); c++) append(f, &f->nodes, &f->n_nodes, &f->node_capacity, corner[c]);
        for (dem_index p = spring < 0 ? s->row[t] : 0; spring < 0 && p < s->row[t + 1]; p++)
            for (int end = 0; end < 2; end++)
                append(f, &f->nodes, &f->n_nodes, &f->node_capacity, l->ends[2 * s->spring[p] + end]);
    }
    f->n_nodes = sorted_make(f->nodes, f->n_nodes);
}

void failing_elements_complete(failing_elements *f, const element_state *s)
{
    f->n = sorted_make(f->list, f->n);
    f->n_forced = sorted_make(f->forced, f->n_forced);
    find_nodes(f, s);
    if (!grow_array((void **)&f->breaks, &f->breaks_capacity, f->n, sizeof *f->breaks)) {
        f->status = status_fail(DEM_ERROR_MEMORY, "out of memory for elements that break");
        return;
    }
    f->n_breaking = 0;
    for (dem_index k = 0; k < f->n; k++) f->n_breaking += f->breaks[k] = breaks(f, s, f->list[k]);
}

/* ---- their end ---- */

/* The energy of all is taken at once, whose rounding does not depend on their number. */
double failing_elements_fail(const failing_elements *f, const dem_model *model, element_state *s, const double *x,
                             break_list *noted)
{
    const double before = break_list_energy(f->nodes, f->n_nodes, model, s, x);
    dem_index at = noted->n - f->n_breaking;
    for (dem_index k = 0; k < f->n; k++) {
        if (f->breaks[k])
            break_list_break(noted, at++, model, s, x);
        else
            element_state_soften(s, f->list[k]);
    }
    return before - break_list_energy(f->nodes, f->n_nodes, model, s, x);
}
