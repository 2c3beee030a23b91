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

#include "base/inline.h"
#include "elastic/lane_operands.h"
#include "elastic/sweep.h"

/* What acts beside undamped springs of their own, whether the pass takes a step, whether it also tells which nodes have
 * springs that are strained more than their block's limit, and whether entries may be soft. */
typedef struct laws {
    bool damped, coupled, fused, watched, softened;
} laws;

enum { all_lanes = 0xffff };

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

/* Most often none is chosen. */
INLINE unsigned nodes_of_any(unsigned chosen, unsigned mask)
{
    return chosen != 0 ? nodes_of(chosen, mask) : 0;
}

/* The lanes in which something is not between two numbers, by the least and the most of it. */
INLINE unsigned beyond(double from, double to, lanes least, lanes most)
{
    return lanes_below(least, lanes_all(from)) | lanes_below(lanes_all(to), most);
}

/* The lanes in which springs, of these lengths, are longer or shorter than at rest by more than the limits. A strain
 * within 1e-12 of a limit may count or not. */
INLINE unsigned over_limits(const double *set, lanes length, const sweep_limits *limit)
{
    if (limit->longest >= 0.0) return beyond(limit->shortest, limit->longest, length, length);
    const double stretch = (double)limit->stretch - 1e-12, squeeze = (double)limit->squeeze - 1e-12;
    const lanes rest = lanes_load(set + LAYOUT_LANES), longer = lanes_sub(length, rest);
    return lanes_below(lanes_mul(lanes_all(stretch), rest), longer) |
           lanes_below(longer, lanes_mul(lanes_all(-squeeze), rest));
}

/* Force (1) on the lower nodes, p d with p = E (|d| - d0)/(d0 |d|), of springs with a stiffness E and the rest lengths
 * of a set. */
INLINE pairs pull_by(lanes stiffness, const double *set, pairs d, lanes length)
{
    const lanes rest = lanes_load(set + LAYOUT_LANES);
    const lanes stretch = lanes_mul(stiffness, lanes_sub(length, rest));
    return pairs_scale(lanes_div(stretch, lanes_mul(rest, length)), d);
}

INLINE pairs pull(const double *set, pairs d, lanes length)
{
    return pull_by(lanes_load(set), set, d, length);
}

/* The same of springs which are not as stiff in tension as under pressure. */
INLINE pairs pull_soft(const double *set, bool damped, pairs d, lanes length)
{
    const lanes pushed = lanes_load(set), pulled = lanes_load(set + (damped ? 3 : 2) * LAYOUT_LANES);
    const unsigned longer = lanes_below(lanes_load(set + LAYOUT_LANES), length);
    return pull_by(lanes_where(longer, pulled, pushed), set, d, length);
}

/* Forces of the springs of which the block has the lower nodes, into the ring; and behind all of them, those of
 * damping, c (d.v)/(d0 d^2) d. Lanes that take no part leave what nobody collects.
 * \return if it is watched, the nodes with a spring strained by more than its limit, a bit each */
INLINE unsigned evaluate_springs(const sweep *s, dem_index block, laws acting, double *ring)
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
    unsigned over = 0;
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const double *set = sets + e->set;
        const pairs d = pairs_sub(lane_operands_fetch(l, s->x, positions, e->at, gathered), x);
        const lanes square = pairs_dot(d, d), length = lanes_sqrt(square);
        pairs_store(out + e->to, acting.softened && e->soft ? pull_soft(set, damped, d, length) : pull(set, d, length));
        if (acting.watched) over |= over_limits(set, length, &s->limit[block]) & lane_operands_taken(e);
        if (!damped) continue;
        const pairs dv = pairs_sub(lane_operands_fetch(l, s->v, velocities, e->at, gathered), v);
        const lanes rate = lanes_mul(lanes_load(set + 2 * LAYOUT_LANES), pairs_dot(d, dv));
        const lanes scale = lanes_div(rate, lanes_mul(lanes_load(set + LAYOUT_LANES), square));
        pairs_store(damping + 2 * at_row + e->to, pairs_scale(scale, d));
    }
    if (at_row == 0) repeat(l, span, ring);
    if (at_row == 0 && damped) repeat(l, span, damping);
    return nodes_of_any(over, all_lanes);
}

