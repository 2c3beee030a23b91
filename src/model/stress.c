/* SPDX-License-Identifier: BSD-3-Clause */
/* Stress of nodes (docs/method.md, Stress). The stress of a triangle is
 *     S = (1/V) (sum over its springs of w r x f + sum of r x f of its couplings + A dW/dA I),
 * and that of a node the mean of its triangles' by volume. A spring's r x f goes to the triangles that have it for a
 * side, or between whose outer corners it is (the second diagonal of a square), with shares w in proportion to modulus
 * * thickness * area * weight (lattice/triangle_share.h): what they gave to its stiffness. A spring outside of all
 * triangles gives half to each of its ends. The file compiles the shares into rows by node, once; the stress itself is
 * then a sum over a row. Largest stresses over time are in simulation/peaks.c; forces are not computed from stresses
 * anywhere. */
#include "model/stress.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/status.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"
#include "model/spring_share.h"

/* ---- compilation ---- */

/* Goes through the same shares twice: first it counts, then it writes. */
typedef struct draft {
    const dem_lattice *lattice;
    const springs *springs;
    mesh_edges sides;
    bool *placed;    /* [n_springs] in a triangle */
    dem_index *next; /* [n_nodes] slot to be written; while counting, number of slots */
    bool writes;
    stress_map *map;
} draft;

/* The corner of a triangle that is neither i nor j. */
static dem_index opposite(const dem_lattice *l, dem_index triangle, dem_index i, dem_index j)
{
    const dem_index *c = &l->triangles[3 * triangle];
    return c[0] != i && c[0] != j ? c[0] : (c[1] != i && c[1] != j ? c[1] : c[2]);
}

/* Gives a share of a spring to a node. The first pass only counts; the second one writes. */
static void give(draft *d, dem_index node, dem_index spring, double share)
{
    const dem_index p = d->next[node]++;
    if (!d->writes) return;
    d->map->spring[p] = spring;
    d->map->share[p] = share;
}

/* Shares a spring between the triangles of the edge in slots p to end - 1 of the sides: to each in proportion to
 * what it has given to the spring, and from each a third to every corner. */
static void give_triangles(draft *d, dem_index spring, dem_index p, dem_index end)
{
    const dem_lattice *l = d->lattice;
    double sum = 0.0;
    for (dem_index q = p; q < end; q++) sum += spring_share_given(l, d->sides.list[q].triangle, spring);
    for (dem_index q = p; q < end; q++) {
        const dem_index t = d->sides.list[q].triangle;
        const double share = spring_share_given(l, t, spring) / sum;
        for (int c = 0; c < 3; c++) give(d, l->triangles[3 * t + c], spring, share / 3.0);
    }
    d->placed[spring] = true;
}

/* The spring along the edge of node i in slots p to end - 1 of the sides; or else (`along` false), where two triangles
 * meet there, the one between their outer corners. -1: there is none. */
static dem_index spring_of(const draft *d, bool along, dem_index i, dem_index p, dem_index end)
{
    const mesh_edge_slot *list = d->sides.list;
    const dem_index j = list[p].upper;
    if (along) return springs_between(d->springs, i, j);
    if (end - p != 2) return -1;
    return springs_between(d->springs, opposite(d->lattice, list[p].triangle, i, j),
                           opposite(d->lattice, list[p + 1].triangle, i, j));
}

/* Goes through all edges, and shares their springs if no triangle has them yet. */
static void give_edges(draft *d, bool along)
{
    for (dem_index i = 0; i < d->lattice->n_nodes; i++)
        for (dem_index p = d->sides.row[i], end; p < d->sides.row[i + 1]; p = end) {
            for (end = p + 1; end < d->sides.row[i + 1] && !mesh_edges_is_first(&d->sides, i, end);) end++;
            const dem_index spring = spring_of(d, along, i, p, end);
            if (spring >= 0 && !d->placed[spring]) give_triangles(d, spring, p, end);
        }
}

/* Springs along edges come first: a spring that is an edge of some triangle must not be taken for a diagonal between
 * the outer corners of two others. */
static void give_all(draft *d)
{
    for (dem_index k = 0; k < d->lattice->n_springs; k++) d->placed[k] = false;
    give_edges(d, true);
    give_edges(d, false);
    for (dem_index k = 0; k < 2 * d->lattice->n_springs; k++)
        if (!d->placed[k / 2]) give(d, d->lattice->ends[k], k / 2, 0.5);
}

/* From counts to rows, and to the slots that are written first. */
static void lay_rows(draft *d)
{
    dem_index *row = d->map->row;
    for (dem_index i = 0; i < d->lattice->n_nodes; i++) {
        row[i + 1] = row[i] + d->next[i];
        d->next[i] = row[i];
    }
}

/* Adds up what a node has of one spring from two triangles. Such shares are next to each other in its row, since
 * give_triangles() gives them in one go. */
static void merge(stress_map *map, dem_index n_nodes)
{
    dem_index kept = 0;
    for (dem_index i = 0, p = 0; i < n_nodes; i++) {
        const dem_index end = map->row[i + 1], start = kept;
        for (; p < end; p++) {
            if (kept > start && map->spring[kept - 1] == map->spring[p]) {
                map->share[kept - 1] += map->share[p];
                continue;
            }
            map->spring[kept] = map->spring[p];
            map->share[kept++] = map->share[p];
        }
        map->row[i + 1] = kept;
    }
}

