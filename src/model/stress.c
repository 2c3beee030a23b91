/* SPDX-License-Identifier: BSD-3-Clause */
/* Stress of nodes (docs/method.md, Stress). The stress of a triangle is
 *     S = (1/V) (sum over its springs of w r x f + sum of r x f of its couplings + A dW/dA I),
 * and that of a node the mean of its triangles' by volume. A spring's r x f goes to the triangles that hold it, with
 * the shares w of model/spring_holders.c. A spring outside of all triangles gives half to each of its ends. The file
 * puts the shares into rows by node when stresses are first asked for, once for all simulations of a model; the stress
 * itself is then a sum over a row. Largest stresses over time are in simulation/peaks.c; forces are not computed from
 * stresses anywhere. */
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
    stress_rows *rows;
    spring_holders holders;
    int32_t *next;   /* [n_nodes] slot to be written; while counting, number of slots */
    int32_t *last;   /* [n_nodes] the last spring that a node has got a share of; -1: none */
    dem_index loose; /* ends of springs in no triangle that have been visited */
    bool writes;
} draft;

/* Gives a share of a spring to a node. What a node has of one spring from two triangles is added up: such shares come
 * one after the other, since all triangles of a spring are visited in one go. */
static void give(draft *d, dem_index node, dem_index spring, double share)
{
    const bool again = d->last[node] == spring;
    const int32_t p = again ? d->next[node] - 1 : d->next[node]++;
    d->last[node] = (int32_t)spring;
    if (!d->writes) return;
    d->rows->spring[p] = (int32_t)spring;
    d->rows->share[p] = again ? d->rows->share[p] + share : share;
}

/* From each triangle a third of its share goes to every corner; of a spring in no triangle half goes to each end. */
static void give_share(void *context, dem_index spring, dem_index triangle, double share)
{
    draft *d = context;
    const dem_lattice *l = d->rows->lattice;
    if (triangle < 0) give(d, l->ends[2 * spring + (d->loose++ & 1)], spring, share);
    for (int c = 0; c < 3 && triangle >= 0; c++) give(d, l->triangles[3 * triangle + c], spring, share / 3.0);
}

static void forget_last(draft *d)
{
    for (dem_index i = 0; i < d->rows->lattice->n_nodes; i++) d->last[i] = -1;
}

/* From counts to rows, and to the slots that are written first. */
static dem_status lay_rows(draft *d)
{
    const dem_lattice *l = d->rows->lattice;
    int32_t *row = d->rows->row;
    dem_index total = 0;
    for (dem_index i = 0; i < l->n_nodes; i++) total += d->next[i];
    CHECK(total < INT32_MAX, DEM_ERROR_MODEL, "the stresses of %lld nodes are more than the library takes",
          (long long)l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        row[i + 1] = row[i] + d->next[i];
        d->next[i] = row[i];
    }
    return DEM_OK;
}

/* Shares over volumes make the sum of a row a stress. */
static void divide_by_volumes(stress_rows *r)
{
    for (dem_index i = 0; i < r->lattice->n_nodes; i++)
        for (dem_index p = r->row[i]; p < r->row[i + 1]; p++)
            r->share[p] = r->volume[i] > 0.0 ? r->share[p] / r->volume[i] : 0.0;
}

static dem_status allocate_shares(stress_rows *r, dem_index n_nodes, dem_index n)
{
    r->spring = malloc(((size_t)n + 1) * sizeof *r->spring);
    r->share = malloc(((size_t)n + 1) * sizeof *r->share);
    CHECK(r->spring && r->share, DEM_ERROR_MEMORY, "out of memory for the stresses of %lld nodes", (long long)n_nodes);
    return DEM_OK;
}

/* The volume of a node is a third of that of its triangles at rest. */
static dem_status make_volumes(void *self)
{
    stress_rows *r = self;
    const dem_lattice *l = r->lattice;
    r->volume = lattice_zeros(l->n_nodes, sizeof *r->volume);
    CHECK(r->volume, DEM_ERROR_MEMORY, "out of memory for the volumes of %lld nodes", (long long)l->n_nodes);
    for (dem_index k = 0; k < 3 * l->n_triangles; k++)
        r->volume[l->triangles[k]] += spring_share_volume(l, k / 3) / 3.0;
    return DEM_OK;
}