/* The blocks below the first are another share's. */
INLINE void note_strained(const sweep *s, dem_index block, dem_index first, laws acting, unsigned nodes)
{
    if (acting.watched && nodes != 0 && block >= first) s->strained[block] = (uint8_t)nodes;
}

/* What couplings add to the tensions of edges: `own` and `other` are the couplings at the ends of an edge, and `before`
 * and `behind` the stretches of the edges there. */
INLINE lanes tension_of(lanes own, lanes before, lanes other, lanes behind)
{
    return lanes_add(lanes_mul(own, before), lanes_mul(other, behind));
}

/* Forces of the coupled triangles of which the block has the lowest corners, on each corner, into the ring. */
INLINE void evaluate_couplings(const sweep *s, dem_index block, laws acting, double *ring)
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
        const pairs next = lane_operands_fetch(l, s->x, here, e->at, gathered),
                    last = lane_operands_fetch(l, s->x, here, e->to, gathered);
        const pairs edge[3] = {pairs_sub(next, x), pairs_sub(last, next), pairs_sub(x, last)};
        lanes length[3], stretch[3], coupling[3];
        pairs force[3];
        for (int c = 0; c < 3; c++) {
            length[c] = lanes_sqrt(pairs_dot(edge[c], edge[c]));
            stretch[c] = lanes_sub(length[c], lanes_load(set + c * LAYOUT_LANES));
            coupling[c] = lanes_load(set + (3 + c) * LAYOUT_LANES);
        }
        for (int c = 0; c < 3; c++) {
            lanes tension = tension_of(coupling[c], stretch[(c + 2) % 3], coupling[(c + 1) % 3], stretch[(c + 1) % 3]);
            if (acting.softened && e->soft) tension = lanes_mul(lanes_load(set + 6 * LAYOUT_LANES), tension);
            force[c] = pairs_scale(lanes_div(tension, length[c]), edge[c]);
        }
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
            const pairs force = lane_operands_fetch(l, ring, here, e->at, e->kind == LAYOUT_GATHERED);
            sum = pairs_add(sum, pairs_mask(pairs_negate(force, (unsigned)e->to), e->mask));
        }
    }
    return sum;
}

/* Each node's sum over its triangles of the area term, -kappa (A/A0 - 1) dA/dx_i, and which nodes the guard acts on. */
INLINE pairs sum_corners(const sweep *s, dem_index block, laws acting, unsigned *guarded)
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
        const pairs next = lane_operands_fetch(l, s->x, here, e->at, gathered),
                    last = lane_operands_fetch(l, s->x, here, e->to, gathered);
        const lanes twice = pairs_cross(pairs_sub(next, x), pairs_sub(last, x));
        const lanes area = lanes_mul(lanes_all(0.5), twice), rest = lanes_load(set);
        const unsigned below = lanes_below(area, lanes_load(set + LAYOUT_LANES)) & lane_operands_taken(e);
        if (below != 0) *guarded |= lane_operands_nodes(below);
        if (!l->stiff) continue;
        const lanes ratio = lanes_div(area, rest), stretch = lanes_sub(ratio, lanes_all(1.0));
        lanes stiffness = lanes_load(set + 2 * LAYOUT_LANES);
        if (acting.softened && e->soft)
            stiffness = lanes_where(lanes_below(lanes_all(1.0), ratio), lanes_load(set + 3 * LAYOUT_LANES), stiffness);
        const lanes slope = lanes_mul(stiffness, stretch);
        const pairs gradient = pairs_mul(turn, pairs_swap(pairs_sub(last, next)));
        const pairs force = pairs_scale(lanes_mul(lanes_all(-1.0), slope), gradient);
        sum = pairs_add(sum, pairs_mask(force, e->mask));
    }
    return sum;
}

