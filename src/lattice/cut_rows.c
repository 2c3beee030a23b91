/* SPDX-License-Identifier: BSD-3-Clause */
/* A node stays if one of its triangles does, which have nodes in its row and in those beside, as many as triangles are
 * high. So of a range of rows it is known what stays of all but these first and last ones. Numbers follow from counts
 * of what is left in the rows before. */
#include "lattice/cut_rows.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"

static const dem_index most_counted = 65536; /* nodes at a time, but for those of whole rows */

static dem_status lacks_memory(const grid *rows)
{
    return status_fail(DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)grid_count_nodes(rows));
}

/* ---- a range of rows ---- */

typedef struct range {
    cut_range at;
    dem_lattice lattice; /* all of them */
    bool *keep;          /* [n_triangles] */
    bool *stays;         /* [n_nodes] whether one of the triangles here that stay has the node */
} range;

static void close_range(range *g)
{
    dem_lattice_free(&g->lattice);
    free(g->keep);
    free(g->stays);
}

/* Nodes of triangles for which keep[t].  \param marked  [n_nodes] */
static void mark_nodes(bool *marked, const dem_lattice *l, const bool *keep)
{
    memset(marked, 0, (size_t)l->n_nodes * sizeof *marked);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        if (keep[k / 3]) marked[l->triangles[k]] = true;
}

/* Rows from `first` to `last` are the own ones, with some beside on each side. To be closed after a failure, too. */
static dem_status open_range(range *g, const cut_rows *c, dem_index first, dem_index last, dem_index beside)
{
    const cut_range at = {grid_between(&c->whole, first - beside, last + beside), grid_between(&c->whole, first, last)};
    *g = (range){.at = at, .lattice = dem_lattice_empty()};
    TRY(grid_lattice(&g->lattice, &at.rows));
    g->keep = lattice_zeros(g->lattice.n_triangles, sizeof *g->keep);
    g->stays = lattice_zeros(g->lattice.n_nodes, sizeof *g->stays);
    if (g->keep == NULL || g->stays == NULL) return lacks_memory(&at.rows);
    memset(g->keep, true, (size_t)g->lattice.n_triangles * sizeof *g->keep);
    if (c->mark != NULL) TRY(c->mark(c->context, &at, &g->lattice, g->keep));
    mark_nodes(g->stays, &g->lattice, g->keep);
    return DEM_OK;
}

static dem_index count(const bool *flags, dem_index begin, dem_index end)
{
    dem_index n = 0;
    for (dem_index k = begin; k < end; k++) n += flags[k];
    return n;
}

/* What stays in rows from `first` on, before `end`; of triangles those above each row. */
static dem_index count_nodes(const range *g, dem_index first, dem_index end)
{
    return count(g->stays, grid_nodes_below(&g->at.rows, first), grid_nodes_below(&g->at.rows, end));
}

static dem_index count_triangles(const range *g, dem_index first, dem_index end)
{
    return count(g->keep, grid_triangles_below(&g->at.rows, first), grid_triangles_below(&g->at.rows, end));
}

/* ---- counts of all rows ---- */

/* What is left in the rows before each, from the first one on, and before the end. NULL: all is. */
typedef struct row_counts {
    dem_index *nodes, *triangles; /* [rows + 1] */
    dem_index *joined;            /* [rows + 1] 1: no slab begins with the row, as a triangle above it has a node below.
                                     Ranks number triangles with their lowest nodes, slab by slab */
    dem_index *list;              /* [1 + 3 (rows + 1)] how many numbers follow, and these arrays */
} row_counts;

static dem_index count_rows(const cut_rows *c)
{
    return c->whole.last - c->whole.first + 1;
}

static row_counts counts_in(dem_index *list)
{
    if (list == NULL) return (row_counts){0};
    const dem_index n = list[0] / 3;
    return (row_counts){list + 1, list + 1 + n, list + 1 + 2 * n, list};
}

static dem_index nodes_before(const cut_rows *c, const row_counts *n, dem_index row)
{
    return n->nodes != NULL ? n->nodes[row - c->whole.first] : grid_nodes_below(&c->whole, row);
}

static dem_index triangles_before(const cut_rows *c, const row_counts *n, dem_index row)
{
    return n->triangles != NULL ? n->triangles[row - c->whole.first] : grid_triangles_below(&c->whole, row);
}

