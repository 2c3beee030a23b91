/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion of the nodes that events inside a step have moved off its dense output: a polynomial in s for each, from
 * the last event to the end of the step, and a copy of what the end of the step was before. The copies make undo exact
 * to the bit, which a second run through the same events relies on (docs/algorithms.md, Local correction). How a change
 * is computed belongs to src/events/local_correction.c; here it is only added, shifted in time and evaluated. */
#include "time/changed_motion.h"

#include <stdlib.h>

#include "base/exact_sum.h"
#include "base/grow.h"
#include "base/status.h"

dem_status changed_motion_create(changed_motion *out, const state_layout *layout)
{
    changed_motion tr = {.layout = *layout, .place = malloc((size_t)layout->n_rows * sizeof *tr.place)};
    CHECK(tr.place != NULL, DEM_ERROR_MEMORY, "out of memory for the motion of %lld nodes", (long long)layout->n_nodes);
    for (dem_index i = 0; i < layout->n_rows; i++) tr.place[i] = -1;
    *out = tr;
    return DEM_OK;
}

void changed_motion_destroy(changed_motion *tr)
{
    free(tr->place);
    free(tr->list);
    free(tr->interpolants);
    free(tr->parts);
    *tr = (changed_motion){0};
}

/* Empties the list; each node that is on it goes back to `no place`. */
static void forget(changed_motion *tr)
{
    for (dem_index k = 0; k < tr->n; k++) tr->place[tr->list[k].node] = -1;
    tr->n = tr->n_interpolants = tr->n_parts = 0;
}

void changed_motion_start(changed_motion *tr, double end, double *y1, double *f1)
{
    forget(tr);
    tr->end = end;
    tr->y1 = y1;
    tr->f1 = f1;
}

/* Copies are put back from the last to the first. A node may be on the list twice, once kept for its end alone and once
 * for its motion: the older copy is then put back last and stands. */
void changed_motion_undo(changed_motion *tr)
{
    const state_layout *l = &tr->layout;
    for (dem_index k = tr->n - 1; k >= 0; k--) {
        const changed_motion_node *e = &tr->list[k];
        const dem_index at = state_row(l, e->node), v = state_velocities(l) + at;
        state_copy_row(l, tr->y1 + at, e->x);
        state_copy_row(l, tr->y1 + v, e->v);
        state_copy_row(l, tr->f1 + at, e->u);
        state_copy_row(l, tr->f1 + v, e->a);
    }
    forget(tr);
}

/* The copy of the end: position, velocity, and both halves of the derivative. */
dem_status changed_motion_keep(changed_motion *tr, dem_index node)
{
    const state_layout *l = &tr->layout;
    const dem_index at = state_row(l, node), v = state_velocities(l) + at;
    CHECK(grow_array((void **)&tr->list, &tr->capacity, tr->n + 1, sizeof *tr->list), DEM_ERROR_MEMORY,
          "out of memory for the contact events of a step");
    changed_motion_node *e = &tr->list[tr->n++];
    e->node = node;
    state_copy_row(l, e->x, tr->y1 + at);
    state_copy_row(l, e->v, tr->y1 + v);
    state_copy_row(l, e->u, tr->f1 + at);
    state_copy_row(l, e->a, tr->f1 + v);
    return DEM_OK;
}

/* The first change of a node keeps its end and gives it a place; a later one only replaces the polynomial, which then
 * holds from the later event on. Times before that are not asked for again: events near each other are resolved in the
 * order of time. */
dem_status changed_motion_take(changed_motion *tr, dem_index node, motion_polynomial **out)
{
    if (!changed_motion_has(tr, node)) {
        CHECK(grow_array((void **)&tr->interpolants, &tr->interpolant_capacity, tr->n_interpolants + 1,
                         sizeof *tr->interpolants),
              DEM_ERROR_MEMORY, "out of memory for the contact events of a step");
        TRY(changed_motion_keep(tr, node));
        tr->place[node] = (int32_t)tr->n_interpolants;
        tr->interpolants[tr->n_interpolants++].is_known = false;
    }
    *out = &tr->interpolants[tr->place[node]].motion;
    return DEM_OK;
}

/* Sums go by way of two local numbers, so that the row_pair may be one vector instruction although the arrays may
 * overlap. */
static inline void add_to_row(const state_layout *l, double *to, const double *change)
{
    const double first = to[0] + change[0], second = to[1] + change[1];
    if (l->dim > 2) to[2] += change[2];
    to[0] = first;
    to[1] = second;
}

/* Adds (dx, dv) to the state at the end and (dv, da) to its derivative: x' changes by as much as v does. */
void changed_motion_move_end(changed_motion *tr, dem_index node, const motion_change *jump)
{
    const state_layout *l = &tr->layout;
    const dem_index at = state_row(l, node), v = state_velocities(l) + at;
    add_to_row(l, tr->y1 + at, jump->x);
    add_to_row(l, tr->y1 + v, jump->v);
    add_to_row(l, tr->f1 + at, jump->v);
    add_to_row(l, tr->f1 + v, jump->a);
}

