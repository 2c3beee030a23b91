/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks surfaces at the start of a motion. Two of them cross where two edges do: each edge looks for the middles of
 * others near it. A node that is nearer to an edge than a twentieth of the contact thickness is refused as well, since
 * the force would be out of all proportion. A body that is inside another as a whole is not found here, but counted
 * among the overlaps (model/overlap.c). */
#include "surface_contact/surface_start.h"

#include <stdlib.h>

#include "base/status.h"

static const double least_distance = 0.05; /* over the contact thickness */

/* Two edges as segments AB and CD. */
typedef struct two_edges {
    dem_index a, b, c, d;
} two_edges;

static bool share_a_node(const two_edges *e)
{
    return e->a == e->c || e->a == e->d || e->b == e->c || e->b == e->d;
}

static double side_of(const double *x, dem_index a, dem_index b, dem_index node)
{
    return vec2_triangle_area(vec2_at(x, a), vec2_at(x, b), vec2_at(x, node));
}

static bool cross(const double *x, const two_edges *e)
{
    return vec2_segments_cross(vec2_at(x, e->a), vec2_at(x, e->b), vec2_at(x, e->c), vec2_at(x, e->d));
}

/* How far a node is behind an edge, m; infinite if it is in front of it. */
static double depth_of(const double *x, dem_index a, dem_index b, dem_index node)
{
    const double side = side_of(x, a, b, node);
    return side > 0.0 ? contact_pair_distance(vec2_at(x, node), vec2_at(x, a), vec2_at(x, b)) : INFINITY;
}

/* Names the node that has the shortest way out. */
static dem_status refuse(const contact_surface *s, const double *x, const two_edges *e)
{
    const dem_index ways[4][3] = {{e->c, e->d, e->a}, {e->c, e->d, e->b}, {e->a, e->b, e->c}, {e->a, e->b, e->d}};
    int least = 0;
    for (int k = 1; k < 4; k++)
        if (depth_of(x, ways[k][0], ways[k][1], ways[k][2]) <
            depth_of(x, ways[least][0], ways[least][1], ways[least][2]))
            least = k;
    const dem_index *way = ways[least], node = way[2];
    return status_fail(DEM_ERROR_MODEL,
                       "node %lld of body %lld at (%g, %g) m is %g m inside body %lld, behind its edge between nodes "
                       "%lld and %lld: surfaces must not cross at the start",
                       (long long)contact_surface_number(s, node), (long long)contact_surface_body(s, node),
                       x[2 * node], x[2 * node + 1], depth_of(x, way[0], way[1], node),
                       (long long)contact_surface_body(s, way[0]), (long long)contact_surface_number(s, way[0]),
                       (long long)contact_surface_number(s, way[1]));
}

static double length_of(const contact_surface *s, const double *x, dem_index edge)
{
    return vec2_norm(vec2_sub(vec2_at(x, contact_surface_second(s, edge)), vec2_at(x, contact_surface_first(s, edge))));
}

static vec2 middle_of(const contact_surface *s, const double *x, dem_index edge)
{
    return vec2_scale(
        0.5, vec2_add(vec2_at(x, contact_surface_first(s, edge)), vec2_at(x, contact_surface_second(s, edge))));
}

/* Compares an edge with those of higher numbers whose middles the search has found. */
static dem_status compare(const surface_contact *c, const cell_search *cells, const double *x, dem_index edge)
{
    const contact_surface *s = &c->surface;
    for (dem_index k = 0; k < cells->n_found; k++) {
        const dem_index other = cells->found[k];
        const two_edges e = {contact_surface_first(s, edge), contact_surface_second(s, edge),
                             contact_surface_first(s, other), contact_surface_second(s, other)};
        const bool within = contact_surface_body(s, e.a) == contact_surface_body(s, e.c);
        if (other <= edge || share_a_node(&e) || (within && !c->candidates.within_bodies)) continue;
        if (cross(x, &e)) return refuse(s, x, &e);
    }
    return DEM_OK;
}

static dem_status check_crossings(const surface_contact *c, const double *x, double *middles, cell_search *cells)
{
    const contact_surface *s = &c->surface;
    double longest = 0.0;
    for (dem_index e = 0; e < s->surface.n_edges; e++) {
        longest = fmax(longest, length_of(s, x, e));
        vec2_put(middles, e, middle_of(s, x, e));
    }
    TRY(cell_search_fill(cells, middles, s->surface.n_edges, longest));
    for (dem_index e = 0; e < s->surface.n_edges; e++) {
        const double reach = 0.5 * (longest + length_of(s, x, e));
        const vec2 at = vec2_at(middles, e);
        TRY(cell_search_find(cells, (vec2){at.x - reach, at.y - reach}, (vec2){at.x + reach, at.y + reach}));
        TRY(compare(c, cells, x, e));
    }
    return DEM_OK;
}

static dem_status check_distances(const surface_contact *c, const double *x)
{
    const pair_rows *r = &c->candidates.pairs;
    const contact_surface *s = &c->surface;
    for (dem_index k = 0; k < r->n; k++) {
        const contact_pair *p = &r->list[k];
        const dem_index node = p->nodes[CONTACT_PAIR_NODE], a = p->nodes[CONTACT_PAIR_FIRST];
        const dem_index b = p->nodes[CONTACT_PAIR_SECOND];
        const double gap = contact_pair_distance(vec2_at(x, node), vec2_at(x, a), vec2_at(x, b));
        CHECK(p->fills || gap >= least_distance * p->thickness, DEM_ERROR_MODEL,
              "node %lld of body %lld at (%g, %g) m is %g m from the edge between nodes %lld and %lld of body %lld: "
              "surfaces must be %g m apart at the start, a twentieth of the contact thickness",
              (long long)contact_surface_number(s, node), (long long)contact_surface_body(s, node), x[2 * node],
              x[2 * node + 1], gap, (long long)contact_surface_number(s, a), (long long)contact_surface_number(s, b),
              (long long)contact_surface_body(s, a), least_distance * p->thickness);
    }
    return DEM_OK;
}

dem_status surface_start_check(surface_contact *c, const double *x)
{
    cell_search cells = {0};
    double *middles = malloc((2 * (size_t)c->surface.surface.n_edges + 1) * sizeof *middles);
    CHECK_MEMORY(middles);
    dem_status status = check_crossings(c, x, middles, &cells);
    cell_search_free(&cells);
    free(middles);
    return status_first(status, status == DEM_OK ? check_distances(c, x) : DEM_OK);
}
