/* SPDX-License-Identifier: BSD-3-Clause */
/* The step of a lattice row, written once for all instruction sets, with the lanes of sweep_body.h: here the nodes of
 * eight places in their order. A sweep_*.c file defines LATTICE_STEP and includes this. The order of operations, and so
 * the bits, are those of sweep_body.h: of a node springs come in the order of its neighbours, down left, down right,
 * left, right, up left, up right. Springs without stiffness leave zeros, which change no sum: none is -0. */
#ifndef DEM_ELASTIC_LATTICE_STEP_BODY_H
#define DEM_ELASTIC_LATTICE_STEP_BODY_H

#include "base/inline.h"
#include "elastic/lattice_step.h"

/* The components of eight vectors. */
typedef struct plane_pair {
    lanes x, y;
} plane_pair;

INLINE plane_pair plane_pair_load(double *const planes[2], dem_index at)
{
    return (plane_pair){lanes_load(planes[0] + at), lanes_load(planes[1] + at)};
}

INLINE void plane_pair_store(double *const planes[2], dem_index at, plane_pair p)
{
    lanes_store(planes[0] + at, p.x);
    lanes_store(planes[1] + at, p.y);
}

INLINE plane_pair plane_pair_add(plane_pair a, plane_pair b)
{
    return (plane_pair){lanes_add(a.x, b.x), lanes_add(a.y, b.y)};
}

INLINE plane_pair plane_pair_sub(plane_pair a, plane_pair b)
{
    return (plane_pair){lanes_sub(a.x, b.x), lanes_sub(a.y, b.y)};
}

INLINE plane_pair plane_pair_scale(lanes s, plane_pair a)
{
    return (plane_pair){lanes_mul(s, a.x), lanes_mul(s, a.y)};
}

/* Those of the places before, where `before` is the block before. */
INLINE plane_pair plane_pair_behind(plane_pair before, plane_pair a)
{
    return (plane_pair){lanes_behind(before.x, a.x), lanes_behind(before.y, a.y)};
}

/* Force (1) on the lower nodes of springs along d. */
INLINE plane_pair plane_pull(const double *set, plane_pair d)
{
    const lanes length = lanes_sqrt(lanes_add(lanes_mul(d.x, d.x), lanes_mul(d.y, d.y)));
    const lanes rest = lanes_load(set + LAYOUT_LANES);
    const lanes stretch = lanes_mul(lanes_load(set), lanes_sub(length, rest));
    return plane_pair_scale(lanes_div(stretch, lanes_mul(rest, length)), d);
}

/* Lanes in which the triangles with these edges from one corner, counter-clockwise, are smaller than the areas of a
 * set. */
INLINE unsigned smaller(const double *set, plane_pair first, plane_pair last)
{
    const lanes twice = lanes_sub(lanes_mul(first.x, last.y), lanes_mul(first.y, last.x));
    return lanes_below(lanes_mul(lanes_all(0.5), twice), lanes_load(set));
}

/* x1 = x0 + h v',  v' = v0 + h/2 a0 */
INLINE void drift_row(const lattice_planes *p, double h, dem_index n)
{
    const lanes whole = lanes_all(h), half = lanes_all(0.5 * h);
    for (dem_index at = 0; at < n; at += LAYOUT_LANES) {
        const plane_pair x = plane_pair_load(p->x, at), v = plane_pair_load(p->v, at), a = plane_pair_load(p->a, at);
        plane_pair_store(p->x, at,
                         plane_pair_add(x, plane_pair_scale(whole, plane_pair_add(v, plane_pair_scale(half, a)))));
    }
}

/* v1 = (v' + h/2 a0) + h/2 (a1 - a0) */
INLINE void kick_block(const lattice_planes *p, lanes half, dem_index at, plane_pair a1)
{
    const plane_pair a0 = plane_pair_load(p->a, at), v0 = plane_pair_load(p->v, at), push = plane_pair_scale(half, a0);
    const plane_pair extrapolated = plane_pair_add(plane_pair_add(v0, push), push);
    plane_pair_store(p->v, at, plane_pair_add(extrapolated, plane_pair_scale(half, plane_pair_sub(a1, a0))));
    plane_pair_store(p->a, at, a1);
}

/* a = g + F/m; 0 where 1/m = 0 */
INLINE plane_pair plane_accelerate(plane_pair gravity, lanes inverse_mass, plane_pair force)
{
    const plane_pair a = plane_pair_add(gravity, plane_pair_scale(inverse_mass, force));
    return (plane_pair){lanes_unless_zero(inverse_mass, a.x), lanes_unless_zero(inverse_mass, a.y)};
}