/* The sum of forces on the nodes of a block but for those of triangles. */
INLINE pairs force_on(const sweep *s, dem_index block, laws acting, const double *ring)
{
    const layout *l = s->layout;
    const pairs none = pairs_both(0.0, 0.0);
    pairs force = sum_terms(l, &l->terms, block, ring, none);
    if (acting.coupled) force = sum_terms(l, &l->coupling_terms, block, ring, force);
    if (acting.damped) force = pairs_add(force, sum_terms(l, &l->terms, block, ring + 2 * l->ring_length, none));
    return force;
}

/* A pass over the blocks `first` to `last` - 1: what is the same for all of them, and what is added up. */
typedef struct pass {
    const sweep *sweep;
    dem_index first, last, drift_end;
    double *ring;
    pairs gravity, h, half_h, sum;
} pass;

INLINE pass begin_pass(const sweep *s, dem_index first, dem_index last, double *ring)
{
    const double h = s->fused_step != NULL ? s->fused_step->h : 0.0;
    const dem_index ahead_of_last = last + s->layout->ahead;
    return (pass){s,
                  first,
                  last,
                  s->drift_end < ahead_of_last ? s->drift_end : ahead_of_last,
                  ring,
                  pairs_both(s->gravity.x, s->gravity.y),
                  pairs_both(h, h),
                  pairs_both(0.5 * h, 0.5 * h),
                  pairs_both(0.0, 0.0)};
}

/* a = g + F/m - alpha v; 0 where 1/m = 0, which is a fixed node. */
INLINE pairs accelerate(const pass *p, dem_index block, laws acting, pairs force)
{
    const sweep *s = p->sweep;
    const layout *l = s->layout;
    const dem_index row = LAYOUT_LANES * block;
    if (!s->looks_at_lowest) {
        unsigned guarded = 0;
        if (l->corners.span[block].first < l->corners.span[block].end)
            force = pairs_add(force, sum_corners(s, block, acting, &guarded));
        s->guarded[block] = (uint8_t)guarded;
    }
    const pairs inverse_mass = pairs_spread(s->inverse_mass + row);
    pairs a = pairs_add(p->gravity, pairs_mul(inverse_mass, force));
    if (s->mass_damping != 0.0)
        a = pairs_add(a, pairs_mul(pairs_both(-s->mass_damping, -s->mass_damping), pairs_load(s->v + 2 * row)));
    return pairs_unless_zero(inverse_mass, a);
}

/* x1 = x0 + h v',  v' = v0 + h/2 a0 */
INLINE void drift(const pass *p, const sweep_fused_step *step, dem_index block)
{
    const dem_index at = 2 * LAYOUT_LANES * block;
    const pairs half = pairs_add(pairs_load(step->v0 + at), pairs_mul(p->half_h, pairs_load(step->a0 + at)));
    pairs_store(step->x1 + at, pairs_add(pairs_load(step->x0 + at), pairs_mul(p->h, half)));
}

/* v1 = (v' + h/2 a0) + h/2 (a1 - a0), with the roundings of array_ops: there v1 is extrapolated first, since a1 may
 * depend on it. */
INLINE void kick(const pass *p, const sweep_fused_step *step, dem_index block, pairs a1)
{
    const dem_index at = 2 * LAYOUT_LANES * block;
    const pairs a0 = pairs_load(step->a0 + at), push = pairs_mul(p->half_h, a0);
    const pairs extrapolated = pairs_add(pairs_add(pairs_load(step->v0 + at), push), push);
    pairs_store(step->v1 + at, pairs_add(extrapolated, pairs_mul(p->half_h, pairs_sub(a1, a0))));
}