/* Whether a triangle between this row and the next one has a node below them. */
static bool has_node_below(const range *g, dem_index row)
{
    const dem_index above = grid_nodes_below(&g->at.rows, row), end = 3 * grid_triangles_below(&g->at.rows, row + 1);
    for (dem_index k = 3 * grid_triangles_below(&g->at.rows, row); k < end; k++)
        if (g->keep[k / 3] && g->lattice.triangles[k] < above) return true;
    return false;
}

/* Of rows from `first` on, before `end`. */
static dem_status count_some(row_counts *n, const cut_rows *c, dem_index first, dem_index end)
{
    range g;
    const dem_status status = open_range(&g, c, first, end - 1, c->height);
    for (dem_index row = first; status == DEM_OK && row < end; row++) {
        const dem_index k = row - c->whole.first;
        n->nodes[k + 1] = n->nodes[k] + count_nodes(&g, row, row + 1);
        n->triangles[k + 1] = n->triangles[k] + count_triangles(&g, row, row + 1);
        n->joined[k] = c->height > 1 && has_node_below(&g, row);
    }
    close_range(&g);
    return status;
}

static dem_status count_all(row_counts *n, const cut_rows *c)
{
    const grid *w = &c->whole;
    const dem_index many = 1 + most_counted / (w->reach + 1), some = many > c->least ? many : c->least;
    *n = (row_counts){0};
    if (c->mark == NULL) return DEM_OK;
    const dem_index n_numbers = 3 * (count_rows(c) + 1);
    dem_index *list = lattice_zeros(1 + n_numbers, sizeof *list);
    if (list == NULL) return lacks_memory(w);
    list[0] = n_numbers;
    *n = counts_in(list);
    for (dem_index row = w->first; row <= w->last; row += some)
        TRY(count_some(n, c, row, row + some <= w->last ? row + some : w->last + 1));
    return DEM_OK;
}

/* ---- which rows are own ---- */

static bool is_empty(const cut_rows *c, const row_counts *n, dem_index row)
{
    return nodes_before(c, n, row) == nodes_before(c, n, row + 1);
}

static bool is_joined(const cut_rows *c, const row_counts *n, dem_index row)
{
    return n->joined != NULL && n->joined[row - c->whole.first] != 0;
}

/* Whether a slab may begin with a row, which then has nodes. */
static bool may_begin(const cut_rows *c, const row_counts *n, dem_index row)
{
    return !is_empty(c, n, row) && !is_joined(c, n, row);
}

static dem_index count_beginnings(const cut_rows *c, const row_counts *n)
{
    dem_index beginnings = 0;
    for (dem_index row = c->whole.first; row <= c->whole.last; row++) beginnings += may_begin(c, n, row);
    return beginnings;
}

/* Of n rows each part has n/n_parts, and the first ones have one more. */
static grid own_rows_evenly(const grid *whole, dem_index part, dem_index n_parts)
{
    const dem_index n = whole->last - whole->first + 1, each = n / n_parts, more = n % n_parts;
    const dem_index first = whole->first + part * each + (part < more ? part : more);
    return grid_between(whole, first, first + each - (part < more ? 0 : 1));
}

/* Parts end where they have, with those before, their share of the nodes, and have one row with nodes at least.
 * \param left  rows with nodes with which a slab may begin */
static grid own_rows_by_nodes(const cut_rows *c, const row_counts *n, dem_index left, dem_index part, dem_index n_parts)
{
    const double share = (double)nodes_before(c, n, c->whole.last + 1) / (double)n_parts;
    dem_index first = c->whole.first, row = first;
    for (dem_index k = 0; k <= part; k++) {
        first = row;
        bool has_nodes = false, has_share = false;
        while (row <= c->whole.last &&
               !(has_nodes && (has_share || left == n_parts - 1 - k) && !is_joined(c, n, row))) {
            left -= may_begin(c, n, row);
            has_nodes = has_nodes || !is_empty(c, n, row);
            row++;
            has_share = k + 1 < n_parts && (double)nodes_before(c, n, row) >= (double)(k + 1) * share;
        }
    }
    return grid_between(&c->whole, first, row - 1);
}

