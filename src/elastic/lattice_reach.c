/* SPDX-License-Identifier: BSD-3-Clause */
/* Of each lattice row the outermost nodes are followed that have to be right, on the left and on the right. What is
 * between them is taken as well, whether or not it is asked for. */
#include "elastic/lattice_reach.h"

#include <stdlib.h>

#include "base/status.h"

/* Columns from `low` to `high`, none where high < low. */
typedef struct extent {
    int32_t low, high;
} extent;

static const extent none = {INT32_MAX, INT32_MIN};

static extent join(extent a, extent b)
{
    return (extent){a.low < b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}

static extent meet(extent a, extent b)
{
    const extent both = {a.low > b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
    return both.high < both.low ? none : both;
}

/* With so many columns more on the left and on the right. */
static extent widen(extent e, int32_t left, int32_t right)
{
    return e.high < e.low ? none : (extent){e.low - left, e.high + right};
}

/* What is known of each lattice row, with one more before the first and one behind the last. */
typedef struct search {
    const lattice_rows *rows;
    extent *all;          /* its nodes; */
    extent *asked, *next; /* those that have to be right after a step, and before it */
} search;

static void find_nodes(const search *s, const unsigned char *is_ghost)
{
    const lattice_rows *rows = s->rows;
    for (dem_index r = 0; r < rows->n_rows; r++) {
        const lattice_row *row = &rows->row[r];
        extent all = none, asked = none;
        for (int32_t k = 0; k < row->n_segments; k++) {
            const lattice_segment *g = &rows->segment[row->segment + k];
            const int32_t column = LAYOUT_LANES * row->stored + g->place;
            all = join(all, (extent){column, column + g->n - 1});
            for (int32_t q = 0; q < g->n; q++)
                if (is_ghost == NULL || is_ghost[g->node + q] == 0)
                    asked = join(asked, (extent){column + q, column + q});
        }
        s->all[r] = all;
        s->asked[r] = asked;
    }
}

/* Neighbours are at the same column and the next one in the lattice row below, at the same column and the one before in
 * that above. */
static void take_neighbours(search *s)
{
    for (dem_index r = 0; r < s->rows->n_rows; r++) {
        const extent beside = widen(s->asked[r], 1, 1), below = widen(s->asked[r - 1], 1, 0),
                     above = widen(s->asked[r + 1], 0, 1);
        s->next[r] = meet(s->all[r], join(beside, join(below, above)));
    }
    extent *const kept = s->asked;
    s->asked = s->next;
    s->next = kept;
}

/* Blocks that evaluate all springs at these nodes and judge all triangles there: those of the triangles c, c + 1, c
 * above, and c, c above, c - 1 above, of which one corner is asked for. The place before is evaluated, too, as a block
 * takes from it what it leaves. */
static lattice_span span_of(const search *s, dem_index row)
{
    const lattice_row *of = &s->rows->row[row];
    const extent evaluated = {LAYOUT_LANES * of->first, LAYOUT_LANES * (of->first + of->n_blocks) - 1};
    const extent places = meet(evaluated, join(widen(s->asked[row], 1, 0), widen(s->asked[row + 1], 1, 1)));
    if (places.high < places.low) return (lattice_span){of->first, 0};
    const int32_t first = places.low / LAYOUT_LANES;
    return (lattice_span){first, places.high / LAYOUT_LANES - first + 1};
}

static dem_status allocate(search *s, lattice_reach *out)
{
    const size_t n = (size_t)s->rows->n_rows + 2;
    extent *const extents = malloc(3 * n * sizeof *extents);
    out->row = malloc((size_t)s->rows->n_rows * (size_t)out->n_levels * sizeof *out->row);
    if (extents == NULL || out->row == NULL) {
        free(extents);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld lattice rows", (long long)s->rows->n_rows);
    }
    for (size_t k = 0; k < 3 * n; k++) extents[k] = none;
    s->all = extents + 1;
    s->asked = s->all + n;
    s->next = s->asked + n;
    return DEM_OK;
}

dem_status lattice_reach_create(lattice_reach *out, const lattice_rows *rows, const unsigned char *is_ghost, int most)
{
    search s = {.rows = rows};
    *out = (lattice_reach){.n_levels = is_ghost != NULL ? most : 1};
    const dem_status status = allocate(&s, out);
    if (status != DEM_OK) return status;
    find_nodes(&s, is_ghost);
    for (int level = 0; level < out->n_levels; level++) {
        for (dem_index r = 0; r < rows->n_rows; r++) out->row[r * out->n_levels + level] = span_of(&s, r);
        take_neighbours(&s);
    }
    free(s.all - 1);
    return DEM_OK;
}

void lattice_reach_destroy(lattice_reach *r)
{
    free(r->row);
    *r = (lattice_reach){0};
}