/* The positions that a block is the first to read. Those at the beginning of the pass, behind its drift_end, and in
 * drifted blocks are there already. */
INLINE void drift_ahead(const pass *p, dem_index block, laws acting)
{
    const sweep *s = p->sweep;
    const dem_index ahead = s->layout->ahead;
    if (acting.fused && block >= p->first && block + ahead < p->drift_end &&
        (USUALLY(s->drifted == NULL) || !s->drifted[block + ahead]))
        drift(p, s->fused_step, block + ahead);
}

/* What follows from the forces of springs on the nodes of a block. */
INLINE void complete(pass *p, dem_index block, laws acting, pairs force)
{
    const sweep *s = p->sweep;
    const dem_index at = 2 * LAYOUT_LANES * block;
    const pairs a = accelerate(p, block, acting, force);
    pairs_store(s->a + at, a);
    const pairs square = pairs_mul(a, a);
    p->sum = pairs_add(p->sum, pairs_mul(square, square));
    if (acting.fused) kick(p, s->fused_step, block, a);
    if (s->u == NULL) return;
    const pairs v = pairs_load(s->v + at);
    pairs_store(s->u + at, v);
    p->sum = pairs_add(p->sum, pairs_mul(pairs_both(0.0, 0.0), v));
}

/* ---- rows of a lattice ---- */

enum { most_rows = 4 }; /* neighbours of a node at higher places, in a square lattice with both diagonals */

/* What a block does whose nodes all have n neighbours at higher places and n at lower ones, side by side, which are
 * nearly all blocks of a lattice numbered by rows. Operands are counted in numbers from the block on. */
typedef struct row_block {
    int32_t upper[most_rows];                 /* neighbours at higher places */
    int32_t own[most_rows], lower[most_rows]; /* in the ring: forces that the block evaluates, and those from below */
    const double *set[most_rows];             /* coefficients */
} row_block;

/* \return n; 0: the block is not of this kind */
INLINE int describe_row(const layout *l, dem_index block, row_block *out)
{
    const intern_span evaluated = l->springs.span[block], summed = l->terms.span[block];
    const layout_entry *e = (const layout_entry *)l->springs.entries.items + evaluated.first;
    const layout_entry *term = (const layout_entry *)l->terms.entries.items + summed.first;
    const int n = evaluated.end - evaluated.first;
    if (n > most_rows || summed.end - summed.first != 2 * n) return 0;
    for (int k = 0; k < n; k++) {
        if (e[k].kind != LAYOUT_ADD || term[k].kind != LAYOUT_SUBTRACT) return 0;
        if (term[n + k].kind != LAYOUT_ADD || term[n + k].at != e[k].to) return 0;
        out->upper[k] = e[k].at;
        out->own[k] = e[k].to;
        out->lower[k] = term[k].at;
        out->set[k] = (const double *)l->bonds.items + e[k].set;
    }
    return n;
}

/* Equal lists of entries are stored once. */
INLINE bool do_the_same(const layout *l, dem_index a, dem_index b)
{
    return l->springs.span[a].first == l->springs.span[b].first && l->terms.span[a].first == l->terms.span[b].first;
}

/* The nodes of a block of rows with a spring strained by more than its limit. */
INLINE unsigned strained_in_row(const sweep_limits *limit, const row_block *row, const lanes *length, int n)
{
    lanes least = length[0], most = length[0];
    unsigned over = 0;
    if (limit->longest < 0.0) {
        UNROLLED for (int k = 0; k < n; k++) over |= over_limits(row->set[k], length[k], limit);
        return nodes_of_any(over, all_lanes);
    }
    UNROLLED for (int k = 1; k < n; k++)
    {
        least = lanes_min(least, length[k]);
        most = lanes_max(most, length[k]);
    }
    return nodes_of_any(beyond(limit->shortest, limit->longest, least, most), all_lanes);
}

/* Whether rows have a loop of their own. */
INLINE bool has_rows(int n)
{
    return n == 3 || n == 4;
}