static dem_status find_own_rows(grid *own, const cut_rows *c, const row_counts *n, dem_index part, dem_index n_parts)
{
    const dem_index most = n->nodes != NULL ? count_beginnings(c, n) : count_rows(c);
    CHECK(most > 0, DEM_ERROR_MODEL, "none of %lld nodes is left", (long long)grid_count_nodes(&c->whole));
    CHECK(n_parts <= most, DEM_ERROR_MODEL, "%lld rows of nodes cannot be %lld slabs", (long long)most,
          (long long)n_parts);
    *own = n->nodes != NULL ? own_rows_by_nodes(c, n, most, part, n_parts) : own_rows_evenly(&c->whole, part, n_parts);
    return DEM_OK;
}

/* ---- a slab ---- */

/* Of what is left of the rows about own ones: as many rows on each side as triangles are high have the rim, and as many
 * beyond these tell whether its nodes stay, and are on the boundary. */
typedef struct draft {
    dem_slab slab;
    dem_index own;        /* where own nodes begin */
    dem_index counted;    /* triangles below the rows that the rim has */
    unsigned char *flags; /* [n_nodes] not 0: on the boundary */
    bool *keep;           /* [n_triangles] those at own nodes */
    bool *marked;         /* [n_nodes] the other nodes of these: the rim */
} draft;

static void place(draft *d, const cut_rows *c, const row_counts *n, const grid *own)
{
    d->slab.n_nodes = nodes_before(c, n, c->whole.last + 1);
    d->slab.n_triangles = triangles_before(c, n, c->whole.last + 1);
    d->slab.first_node = nodes_before(c, n, own->first);
    d->slab.n_own = nodes_before(c, n, own->last + 1) - d->slab.first_node;
}

/* Takes the lattice of the range over.  \param rim_row  the first one with a rim */
static dem_status cut_out(draft *d, range *g, dem_index rim_row)
{
    d->own = count_nodes(g, g->at.rows.first, g->at.own.first);
    d->counted = count_triangles(g, g->at.rows.first, rim_row);
    TRY(dem_lattice_trim(&g->lattice, g->keep));
    d->slab.lattice = g->lattice;
    g->lattice = dem_lattice_empty();
    return DEM_OK;
}

static bool is_own(const draft *d, dem_index i)
{
    return i >= d->own && i < d->own + d->slab.n_own;
}

static dem_status mark(draft *d)
{
    const dem_lattice *l = &d->slab.lattice;
    d->flags = lattice_zeros(l->n_nodes, sizeof *d->flags);
    d->keep = lattice_zeros(l->n_triangles, sizeof *d->keep);
    d->marked = lattice_zeros(l->n_nodes, sizeof *d->marked);
    CHECK(d->flags && d->keep && d->marked, DEM_ERROR_MEMORY, "out of memory for a slab of %lld nodes",
          (long long)l->n_nodes);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        if (is_own(d, l->triangles[k])) d->keep[k / 3] = true;
    mark_nodes(d->marked, l, d->keep);
    for (dem_index i = d->own; i < d->own + d->slab.n_own; i++) d->marked[i] = false;
    return DEM_OK;
}

/* Of the triangles at own nodes. \param before  of the whole, triangles below the rows that the rim has */
static void number_triangles(draft *d, dem_index before)
{
    const dem_index all = d->slab.lattice.n_triangles, n = count(d->keep, 0, all);
    dem_index first = 0;
    while (first < all && !d->keep[first]) first++;
    d->slab.first_triangle = n > 0 && count(d->keep, first, first + n) == n ? before + (first - d->counted) : -1;
}

static bool has_rim(const draft *d, const dem_index *corner)
{
    return d->marked[corner[0]] || d->marked[corner[1]] || d->marked[corner[2]];
}

/* By the triangles at nodes of the rim, which tell all about edges there. */
static dem_status mark_boundary(draft *d)
{
    const dem_lattice *l = &d->slab.lattice;
    dem_lattice at_rim = *l;
    dem_index n = 0;
    for (dem_index t = 0; t < l->n_triangles; t++) n += has_rim(d, l->triangles + 3 * t);
    at_rim.triangles = lattice_zeros(n, 3 * sizeof *at_rim.triangles);
    at_rim.n_triangles = 0;
    CHECK(at_rim.triangles != NULL, DEM_ERROR_MEMORY, "out of memory for %lld triangles", (long long)n);
    for (dem_index t = 0; t < l->n_triangles; t++)
        if (has_rim(d, l->triangles + 3 * t))
            memcpy(at_rim.triangles + 3 * at_rim.n_triangles++, l->triangles + 3 * t, 3 * sizeof *l->triangles);
    const dem_status status = mesh_edges_contact_flags(d->flags, &at_rim);
    free(at_rim.triangles);
    return status;
}

