/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the contact pairs near each other: edges ask the cells that they go through for nodes (cell_search.c), and the
 * pairs found are sorted by (node, edge). Left out are the ends of an edge and the third corner of its triangle, and
 * those pairs of one body that are nearer than the thickness at rest already: a notch that is narrower than the
 * surfaces are thick would push itself apart. */
#include "surface_contact/pair_list.h"

#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

static const double rounding = 1.0 + 1e-9;   /* what is as near as a list reaches is in it whatever the rounding */
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

/* An edge in a search. */
typedef struct searched_edge {
    dem_index edge, first;
    vec2 a, t;         /* m, its first end and the way to the second one */
    double per_square; /* 1/m^2, 1/t.t */
} searched_edge;

/* contact_pair_square_distance() but for rounding. */
static double square_distance(const searched_edge *e, vec2 point)
{
    const vec2 r = vec2_sub(point, e->a);
    const double s = vec2_dot(r, e->t) * e->per_square, beside = s < 1.0 ? s : 1.0;
    const vec2 way = vec2_along(r, s > 0.0 ? -beside : -0.0, e->t);
    return vec2_dot(way, way);
}

/* Whether a node and the edge may be a pair for the filter, at the square of their distance. */
static bool is_found(const pair_list *l, const searched_edge *e, dem_index node, double square,
                     const pair_filter *filter)
{
    const contact_surface *c = l->surface;
    if (!is_apart(c, node, e->edge)) return false;
    const surface_law law = contact_surface_law(c, contact_surface_body(c, node), contact_surface_body(c, e->first));
    const double reach = rounding * (law.thickness + filter->margin);
    return square <= reach * reach && filter->takes(l, &(possible_pair){node, e->edge, law});
}

/* Adds those of the points just found that are near the edge. */
static dem_status take_found(pair_list *l, const searched_edge *e, const pair_filter *filter)
{
    const contact_surface *c = l->surface;
    const double reach = rounding * (c->most.thickness + filter->margin);
    for (dem_index k = 0; k < l->cells.n_found; k++) {
        const dem_index number = l->cells.found[k];
        const double square = square_distance(e, vec2_at(l->points, number));
        if (square > reach * reach || !is_found(l, e, c->nodes[number], square, filter)) continue;
        CHECK(grow_array((void **)&l->found, &l->found_capacity, l->n_found + 1, sizeof *l->found), DEM_ERROR_MEMORY,
              "out of memory for %lld contact pairs", (long long)l->n_found + 1);
        l->found[l->n_found++] = (found_pair){number, e->edge};
    }
    return DEM_OK;
}

/* Searches around the piece pq of the edge. */
static dem_status search_piece(pair_list *l, const searched_edge *e, vec2 p, vec2 q, const pair_filter *filter)
{
    const double reach = rounding * (l->surface->most.thickness + filter->margin);
    const box of = box_with((box){p, p}, q);
    TRY(cell_search_find(&l->cells, vec2_sub(of.low, (vec2){reach, reach}), vec2_add(of.high, (vec2){reach, reach})));
    return take_found(l, e, filter);
}

/* An edge longer than a cell asks piece by piece, so that the boxes of a long one do not cover an area. */
static dem_status search_along(pair_list *l, dem_index edge, const double *x, const pair_filter *filter)
{
    const contact_surface *c = l->surface;
    const dem_index first = contact_surface_first(c, edge), second = contact_surface_second(c, edge);
    const vec2 a = vec2_at(x, first), b = vec2_at(x, second), t = vec2_sub(b, a);
    const searched_edge e = {edge, first, a, t, 1.0 / vec2_dot(t, t)};
    const double most = largest_stretch * c->length[edge], length = vec2_norm(t);
    if (length <= fmin(l->cells.side, most)) return search_piece(l, &e, a, b, filter);
    CHECK(length <= most, DEM_ERROR_INTEGRATOR,
          "the boundary edge between nodes %lld and %lld is %g m long, %g times its length at rest",
          (long long)contact_surface_number(c, first), (long long)contact_surface_number(c, second), length,
          length / c->length[edge]);
    const double n_pieces = ceil(length / l->cells.side);
    for (double k = 0.0; k < n_pieces; k++)
        TRY(search_piece(l, &e, vec2_along(a, k / n_pieces, t), vec2_along(a, (k + 1.0) / n_pieces, t), filter));
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
