/* SPDX-License-Identifier: BSD-3-Clause */
/* Triangles are read as find_lowest() of sweep_body.h reads them, and measured as triangles_room_to_fold() measures
 * them; compiled once for each instruction set, whose vectors LANES names. */
#include LANES

#include <math.h>

#include "elastic/fold_pass.h"
#include "elastic/lane_operands.h"

/* The least square of w, and the largest of a speed. */
typedef struct running {
    lanes way, speed;
} running;

INLINE lanes square_of_way(lanes spare, pairs b, pairs c)
{
    const lanes half = lanes_add(pairs_dot(b, b), pairs_dot(c, c)), square = lanes_add(half, half);
    const lanes left = lanes_max(spare, lanes_all(0.0)), part = lanes_div(left, lanes_add(square, left));
    return lanes_mul(lanes_mul(part, part), square);
}

INLINE lanes larger_square(lanes square, pairs a)
{
    return lanes_max(pairs_dot(a, a), square);
}

INLINE void measure_block(const layout *l, const double *x, const double *v, dem_index block, running *r)
{
    const intern_span span = l->lowest.span[block];
    const layout_entry *entries = l->lowest.entries.items;
    const double *sets = l->areas.items, *here = x + 2 * LAYOUT_LANES * block, *moving = v + 2 * LAYOUT_LANES * block;
    const lanes twice = lanes_all(2.0 * TRIANGLES_ROUNDED);
    const pairs place = pairs_load(here), velocity = pairs_load(moving);
    for (const layout_entry *e = entries + span.first, *end = entries + span.end; e < end; e++) {
        const bool gathered = e->kind == LAYOUT_GATHERED;
        const unsigned taken = lane_operands_taken(e);
        if (taken == 0) continue;
        const pairs b = pairs_sub(lane_operands_fetch(l, x, here, e->at, gathered), place),
                    c = pairs_sub(lane_operands_fetch(l, x, here, e->to, gathered), place);
        const pairs to_b = pairs_sub(lane_operands_fetch(l, v, moving, e->at, gathered), velocity),
                    to_c = pairs_sub(lane_operands_fetch(l, v, moving, e->to, gathered), velocity);
        const lanes folded = lanes_mul(twice, lanes_load(sets + e->set + LAYOUT_LANES));
        const lanes way = square_of_way(lanes_sub(pairs_cross(b, c), folded), b, c);
        const lanes speed = larger_square(larger_square(larger_square(r->speed, to_b), to_c), pairs_sub(to_c, to_b));
        r->way = lanes_where(taken, lanes_min(way, r->way), r->way);
        r->speed = lanes_where(taken, speed, r->speed);
    }
}

triangles_room FOLD_PASS(const layout *l, const double *x, const double *v)
{
    running r = {lanes_all((double)INFINITY), lanes_all(0.0)};
    double way[LAYOUT_LANES], speed[LAYOUT_LANES];
    for (dem_index block = 0; block < l->n_blocks; block++) measure_block(l, x, v, block, &r);
    lanes_store(way, r.way);
    lanes_store(speed, r.speed);
    for (int k = 1; k < LAYOUT_LANES; k++) {
        if (way[k] < way[0]) way[0] = way[k];
        if (speed[k] > speed[0]) speed[0] = speed[k];
    }
    return (triangles_room){sqrt(way[0]), sqrt(speed[0])};
}
