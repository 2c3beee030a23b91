/* SPDX-License-Identifier: BSD-3-Clause */
/* The pass over eight nodes at a time, as the sweep of the forces goes (sweep_body.h); compiled once for each
 * instruction set, whose vectors LANES names. */
#include LANES

#include "elastic/energy_pass.h"
#include "elastic/lane_operands.h"
#include "elastic/lanes_terms.h"

/* What is summed up and compared over some blocks. */
typedef struct running {
    exact_terms *elastic, *area;
    lanes least, largest, area_min;
} running;

/* A block in hand. */
typedef struct place {
    const layout *l;
    const double *x, *here; /* positions of all, and of the block's nodes */
    dem_index block;
    unsigned skipped; /* lanes */
    unsigned folded;  /* lanes of which triangles are folded, found here */
} place;

/* The bits of lanes from those of nodes. */
INLINE unsigned lanes_of_nodes(unsigned nodes)
{
    unsigned chosen = 0;
    for (int q = 0; q < LAYOUT_LANES; q++) chosen |= (nodes >> q & 1u) << layout_lane(q);
    return chosen;
}

INLINE pairs positions(const place *p, int32_t at, bool gathered)
{
    return lane_operands_fetch(p->l, p->x, p->here, at, gathered);
}

enum { ALL_LANES = (1 << LAYOUT_LANES) - 1 };

/* Lanes that take no part have no energy, and no extreme. */
INLINE void take_strains(running *r, lanes strain, lanes energy, unsigned taken)
{
    lanes low = strain, high = strain;
    if (taken != ALL_LANES) {
        low = lanes_where(taken, strain, lanes_all((double)INFINITY));
        high = lanes_where(taken, strain, lanes_all(-(double)INFINITY));
        energy = lanes_where(taken, energy, lanes_all(0.0));
    }
    r->least = lanes_min(low, r->least);
    r->largest = lanes_max(high, r->largest);
    lanes_terms_add(r->elastic, energy);
}

/* E d0 e^2/2 with the strain e = (|d| - d0)/d0 */
INLINE void measure_springs(const place *p, running *r)
{
    const intern_span span = p->l->springs.span[p->block];
    const layout_entry *entries = p->l->springs.entries.items;
    const double *sets = p->l->bonds.items;
    const pairs x = pairs_load(p->here);
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const pairs d = pairs_sub(positions(p, e->at, e->kind == LAYOUT_GATHERED), x);
        const lanes stiffness = lanes_load(sets + e->set), rest = lanes_load(sets + e->set + LAYOUT_LANES);
        const lanes strain = lanes_div(lanes_sub(lanes_sqrt(pairs_dot(d, d)), rest), rest);
        const lanes scale = lanes_mul(lanes_mul(lanes_all(0.5), stiffness), rest);
        take_strains(r, strain, lanes_mul(lanes_mul(scale, strain), strain), lane_operands_taken(e) & ~p->skipped);
    }
}

/* Each product of two stretches of a triangle is a term of its own: then it does not matter which corner is the
 * first. */
INLINE void measure_couplings(const place *p, running *r)
{
    const intern_span span = p->l->couplings.span[p->block];
    const layout_entry *entries = p->l->couplings.entries.items;
    const pairs x = pairs_load(p->here);
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e += 2) {
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const double *set = (const double *)p->l->couples.items + e->set;
        const pairs next = positions(p, e->at, gathered), last = positions(p, e->to, gathered);
        const pairs edge[3] = {pairs_sub(next, x), pairs_sub(last, next), pairs_sub(x, last)};
        const unsigned taken = lane_operands_taken(e) & ~p->skipped;
        lanes stretch[3];
        for (int c = 0; c < 3; c++)
            stretch[c] = lanes_sub(lanes_sqrt(pairs_dot(edge[c], edge[c])), lanes_load(set + c * LAYOUT_LANES));
        for (int c = 0; c < 3; c++) {
            const lanes coupling = lanes_load(set + (3 + c) * LAYOUT_LANES);
            const lanes term = lanes_mul(lanes_mul(coupling, stretch[c]), stretch[(c + 2) % 3]);
            lanes_terms_add(r->elastic, taken == ALL_LANES ? term : lanes_where(taken, term, lanes_all(0.0)));
        }
    }
}

