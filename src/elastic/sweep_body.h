/* SPDX-License-Identifier: BSD-3-Clause */
/* The sweep over blocks of eight nodes, written once for all instruction sets. A file for each set (lanes_*.h) defines
 *   pairs  the two components of eight nodes, in the order x0 y0 x1 y1 .. x7 y7;
 *   lanes  one number for each of eight nodes, in the order 0 4 1 5 2 6 3 7, which is how pairs interleave without a
 *          permutation across the halves of a vector;
 * and their operations. The sweep_*.c files then define SWEEP, SWEEP_GUARD and SWEEP_STRAIN and include this. Every
 * operation acts on each node alone and rounds as in springs_force(), couplings_add_force(), triangles_force() and
 * forces_acceleration_by(): for each node the same IEEE operations follow in the same order, which is why the bits are
 * equal. */
#ifndef DEM_ELASTIC_SWEEP_BODY_H
#define DEM_ELASTIC_SWEEP_BODY_H

#include "elastic/sweep.h"

#define INLINE static inline __attribute__((always_inline)) /* so that laws are known where loops are compiled */

/* What acts beside undamped springs of their own, whether the pass takes a step, and whether it also tells which nodes
 * have springs that are strained more than their block's limit. */
typedef struct laws {
    bool damped, coupled, fused, watched;
} laws;

/* The operands of an entry for all lanes. `here` is where those that lie side by side are counted from. */
INLINE pairs fetch(const layout *l, const double *array, const double *here, int32_t at, bool gathered)
{
    return gathered ? pairs_gather(array, l->lists + at) : pairs_load(here + at);
}

/* The first eight places of a stream are repeated behind its end, so that any eight in a row can be read. */
INLINE void repeat_first(const layout *l, double *stream)
{
    pairs_store(stream + 2 * l->ring_rows, pairs_load(stream));
}

INLINE void repeat(const layout *l, intern_span span, double *ring)
{
    const layout_entry *entries = l->springs.entries.items;
    for (int32_t p = span.first; p < span.end; p++) repeat_first(l, ring + entries[p].to);
}

/* A bit for each node whose lane is chosen and takes part. */
INLINE unsigned nodes_of(unsigned chosen, unsigned mask)
{
    unsigned nodes = 0;
    for (int q = 0; q < LAYOUT_LANES; q++) nodes |= (chosen >> layout_lane(q) & mask >> (2 * q) & 1u) << q;
    return nodes;
}

/* The same of the nodes whose springs are longer or shorter than at rest by more than the limits. */
INLINE unsigned strained_of(lanes longer, lanes rest, sweep_limits limit, unsigned mask)
{
    const unsigned over = lanes_below(lanes_mul(lanes_all(limit.stretch), rest), longer) |
                          lanes_below(longer, lanes_mul(lanes_all(-limit.squeeze), rest));
    return over != 0 ? nodes_of(over, mask) : 0;
}

/* A strain within 1e-12 of a limit may count or not. */
INLINE sweep_limits limits_of(const sweep *s, dem_index block)
{
    return (sweep_limits){s->limit[block].stretch - 1e-12, s->limit[block].squeeze - 1e-12};
}

/* Forces (1) of the springs of which the block has the lower nodes, p d with p = E (|d| - d0)/(d0 |d|), into the ring;
 * and behind all of them, those of damping, c (d.v)/(d0 d^2) d. Lanes that take no part leave what nobody collects.
 * \return if it is watched, the nodes with a spring strained by more than the limit, a bit each */
