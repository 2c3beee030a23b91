/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the contact pairs near each other: edges ask the cells that they go through for nodes (cell_search.c), and the
 * pairs found are sorted by (node, edge). Left out are the ends of an edge and the third corner of its triangle, and
 * those pairs of one body that are nearer than the thickness at rest already: a notch that is narrower than the
 * surfaces are thick would push itself apart. */
#include "surface_contact/pair_list.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

static const double largest_stretch = 100.0; /* of an edge; beyond it positions have lost all meaning */

dem_status pair_list_create(pair_list *out, const contact_surface *of, bool within_bodies, double margin)
{
    const size_t n = (size_t)of->n_nodes;
    pair_list l = {.surface = of, .within_bodies = within_bodies, .margin = margin};
    l.reference = calloc(2 * n + 1, sizeof *l.reference);
    l.rank = malloc((n + 2) * sizeof *l.rank);
    const dem_status status = pair_rows_create(&l.pairs, of->lattice->n_nodes);
    if (status != DEM_OK || l.reference == NULL || l.rank == NULL) {
        pair_list_destroy(&l);
        return status_fail(DEM_ERROR_MEMORY, "out of memory for the contact pairs of %zu nodes", n);
    }
    l.reference[0] = (double)NAN;
    *out = l;
    return DEM_OK;
}

void pair_list_destroy(pair_list *l)
{
    pair_rows_destroy(&l->pairs);
    cell_search_free(&l->cells);
    free(l->reference);
    free(l->found);
    free(l->sorted);
    free(l->rank);
    *l = (pair_list){0};
}

/* ---- which pairs ---- */

static bool is_fixed(const contact_surface *c, dem_index node)
{
    return (c->lattice->flags[node] & DEM_NODE_FIXED) != 0;
}

/* Whether a node and an edge may ever touch. */
static bool may_touch(const pair_list *l, dem_index node, dem_index edge, const surface_law *law)
{
    const contact_surface *c = l->surface;
    const dem_index a = contact_surface_first(c, edge), b = contact_surface_second(c, edge);
    if (node == a || node == b || node == c->corner[edge]) return false;
    if (is_fixed(c, node) && is_fixed(c, a) && is_fixed(c, b)) return false;
    if (contact_surface_body(c, node) != contact_surface_body(c, a)) return true;
    const double *x = c->lattice->x;
    return l->within_bodies && contact_pair_distance(vec2_at(x, node), vec2_at(x, a), vec2_at(x, b)) >= law->thickness;
}

/* Adds those of the points just found that are near the edge at positions x. */
static dem_status take_found(pair_list *l, dem_index edge, const double *x)
{
    const contact_surface *c = l->surface;
    const dem_index first = contact_surface_first(c, edge);
    const vec2 a = vec2_at(x, first), b = vec2_at(x, contact_surface_second(c, edge));
    for (dem_index k = 0; k < l->cells.n_found; k++) {
        const dem_index number = l->cells.found[k], node = c->nodes[number];
        const surface_law law = contact_surface_law(c, contact_surface_body(c, node), contact_surface_body(c, first));
        if (contact_pair_distance(vec2_at(x, node), a, b) > law.thickness + l->margin) continue;
        if (!may_touch(l, node, edge, &law)) continue;
        CHECK(grow_array((void **)&l->found, &l->found_capacity, l->n_found + 1, sizeof *l->found), DEM_ERROR_MEMORY,
              "out of memory for %lld contact pairs", (long long)l->n_found + 1);
        l->found[l->n_found++] = (found_pair){number, edge};
    }
    return DEM_OK;
}

/* An edge longer than a cell asks piece by piece, so that the boxes of a long one do not cover an area. */
static dem_status search_along(pair_list *l, dem_index edge, const double *x)
{
    const contact_surface *c = l->surface;
    const vec2 a = vec2_at(x, contact_surface_first(c, edge));
    const vec2 t = vec2_sub(vec2_at(x, contact_surface_second(c, edge)), a);
    const double length = vec2_norm(t), reach = c->most_thickness + l->margin;
    CHECK(length <= largest_stretch * c->length[edge], DEM_ERROR_INTEGRATOR,
          "the boundary edge between nodes %lld and %lld is %g m long, %g times its length at rest",
          (long long)contact_surface_first(c, edge), (long long)contact_surface_second(c, edge), length,
          length / c->length[edge]);
    const int n_pieces = 1 + (int)(length / l->cells.side);
    for (int k = 0; k < n_pieces; k++) {
        const vec2 p = vec2_along(a, (double)k / n_pieces, t), q = vec2_along(a, (k + 1.0) / n_pieces, t);
        const vec2 low = {fmin(p.x, q.x) - reach, fmin(p.y, q.y) - reach};
        const vec2 high = {fmax(p.x, q.x) + reach, fmax(p.y, q.y) + reach};
        TRY(cell_search_find(&l->cells, low, high));
        TRY(take_found(l, edge, x));
    }
    return DEM_OK;
}