/* ---- values ---- */

/* s of a time: 0 at the event from which the polynomial goes, 1 at the end of the step. An event right at the end has s
 * = 0. */
static double share(const changed_motion *tr, const motion_polynomial *m, double t)
{
    return tr->end > m->from ? (t - m->from) / (tr->end - m->from) : 0.0;
}

void changed_motion_position(const changed_motion *tr, double t, dem_index node, double *out)
{
    const motion_polynomial *m = changed_motion_of(tr, node);
    motion_polynomial_position(m, share(tr, m, t), out);
}

void changed_motion_velocity(const changed_motion *tr, double t, dem_index node, double *out)
{
    const motion_polynomial *m = changed_motion_of(tr, node);
    motion_polynomial_velocity(m, share(tr, m, t), out);
}

/* ---- rows of quadratures ---- */

dem_status changed_motion_add(changed_motion *tr, const changed_motion_part *part)
{
    CHECK(grow_array((void **)&tr->parts, &tr->part_capacity, tr->n_parts + 1, sizeof *tr->parts), DEM_ERROR_MEMORY,
          "out of memory for the contact events of a step");
    if (!changed_motion_has(tr, part->row)) {
        TRY(changed_motion_keep(tr, part->row));
        tr->place[part->row] = (int32_t)(tr->n - 1);
    }
    tr->parts[tr->n_parts++] = *part;
    return DEM_OK;
}

/* Rounded once, with all parts in it. */
static void add_sum(exact_sum *sum, double *to)
{
    exact_sum_add(sum, *to);
    *to = exact_sum_value(sum);
}

void changed_motion_row_at(const changed_motion *tr, double t, dem_index row, double *x, double *v)
{
    exact_sum sums[2][STATE_DIM_MOST] = {0};
    for (dem_index k = 0; k < tr->n_parts; k++) {
        double at[2][STATE_DIM_MOST];
        if (tr->parts[k].row != row) continue;
        motion_polynomial_position(&tr->parts[k].motion, share(tr, &tr->parts[k].motion, t), at[0]);
        motion_polynomial_velocity(&tr->parts[k].motion, share(tr, &tr->parts[k].motion, t), at[1]);
        for (int d = 0; d < tr->layout.dim; d++)
            for (int q = 0; q < 2; q++) exact_sum_add(&sums[q][d], at[q][d]);
    }
    for (int d = 0; d < tr->layout.dim; d++) {
        if (x != NULL) add_sum(&sums[0][d], &x[d]);
        if (v != NULL) add_sum(&sums[1][d], &v[d]);
    }
}

/* x' is the velocity. */
static void end_row(changed_motion *tr, dem_index row)
{
    const state_layout *l = &tr->layout;
    const dem_index at = state_row(l, row), v = state_velocities(l) + at;
    exact_sum sums[3][STATE_DIM_MOST] = {0};
    for (dem_index k = 0; k < tr->n_parts; k++)
        for (int d = 0; d < l->dim && tr->parts[k].row == row; d++) {
            exact_sum_add(&sums[0][d], tr->parts[k].end.x[d]);
            exact_sum_add(&sums[1][d], tr->parts[k].end.v[d]);
            exact_sum_add(&sums[2][d], tr->parts[k].end.a[d]);
        }
    for (int d = 0; d < l->dim; d++) {
        add_sum(&sums[0][d], &tr->y1[at + d]);
        add_sum(&sums[1][d], &tr->y1[v + d]);
        add_sum(&sums[2][d], &tr->f1[v + d]);
        tr->f1[at + d] = tr->y1[v + d];
    }
}

void changed_motion_end_rows(changed_motion *tr)
{
    for (dem_index k = 0; k < tr->n; k++)
        if (tr->list[k].node >= tr->layout.n_nodes && tr->place[tr->list[k].node] == k) end_row(tr, tr->list[k].node);
}

/* ---- polynomials in powers of s ---- */

/* Rewrites n terms c(s + r u) of components d and d + 1 in powers of u, with r = 1 - s: first Taylor's shift by
 * repeated Horner steps, c_j += s c_(j+1), then each power k is scaled by r^k. */
INLINE void shift_two(double (*c)[STATE_DIM_MOST], int n, int d, double s)
{
    row_pair own[MOTION_TERMS];
    double power = 1.0 - s;
    for (int k = 0; k < n; k++) own[k] = row_pair_at(c[k], d);
    UNROLLED for (int k = 0; k < n; k++) UNROLLED for (int j = n - 2; j >= k; j--) own[j] += s * own[j + 1];
    row_pair_put(c[0], d, own[0]);
    for (int k = 1; k < n; k++, power *= 1.0 - s) row_pair_put(c[k], d, power * own[k]);
}