INLINE lanes plane_term(plane_pair a)
{
    const lanes x = lanes_mul(a.x, a.x), y = lanes_mul(a.y, a.y);
    return lanes_add(lanes_mul(x, x), lanes_mul(y, y));
}

/* Where the pass over the blocks is, and what a block leaves for the next one. */
typedef struct lattice_carry {
    dem_index at, above;    /* the block's first place, in its lattice row and in the next one */
    lanes sum;              /* of what has been accelerated */
    plane_pair here;        /* its positions */
    plane_pair right, back; /* forces of the springs of the block before, */
    plane_pair back_edge;   /* and the vectors along the latter */
} lattice_carry;

INLINE void take_block(lattice_step *s, const lattice_block *b, lattice_carry *c, bool guarded)
{
    const dem_index at = c->at, above = c->above;
    const double *sets = s->rows->sets.items;
    const plane_pair x = c->here, behind = plane_pair_load(s->here.x, at + LAYOUT_LANES);
    const plane_pair next = {lanes_ahead(x.x, behind.x), lanes_ahead(x.y, behind.y)};
    const plane_pair top = plane_pair_load(s->next.x, above), none = {lanes_all(0.0), lanes_all(0.0)};
    const plane_pair right_edge = plane_pair_sub(next, x), up_edge = plane_pair_sub(top, x),
                     back_edge = plane_pair_sub(top, next);
    const plane_pair right = plane_pull(sets + b->right, right_edge), up = plane_pull(sets + b->up, up_edge),
                     back = plane_pull(sets + b->back, back_edge);
    if (guarded) {
        const plane_pair left_edge = plane_pair_behind(c->back_edge, back_edge);
        const unsigned folded =
            smaller(sets + b->upright, right_edge, up_edge) | smaller(sets + b->overturned, up_edge, left_edge);
        s->guarded = s->guarded || folded != 0;
    }
    plane_pair_store(s->next.below, above, plane_pair_sub(plane_pair_sub(none, up), back));
    plane_pair force = plane_pair_sub(plane_pair_load(s->here.below, at), plane_pair_behind(c->right, right));
    force = plane_pair_add(plane_pair_add(force, right), plane_pair_behind(c->back, back));
    force = plane_pair_add(force, up);
    const plane_pair gravity = {lanes_all(s->gravity.x), lanes_all(s->gravity.y)};
    const plane_pair a = plane_accelerate(gravity, lanes_load(sets + b->inverse_mass), force);
    kick_block(&s->here, lanes_all(0.5 * s->h), at, a);
    *c = (lattice_carry){.at = at + LAYOUT_LANES,
                         .above = above + LAYOUT_LANES,
                         .sum = lanes_add(c->sum, plane_term(a)),
                         .here = behind,
                         .right = right,
                         .back = back,
                         .back_edge = back_edge};
}

/* What the block before the first one would leave is 0: at its first place no node is, or none that is asked for, nor a
 * triangle that is judged. */
INLINE void take_row(lattice_step *s, bool guarded)
{
    const lattice_rows *r = s->rows;
    const lattice_row *here = &r->row[s->row], *next = here + 1;
    const lattice_block *records = r->records.items;
    const lattice_span blocks = s->blocks;
    const int32_t *block = r->block + here->block + blocks.first - here->first;
    const dem_index at = LAYOUT_LANES * (blocks.first - here->stored);
    const plane_pair none = {lanes_all(0.0), lanes_all(0.0)};
    lattice_carry carry = {.at = at,
                           .above = LAYOUT_LANES * (blocks.first - next->stored),
                           .sum = none.x,
                           .here = plane_pair_load(s->here.x, at),
                           .right = none,
                           .back = none,
                           .back_edge = none};
    double each[LAYOUT_LANES];
    drift_row(&s->next, s->h, LAYOUT_LANES * (dem_index)next->n_stored);
    for (int32_t k = 0; k < blocks.n_blocks; k++) take_block(s, &records[block[k]], &carry, guarded);
    lanes_store(each, carry.sum);
    s->sum = 0.0;
    for (int k = 0; k < LAYOUT_LANES; k++) s->sum += each[k];
}

void LATTICE_STEP(lattice_step *s)
{
    s->guarded = false;
    if (s->rows->guarded)
        take_row(s, true);
    else
        take_row(s, false);
}

#endif