/* Vectors of the springs of a block of rows, and their lengths. */
INLINE void measure_row(const double *here, const row_block *row, int n, pairs *d, lanes *length)
{
    const pairs x = pairs_load(here);
    UNROLLED for (int k = 0; k < n; k++) d[k] = pairs_sub(pairs_load(here + row->upper[k]), x);
    UNROLLED for (int k = 0; k < n; k++) length[k] = lanes_sqrt(pairs_dot(d[k], d[k]));
}

/* What nothing reads: compilers do not see that. */
INLINE void clear_row(int n, pairs *d, lanes *length)
{
    UNROLLED for (int k = 0; k < n; k++) d[k] = pairs_both(0.0, 0.0);
    UNROLLED for (int k = 0; k < n; k++) length[k] = lanes_all(0.0);
}

/* The row of a block in the ring, and where its forces stand there. */
INLINE dem_index ring_row(const pass *p, dem_index block)
{
    return LAYOUT_LANES * block & (p->sweep->layout->ring_rows - 1);
}

INLINE const double *ring_at(const pass *p, dem_index block)
{
    return p->ring + 2 * ring_row(p, block);
}

/* Forces of springs with these vectors and lengths, into the ring. */
INLINE void store_row(const pass *p, dem_index at_row, const row_block *row, int n, const pairs *d, const lanes *length)
{
    UNROLLED for (int k = 0; k < n; k++)
    {
        double *stream = p->ring + row->own[k];
        pairs_store(stream + 2 * at_row, pull(row->set[k], d[k], length[k]));
        if (at_row == 0) repeat_first(p->sweep->layout, stream);
    }
}

/* The sum of forces on the nodes of a block of rows. */
INLINE pairs sum_row(const double *here, const row_block *row, int n)
{
    pairs force = pairs_both(0.0, 0.0);
    UNROLLED for (int k = 0; k < n; k++) force = pairs_sub(force, pairs_load(here + row->lower[k]));
    UNROLLED for (int k = 0; k < n; k++) force = pairs_add(force, pairs_load(here + row->own[k]));
    return force;
}

/* A block that a pass over rows is at: what it does, if it is one of rows, and the vectors and lengths of its springs
 * until their forces are in the ring. */
typedef struct row_step {
    const row_block *row;
    bool is_row;
    pairs d[most_rows];
    lanes length[most_rows];
} row_step;

/* Measures the springs of a block; where rows end, their forces are in the ring then. */
INLINE void begin_step(const pass *p, dem_index block, laws acting, row_step *b, int n)
{
    const sweep *s = p->sweep;
    unsigned strained = 0;
    drift_ahead(p, block, acting);
    if (USUALLY(b->is_row)) {
        measure_row(s->x + 2 * LAYOUT_LANES * block, b->row, n, b->d, b->length);
        if (acting.watched) strained = strained_in_row(&s->limit[block], b->row, b->length, n);
    } else {
        clear_row(n, b->d, b->length);
        strained = evaluate_springs(s, block, acting, p->ring);
    }
    note_strained(s, block, p->first, acting, strained);
}

INLINE void store_step(const pass *p, dem_index block, const row_step *b, int n)
{
    if (USUALLY(b->is_row)) store_row(p, ring_row(p, block), b->row, n, b->d, b->length);
}

INLINE void end_step(pass *p, dem_index block, laws acting, const row_block *row, bool is_row, int n)
{
    complete(p, block, acting,
             USUALLY(is_row) ? sum_row(ring_at(p, block), row, n) : force_on(p->sweep, block, acting, p->ring));
}

/* Passes over the blocks from `block` on; the one before is described by `first`, and its forces are in the ring. Most
 * are blocks of rows with n springs a node; the others, in which rows end, are done by their entries. What a block does
 * is looked up where it changes. Three blocks are in hand at a time: the roots of one are begun, the quotients and
 * forces of that before follow, and the one before that is completed; none of these waits for another.
 * \return the first block that is not evaluated: one of rows with another number of springs, or that behind the last;
 * the one before it is to be completed */