INLINE void shift(double (*c)[STATE_DIM_MOST], int n, int dim, double s)
{
    shift_two(c, n, 0, s);
    if (dim > 2) shift_two(c, n, 2, s);
}

void motion_polynomial_restart(motion_polynomial *m, double from, double end)
{
    const double length = end - m->from, s = length > 0.0 ? (from - m->from) / length : 0.0;
    m->from = from;
    if (s == 0.0) return;
    if (m->parabolic) {
        shift(m->x, MOTION_PARABOLA, m->dim, s);
        shift(m->v, MOTION_PARABOLA, m->dim, s);
    } else {
        shift(m->x, MOTION_TERMS, m->dim, s);
        shift(m->v, MOTION_SLOPES, m->dim, s);
    }
}

/* Adds the quintic Hermite polynomial through (x, v, a) at u = 0 and (x + dx, v + dv, a + da) at u = 1, in powers of u,
 * where time derivatives are multiplied by h and h^2. What the first three terms x + h v u + h^2 a/2 u^2 lack at the
 * end is
 *   D = dx - h v - h^2 a/2,   V = h dv - h^2 a,   A = h^2 da,
 * and the terms (10 D - 4 V + A/2) u^3 + (-15 D + 7 V - A) u^4 + (6 D - 3 V + A/2) u^5 have just these value, slope and
 * second derivative at u = 1. The velocity's terms are the derivative's, (k + 1) c_(k+1)/h. With h = 0, an event at the
 * very end, only the jump of position and velocity is left. */
INLINE void add_quintic(const motion_polynomial *m, double h, const motion_change *at, const motion_change *by, int d,
                        motion_polynomial *to)
{
    const double per_h = h > 0.0 ? 1.0 / h : 0.0;
    const row_pair v0 = h * row_pair_at(at->v, d), a0 = h * h * row_pair_at(at->a, d);
    const row_pair D = row_pair_at(by->x, d) - v0 - 0.5 * a0, V = h * row_pair_at(by->v, d) - a0,
                   A = h * h * row_pair_at(by->a, d);
    const row_pair c[MOTION_TERMS] = {
        row_pair_at(at->x, d),      v0, 0.5 * a0, 10.0 * D - 4.0 * V + 0.5 * A, -15.0 * D + 7.0 * V - A,
        6.0 * D - 3.0 * V + 0.5 * A};
    for (int k = 0; k < MOTION_TERMS; k++) row_pair_put(to->x[k], d, row_pair_at(m->x[k], d) + c[k]);
    for (int k = 0; k < MOTION_SLOPES; k++)
        row_pair_put(to->v[k], d, row_pair_at(m->v[k], d) + per_h * (k + 1) * c[k + 1]);
    if (!(h > 0.0)) row_pair_put(to->v[0], d, row_pair_at(to->v[0], d) + row_pair_at(at->v, d));
}

void motion_polynomial_add(const motion_polynomial *m, double end, const motion_change *at, const motion_change *by,
                           motion_polynomial *to)
{
    const double h = end - m->from;
    to->from = m->from;
    to->dim = m->dim;
    to->parabolic = false;
    add_quintic(m, h, at, by, 0, to);
    if (m->dim > 2) add_quintic(m, h, at, by, 2, to);
}

/* The same where the step has parabolas: x + h v u + (dx - h v) u^2 for positions, v + h a u + (dv - h a) u^2 for
 * velocities. Both are independent; the second is not the derivative of the first. */
INLINE void add_parabola(motion_polynomial *m, double h, const motion_change *at, const motion_change *by, int d)
{
    const row_pair v0 = h * row_pair_at(at->v, d), a0 = h * row_pair_at(at->a, d);
    const row_pair x[MOTION_PARABOLA] = {row_pair_at(at->x, d), v0, row_pair_at(by->x, d) - v0},
                   v[MOTION_PARABOLA] = {row_pair_at(at->v, d), a0, row_pair_at(by->v, d) - a0};
    for (int k = 0; k < MOTION_PARABOLA; k++) {
        row_pair_put(m->x[k], d, row_pair_at(m->x[k], d) + x[k]);
        row_pair_put(m->v[k], d, row_pair_at(m->v[k], d) + v[k]);
    }
}

void motion_polynomial_add_parabolas(const motion_polynomial *m, double end, const motion_change *at,
                                     const motion_change *by, motion_polynomial *to)
{
    const double h = end - m->from;
    if (to != m) motion_polynomial_copy(to, m);
    add_parabola(to, h, at, by, 0);
    if (m->dim > 2) add_parabola(to, h, at, by, 2);
}