/* ---- the list ---- */

/* Stable counting sort by node: the edges of a node stay ascending. */
static dem_status sort_found(pair_list *l)
{
    const dem_index n = l->surface->n_nodes;
    CHECK(grow_array((void **)&l->sorted, &l->sorted_capacity, l->n_found, sizeof *l->sorted), DEM_ERROR_MEMORY,
          "out of memory for %lld contact pairs", (long long)l->n_found);
    for (dem_index k = 0; k < n + 2; k++) l->rank[k] = 0;
    for (dem_index k = 0; k < l->n_found; k++) l->rank[l->found[k].node + 2]++;
    for (dem_index k = 1; k < n + 2; k++) l->rank[k] += l->rank[k - 1];
    for (dem_index k = 0; k < l->n_found; k++) l->sorted[l->rank[l->found[k].node + 1]++] = l->found[k];
    return DEM_OK;
}

static contact_pair make_pair(const contact_surface *c, found_pair found)
{
    const surface *s = &c->surface;
    const dem_index node = c->nodes[found.node], first = contact_surface_first(c, found.edge);
    const surface_law law = contact_surface_law(c, contact_surface_body(c, node), contact_surface_body(c, first));
    return (contact_pair){.nodes = {node, first, contact_surface_second(c, found.edge),
                                    contact_surface_first(c, s->previous[found.edge])},
                          .edge = found.edge,
                          .thickness = law.thickness,
                          .weight = c->half_length[found.node] * law.modulus};
}

/* A pair that was found in several pieces of its edge, or in cells that share a bucket, is taken once. */
static dem_status fill_rows(pair_list *l)
{
    TRY(sort_found(l));
    for (dem_index k = 0; k < l->n_found; k++) {
        const found_pair here = l->sorted[k];
        if (k > 0 && l->sorted[k - 1].node == here.node && l->sorted[k - 1].edge == here.edge) continue;
        const contact_pair pair = make_pair(l->surface, here);
        TRY(pair_rows_add(&l->pairs, &pair));
    }
    return pair_rows_link(&l->pairs);
}

/* Cells are as large as the box of a usual edge. */
static dem_status find_pairs(pair_list *l, const double *x)
{
    const contact_surface *c = l->surface;
    const double side = c->mean_length + 2.0 * (c->most_thickness + l->margin);
    for (dem_index k = 0; k < c->n_nodes; k++) vec2_put(l->reference, k, vec2_at(x, c->nodes[k]));
    TRY(cell_search_fill(&l->cells, l->reference, c->n_nodes, side));
    l->n_found = 0;
    for (dem_index edge = 0; edge < c->surface.n_edges; edge++) TRY(search_along(l, edge, x));
    return fill_rows(l);
}

static double lower(double a, double b)
{
    return a < b ? a : b;
}

static double higher(double a, double b)
{
    return a > b ? a : b;
}

/* How far two nodes of the surface have moved relative to each other since the list was made, at most, m; the diagonal
 * of the box of all ways. What all have in common, as the flight of a body, brings no surfaces nearer. Not a number if
 * some way is not finite, which comparisons alone would pass over. */
static double largest_change(const pair_list *l, const double *x)
{
    const contact_surface *c = l->surface;
    vec2 low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};
    double finite = 0.0;
    for (dem_index k = 0; k < c->n_nodes; k++) {
        const vec2 way = vec2_sub(vec2_at(x, c->nodes[k]), vec2_at(l->reference, k));
        low = (vec2){lower(way.x, low.x), lower(way.y, low.y)};
        high = (vec2){higher(way.x, high.x), higher(way.y, high.y)};
        finite += 0.0 * (way.x + way.y);
    }
    return c->n_nodes > 0 ? vec2_norm(vec2_sub(high, low)) + finite : 0.0;
}

dem_status pair_list_follow(pair_list *l, const double *x, double spare)
{
    if (largest_change(l, x) <= (1.0 - spare) * l->margin) return DEM_OK;
    pair_rows_clear(&l->pairs);
    l->n_made++;
    const dem_status status = find_pairs(l, x);
    if (status == DEM_OK) return DEM_OK;
    pair_rows_clear(&l->pairs);
    l->reference[0] = (double)NAN;
    return status;
}