INLINE dem_index run_rows(pass *p, dem_index block, laws acting, const row_block *first, int n)
{
    enum { in_hand = 4 }; /* and the next one, which is looked up before the last is completed */
    row_block known[in_hand];
    const dem_index begin = block;
    row_step now = {.row = first, .is_row = true}, before = {.row = first};
    const row_block *completed = first;
    bool was_row = true;
    for (int next = 0; block < p->last; block++) {
        if (!USUALLY(do_the_same(p->sweep->layout, block, block - 1))) {
            const int k = describe_row(p->sweep->layout, block, &known[next]);
            if (has_rows(k) && k != n) break;
            now.row = &known[next];
            now.is_row = k == n;
            next = (next + 1) % in_hand;
        }
        begin_step(p, block, acting, &now, n);
        store_step(p, block - 1, &before, n);
        if (USUALLY(block > begin)) end_step(p, block - 2, acting, completed, was_row, n);
        completed = before.row;
        was_row = block == begin || before.is_row;
        before = now;
    }
    store_step(p, block - 1, &before, n);
    if (block > begin) end_step(p, block - 2, acting, completed, was_row, n);
    return block;
}

/* Does so where it can. Damping and couplings are not done there.  \return the block behind those passed over */
INLINE dem_index pass_rows(pass *p, dem_index block, laws acting)
{
    row_block before;
    if (acting.damped || acting.coupled || block <= p->first || block >= p->last) return block;
    const int n = describe_row(p->sweep->layout, block - 1, &before);
    if (!has_rows(n)) return block;
    return n == 3 ? run_rows(p, block, acting, &before, 3) : run_rows(p, block, acting, &before, 4);
}

/* ---- all blocks ---- */

/* Blocks below the first are evaluated only, for the springs that reach into this share from below, unless the pass
 * goes on and the ring has their forces. Nodes collect their forces a block later than these are computed, when what
 * was stored has reached the cache. */
INLINE double run(const sweep *s, dem_index first, dem_index last, laws acting, double *ring)
{
    const dem_index reach = s->goes_on ? 0 : s->layout->reach;
    pass p = begin_pass(s, first, last, ring);
    for (dem_index block = first; block < last && acting.watched; block++) s->strained[block] = 0;
    for (dem_index block = first > reach ? first - reach : 0; block <= last; block++) {
        block = pass_rows(&p, block, acting);
        drift_ahead(&p, block, acting);
        if (block < last) {
            const unsigned strained = evaluate_springs(s, block, acting, ring);
            note_strained(s, block, first, acting, strained);
        }
        if (acting.coupled && block < last) evaluate_couplings(s, block, acting, ring);
        if (block > first) complete(&p, block - 1, acting, force_on(s, block - 1, acting, ring));
    }
    return pairs_total(p.sum);
}

/* ---- the guard ---- */

/* The nodes of a block that are the lowest corners of triangles that are smaller than the onset of their guard, or
 * little larger: areas differ by rounding from corner to corner. */
INLINE unsigned find_lowest(const sweep *s, dem_index block)
{
    const layout *l = s->layout;
    const intern_span span = l->lowest.span[block];
    const layout_entry *entries = l->lowest.entries.items;
    const double *sets = l->areas.items, *here = s->x + 2 * LAYOUT_LANES * block;
    const lanes twice = lanes_all(2.0 * TRIANGLES_ROUNDED);
    const pairs x = pairs_load(here);
    unsigned folded = 0;
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const pairs next = lane_operands_fetch(l, s->x, here, e->at, gathered),
                    last = lane_operands_fetch(l, s->x, here, e->to, gathered);
        const lanes onset = lanes_mul(twice, lanes_load(sets + e->set + LAYOUT_LANES));
        folded |= lanes_below(pairs_cross(pairs_sub(next, x), pairs_sub(last, x)), onset) & lane_operands_taken(e);
    }
    return folded != 0 ? lane_operands_nodes(folded) : 0;
}