INLINE unsigned evaluate_springs(const sweep *s, dem_index block, laws acting, sweep_limits limit, double *ring)
{
    const bool damped = acting.damped;
    const layout *l = s->layout;
    const intern_span span = l->springs.span[block];
    const layout_entry *entries = l->springs.entries.items;
    const double *sets = l->bonds.items;
    const dem_index row = LAYOUT_LANES * block, at_row = row & (l->ring_rows - 1);
    const double *positions = s->x + 2 * row, *velocities = damped ? s->v + 2 * row : NULL;
    const pairs x = pairs_load(positions), v = damped ? pairs_load(velocities) : x;
    double *out = ring + 2 * at_row, *damping = ring + 2 * l->ring_length;
    unsigned nodes = 0;
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const double *set = sets + e->set;
        const pairs d = pairs_sub(fetch(l, s->x, positions, e->at, gathered), x);
        const lanes square = pairs_dot(d, d), length = lanes_sqrt(square), rest = lanes_load(set + LAYOUT_LANES);
        const lanes longer = lanes_sub(length, rest), stretch = lanes_mul(lanes_load(set), longer);
        pairs_store(out + e->to, pairs_scale(lanes_div(stretch, lanes_mul(rest, length)), d));
        if (acting.watched) nodes |= strained_of(longer, rest, limit, e->mask);
        if (!damped) continue;
        const pairs dv = pairs_sub(fetch(l, s->v, velocities, e->at, gathered), v);
        const lanes rate = lanes_mul(lanes_load(set + 2 * LAYOUT_LANES), pairs_dot(d, dv));
        pairs_store(damping + 2 * at_row + e->to, pairs_scale(lanes_div(rate, lanes_mul(rest, square)), d));
    }
    if (at_row != 0) return nodes;
    repeat(l, span, ring);
    if (damped) repeat(l, span, damping);
    return nodes;
}

/* The blocks below the first are another share's. */
INLINE void evaluate_block(const sweep *s, dem_index block, dem_index first, laws acting, double *ring)
{
    const sweep_limits limit = acting.watched ? limits_of(s, block) : (sweep_limits){0.0, 0.0};
    const unsigned nodes = evaluate_springs(s, block, acting, limit, ring);
    if (acting.watched && block >= first) s->strained[block] = (uint8_t)nodes;
}

/* What couplings add to the tensions of edges, over their lengths, times the edges: `own` and `other` are the couplings
 * at the ends of an edge, and `before` and `behind` the stretches of the edges there. */
INLINE pairs pull_edge(pairs edge, lanes length, lanes own, lanes before, lanes other, lanes behind)
{
    const lanes tension = lanes_add(lanes_mul(own, before), lanes_mul(other, behind));
    return pairs_scale(lanes_div(tension, length), edge);
}

/* Forces of the coupled triangles of which the block has the lowest corners, on each corner, into the ring. */
INLINE void evaluate_couplings(const sweep *s, dem_index block, double *ring)
{
    const layout *l = s->layout;
    const intern_span span = l->couplings.span[block];
    const layout_entry *entries = l->couplings.entries.items;
    const dem_index row = LAYOUT_LANES * block, at_row = row & (l->ring_rows - 1);
    const double *here = s->x + 2 * row;
    double *out = ring + 2 * at_row;
    const pairs x = pairs_load(here);
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e += 2) {
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const double *set = (const double *)l->couples.items + e->set;
        const pairs next = fetch(l, s->x, here, e->at, gathered), last = fetch(l, s->x, here, e->to, gathered);
        const pairs edge[3] = {pairs_sub(next, x), pairs_sub(last, next), pairs_sub(x, last)};
        lanes length[3], stretch[3], coupling[3];
        pairs force[3];
        for (int c = 0; c < 3; c++) {
            length[c] = lanes_sqrt(pairs_dot(edge[c], edge[c]));
            stretch[c] = lanes_sub(length[c], lanes_load(set + c * LAYOUT_LANES));
            coupling[c] = lanes_load(set + (3 + c) * LAYOUT_LANES);
        }
        for (int c = 0; c < 3; c++)
            force[c] = pull_edge(edge[c], length[c], coupling[c], stretch[(c + 2) % 3], coupling[(c + 1) % 3],
                                 stretch[(c + 1) % 3]);
        pairs_store(out + e[1].at, pairs_sub(force[0], force[2]));
        pairs_store(out + e[1].to, pairs_sub(force[1], force[0]));
        pairs_store(out + e[1].set, pairs_sub(force[2], force[1]));
        if (at_row != 0) continue;
        repeat_first(l, ring + e[1].at);
        repeat_first(l, ring + e[1].to);
        repeat_first(l, ring + e[1].set);
    }
}

/* Adds to each node's sum the terms of its row, in the order of the row: the upper end of a spring subtracts the force
 * on the lower end. */
