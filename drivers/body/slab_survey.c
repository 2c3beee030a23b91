/* SPDX-License-Identifier: BSD-3-Clause */
/* Own nodes have all of their triangles, and of the others a slab says which are on the boundary. A side with both ends
 * there has all of its triangles in the strip, so that strip and body have the same sides between such nodes. */
#include "slab_survey.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/union_find.h"
#include "slab_nodes.h"

/* ---- the strip ---- */

static slab_corner corner_of(const dem_slab *slab, dem_index i, const dem_index *rims)
{
    const double *x = slab->lattice.x + 2 * i;
    return (slab_corner){
        .number = slab_nodes_number(slab, i), .x = {x[0], x[1]}, .flags = rims[i] > 0 ? DEM_NODE_CONTACT : 0};
}

static bool append_corners(slab_survey *s, const slab_corner corners[3])
{
    if (!grow_array((void **)&s->corners, &s->corner_room, s->n_corners + 3, sizeof *s->corners)) return false;
    memcpy(s->corners + s->n_corners, corners, 3 * sizeof *corners);
    s->n_corners += 3;
    return true;
}

static double shortest_side(const slab_corner corners[3])
{
    double least = (double)INFINITY;
    for (int c = 0; c < 3; c++) {
        const double *a = corners[c].x, *b = corners[(c + 1) % 3].x, x = b[0] - a[0], y = b[1] - a[1];
        least = fmin(least, sqrt(x * x + y * y));
    }
    return least;
}

static void note_inner(slab_survey *s, const slab_corner corners[3])
{
    const double side = shortest_side(corners);
    if (s->has_inner && side >= s->shortest) return;
    s->has_inner = true;
    s->shortest = side;
    memcpy(s->inner, corners, sizeof s->inner);
}

static bool add_triangle(slab_survey *s, const dem_slab *slab, const dem_index *corner, const dem_index *rims)
{
    slab_corner corners[3];
    unsigned flags = 0;
    for (int c = 0; c < 3; c++) {
        corners[c] = corner_of(slab, corner[c], rims);
        flags |= corners[c].flags;
    }
    if (flags != 0) return append_corners(s, corners);
    note_inner(s, corners);
    return true;
}

/* Edges of the boundary at each node, of which a rim's node has some or none. */
static dem_index *find_rims(slab_survey *s, const dem_slab *slab)
{
    const dem_lattice *l = &slab->lattice;
    dem_index *rims = calloc((size_t)l->n_nodes + 1, sizeof *rims);
    if (rims == NULL || dem_lattice_rims(l, rims) != DEM_OK) {
        free(rims);
        return NULL;
    }
    for (dem_index i = 0; i < l->n_nodes; i++) {
        if (slab_nodes_own(slab, i))
            s->has_hinge = s->has_hinge || rims[i] > 2;
        else
            rims[i] = slab->rim_boundary[slab_nodes_rim(slab, i)];
    }
    return rims;
}

bool slab_survey_add_strip(slab_survey *s, const dem_slab *slab)
{
    const dem_lattice *l = &slab->lattice;
    dem_index *rims = find_rims(s, slab);
    bool good = rims != NULL;
    for (dem_index t = 0; t < l->n_triangles && good; t++)
        if (slab_nodes_owns(slab, l->triangles + 3 * t, 3)) good = add_triangle(s, slab, l->triangles + 3 * t, rims);
    free(rims);
    return good;
}

static int by_number(const void *a, const void *b)
{
    const slab_corner *p = a, *q = b;
    return (p->number > q->number) - (p->number < q->number);
}

/* \return how many different ones there are, now the first in the list */
static dem_index keep_one_each(slab_corner *list, dem_index n)
{
    dem_index kept = 0;
    qsort(list, (size_t)n, sizeof *list, by_number);
    for (dem_index k = 0; k < n; k++)
        if (kept == 0 || list[k].number != list[kept - 1].number) list[kept++] = list[k];
    return kept;
}

