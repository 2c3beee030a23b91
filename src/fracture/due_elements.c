/* SPDX-License-Identifier: BSD-3-Clause */
/* A binary heap, and a table that has the place of each element in it: an element is in the first free cell from that
 * of its hash on, so that from there to it no cell is empty. Which of those due at the same time comes first does not
 * matter, as all of them are taken together. */
#include "fracture/due_elements.h"

#include <stdlib.h>

#include "base/status.h"

void due_elements_destroy(due_elements *d)
{
    free(d->list);
    free(d->cells);
    *d = (due_elements){0};
}

/* ---- the table ---- */

static dem_index home_of(const due_elements *d, dem_index element)
{
    return (dem_index)(((uint64_t)element * 0x9e3779b97f4a7c15u) >> 32) & (d->n_cells - 1);
}

static dem_index after(const due_elements *d, dem_index cell)
{
    return (cell + 1) & (d->n_cells - 1);
}

/* The cell of an element, or the empty one in which it would be. */
static dem_index cell_of(const due_elements *d, dem_index element)
{
    dem_index cell = home_of(d, element);
    while (d->cells[cell] >= 0 && d->list[d->cells[cell]].element != element) cell = after(d, cell);
    return cell;
}

/* Empties a cell. Those behind it that may not be reached any more are moved up. */
static void empty(due_elements *d, dem_index cell)
{
    dem_index gap = cell;
    for (cell = after(d, cell); d->cells[cell] >= 0; cell = after(d, cell)) {
        const dem_index home = home_of(d, d->list[d->cells[cell]].element), mask = d->n_cells - 1;
        if (((cell - home) & mask) < ((cell - gap) & mask)) continue;
        d->cells[gap] = d->cells[cell];
        gap = cell;
    }
    d->cells[gap] = -1;
}

/* From the home of each element on: its own cell is among those that are emptied. */
void due_elements_clear(due_elements *d)
{
    for (dem_index p = 0; p < d->n; p++)
        for (dem_index cell = home_of(d, d->list[p].element); d->cells[cell] >= 0; cell = after(d, cell))
            d->cells[cell] = -1;
    d->n = 0;
    d->status = DEM_OK;
}

static dem_status reserve(due_elements *d, dem_index n)
{
    dem_index n_cells = 64;
    if (n <= d->capacity) return DEM_OK;
    while (n_cells < 4 * n) n_cells *= 2;
    CHECK(n_cells < INT32_MAX, DEM_ERROR_MODEL, "%lld elements that break at once are more than the library takes",
          (long long)n);
    due_element *list = realloc(d->list, (size_t)(n_cells / 2) * sizeof *list);
    if (list != NULL) d->list = list;
    int32_t *cells = malloc((size_t)n_cells * sizeof *cells);
    if (list == NULL || cells == NULL) {
        free(cells);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld elements that break", (long long)n);
    }
    free(d->cells);
    d->cells = cells;
    d->n_cells = n_cells;
    d->capacity = n_cells / 2;
    for (dem_index cell = 0; cell < n_cells; cell++) cells[cell] = -1;
    for (dem_index p = 0; p < d->n; p++) cells[cell_of(d, list[p].element)] = (int32_t)p;
    return DEM_OK;
}

/* ---- the heap ---- */

/* Puts an element, which has a cell, into a place. */
static void put(due_elements *d, dem_index p, dem_index cell, due_element own)
{
    d->list[p] = own;
    d->cells[cell] = (int32_t)p;
}

/* Moves an element from place p towards the root, or away from it, as far as it has to go. What it passes goes to where
 * it was; cells are found while the list still has who they are of. */
static void settle(due_elements *d, dem_index p, dem_index cell, due_element own)
{
    for (; p > 0 && own.t < d->list[(p - 1) / 2].t; p = (p - 1) / 2)
        put(d, p, cell_of(d, d->list[(p - 1) / 2].element), d->list[(p - 1) / 2]);
    for (dem_index next = 2 * p + 1; next < d->n; next = 2 * p + 1) {
        if (next + 1 < d->n && d->list[next + 1].t < d->list[next].t) next++;
        if (!(d->list[next].t < own.t)) break;
        put(d, p, cell_of(d, d->list[next].element), d->list[next]);
        p = next;
    }
    put(d, p, cell, own);
}

/* The last one fills the gap. */
static void take_out(due_elements *d, dem_index cell)
{
    const dem_index p = d->cells[cell];
    const due_element last = d->list[d->n - 1];
    empty(d, cell);
    if (p < --d->n) settle(d, p, cell_of(d, last.element), last);
}

void due_elements_set(due_elements *d, dem_index element, double t)
{
    if (!isfinite(t) && d->n == 0) return;
    const dem_status status = isfinite(t) ? reserve(d, d->n + 1) : DEM_OK;
    d->status = status_first(d->status, status);
    if (status != DEM_OK) return;
    const dem_index cell = cell_of(d, element), place = d->cells[cell];
    if (!isfinite(t)) {
        if (place >= 0) take_out(d, cell);
        return;
    }
    settle(d, place >= 0 ? place : d->n++, cell, (due_element){t, element});
}