INLINE pairs sum_terms(const layout *l, const layout_part *part, dem_index block, const double *ring, pairs sum)
{
    const intern_span span = part->span[block];
    const layout_entry *entries = part->entries.items;
    const double *here = ring + 2 * (LAYOUT_LANES * block & (l->ring_rows - 1));
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        if (e->kind == LAYOUT_SUBTRACT) {
            sum = pairs_sub(sum, pairs_load(here + e->at));
        } else if (e->kind == LAYOUT_ADD) {
            sum = pairs_add(sum, pairs_load(here + e->at));
        } else {
            const pairs force = fetch(l, ring, here, e->at, e->kind == LAYOUT_GATHERED);
            sum = pairs_add(sum, pairs_mask(pairs_negate(force, (unsigned)e->to), e->mask));
        }
    }
    return sum;
}

/* Each node's sum over its triangles of the area term, -kappa (A/A0 - 1) dA/dx_i, and which nodes the guard acts on. */
INLINE pairs sum_corners(const sweep *s, dem_index block, unsigned *guarded)
{
    const layout *l = s->layout;
    const intern_span span = l->corners.span[block];
    const layout_entry *entries = l->corners.entries.items;
    const double *sets = l->areas.items, *here = s->x + 2 * LAYOUT_LANES * block;
    const pairs x = pairs_load(here), turn = pairs_both(-0.5, 0.5);
    pairs sum = pairs_both(0.0, 0.0);
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const double *set = sets + e->set;
        const pairs next = fetch(l, s->x, here, e->at, gathered), last = fetch(l, s->x, here, e->to, gathered);
        const lanes twice = pairs_cross(pairs_sub(next, x), pairs_sub(last, x));
        const lanes area = lanes_mul(lanes_all(0.5), twice), rest = lanes_load(set);
        const unsigned below = lanes_below(area, lanes_load(set + LAYOUT_LANES));
        if (below != 0) *guarded |= nodes_of(below, e->mask);
        if (!l->stiff) continue;
        const lanes stretch = lanes_sub(lanes_div(area, rest), lanes_all(1.0));
        const lanes slope = lanes_mul(lanes_load(set + 2 * LAYOUT_LANES), stretch);
        const pairs gradient = pairs_mul(turn, pairs_swap(pairs_sub(last, next)));
        const pairs force = pairs_scale(lanes_mul(lanes_all(-1.0), slope), gradient);
        sum = pairs_add(sum, pairs_mask(force, e->mask));
    }
    return sum;
}

/* a = g + F/m - alpha v; 0 where 1/m = 0, which is a fixed node. */
INLINE pairs accelerate(const sweep *s, dem_index block, laws acting, const double *ring)
{
    const layout *l = s->layout;
    const dem_index row = LAYOUT_LANES * block;
    const pairs none = pairs_both(0.0, 0.0);
    pairs force = sum_terms(l, &l->terms, block, ring, none);
    if (acting.coupled) force = sum_terms(l, &l->coupling_terms, block, ring, force);
    if (acting.damped) force = pairs_add(force, sum_terms(l, &l->terms, block, ring + 2 * l->ring_length, none));
    unsigned guarded = 0;
    if (l->corners.span[block].first < l->corners.span[block].end)
        force = pairs_add(force, sum_corners(s, block, &guarded));
    s->guarded[block] = (uint8_t)guarded;
    const pairs inverse_mass = pairs_spread(s->inverse_mass + row);
    pairs a = pairs_add(pairs_both(s->gravity.x, s->gravity.y), pairs_mul(inverse_mass, force));
    if (s->mass_damping != 0.0)
        a = pairs_add(a, pairs_mul(pairs_both(-s->mass_damping, -s->mass_damping), pairs_load(s->v + 2 * row)));
    return pairs_unless_zero(inverse_mass, a);
}

/* x1 = x0 + h v',  v' = v0 + h/2 a0 */
INLINE void drift(const sweep_fused_step *p, dem_index block)
{
    const dem_index at = 2 * LAYOUT_LANES * block;
    const pairs h = pairs_both(p->h, p->h), half_h = pairs_both(0.5 * p->h, 0.5 * p->h);
    const pairs half = pairs_add(pairs_load(p->v0 + at), pairs_mul(half_h, pairs_load(p->a0 + at)));
    pairs_store(p->x1 + at, pairs_add(pairs_load(p->x0 + at), pairs_mul(h, half)));
}

/* v1 = (v' + h/2 a0) + h/2 (a1 - a0), with the roundings of array_ops: there v1 is extrapolated first, since a1 may
 * depend on it. */