static bool make_room(dem_lattice *out, dem_index n_nodes, dem_index n_triangles)
{
    out->n_nodes = n_nodes;
    out->n_triangles = n_triangles;
    out->x = calloc(2 * (size_t)n_nodes + 1, sizeof *out->x);
    out->flags = calloc((size_t)n_nodes + 1, sizeof *out->flags);
    out->triangles = calloc(3 * (size_t)n_triangles + 1, sizeof *out->triangles);
    if (out->x != NULL && out->flags != NULL && out->triangles != NULL) return true;
    dem_lattice_free(out);
    return false;
}

static bool fill_strip(dem_lattice *out, const slab_survey *s, slab_corner *nodes)
{
    memcpy(nodes, s->corners, (size_t)s->n_corners * sizeof *nodes);
    const dem_index n = keep_one_each(nodes, s->n_corners);
    if (!make_room(out, n, s->n_corners / 3)) return false;
    for (dem_index i = 0; i < n; i++) {
        memcpy(out->x + 2 * i, nodes[i].x, sizeof nodes[i].x);
        out->flags[i] = nodes[i].flags;
    }
    for (dem_index k = 0; k < s->n_corners; k++) {
        const slab_corner *found = bsearch(&s->corners[k], nodes, (size_t)n, sizeof *nodes, by_number);
        out->triangles[k] = found - nodes;
    }
    return true;
}

bool slab_survey_take_strip(dem_lattice *out, slab_survey *s)
{
    *out = dem_lattice_empty();
    if (s->has_inner && !append_corners(s, s->inner)) return false;
    s->has_inner = false;
    slab_corner *nodes = calloc((size_t)s->n_corners + 1, sizeof *nodes);
    const bool good = nodes != NULL && fill_strip(out, s, nodes);
    free(nodes);
    return good;
}

/* ---- parts ---- */

/* The parts of a slab come behind those that there are. */
static bool append_parts(slab_survey *s, dem_index n)
{
    if (!grow_array((void **)&s->parent, &s->part_room, s->n_parts + n, sizeof *s->parent)) return false;
    for (dem_index p = s->n_parts; p < s->n_parts + n; p++) s->parent[p] = p;
    s->n_parts += n;
    return true;
}

/* Both lists are ascending. */
static void join(slab_survey *s, const dem_index *number, const dem_index *part, dem_index n)
{
    dem_index k = 0;
    for (dem_index i = 0; i < n; i++) {
        while (k < s->n_last && s->last_number[k] < number[i]) k++;
        if (k < s->n_last && s->last_number[k] == number[i]) union_find_unite(s->parent, s->last_part[k], part[i]);
    }
}

static void note_springs(slab_survey *s, const dem_lattice *l)
{
    for (dem_index k = 0; k < l->n_springs; k++)
        if (s->rest_length == 0.0 || l->rest_length[k] < s->rest_length) s->rest_length = l->rest_length[k];
}

bool slab_survey_add_parts(slab_survey *s, const dem_slab *slab)
{
    const size_t room = (size_t)slab->lattice.n_nodes + 1;
    const dem_index first = s->n_parts;
    dem_index *number = calloc(room, sizeof *number), *part = calloc(room, sizeof *part), n_parts;
    const bool good = number != NULL && part != NULL && dem_lattice_parts(&slab->lattice, &n_parts, part) == DEM_OK &&
                      append_parts(s, n_parts);
    if (!good) {
        free(number);
        free(part);
        return false;
    }
    note_springs(s, &slab->lattice);
    for (dem_index i = 0; i < slab->lattice.n_nodes; i++) {
        number[i] = slab_nodes_number(slab, i);
        part[i] += first;
    }
    join(s, number, part, slab->lattice.n_nodes);
    free(s->last_number);
    free(s->last_part);
    s->last_number = number;
    s->last_part = part;
    s->n_last = slab->lattice.n_nodes;
    return true;
}

bool slab_survey_is_one(const slab_survey *s)
{
    for (dem_index p = 0; p < s->n_parts; p++)
        if (union_find_root(s->parent, p) != 0) return false;
    return !s->has_hinge;
}

void slab_survey_free(slab_survey *s)
{
    free(s->corners);
    free(s->parent);
    free(s->last_number);
    free(s->last_part);
    *s = (slab_survey){0};
}
