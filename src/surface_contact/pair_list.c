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
    *out = (pair_list){.surface = of, .ways.surface = of, .within_bodies = within_bodies, .margin = margin};
    return pair_rows_create(&out->pairs, of->lattice->n_nodes);
}

void pair_list_destroy(pair_list *l)
{
    pair_rows_destroy(&l->pairs);
    cell_search_free(&l->cells);
    surface_ways_destroy(&l->ways);
    free(l->points);
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

/* A node and an edge that may be a pair, and the law between their bodies. */
typedef struct possible_pair {
    dem_index node, edge;
    surface_law law;
} possible_pair;

/* Which pairs a search takes of those that are apart, and how near they have to be, in addition to the thickness, m. */
typedef struct pair_filter {
    bool (*takes)(const pair_list *l, const possible_pair *p);
    double margin;
} pair_filter;

/* Whether what a pair consists of moves, and is not joined by a triangle. */
static bool is_apart(const contact_surface *c, dem_index node, dem_index edge)
{
    const dem_index a = contact_surface_first(c, edge), b = contact_surface_second(c, edge);
    if (node == a || node == b || node == c->corner[edge]) return false;
    return !(is_fixed(c, node) && is_fixed(c, a) && is_fixed(c, b));
}

static bool is_within_body(const contact_surface *c, const possible_pair *p)
{
    return contact_surface_body(c, p->node) == contact_surface_body(c, contact_surface_first(c, p->edge));
}

/* Whether a pair of one body is nearer than the thickness in the rest shape. */
static bool is_near_at_rest(const contact_surface *c, const possible_pair *p)
{
    const double *x = c->lattice->x;
    return contact_pair_distance(vec2_at(x, p->node), vec2_at(x, contact_surface_first(c, p->edge)),
                                 vec2_at(x, contact_surface_second(c, p->edge))) < p->law.thickness;
}

/* Whether a node and an edge may ever touch. */
static bool may_touch(const pair_list *l, const possible_pair *p)
{
    const contact_surface *c = l->surface;
    return !is_within_body(c, p) || (l->within_bodies && !is_near_at_rest(c, p));
}

/* Whether they would touch if they were not so near at rest. */
static bool is_left_out(const pair_list *l, const possible_pair *p)
{
    const contact_surface *c = l->surface;
    return l->within_bodies && is_within_body(c, p) && is_near_at_rest(c, p);
}

/* Whether another edge of the same body never touches the node of a pair. */
static bool is_never_touched(const contact_surface *c, possible_pair p, dem_index edge)
{
    p.edge = edge;
    return is_within_body(c, &p) && (!is_apart(c, p.node, edge) || is_near_at_rest(c, &p));
}

/* Adds those of the points just found that are near the edge at positions x. */
static dem_status take_found(pair_list *l, dem_index edge, const double *x, const pair_filter *filter)
{
    const contact_surface *c = l->surface;
    const dem_index first = contact_surface_first(c, edge);
    const vec2 a = vec2_at(x, first), b = vec2_at(x, contact_surface_second(c, edge));
    for (dem_index k = 0; k < l->cells.n_found; k++) {
        const dem_index number = l->cells.found[k], node = c->nodes[number];
        if (!is_apart(c, node, edge)) continue;
        const surface_law law = contact_surface_law(c, contact_surface_body(c, node), contact_surface_body(c, first));
        if (contact_pair_distance(vec2_at(x, node), a, b) > law.thickness + filter->margin) continue;
        if (!filter->takes(l, &(possible_pair){node, edge, law})) continue;
        CHECK(grow_array((void **)&l->found, &l->found_capacity, l->n_found + 1, sizeof *l->found), DEM_ERROR_MEMORY,
              "out of memory for %lld contact pairs", (long long)l->n_found + 1);
        l->found[l->n_found++] = (found_pair){number, edge};
    }
    return DEM_OK;
}

/* An edge longer than a cell asks piece by piece, so that the boxes of a long one do not cover an area. */
static dem_status search_along(pair_list *l, dem_index edge, const double *x, const pair_filter *filter)
{
    const contact_surface *c = l->surface;
    const vec2 a = vec2_at(x, contact_surface_first(c, edge));
    const vec2 t = vec2_sub(vec2_at(x, contact_surface_second(c, edge)), a);
    const double length = vec2_norm(t), reach = c->most.thickness + filter->margin;
    CHECK(length <= largest_stretch * c->length[edge], DEM_ERROR_INTEGRATOR,
          "the boundary edge between nodes %lld and %lld is %g m long, %g times its length at rest",
          (long long)contact_surface_first(c, edge), (long long)contact_surface_second(c, edge), length,
          length / c->length[edge]);
    const int n_pieces = 1 + (int)(length / l->cells.side);
    for (int k = 0; k < n_pieces; k++) {
        const vec2 p = vec2_along(a, (double)k / n_pieces, t), q = vec2_along(a, (k + 1.0) / n_pieces, t);
        const vec2 middle = vec2_scale(0.5, vec2_add(p, q)), half = {0.5 * fabs(q.x - p.x), 0.5 * fabs(q.y - p.y)};
        const vec2 low = {middle.x - half.x - reach, middle.y - half.y - reach};
        const vec2 high = {middle.x + half.x + reach, middle.y + half.y + reach};
        TRY(cell_search_find(&l->cells, low, high));
        TRY(take_found(l, edge, x, filter));
    }
    return DEM_OK;
}

/* ---- the list ---- */

/* Stable counting sort by node: the edges of a node stay ascending. */
static dem_status sort_found(pair_list *l)
{
    const dem_index n = l->surface->n_nodes;
    CHECK(grow_array((void **)&l->rank, &l->rank_capacity, n + 2, sizeof *l->rank), DEM_ERROR_MEMORY,
          "out of memory for the contact pairs of %lld nodes", (long long)n);
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
    const possible_pair here = {node, found.edge, law};
    return (contact_pair){.nodes = {node, first, contact_surface_second(c, found.edge),
                                    contact_surface_first(c, s->previous[found.edge]),
                                    contact_surface_second(c, s->next[found.edge])},
                          .thickness = law.thickness,
                          .weight = c->half_length[found.node] * law.modulus,
                          .ends_at_first = is_never_touched(c, here, s->previous[found.edge]),
                          .ends_at_second = is_never_touched(c, here, s->next[found.edge])};
}

/* The broken triangle beside an edge, where a body touches itself: half of the pressure, as every surface has it. One
 * that was squeezed when it broke pushes later, as stiff. */
static contact_pair make_filling(const contact_surface *c, dem_index edge)
{
    const surface *s = &c->surface;
    const dem_index first = contact_surface_first(c, edge), node = c->opposite[edge];
    const surface_law law = contact_surface_law(c, contact_surface_body(c, node), contact_surface_body(c, first));
    const double part = c->filled[edge] / contact_surface_height(c, edge);
    return (contact_pair){.nodes = {node, first, contact_surface_second(c, edge),
                                    contact_surface_first(c, s->previous[edge]),
                                    contact_surface_second(c, s->next[edge])},
                          .thickness = c->filled[edge],
                          .weight = 0.5 * c->length[edge] * law.modulus * part,
                          .fills = true};
}

/* Those that may push, behind all other pairs. */
static dem_status add_fillings(pair_list *l, const double *x)
{
    const contact_surface *c = l->surface;
    for (dem_index edge = 0; l->within_bodies && c->highest > 0.0 && edge < c->surface.n_edges; edge++) {
        if (c->filled[edge] <= 0.0) continue;
        const contact_pair pair = make_filling(c, edge);
        if (contact_pair_gap(&pair, x) <= pair.thickness + l->margin) TRY(pair_rows_add(&l->pairs, &pair));
    }
    return DEM_OK;
}

/* A pair that was found in several pieces of its edge, or in cells that share a bucket, is taken once. */
static bool is_repeated(const pair_list *l, dem_index k)
{
    const found_pair here = l->sorted[k];
    return k > 0 && l->sorted[k - 1].node == here.node && l->sorted[k - 1].edge == here.edge;
}

static dem_status fill_rows(pair_list *l, const double *x)
{
    for (dem_index k = 0; k < l->n_found; k++) {
        if (is_repeated(l, k)) continue;
        const contact_pair pair = make_pair(l->surface, l->sorted[k]);
        TRY(pair_rows_add(&l->pairs, &pair));
    }
    TRY(add_fillings(l, x));
    return pair_rows_link(&l->pairs);
}

/* Cells are as large as the box of a usual edge. */
static dem_status find_pairs(pair_list *l, const double *x, const pair_filter *filter)
{
    const contact_surface *c = l->surface;
    const double side = c->mean_length + 2.0 * (c->most.thickness + filter->margin);
    CHECK(grow_array((void **)&l->points, &l->points_capacity, 2 * c->n_nodes, sizeof *l->points), DEM_ERROR_MEMORY,
          "out of memory for the contact pairs of %lld nodes", (long long)c->n_nodes);
    for (dem_index k = 0; k < c->n_nodes; k++) vec2_put(l->points, k, vec2_at(x, c->nodes[k]));
    TRY(cell_search_fill(&l->cells, l->points, c->n_nodes, side));
    l->n_found = 0;
    for (dem_index edge = 0; edge < c->surface.n_edges; edge++) TRY(search_along(l, edge, x, filter));
    return sort_found(l);
}

static dem_status make_list(pair_list *l, const double *x)
{
    TRY(surface_ways_note(&l->ways, contact_surface_reach(l->surface) + l->margin, x));
    TRY(find_pairs(l, x, &(pair_filter){may_touch, l->margin}));
    return fill_rows(l, x);
}

void pair_list_clear(pair_list *l)
{
    pair_rows_clear(&l->pairs);
    surface_ways_clear(&l->ways);
    l->made = false;
}

dem_status pair_list_follow(pair_list *l, const double *x, double spare)
{
    if (l->made && surface_ways_within(&l->ways, (1.0 - spare) * l->margin, x)) return DEM_OK;
    pair_rows_clear(&l->pairs);
    l->n_made++;
    const dem_status status = make_list(l, x);
    l->made = status == DEM_OK;
    if (!l->made) pair_rows_clear(&l->pairs);
    return status;
}

dem_status pair_list_count_left_out(pair_list *l, dem_index *out)
{
    dem_index n = 0;
    if (l->within_bodies) TRY(find_pairs(l, l->surface->lattice->x, &(pair_filter){is_left_out, 0.0}));
    for (dem_index k = 0; k < l->n_found; k++) n += !is_repeated(l, k);
    l->made = false;
    *out = n;
    return DEM_OK;
}