INLINE void kick(const sweep_fused_step *p, dem_index block, pairs a1)
{
    const dem_index at = 2 * LAYOUT_LANES * block;
    const pairs half_h = pairs_both(0.5 * p->h, 0.5 * p->h), a0 = pairs_load(p->a0 + at), push = pairs_mul(half_h, a0);
    const pairs extrapolated = pairs_add(pairs_add(pairs_load(p->v0 + at), push), push);
    pairs_store(p->v1 + at, pairs_add(extrapolated, pairs_mul(half_h, pairs_sub(a1, a0))));
}

/* Blocks below the first are evaluated only, for the springs that reach into this share from below. Nodes collect their
 * forces a block later than these are computed, when what was stored has reached the cache. */
INLINE double run(const sweep *s, dem_index first, dem_index last, laws acting, double *ring)
{
    const dem_index reach = s->layout->reach, ahead = s->layout->ahead;
    pairs sum = pairs_both(0.0, 0.0);
    for (dem_index block = first > reach ? first - reach : 0; block <= last; block++) {
        if (acting.fused && block >= first && block + ahead < last - ahead) drift(s->fused_step, block + ahead);
        if (block < last) evaluate_block(s, block, first, acting, ring);
        if (acting.coupled && block < last) evaluate_couplings(s, block, ring);
        if (block <= first) continue;
        const dem_index at = 2 * LAYOUT_LANES * (block - 1);
        const pairs a = accelerate(s, block - 1, acting, ring);
        pairs_store(s->a + at, a);
        sum = pairs_add(sum, a);
        if (acting.fused) kick(s->fused_step, block - 1, a);
        if (s->u == NULL) continue;
        const pairs v = pairs_load(s->v + at);
        pairs_store(s->u + at, v);
        sum = pairs_add(sum, v);
    }
    return pairs_total(sum);
}

void SWEEP_GUARD(const sweep *s, dem_index first, dem_index last)
{
    for (dem_index block = first; block < last; block++) {
        unsigned guarded = 0;
        (void)sum_corners(s, block, &guarded);
        s->guarded[block] = (uint8_t)guarded;
    }
}

/* Squares of lengths are compared, without roots. */
INLINE unsigned strained_nodes(const sweep *s, dem_index block, sweep_limits limit)
{
    const layout *l = s->layout;
    const intern_span span = l->springs.span[block];
    const layout_entry *entries = l->springs.entries.items;
    const double *sets = l->bonds.items, *here = s->x + 2 * LAYOUT_LANES * block;
    const double least = limit.squeeze < 1.0 ? 1.0 - limit.squeeze : 0.0, most = 1.0 + limit.stretch;
    const double low = least * least, high = most * most;
    const pairs x = pairs_load(here);
    unsigned nodes = 0;
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const pairs d = pairs_sub(fetch(l, s->x, here, e->at, e->kind == LAYOUT_GATHERED), x);
        const lanes square = pairs_dot(d, d), rest = lanes_load(sets + e->set + LAYOUT_LANES);
        const lanes at_rest = lanes_mul(rest, rest);
        const unsigned over = lanes_below(lanes_mul(lanes_all(high), at_rest), square) |
                              lanes_below(square, lanes_mul(lanes_all(low), at_rest));
        if (over != 0) nodes |= nodes_of(over, e->mask);
    }
    return nodes;
}

void SWEEP_STRAIN(const sweep *s, dem_index first, dem_index last)
{
    for (dem_index block = first; block < last; block++) {
        const sweep_limits limit = limits_of(s, block);
        const bool is_watched = fmin(limit.stretch, limit.squeeze) < (double)INFINITY;
        s->strained[block] = is_watched ? (uint8_t)strained_nodes(s, block, limit) : 0;
    }
}

double SWEEP(const sweep *s, dem_index first, dem_index last, double *ring)
{
    const layout *l = s->layout;
    const bool fused = s->fused_step != NULL, watched = s->limit != NULL;
    if (l->coupled) return run(s, first, last, (laws){l->damped, true, fused, watched}, ring);
    if (fused && watched) return run(s, first, last, (laws){.fused = true, .watched = true}, ring);
    if (fused) return run(s, first, last, (laws){.fused = true}, ring);
    return l->damped ? run(s, first, last, (laws){.damped = true}, ring) : run(s, first, last, (laws){0}, ring);
}

#endif