/* Count, lay out the rows, write. All sums that follow are in the order of these rows. */
static dem_status fill(draft *d)
{
    stress_rows *r = d->rows;
    const dem_lattice *l = r->lattice;
    TRY(on_demand_make(&r->weighed, make_volumes, r));
    TRY(spring_holders_create(&d->holders, l, r->springs));
    d->next = lattice_zeros(l->n_nodes, sizeof *d->next);
    d->last = lattice_zeros(l->n_nodes, sizeof *d->last);
    r->row = lattice_zeros(l->n_nodes + 1, sizeof *r->row);
    CHECK(d->next && d->last && r->row, DEM_ERROR_MEMORY, "out of memory");
    forget_last(d);
    spring_holders_count(&d->holders, give_share, d);
    TRY(lay_rows(d));
    TRY(allocate_shares(r, l->n_nodes, r->row[l->n_nodes]));
    forget_last(d);
    d->writes = true;
    spring_holders_visit(&d->holders, give_share, d);
    divide_by_volumes(r);
    return DEM_OK;
}

static void free_arrays(stress_rows *r)
{
    free(r->row);
    free(r->spring);
    free(r->share);
    r->row = r->spring = NULL;
    r->share = NULL;
}

static void free_volumes(stress_rows *r)
{
    free(r->volume);
    r->volume = NULL;
}

/* Holders and counters are needed only while the shares are found. */
static dem_status make_of_lattice(stress_rows *r)
{
    draft d = {.rows = r};
    const dem_status status = fill(&d);
    spring_holders_free(&d.holders);
    free(d.next);
    free(d.last);
    if (status != DEM_OK) free_arrays(r);
    return status;
}

static dem_status make_by_maker(stress_rows *r)
{
    const dem_status status = r->maker.make(r->maker.self, r);
    if (status == DEM_OK) return DEM_OK;
    free_arrays(r);
    free_volumes(r);
    return status;
}

static dem_status make_rows(void *self)
{
    stress_rows *r = self;
    return r->maker.make != NULL ? make_by_maker(r) : make_of_lattice(r);
}

dem_status stress_prepare(const stress_map *map)
{
    return on_demand_make(&map->rows->made, make_rows, map->rows);
}

void stress_forget(const stress_map *map)
{
    free_arrays(map->rows);
    map->rows->made.is_made = false;
}

const double *stress_volumes(const stress_map *map)
{
    stress_rows *r = map->rows;
    const dem_status status =
        r->maker.make != NULL ? stress_prepare(map) : on_demand_make(&r->weighed, make_volumes, r);
    return status == DEM_OK ? r->volume : NULL;
}

static dem_status create_locks(stress_rows *r)
{
    TRY(on_demand_create(&r->made));
    const dem_status status = on_demand_create(&r->weighed);
    if (status != DEM_OK) on_demand_destroy(&r->made);
    return status;
}

dem_status stress_compile(stress_map *out, const dem_lattice *lattice, const springs *s, const couplings *c)
{
    stress_rows *r = calloc(1, sizeof *r);
    CHECK_MEMORY(r);
    r->lattice = lattice;
    r->springs = s;
    const dem_status status = create_locks(r);
    if (status == DEM_OK)
        *out = (stress_map){.rows = r, .couplings = c};
    else
        free(r);
    return status;
}

dem_status stress_create(stress_map *out, const stress_maker *maker, const couplings *c)
{
    TRY(stress_compile(out, NULL, NULL, c));
    out->rows->maker = *maker;
    return DEM_OK;
}

void stress_free(stress_map *map)
{
    if (map->rows != NULL) {
        on_demand_destroy(&map->rows->made);
        on_demand_destroy(&map->rows->weighed);
        free_arrays(map->rows);
        free_volumes(map->rows);
        if (map->rows->maker.make != NULL) map->rows->maker.end(map->rows->maker.self);
        free(map->rows);
    }
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
        for (int k = 0; k < 3; k++) stress[k] += virial[k] / (3.0 * map->rows->volume[i]);
    }
}

/* The sum over the node's row of share r x f, Pa, and the isotropic part A dW/dA of its triangles, of which a third
 * falls to each corner. */
void stress_of_node(const stress_map *map, const dem_lattice *lattice, const triangles *t, dem_index i, const double *x,
                    double stress[3])
{
    const stress_rows *r = map->rows;
    const dem_index first = r->row[i], n = r->row[i + 1] - first;
    stress[0] = stress[1] = stress[2] = 0.0;
    springs_add_virials(lattice, n, r->spring + first, r->share + first, x, stress);
    const double spread = triangles_node_virial(t, i, x, 3.0 * r->volume[i]); /* the same in all directions */
    stress[0] += spread;
    stress[1] += spread;
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
