/* SPDX-License-Identifier: BSD-3-Clause */
/* Stress of nodes (docs/method.md, Stress). The stress of a triangle is
 *     S = (1/V) (sum over its springs of w r x f + sum of r x f of its couplings + A dW/dA I),
 * and that of a node the mean of its triangles' by volume. A spring's r x f goes to the triangles that hold it, with
 * the shares w of model/spring_holders.c. A spring outside of all triangles gives half to each of its ends. The file
 * compiles the shares into rows by node, once; the stress itself is then a sum over a row. Largest stresses over time
 * are in simulation/peaks.c; forces are not computed from stresses anywhere. */
#include "model/stress.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/status.h"
#include "lattice/lattice.h"
#include "model/spring_holders.h"
#include "model/spring_share.h"

/* ---- compilation ---- */

/* Goes through the same shares twice: first it counts, then it writes. */
typedef struct draft {
    const dem_lattice *lattice;
    spring_holders holders;
    dem_index *next; /* [n_nodes] slot to be written; while counting, number of slots */
    dem_index loose; /* ends of springs in no triangle that have been visited */
    bool writes;
    stress_map *map;
} draft;

/* Gives a share of a spring to a node. The first pass only counts; the second one writes. */
static void give(draft *d, dem_index node, dem_index spring, double share)
{
    const dem_index p = d->next[node]++;
    if (!d->writes) return;
    d->map->spring[p] = spring;
    d->map->share[p] = share;
}

/* From each triangle a third of its share goes to every corner; of a spring in no triangle half goes to each end. */
static void give_share(void *context, dem_index spring, dem_index triangle, double share)
{
    draft *d = context;
    const dem_lattice *l = d->lattice;
    if (triangle < 0) give(d, l->ends[2 * spring + (d->loose++ & 1)], spring, share);
    for (int c = 0; c < 3 && triangle >= 0; c++) give(d, l->triangles[3 * triangle + c], spring, share / 3.0);
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
 * all triangles of a spring are visited in one go. */
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
static dem_status compile(draft *d, const springs *s)
{
    const dem_lattice *l = d->lattice;
    stress_map *map = d->map;
    TRY(spring_holders_create(&d->holders, l, s));
    d->next = lattice_zeros(l->n_nodes, sizeof *d->next);
    map->row = lattice_zeros(l->n_nodes + 1, sizeof *map->row);
    map->volume = lattice_zeros(l->n_nodes, sizeof *map->volume);
    CHECK(d->next && map->row && map->volume, DEM_ERROR_MEMORY, "out of memory");
    spring_holders_count(&d->holders, give_share, d);
    lay_rows(d);
    map->spring = lattice_zeros(map->row[l->n_nodes], sizeof *map->spring);
    map->share = lattice_zeros(map->row[l->n_nodes], sizeof *map->share);
    CHECK(map->spring && map->share, DEM_ERROR_MEMORY, "out of memory for the stresses of %lld nodes",
          (long long)l->n_nodes);
    d->writes = true;
    spring_holders_visit(&d->holders, give_share, d);
    merge(map, l->n_nodes);
    divide_by_volumes(map, l);
    return DEM_OK;
}

/* Holders and counters are needed only while the shares are found. */
dem_status stress_compile(stress_map *out, const dem_lattice *lattice, const springs *s, const couplings *c)
{
    stress_map map = {.couplings = c};
    draft d = {.lattice = lattice, .map = &map};
    const dem_status status = compile(&d, s);
    spring_holders_free(&d.holders);
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
    const double spread = triangles_node_virial(t, i, x, 3.0 * map->volume[i]); /* the same in all directions */
    stress[0] = xx + spread;
    stress[1] = yy + spread;
    stress[2] = xy;
    if (map->couplings->n > 0) add_couplings(map, i, x, stress);
}

double dem_stress_von_mises(const double stress[3])
{
    return sqrt(stress_square(stress));
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