static dem_status list_rim(draft *d)
{
    dem_slab *s = &d->slab;
    const dem_lattice *l = &s->lattice;
    const dem_index n = count(d->marked, 0, l->n_nodes);
    dem_index k = 0;
    s->rim = lattice_zeros(n, sizeof *s->rim);
    s->rim_boundary = lattice_zeros(n, sizeof *s->rim_boundary);
    CHECK(s->rim && s->rim_boundary, DEM_ERROR_MEMORY, "out of memory for a slab of %lld nodes", (long long)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        if (!d->marked[i]) continue;
        s->first_own += i < d->own;
        s->rim[k] = s->first_node + (i - d->own);
        s->rim_boundary[k++] = d->flags[i] != 0;
    }
    return DEM_OK;
}

static void *shrink(void *array, dem_index n, size_t size)
{
    void *smaller = realloc(array, (size_t)n * size);
    return smaller != NULL ? smaller : array;
}

static dem_status finish(draft *d, range *g, const cut_rows *c, const row_counts *n)
{
    dem_lattice *l = &d->slab.lattice;
    const dem_index below = g->at.own.first - c->height, rim_row = below > c->whole.first ? below : c->whole.first;
    TRY(cut_out(d, g, rim_row));
    TRY(mark(d));
    number_triangles(d, triangles_before(c, n, rim_row));
    TRY(mark_boundary(d));
    TRY(list_rim(d));
    TRY(dem_lattice_trim(l, d->keep));
    l->x = shrink(l->x, l->n_nodes, 2 * sizeof *l->x);
    l->triangles = shrink(l->triangles, l->n_triangles, 3 * sizeof *l->triangles);
    return DEM_OK;
}

static dem_status make(dem_slab *out, const cut_rows *c, const row_counts *n, const grid *own)
{
    draft d = {.slab = dem_slab_empty()};
    range g;
    dem_status status = open_range(&g, c, own->first, own->last, 2 * c->height);
    place(&d, c, n, own);
    if (status == DEM_OK) status = finish(&d, &g, c, n);
    if (status == DEM_OK)
        *out = d.slab;
    else
        dem_slab_free(&d.slab);
    close_range(&g);
    free(d.flags);
    free(d.keep);
    free(d.marked);
    return status;
}

/* ---- public ---- */

dem_status cut_rows_slab(dem_slab *out, const cut_rows *c, dem_index part, dem_index n_parts)
{
    row_counts n;
    grid own;
    dem_status status = count_all(&n, c);
    if (status == DEM_OK) status = find_own_rows(&own, c, &n, part, n_parts);
    if (status == DEM_OK) status = make(out, c, &n, &own);
    free(n.list);
    return status;
}

/* The first row before which there are so many nodes, and with which a slab may begin. */
static dem_index row_behind(const cut_rows *c, const row_counts *n, dem_index nodes)
{
    dem_index row = c->whole.first;
    while (row <= c->whole.last && (nodes_before(c, n, row) < nodes || is_joined(c, n, row))) row++;
    return row;
}

static dem_status make_between(dem_slab *out, const cut_rows *c, const row_counts *n, dem_index begin, dem_index end)
{
    const dem_index first = row_behind(c, n, begin), last = row_behind(c, n, end) - 1;
    const dem_index n_nodes = nodes_before(c, n, c->whole.last + 1);
    CHECK(n_nodes > 0, DEM_ERROR_MODEL, "none of %lld nodes is left", (long long)grid_count_nodes(&c->whole));
    if (first <= last) {
        const grid own = grid_between(&c->whole, first, last);
        return make(out, c, n, &own);
    }
    *out = dem_slab_empty();
    out->n_nodes = n_nodes;
    out->n_triangles = triangles_before(c, n, c->whole.last + 1);
    return DEM_OK;
}

dem_status cut_rows_between(dem_slab *out, const cut_rows *c, dem_index **counts, dem_index begin, dem_index end)
{
    row_counts n = counts_in(*counts);
    dem_status status = *counts != NULL ? DEM_OK : count_all(&n, c);
    if (status == DEM_OK) status = make_between(out, c, &n, begin, end);
    *counts = status == DEM_OK ? n.list : NULL;
    if (status != DEM_OK) free(n.list);
    return status;
}
