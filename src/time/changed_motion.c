/* SPDX-License-Identifier: BSD-3-Clause */
/* Polynomials and their lists. */
#include "time/changed_motion.h"

#include <stdlib.h>

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
    *tr = (changed_motion){0};
}

static void forget(changed_motion *tr)
{
    for (dem_index k = 0; k < tr->n; k++) tr->place[tr->list[k].node] = -1;
    tr->n = 0;
}

void changed_motion_start(changed_motion *tr, double end, double *y1, double *f1)
{
    forget(tr);
    tr->end = end;
    tr->y1 = y1;
    tr->f1 = f1;
}

void changed_motion_undo(changed_motion *tr)
{
    const dem_index n = tr->layout.n_rows;
    for (dem_index k = tr->n - 1; k >= 0; k--) { /* of a node that is kept twice the first was before */
        const changed_motion_node *e = &tr->list[k];
        vec2_put(tr->y1, e->node, e->x);
        vec2_put(tr->y1, n + e->node, e->v);
        vec2_put(tr->f1, e->node, e->u);
        vec2_put(tr->f1, n + e->node, e->a);
    }
    forget(tr);
}

dem_status changed_motion_keep(changed_motion *tr, dem_index node)
{
    const dem_index n = tr->layout.n_rows;
    CHECK(grow_array((void **)&tr->list, &tr->capacity, tr->n + 1, sizeof *tr->list), DEM_ERROR_MEMORY,
          "out of memory for the contact events of a step");
    changed_motion_node *e = &tr->list[tr->n++];
    e->node = node;
    e->x = vec2_at(tr->y1, node);
    e->v = vec2_at(tr->y1, n + node);
    e->u = vec2_at(tr->f1, node);
    e->a = vec2_at(tr->f1, n + node);
    return DEM_OK;
}

dem_status changed_motion_set(changed_motion *tr, dem_index node, const motion_polynomial *motion)
{
    if (!changed_motion_has(tr, node)) {
        TRY(changed_motion_keep(tr, node));
        tr->place[node] = tr->n - 1;
    }
    tr->list[tr->place[node]].motion = *motion;
    return DEM_OK;
}

static void add_to(double *array, dem_index i, vec2 change)
{
    vec2_put(array, i, vec2_add(vec2_at(array, i), change));
}

void changed_motion_move_end(changed_motion *tr, dem_index node, const motion_change *jump)
{
    const dem_index n = tr->layout.n_rows;
    add_to(tr->y1, node, jump->x);
    add_to(tr->y1, n + node, jump->v);
    add_to(tr->f1, node, jump->v);
    add_to(tr->f1, n + node, jump->a);
}

/* ---- polynomials ---- */

static double share(const changed_motion *tr, const motion_polynomial *m, double t)
{
    return tr->end > m->from ? (t - m->from) / (tr->end - m->from) : 0.0;
}

vec2 changed_motion_position(const changed_motion *tr, double t, dem_index node)
{
    double at[4];
    const motion_polynomial *m = changed_motion_of(tr, node);
    motion_polynomial_at(m, share(tr, m, t), at);
    return vec2_at(at, 0);
}

vec2 changed_motion_velocity(const changed_motion *tr, double t, dem_index node)
{
    double at[4];
    const motion_polynomial *m = changed_motion_of(tr, node);
    motion_polynomial_at(m, share(tr, m, t), at);
    return vec2_at(at, 1);
}

/* c(s + r u) in powers of u: Taylor's shift, then the scale. */
motion_polynomial motion_polynomial_later(const motion_polynomial *m, double from, double end)
{
    motion_polynomial later = *m;
    const double length = end - m->from, s = length > 0.0 ? (from - m->from) / length : 0.0;
    double power = 1.0 - s;
    later.from = from;
    if (s == 0.0) return later;
    for (int k = 0; k < MOTION_TERMS; k++)
        for (int j = MOTION_TERMS - 2; j >= k; j--)
            for (int q = 0; q < 4; q++) later.c[j][q] += s * later.c[j + 1][q];
    for (int k = 1; k < MOTION_TERMS; k++, power *= 1.0 - s)
        for (int q = 0; q < 4; q++) later.c[k][q] *= power;
    return later;
}

/* Quintic Hermite through (x, v, a) and (x + dx, v + dv, a + da). */
void motion_polynomial_add(motion_polynomial *m, double end, const motion_change *at, const motion_change *by)
{
    const double h = end - m->from, per_h = h > 0.0 ? 1.0 / h : 0.0;
    const vec2 v0 = vec2_scale(h, at->v), a0 = vec2_scale(h * h, at->a);
    const vec2 D = vec2_along(vec2_sub(by->x, v0), -0.5, a0), V = vec2_along(vec2_scale(h, by->v), -1.0, a0);
    const vec2 A = vec2_scale(h * h, by->a);
    const vec2 c[MOTION_TERMS] = {at->x,
                                  v0,
                                  vec2_scale(0.5, a0),
                                  vec2_along(vec2_along(vec2_scale(10.0, D), -4.0, V), 0.5, A),
                                  vec2_along(vec2_along(vec2_scale(-15.0, D), 7.0, V), -1.0, A),
                                  vec2_along(vec2_along(vec2_scale(6.0, D), -3.0, V), 0.5, A)};
    for (int k = 0; k < MOTION_TERMS; k++) {
        const vec2 slope = k + 1 < MOTION_TERMS ? vec2_scale(per_h * (k + 1), c[k + 1]) : (vec2){0.0, 0.0};
        m->c[k][0] += c[k].x;
        m->c[k][1] += c[k].y;
        m->c[k][2] += slope.x;
        m->c[k][3] += slope.y;
    }
    if (h > 0.0) return;
    m->c[0][2] += at->v.x;
    m->c[0][3] += at->v.y;
}

void motion_polynomial_add_parabolas(motion_polynomial *m, double end, const motion_change *at, const motion_change *by)
{
    const double h = end - m->from;
    const vec2 v0 = vec2_scale(h, at->v), a0 = vec2_scale(h, at->a);
    const vec2 x[3] = {at->x, v0, vec2_sub(by->x, v0)}, v[3] = {at->v, a0, vec2_sub(by->v, a0)};
    for (int k = 0; k < 3; k++) {
        m->c[k][0] += x[k].x;
        m->c[k][1] += x[k].y;
        m->c[k][2] += v[k].x;
        m->c[k][3] += v[k].y;
    }
}
