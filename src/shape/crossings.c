/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/crossings.h"

#include <math.h>

/* Of an edge: a circle, or a side. */
typedef struct piece {
    bool round;
    double centre[2], radius;
    outline_side side;
} piece;

static size_t count_pieces(const outline *o)
{
    return o->kind == DEM_OUTLINE_DISC ? 1 : (o->kind == DEM_OUTLINE_RING ? 2 : outline_corners(o));
}

static piece piece_at(const outline *o, size_t k)
{
    if (o->kind == DEM_OUTLINE_DISC || o->kind == DEM_OUTLINE_RING)
        return (piece){.round = true, .centre = {o->centre[0], o->centre[1]}, .radius = k == 0 ? o->radius : o->inner};
    return (piece){.side = outline_side_at(o, k)};
}

/* ---- pairs ---- */

/* On the line through both crossings, at the distance `along` from the first centre and `across` from the line between
 * the centres: along^2 + across^2 = r^2, (d - along)^2 + across^2 = s^2. */
static size_t cross_circles(const piece *p, const piece *q, double at[2][2])
{
    const double dx = q->centre[0] - p->centre[0], dy = q->centre[1] - p->centre[1], d = sqrt(dx * dx + dy * dy);
    if (!(d > fabs(p->radius - q->radius) && d < p->radius + q->radius)) return 0;
    const double along = 0.5 * (d + (p->radius - q->radius) * (p->radius + q->radius) / d);
    const double across = sqrt(fmax((p->radius - along) * (p->radius + along), 0.0));
    for (int k = 0; k < 2; k++) {
        const double side = k == 0 ? across : -across;
        at[k][0] = p->centre[0] + (along * dx - side * dy) / d;
        at[k][1] = p->centre[1] + (along * dy + side * dx) / d;
    }
    return 2;
}

/* At the foot of the centre on the line, and half a chord to both sides of it. */
static size_t cross_side(const piece *circle, const outline_side *side, double at[2][2])
{
    const double tx = side->b[0] - side->a[0], ty = side->b[1] - side->a[1], length = sqrt(tx * tx + ty * ty);
    const double cx = circle->centre[0] - side->a[0], cy = circle->centre[1] - side->a[1];
    const double foot = (cx * tx + cy * ty) / length, height = (cy * tx - cx * ty) / length;
    size_t n = 0;
    if (!(fabs(height) < circle->radius)) return 0;
    const double chord = sqrt((circle->radius - height) * (circle->radius + height));
    for (int k = 0; k < 2; k++) {
        const double s = foot + (k == 0 ? -chord : chord);
        if (s < 0.0 || s > length) continue;
        at[n][0] = side->a[0] + s / length * tx;
        at[n++][1] = side->a[1] + s / length * ty;
    }
    return n;
}

static size_t cross_sides(const outline_side *p, const outline_side *q, double at[2][2])
{
    const double ux = p->b[0] - p->a[0], uy = p->b[1] - p->a[1], vx = q->b[0] - q->a[0], vy = q->b[1] - q->a[1];
    const double wx = q->a[0] - p->a[0], wy = q->a[1] - p->a[1], turn = ux * vy - uy * vx;
    const double s = (wx * vy - wy * vx) / turn, t = (wx * uy - wy * ux) / turn;
    if (!(s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)) return 0; /* also where they are parallel */
    at[0][0] = p->a[0] + s * ux;
    at[0][1] = p->a[1] + s * uy;
    return 1;
}

void crossings_find(const outline *a, const outline *b, crossings_take take, void *context)
{
    for (size_t i = 0; i < count_pieces(a); i++) {
        const piece p = piece_at(a, i);
        for (size_t j = 0; j < count_pieces(b); j++) {
            const piece q = piece_at(b, j);
            double at[2][2];
            const size_t n = p.round && q.round ? cross_circles(&p, &q, at)
                             : p.round          ? cross_side(&p, &q.side, at)
                             : q.round          ? cross_side(&q, &p.side, at)
                                                : cross_sides(&p.side, &q.side, at);
            for (size_t k = 0; k < n; k++) take(context, at[k]);
        }
    }
}
