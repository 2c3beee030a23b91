/* SPDX-License-Identifier: BSD-3-Clause */
/* The distance of two points changes by no more than they move relative to each other, and that is no more than the
 * diagonal of the box of their ways. Boxes of ways are found group by group; the positions of two groups are apart by
 * what is between their boxes at least. Nodes are looked at in twos, neighbours in memory: the nodes of a surface are
 * mostly ends of rows of a lattice, of which one is followed by the next. A node inside that comes along moves with its
 * neighbours. */
#include "surface_contact/surface_ways.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

enum { MOST_GROUPS = 32 };

static const double usual_gap = 4.0; /* mean edges, in addition to the reach: bodies further apart are not near */

void surface_ways_destroy(surface_ways *w)
{
    free(w->begin);
    free(w->boxes);
    free(w->at);
    free(w->places);
    free(w->near);
    *w = (surface_ways){0};
}

void surface_ways_clear(surface_ways *w)
{
    const surface_ways none = {.surface = w->surface, .of = w->of};
    surface_ways_destroy(w);
    *w = none;
}

/* ---- twos ---- */

static dem_index group_of(const surface_ways *w, dem_index node)
{
    return w->n_groups > 1 ? contact_surface_body(w->surface, node) : 0;
}

/* A node and a neighbour in memory, of the same body where there is one. */
static dem_index first_of_two(const dem_lattice *l, dem_index node)
{
    const bool is_followed = node + 1 < l->n_nodes && l->body[node + 1] == l->body[node];
    return is_followed || node == 0 ? node : node - 1;
}

/* Goes through the twos in the order of nodes. Without a list it counts them, two places ahead of their groups; then it
 * lists them, where their groups go on, one place ahead. */
static void go_through(surface_ways *w, dem_index *list)
{
    const contact_surface *c = w->surface;
    dem_index beyond[MOST_GROUPS] = {0}; /* the nodes of a group before this have been looked at */
    for (dem_index k = 0; k < c->n_nodes; k++) {
        const dem_index node = c->nodes[k], group = group_of(w, node);
        if (node < beyond[group] || (w->of != NULL && !pair_rows_has(w->of, node))) continue;
        const dem_index first = first_of_two(c->lattice, node);
        beyond[group] = first + 2;
        if (list == NULL)
            w->begin[group + 2]++;
        else
            list[w->begin[group + 1]++] = vec2_row(first);
    }
}

static dem_status list_twos(surface_ways *w)
{
    const contact_surface *c = w->surface;
    w->n_groups = c->n_bodies <= MOST_GROUPS ? (int)c->n_bodies : 1;
    const size_t n = (size_t)w->n_groups, n_most = (size_t)c->n_nodes;
    w->begin = calloc(n + 2, sizeof *w->begin);
    w->boxes = malloc(n * sizeof *w->boxes);
    w->near = malloc(n * n);
    w->at = malloc(n_most * sizeof *w->at);
    w->places = malloc(4 * n_most * sizeof *w->places);
    CHECK(w->begin && w->boxes && w->near && w->at && w->places, DEM_ERROR_MEMORY,
          "out of memory for the ways of %lld nodes", (long long)c->n_nodes);
    go_through(w, NULL);
    for (int g = 1; g < w->n_groups + 2; g++) w->begin[g] += w->begin[g - 1];
    go_through(w, w->at);
    return DEM_OK;
}

/* ---- the state noted ---- */

/* The box of values at twos: that of ways from the origin, of some twos at a time. */
static box box_of_values(const double *x, const dem_index *at, dem_index n)
{
    enum { SOME = 256 };
    static const double origin[4 * SOME] = {0};
    box all = box_empty();
    for (dem_index k = 0; k < n; k += SOME)
        all = box_join(all, way_box_of(x, at + k, origin, n - k < SOME ? n - k : SOME));
    return all;
}

static void look_at_positions(surface_ways *w, const double *x)
{
    for (int g = 0; g < w->n_groups; g++) {
        const dem_index begin = w->begin[g], n = w->begin[g + 1] - begin;
        double *places = w->places + 4 * begin;
        w->boxes[g] = box_of_values(x, w->at + begin, n);
        for (dem_index k = 0; k < n; k++) memcpy(places + 4 * k, x + w->at[begin + k], 4 * sizeof *places);
    }
}

/* What is between two boxes, m. */
static double gap_between(box a, box b)
{
    const double x = fmax(b.low.x - a.high.x, a.low.x - b.high.x), y = fmax(b.low.y - a.high.y, a.low.y - b.high.y);
    return vec2_norm((vec2){fmax(x, 0.0), fmax(y, 0.0)});
}

static void find_near(surface_ways *w, double reach)
{
    const double far = reach + usual_gap * w->surface->mean_length;
    w->n_near = 0;
    w->between = INFINITY;
    for (int g = 0; g < w->n_groups; g++)
        for (int h = 0; h < g; h++) {
            const double gap = gap_between(w->boxes[g], w->boxes[h]);
            if (gap > far) {
                w->between = fmin(w->between, gap - reach);
                continue;
            }
            w->near[2 * w->n_near] = (unsigned char)g;
            w->near[2 * w->n_near++ + 1] = (unsigned char)h;
        }
}

dem_status surface_ways_note(surface_ways *w, double reach, const double *x)
{
    if (w->n_groups == 0) {
        const dem_status status = list_twos(w);
        if (status != DEM_OK) surface_ways_clear(w);
        TRY(status);
    }
    look_at_positions(w, x);
    find_near(w, reach);
    return DEM_OK;
}

/* ---- ways ---- */

/* The box of all ways, to the twos at these places of x. */
static box look_at_ways(const surface_ways *w, const double *x, const dem_index *at)
{
    box all = box_empty();
    for (int g = 0; g < w->n_groups; g++) {
        const dem_index begin = w->begin[g];
        w->boxes[g] = way_box_of(x, at + begin, w->places + 4 * begin, w->begin[g + 1] - begin);
        all = box_join(all, w->boxes[g]);
    }
    return all;
}

/* Of the ways in `boxes`, whose box is `all`: how much nearer near groups and those within a group have come, or more
 * than others by what was between them. */
static double longest_of(const surface_ways *w, double all)
{
    double longest = all - w->between;
    for (int g = 0; g < w->n_groups; g++) longest = fmax(longest, box_diagonal(w->boxes[g]));
    for (int k = 0; k < w->n_near; k++)
        longest = fmax(longest, box_diagonal(box_join(w->boxes[w->near[2 * k]], w->boxes[w->near[2 * k + 1]])));
    return longest;
}

bool surface_ways_within(const surface_ways *w, double most, const double *x)
{
    return surface_ways_within_at(w, most, x, w->at);
}

bool surface_ways_within_at(const surface_ways *w, double most, const double *x, const dem_index *at)
{
    const double all = box_diagonal(look_at_ways(w, x, at));
    return all <= most || longest_of(w, all) <= most;
}

double surface_ways_longest(const surface_ways *w, const double *x)
{
    const double all = box_diagonal(look_at_ways(w, x, w->at));
    return fmin(all, longest_of(w, all));
}

double surface_ways_spread(const surface_ways *w, const double *v)
{
    return box_diagonal(box_of_values(v, w->at, w->begin[w->n_groups]));
}