/* The volume of a node is a third of that of its triangles at rest. Shares over volumes make the sum of a row a
 * stress. */
static void divide_by_volumes(stress_map *map, const dem_lattice *l)
{
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        map->volume[l->triangles[k]] += spring_share_volume(l, k / 3) / 3.0;
    for (dem_index i = 0; i < l->n_nodes; i++)
        for (dem_index p = map->row[i]; p < map->row[i + 1]; p++)
            map->share[p] = map->volume[i] > 0.0 ? map->share[p] / map->volume[i] : 0.0;
}

/* Count, lay out the rows, write, merge. All sums that follow are in the order of these rows. */
static dem_status compile(draft *d)
{
    const dem_lattice *l = d->lattice;
    stress_map *map = d->map;
    TRY(mesh_edges_create(&d->sides, l));
    d->placed = lattice_zeros(l->n_springs, sizeof *d->placed);
    d->next = lattice_zeros(l->n_nodes, sizeof *d->next);
    map->row = lattice_zeros(l->n_nodes + 1, sizeof *map->row);
    map->volume = lattice_zeros(l->n_nodes, sizeof *map->volume);
    CHECK(d->placed && d->next && map->row && map->volume, DEM_ERROR_MEMORY, "out of memory");
    give_all(d);
    lay_rows(d);
    map->spring = lattice_zeros(map->row[l->n_nodes], sizeof *map->spring);
    map->share = lattice_zeros(map->row[l->n_nodes], sizeof *map->share);
    CHECK(map->spring && map->share, DEM_ERROR_MEMORY, "out of memory for the stresses of %lld nodes",
          (long long)l->n_nodes);
    d->writes = true;
    give_all(d);
    merge(map, l->n_nodes);
    divide_by_volumes(map, l);
    return DEM_OK;
}

/* The sides and counters are needed only while the shares are found. */
dem_status stress_compile(stress_map *out, const dem_lattice *lattice, const springs *s, const couplings *c)
{
    stress_map map = {.couplings = c};
    draft d = {.lattice = lattice, .springs = s, .map = &map};
    const dem_status status = compile(&d);
    mesh_edges_free(&d.sides);
    free(d.placed);
    free(d.next);
    if (status == DEM_OK)
        *out = map;
    else
        stress_free(&map);
    return status;
}

void stress_free(stress_map *map)
{
    free(map->row);
    free(map->spring);
    free(map->share);
    free(map->volume);
    *map = (stress_map){0};
}

/* ---- stresses ---- */

/* A third of the r x f of the couplings of each triangle falls to each corner. */
static void add_couplings(const stress_map *map, dem_index i, const double *x, double stress[3])
{
    const couplings *c = map->couplings;
    for (dem_index p = c->row[i]; p < c->row[i + 1]; p++) {
        double virial[3];
        couplings_virial(c, p, x, virial);
        for (int k = 0; k < 3; k++) stress[k] += virial[k] / (3.0 * map->volume[i]);
    }
}

/* The sum over the node's row of share r x f, Pa, and the isotropic part A dW/dA of its triangles, of which a third
 * falls to each corner. */
void stress_of_node(const stress_map *map, const dem_lattice *lattice, const triangles *t, dem_index i, const double *x,
                    double stress[3])
{
    double xx = 0.0, yy = 0.0, xy = 0.0;
    for (dem_index p = map->row[i]; p < map->row[i + 1]; p++) {
        double virial[3];
        springs_virial(lattice, map->spring[p], x, virial);
        xx += map->share[p] * virial[0];
        yy += map->share[p] * virial[1];
        xy += map->share[p] * virial[2];
    }
    double spread = 0.0; /* of triangles, the same in all directions */
    for (dem_index p = t->row[i]; p < t->row[i + 1]; p++)
        spread += triangles_virial(t, i, p, x) / (3.0 * map->volume[i]);
    stress[0] = xx + spread;
    stress[1] = yy + spread;
    stress[2] = xy;
    if (map->couplings->n > 0) add_couplings(map, i, x, stress);
}

/* Of plane stress. */
double dem_stress_von_mises(const double stress[3])
{
    const double xx = stress[0], yy = stress[1], xy = stress[2];
    return sqrt(xx * xx - xx * yy + yy * yy + 3.0 * xy * xy);
}

/* Principal stresses, the larger one first, and the unit direction of that, with x >= 0. Since (S - value[0]) (S -
 * value[1]) = 0, every column of S - value[1] I is along the first direction; the larger of the two columns is taken.
 * Equal principal stresses have no direction, and the x axis stands for it. */
void dem_stress_principal(const double stress[3], double value[2], double direction[2])
{
    const double mean = 0.5 * (stress[0] + stress[1]), half = 0.5 * (stress[0] - stress[1]), xy = stress[2];
    const double radius = sqrt(half * half + xy * xy);
    /* (S - value[1]) applied to the axis that it does not make small */
    vec2 first = half >= 0.0 ? (vec2){half + radius, xy} : (vec2){xy, radius - half};
    if (radius == 0.0) first = (vec2){1.0, 0.0};
    const double sign = first.x < 0.0 ? -1.0 : 1.0;
    value[0] = mean + radius;
    value[1] = mean - radius;
    vec2_put(direction, 0, vec2_scale(sign / vec2_norm(first), first));
}