/* Whether some of these areas may be folded, or the smallest so far in their lanes, over those at rest: without a
 * quotient, which rounds by less than the margin. */
INLINE bool may_be_small(const running *r, lanes area, lanes rest, unsigned taken)
{
    const lanes least = lanes_max(r->area_min, lanes_all(TRIANGLES_GUARD_ONSET));
    return (lanes_below(area, lanes_mul(lanes_mul(least, lanes_all(1.0 + 1e-12)), rest)) & taken) != 0;
}

/* A0 kappa/2 (J - 1)^2 with J = A/A0 */
INLINE void measure_areas(place *p, running *r)
{
    const intern_span span = p->l->lowest.span[p->block];
    const layout_entry *entries = p->l->lowest.entries.items;
    const double *sets = p->l->areas.items;
    const pairs x = pairs_load(p->here);
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const unsigned taken = lane_operands_taken(e) & ~p->skipped;
        if (taken == 0) continue;
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const pairs next = positions(p, e->at, gathered), last = positions(p, e->to, gathered);
        const lanes area = lanes_mul(lanes_all(0.5), pairs_cross(pairs_sub(next, x), pairs_sub(last, x)));
        const lanes rest = lanes_load(sets + e->set);
        if (!p->l->stiff && !may_be_small(r, area, rest, taken)) continue;
        lanes J = lanes_div(area, rest);
        if (taken != ALL_LANES) J = lanes_where(taken, J, lanes_all((double)INFINITY));
        r->area_min = lanes_min(J, r->area_min);
        p->folded |= lanes_below(J, lanes_all(TRIANGLES_GUARD_ONSET));
        if (!p->l->stiff) continue;
        const lanes more = lanes_sub(J, lanes_all(1.0)), kappa = lanes_load(sets + e->set + 2 * LAYOUT_LANES);
        const lanes energy = lanes_mul(lanes_mul(lanes_mul(lanes_mul(lanes_all(0.5), rest), kappa), more), more);
        lanes_terms_add(r->area, taken == ALL_LANES ? energy : lanes_where(taken, energy, lanes_all(0.0)));
    }
}

INLINE void measure_block(const energy_pass *p, dem_index block, running *r)
{
    place at = {.l = p->layout, .x = p->x, .here = p->x + 2 * LAYOUT_LANES * block, .block = block};
    if (p->skipped != NULL && p->skipped[block] != 0) at.skipped = lanes_of_nodes(p->skipped[block]);
    measure_springs(&at, r);
    if (at.l->coupled) measure_couplings(&at, r);
    measure_areas(&at, r);
    p->folded[block] = at.folded != 0 ? (uint8_t)lane_operands_nodes(at.folded) : 0;
}

/* The extreme of eight lanes. */
INLINE double extreme_of(lanes values, bool largest)
{
    double list[LAYOUT_LANES];
    lanes_store(list, values);
    for (int k = 1; k < LAYOUT_LANES; k++)
        if (largest ? list[k] > list[0] : list[k] < list[0]) list[0] = list[k];
    return list[0];
}

void ENERGY_PASS(const energy_pass *p, dem_index first, dem_index last, energy_sums *out)
{
    exact_terms elastic, area;
    running r = {.elastic = &elastic, .area = &area, .area_min = lanes_all((double)INFINITY)};
    exact_terms_begin(&elastic, &out->elastic);
    exact_terms_begin(&area, &out->area);
    for (dem_index from = first; from < last; from += ENERGY_PASS_GROUP) {
        const dem_index end = from + ENERGY_PASS_GROUP < last ? from + ENERGY_PASS_GROUP : last;
        r.least = lanes_all((double)INFINITY);
        r.largest = lanes_all(-(double)INFINITY);
        for (dem_index block = from; block < end; block++) measure_block(p, block, &r);
        p->least[from / ENERGY_PASS_GROUP] = extreme_of(r.least, false);
        p->largest[from / ENERGY_PASS_GROUP] = extreme_of(r.largest, true);
    }
    out->area_min = extreme_of(r.area_min, false);
    exact_terms_end(&elastic);
    exact_terms_end(&area);
}