static void look_at_lowest(const sweep *s, dem_index first, dem_index last)
{
    for (dem_index block = first; block < last; block++) s->guarded[block] = (uint8_t)find_lowest(s, block);
}

void SWEEP_GUARD(const sweep *s, dem_index first, dem_index last)
{
    if (s->looks_at_lowest) {
        look_at_lowest(s, first, last);
        return;
    }
    for (dem_index block = first; block < last; block++) {
        unsigned guarded = 0;
        (void)sum_corners(s, block, (laws){0}, &guarded);
        s->guarded[block] = (uint8_t)guarded;
    }
}

/* Squares of lengths are compared, without roots. */
INLINE unsigned strained_nodes(const sweep *s, dem_index block)
{
    const layout *l = s->layout;
    const intern_span span = l->springs.span[block];
    const layout_entry *entries = l->springs.entries.items;
    const double *sets = l->bonds.items, *here = s->x + 2 * LAYOUT_LANES * block;
    const double stretch = (double)s->limit[block].stretch - 1e-12, squeeze = (double)s->limit[block].squeeze - 1e-12;
    const double least = squeeze < 1.0 ? 1.0 - squeeze : 0.0, most = 1.0 + stretch;
    const double low = least * least, high = most * most;
    const pairs x = pairs_load(here);
    unsigned nodes = 0;
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const pairs d = pairs_sub(lane_operands_fetch(l, s->x, here, e->at, e->kind == LAYOUT_GATHERED), x);
        const lanes square = pairs_dot(d, d), rest = lanes_load(sets + e->set + LAYOUT_LANES);
        const lanes at_rest = lanes_mul(rest, rest);
        const unsigned over = lanes_below(lanes_mul(lanes_all(high), at_rest), square) |
                              lanes_below(square, lanes_mul(lanes_all(low), at_rest));
        nodes |= nodes_of_any(over, e->mask);
    }
    return nodes;
}

void SWEEP_STRAIN(const sweep *s, dem_index first, dem_index last)
{
    for (dem_index block = first; block < last; block++) {
        const bool is_watched = fminf(s->limit[block].stretch, s->limit[block].squeeze) < INFINITY;
        s->strained[block] = is_watched ? (uint8_t)strained_nodes(s, block) : 0;
    }
}

/* By the laws that act. */
static double run_all(const sweep *s, dem_index first, dem_index last, double *ring)
{
    const layout *l = s->layout;
    const bool fused = s->fused_step != NULL, watched = s->limit != NULL;
    if (l->softened) return run(s, first, last, (laws){l->damped, l->coupled, fused, watched, true}, ring);
    if (l->coupled) return run(s, first, last, (laws){l->damped, true, fused, watched, false}, ring);
    if (fused && watched) return run(s, first, last, (laws){.fused = true, .watched = true}, ring);
    if (fused) return run(s, first, last, (laws){.fused = true}, ring);
    return l->damped ? run(s, first, last, (laws){.damped = true}, ring) : run(s, first, last, (laws){0}, ring);
}

/* Pieces whose positions the first cache still holds when triangles are looked at. */
enum { piece = 128 };

double SWEEP(const sweep *s, dem_index first, dem_index last, double *ring)
{
    sweep of_piece = *s;
    double sum = 0.0;
    const bool looks = s->looks_at_lowest && s->guarded != NULL && s->layout->lowest.entries.n > 0;
    if (!looks) return run_all(s, first, last, ring);
    for (dem_index from = first; from < last; from += piece) {
        const dem_index end = from + piece < last ? from + piece : last;
        sum += run_all(&of_piece, from, end, ring);
        look_at_lowest(s, from, end);
        of_piece.goes_on = true;
    }
    return sum;
}

#endif
