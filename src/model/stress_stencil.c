/* SPDX-License-Identifier: BSD-3-Clause */
/* The sums of model/node_stress.c and model/stress.c in the same order, so that they have the same bits. A spring is in
 * the sums of four nodes of a solid of equal triangles. */
#include "model/stress_stencil.h"

#include <stdlib.h>
#include <string.h>

#include "base/row_pair.h"
#include "base/status.h"
#include "model/spring_share.h"

dem_status stress_stencil_create(stress_stencil **out, const dem_model *model, const element_state *elements)
{
    stress_stencil *p = calloc(1, sizeof *p);
    CHECK_MEMORY(p);
    p->model = model;
    p->elements = elements;
    *out = p;
    return DEM_OK;
}

void stress_stencil_destroy(stress_stencil *p)
{
    free(p);
}

/* ---- lists ---- */

static void fill_spring(const dem_lattice *l, int32_t k, stress_stencil_spring *out)
{
    out->number = k;
    for (int e = 0; e < 2; e++) out->end[e] = (int32_t)l->ends[2 * (dem_index)k + e];
    out->stiffness = l->stiffness[k];
    out->rest_length = l->rest_length[k];
}

/* The place of a spring, which is listed if it is not there. There is room. */
static int place_of(stress_stencil *p, int32_t k)
{
    uint32_t cell = (uint32_t)k % STRESS_STENCIL_CELLS;
    while (p->cells[cell] != 0 && p->spring[p->cells[cell] - 1].number != k) cell = (cell + 1) % STRESS_STENCIL_CELLS;
    if (p->cells[cell] == 0) {
        fill_spring(&p->model->lattice, k, &p->spring[p->n_springs++]);
        p->cells[cell] = (uint8_t)p->n_springs;
    }
    return p->cells[cell] - 1;
}

/* \return whether there was room for it */
static bool add_terms(stress_stencil *p, int32_t n, const int32_t *list, const double *share)
{
    if (p->n_terms + n > STRESS_STENCIL_TERMS || p->n_springs + n > STRESS_STENCIL_SPRINGS) return false;
    for (int32_t q = 0; q < n; q++) p->term[p->n_terms++] = (stress_stencil_term){place_of(p, list[q]), share[q]};
    return true;
}

/* Half of r x f of the springs at the node that no triangle holds, as three halves of what is divided by 3. */
static bool add_loose_terms(stress_stencil *p, dem_index i)
{
    static const double share = 1.5;
    const springs *all = &p->model->springs;
    const element_state *e = p->elements;
    bool fits = true;
    for (int32_t q = all->row[i]; q < all->row[i + 1]; q++) {
        const int32_t k = all->spring[q];
        if (!e->held[k] && e->integrity[k] != 0.0) fits = fits && add_terms(p, 1, &k, &share);
    }
    return fits;
}

/* Of a node at which all elements are whole. */
static bool add_row(stress_stencil *p, dem_index i)
{
    const stress_rows *r = p->model->stress.rows;
    const int32_t first = r->row[i];
    return add_terms(p, r->row[i + 1] - first, r->spring + first, r->share + first);
}

/* Of another one: its triangles that are whole. The sum is divided by three times their part of its volume. */
static bool add_whole_triangles(stress_stencil *p, dem_index i, double *volume)
{
    const element_state *e = p->elements;
    double sum = 0.0;
    bool fits = true;
    for (int32_t a = e->at_row[i]; a < e->at_row[i + 1]; a++) {
        const int32_t t = e->at[a], first = e->row[t];
        if (e->triangle[t]) continue;
        fits = fits && add_terms(p, e->row[t + 1] - first, e->spring + first, e->share + first);
        sum += spring_share_volume(&p->model->lattice, t);
    }
    if (sum == 0.0) return fits;
    *volume = sum;
    return fits && add_loose_terms(p, i);
}

