/* SPDX-License-Identifier: BSD-3-Clause */
/* Each spring's r x f is computed once, and each node sums up its share of that. Compiled once for each instruction
 * set, whose vectors LANES names; with the plain loops the compiler fills vectors by itself. */
#include LANES

#include <string.h>

#include "base/inline.h"
#include "elastic/lane_operands.h"
#include "model/stress_pass.h"

typedef double two __attribute__((vector_size(16)));
typedef double four __attribute__((vector_size(32)));

enum { BATCH = 256 };

/* Vectors from end to end. */
static void fill_ways(const stress_pass *p, dem_index first, int n, double *dx, double *dy)
{
    const dem_index *ends = p->lattice->ends + 2 * first;
    for (int q = 0; q < n; q++) {
        two from, to;
        memcpy(&from, p->x + 2 * ends[2 * q], sizeof from);
        memcpy(&to, p->x + 2 * ends[2 * q + 1], sizeof to);
        const two way = to - from;
        dx[q] = way[0];
        dy[q] = way[1];
    }
}

/* With the tension over the length, N/m, as in springs_virial(). Each of the four numbers is stored by itself first, as
 * vectors are, and then put together with the others of its spring. */
static void fill_virials(const stress_pass *p, dem_index first, int n)
{
    double dx[BATCH], dy[BATCH], xy[BATCH], strain[BATCH];
    const double *stiffness = p->lattice->stiffness + first, *rest_length = p->lattice->rest_length + first;
    four *out = (four *)(p->virial + 4 * first);
    fill_ways(p, first, n, dx, dy);
    for (int q = 0; q < n; q++) {
        const double x = dx[q], y = dy[q], length = sqrt(x * x + y * y), rest = rest_length[q];
        const double tension = springs_pull(stiffness[q], rest, length);
        dx[q] = tension * x * x;
        dy[q] = tension * y * y;
        xy[q] = tension * x * y;
        strain[q] = springs_strain_at(rest, length);
    }
    for (int q = 0; q < n; q++) out[q] = (four){dx[q], dy[q], xy[q], strain[q]};
}

void STRESS_PASS_SPRINGS(const stress_pass *p, dem_index first, dem_index last)
{
    for (; first < last; first += BATCH) fill_virials(p, first, last - first < BATCH ? (int)(last - first) : BATCH);
}

/* Four numbers at once, of which the last is of no use. */
void STRESS_PASS_NODES(const stress_pass *p, dem_index first, dem_index last)
{
    const stress_rows *r = p->map->rows;
    const four *virial = (const four *)p->virial;
    for (dem_index i = first; i < last; i++) {
        four sum = {0.0, 0.0, 0.0, 0.0};
        for (dem_index k = r->row[i]; k < r->row[i + 1]; k++) sum += r->share[k] * virial[r->spring[k]];
        for (int c = 0; c < 3; c++) p->stress[3 * i + c] = sum[c];
    }
}

void STRESS_PASS_COUPLINGS(const stress_pass *p, dem_index first, dem_index last)
{
    for (dem_index k = first; k < last; k++) couplings_virial_of(&p->map->couplings->list[k], p->x, p->coupled + 4 * k);
}

/* A third of it falls to each corner. */
void STRESS_PASS_CORNERS(const stress_pass *p, dem_index first, dem_index last)
{
    const couplings *c = p->map->couplings;
    const four *virial = (const four *)p->coupled;
    for (dem_index i = first; i < last; i++) {
        const double thrice = 3.0 * p->map->rows->volume[i];
        four sum = {p->stress[3 * i], p->stress[3 * i + 1], p->stress[3 * i + 2], 0.0};
        for (dem_index k = c->row[i]; k < c->row[i + 1]; k++) sum += virial[c->slot[k] / 3] / thrice;
        for (int q = 0; q < 3; q++) p->stress[3 * i + q] = sum[q];
    }
}

/* Sum over a node's triangles of A dW/dA over three of its volumes. */
INLINE lanes spread_of(const stress_pass *p, dem_index block, unsigned *guarded)
{
    const layout *l = p->layout;
    const intern_span span = l->corners.span[block];
    const layout_entry *entries = l->corners.entries.items;
    const double *here = p->x + 2 * LAYOUT_LANES * block;
    const pairs x = pairs_load(here);
    const lanes volume = pairs_dot(pairs_spread(p->map->rows->volume + LAYOUT_LANES * block), pairs_both(1.0, 0.0));
    const lanes thrice = lanes_mul(lanes_all(3.0), volume);
    lanes sum = lanes_all(0.0);
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const double *set = (const double *)l->areas.items + e->set;
        const pairs next = lane_operands_fetch(l, p->x, here, e->at, gathered);
        const pairs last = lane_operands_fetch(l, p->x, here, e->to, gathered);
        const lanes area = lanes_mul(lanes_all(0.5), pairs_cross(pairs_sub(next, x), pairs_sub(last, x)));
        const unsigned taken = lane_operands_taken(e);
        *guarded |= lanes_below(area, lanes_load(set + LAYOUT_LANES)) & taken;
        if (!l->stiff) continue;
        const lanes stretch = lanes_sub(lanes_div(area, lanes_load(set)), lanes_all(1.0));
        const lanes slope = lanes_mul(lanes_load(set + 2 * LAYOUT_LANES), stretch);
        sum = lanes_where(taken, lanes_add(sum, lanes_div(lanes_mul(area, slope), thrice)), sum);
    }
    return sum;
}

void STRESS_PASS_AREAS(const stress_pass *p, dem_index first, dem_index last)
{
    double spread[LAYOUT_LANES];
    for (dem_index block = first; block < last; block++) {
        unsigned guarded = 0;
        lanes_store(spread, spread_of(p, block, &guarded));
        const unsigned nodes = guarded != 0 ? lane_operands_nodes(guarded) : 0;
        p->guarded[block] = (uint8_t)nodes;
        double *stress = p->stress + 3 * LAYOUT_LANES * block;
        for (int q = 0; q < LAYOUT_LANES && p->layout->stiff; q++)
            for (int c = 0; c < 2 && !(nodes >> q & 1); c++) stress[3 * q + c] += spread[layout_lane(q)];
    }
}
