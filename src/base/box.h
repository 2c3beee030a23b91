/* SPDX-License-Identifier: BSD-3-Clause */
/* Boxes along the axes. */
#ifndef DEM_BASE_BOX_H
#define DEM_BASE_BOX_H

#include "base/vec2.h"

typedef struct box {
    vec2 low, high;
} box;

/** Of no points: infinite and the wrong way round. It meets no box, and joining makes it what it is joined with. */
static inline box box_empty(void)
{
    return (box){{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
}

/** The smallest box around both; what is no number in the first one is passed over. */
static inline box box_join(box a, box b)
{
    return (box){{a.low.x < b.low.x ? a.low.x : b.low.x, a.low.y < b.low.y ? a.low.y : b.low.y},
                 {a.high.x > b.high.x ? a.high.x : b.high.x, a.high.y > b.high.y ? a.high.y : b.high.y}};
}

/** The smallest box around a box and a point; a coordinate that is no number is passed over. */
static inline box box_with(box b, vec2 point)
{
    return box_join((box){point, point}, b);
}

/** Whether two boxes have a point in common. */
static inline bool box_meets(const box *a, const box *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y;
}

/** Length of the diagonal, 0 of none. */
static inline double box_diagonal(box a)
{
    return a.low.x > a.high.x || a.low.y > a.high.y ? 0.0 : vec2_norm(vec2_sub(a.high, a.low));
}

#endif