static bool add_areas(stress_stencil *p, dem_index i)
{
    const triangles *t = &p->model->triangles;
    const triangles_integrity integrity = element_state_triangles(p->elements);
    if (p->n_areas + t->row[i + 1] - t->row[i] > STRESS_STENCIL_AREAS) return false;
    for (int32_t q = t->row[i]; q < t->row[i + 1]; q++)
        if (!triangles_broken(t, integrity, q))
            p->area[p->n_areas++] = (stress_stencil_area){{(int32_t)i, t->next[q], t->last[q]}};
    return true;
}

static bool add_node(stress_stencil *p, dem_index i)
{
    double volume = 1.0;
    const bool whole = element_state_at(p->elements, i) == NULL;
    if (p->n == STRESS_STENCIL_NODES) return false;
    if (!(whole ? add_row(p, i) : add_whole_triangles(p, i, &volume)) || !add_areas(p, i)) return false;
    p->node[p->n++] = (stress_stencil_node){p->n_terms, volume, {0.0, 0.0, 0.0}};
    return true;
}

int stress_stencil_list(stress_stencil *p, const dem_index *nodes, dem_index n)
{
    p->n = p->n_springs = p->n_terms = p->n_areas = 0;
    memset(p->cells, 0, sizeof p->cells);
    if (p->model->couplings.n > 0 || p->model->triangles.area_stiffness_of != NULL) return 0;
    for (dem_index j = 0; j < n; j++)
        if (!add_node(p, nodes[j])) break;
    return p->n;
}

/* ---- stresses ---- */

INLINE void put_virial(stress_stencil_spring *k, double tension, row_pair d)
{
    row_pair_put(k->virial, 0, tension * d * d);
    k->virial[2] = tension * d[0] * d[1];
}

/* r x f of two springs, which may be the same. */
INLINE void find_two(stress_stencil_spring *a, stress_stencil_spring *b, const double *x)
{
    const row_pair one = row_pair_at(x + 2 * a->end[1], 0) - row_pair_at(x + 2 * a->end[0], 0);
    const row_pair two = row_pair_at(x + 2 * b->end[1], 0) - row_pair_at(x + 2 * b->end[0], 0);
    const row_pair rest = {a->rest_length, b->rest_length}, stiffness = {a->stiffness, b->stiffness};
    const row_pair tension = springs_pull_two(stiffness, rest, row_pair_lengths(one, two));
    put_virial(a, tension[0], one);
    put_virial(b, tension[1], two);
}

static void find_virials(stress_stencil *p, const double *x)
{
    const int n = p->n_springs;
    for (int k = 0; k + 1 < n; k += 2) find_two(&p->spring[k], &p->spring[k + 1], x);
    if (n % 2 == 1) find_two(&p->spring[n - 1], &p->spring[n - 1], x);
}

/* A guard is off for certain where the area is larger than its onset by more than the areas of one triangle at its
 * corners may differ by rounding. */
static bool are_slack(const stress_stencil *p, const double *x)
{
    const double least = 1.01 * p->model->triangles.largest_onset;
    bool slack = true;
    for (int k = 0; k < p->n_areas; k++) {
        const int32_t *at = p->area[k].corner;
        slack &= vec2_triangle_area(vec2_at(x, at[0]), vec2_at(x, at[1]), vec2_at(x, at[2])) >= least;
    }
    return slack;
}

static void add_up(const stress_stencil *p, int first, stress_stencil_node *to)
{
    row_pair sum = {0.0, 0.0};
    double xy = 0.0;
    for (int q = first; q < to->terms; q++) {
        const double share = p->term[q].share, *virial = p->spring[p->term[q].place].virial;
        sum += share * row_pair_at(virial, 0);
        xy += share * virial[2];
    }
    row_pair_put(to->stress, 0, sum / to->volume);
    to->stress[2] = xy / to->volume;
}

bool stress_stencil_find(stress_stencil *p, const double *x)
{
    if (!are_slack(p, x)) return false;
    find_virials(p, x);
    for (int j = 0, first = 0; j < p->n; first = p->node[j++].terms) add_up(p, first, &p->node[j]);
    return true;
}
