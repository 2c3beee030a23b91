/* SPDX-License-Identifier: BSD-3-Clause */
/* Polynomials and their lists. */
#include "trail.h"

#include <stdlib.h>

#include "status.h"

dem_status trail_create(trail *out, dem_index n_nodes)
{
    trail tr = {.n_nodes = n_nodes, .last = malloc((size_t)n_nodes * sizeof *tr.last)};
    CHECK(tr.last != NULL, DEM_ERROR_MEMORY, "out of memory for the motion of %lld nodes", (long long)n_nodes);
    for (dem_index i = 0; i < n_nodes; i++) tr.last[i] = -1;
    *out = tr;
    return DEM_OK;
}

void trail_destroy(trail *tr)
{
    free(tr->last);
    free(tr->pieces);
    free(tr->ends);
    *tr = (trail){0};
}

static void forget(trail *tr)
{
    for (dem_index k = 0; k < tr->n_ends; k++) tr->last[tr->ends[k].node] = -1;
    tr->n = tr->n_ends = 0;
}

void trail_start(trail *tr, double end, double *y1, double *f1)
{
    forget(tr);
    tr->end = end;
    tr->y1 = y1;
    tr->f1 = f1;
}

void trail_undo(trail *tr)
{
    const dem_index n = tr->n_nodes;
    for (dem_index k = 0; k < tr->n_ends; k++) {
        const trail_end *e = &tr->ends[k];
        vec2_put(tr->y1, e->node, e->x);
        vec2_put(tr->y1, n + e->node, e->v);
        vec2_put(tr->f1, e->node, e->u);
        vec2_put(tr->f1, n + e->node, e->a);
    }
    forget(tr);
}

/* Room for one more. */
static dem_status grow(void **array, dem_index *capacity, dem_index n, size_t size)
{
    if (n < *capacity) return DEM_OK;
    const dem_index more = 2 * *capacity + 256;
    void *larger = realloc(*array, (size_t)more * size);
    CHECK(larger != NULL, DEM_ERROR_MEMORY, "out of memory for the contact events of a step");
    *array = larger;
    *capacity = more;
    return DEM_OK;
}

static dem_status keep_end(trail *tr, dem_index node)
{
    const dem_index n = tr->n_nodes;
    TRY(grow((void **)&tr->ends, &tr->end_capacity, tr->n_ends, sizeof *tr->ends));
    tr->ends[tr->n_ends++] = (trail_end){node, vec2_at(tr->y1, node), vec2_at(tr->y1, n + node), vec2_at(tr->f1, node),
                                         vec2_at(tr->f1, n + node)};
    return DEM_OK;
}

const trail_motion *trail_last(const trail *tr, dem_index node)
{
    return &tr->pieces[tr->last[node]].motion;
}

dem_status trail_add(trail *tr, dem_index node, const trail_motion *motion)
{
    TRY(grow((void **)&tr->pieces, &tr->capacity, tr->n, sizeof *tr->pieces));
    if (!trail_has(tr, node)) TRY(keep_end(tr, node));
    tr->pieces[tr->n] = (trail_piece){*motion, tr->last[node]};
    tr->last[node] = tr->n++;
    return DEM_OK;
}

static void add_to(double *array, dem_index i, vec2 change)
{
    vec2_put(array, i, vec2_add(vec2_at(array, i), change));
}

void trail_move_end(trail *tr, dem_index node, const trail_jump *jump)
{
    const dem_index n = tr->n_nodes;
    add_to(tr->y1, node, jump->x);
    add_to(tr->y1, n + node, jump->v);
    add_to(tr->f1, node, jump->v);
    add_to(tr->f1, n + node, jump->a);
}

/* ---- polynomials ---- */

static double value(const double c[TRAIL_TERMS], double s)
{
    return c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5]))));
}

/* The piece that holds at t. */
static const trail_motion *motion_at(const trail *tr, double t, dem_index node)
{
    const trail_piece *piece = &tr->pieces[tr->last[node]];
    while (t < piece->motion.from && piece->before >= 0) piece = &tr->pieces[piece->before];
    return &piece->motion;
}

static double share(const trail *tr, const trail_motion *m, double t)
{
    return tr->end > m->from ? (t - m->from) / (tr->end - m->from) : 0.0;
}

vec2 trail_position(const trail *tr, double t, dem_index node)
{
    const trail_motion *m = motion_at(tr, t, node);
    const double s = share(tr, m, t);
    return (vec2){value(m->x[0], s), value(m->x[1], s)};
}

vec2 trail_velocity(const trail *tr, double t, dem_index node)
{
    const trail_motion *m = motion_at(tr, t, node);
    const double s = share(tr, m, t);
    return (vec2){value(m->v[0], s), value(m->v[1], s)};
}

/* c(s + r u) in powers of u: Taylor's shift, then the scale. */
static void expand(double c[TRAIL_TERMS], double s, double r)
{
    double power = 1.0;
    for (int k = 0; k < TRAIL_TERMS; k++)
        for (int j = TRAIL_TERMS - 2; j >= k; j--) c[j] += s * c[j + 1];
    for (int k = 0; k < TRAIL_TERMS; k++, power *= r) c[k] *= power;
}

trail_motion trail_later(const trail_motion *m, double from, double end)
{
    trail_motion later = *m;
    const double length = end - m->from, s = length > 0.0 ? (from - m->from) / length : 0.0;
    later.from = from;
    for (int c = 0; c < 2; c++) {
        expand(later.x[c], s, 1.0 - s);
        expand(later.v[c], s, 1.0 - s);
    }
    return later;
}

/* Quintic Hermite through (x, v, a) and (x + dx, v + dv, a + da), in powers of s. */
static void bend(double x[TRAIL_TERMS], double v[TRAIL_TERMS], double h, const double at[3], const double by[3])
{
    const double v0 = h * at[1], a0 = h * h * at[2];
    const double D = by[0] - v0 - 0.5 * a0, V = h * by[1] - a0, A = h * h * by[2];
    const double c[TRAIL_TERMS] = {
        at[0], v0, 0.5 * a0, 10.0 * D - 4.0 * V + 0.5 * A, -15.0 * D + 7.0 * V - A, 6.0 * D - 3.0 * V + 0.5 * A};
    for (int k = 0; k < TRAIL_TERMS; k++) {
        x[k] += c[k];
        if (k > 0 && h > 0.0) v[k - 1] += k * c[k] / h;
    }
    if (!(h > 0.0)) v[0] += at[1];
}

void trail_bend(trail_motion *m, double end, const trail_jump *at, const trail_jump *by)
{
    const double h = end - m->from;
    bend(m->x[0], m->v[0], h, (const double[]){at->x.x, at->v.x, at->a.x}, (const double[]){by->x.x, by->v.x, by->a.x});
    bend(m->x[1], m->v[1], h, (const double[]){at->x.y, at->v.y, at->a.y}, (const double[]){by->x.y, by->v.y, by->a.y});
}
