/* SPDX-License-Identifier: BSD-3-Clause */
/* A chain of masses on linear springs, in two or in three dimensions: what moves near an event without a model. Its
 * components do not depend on one another: in three dimensions they are, to the bit, those of chains in two. */
#ifndef DEM_TEST_CHAIN_H
#define DEM_TEST_CHAIN_H

#include "verification/support.h"

#include <string.h>

#include "forces/local_forces.h"
#include "time/dense_output.h"
#include "unit/forces/look.h"

enum { CHAIN_NODES = 16, CHAIN_STATE = 2 * STATE_DIM_MOST * (CHAIN_NODES + 16) };

static const double chain_stiffness = 900.0, chain_step = 0.02; /* 1/s^2, s: omega h = 1.2 at most */

typedef struct chain {
    state_layout layout;
    int axis[STATE_DIM_MOST]; /* [dim] which of three motions a component is */
    unsigned char held[CHAIN_NODES];
    dem_index broken; /* the spring before this node is; 0: none */
    local_forces forces;
    double y0[CHAIN_STATE], f0[CHAIN_STATE], y1[CHAIN_STATE], f1[CHAIN_STATE], state[CHAIN_STATE];
    dense_output step;
} chain;

/* Whether there is a spring before a node. */
static inline bool chain_has(const chain *s, dem_index i)
{
    return i > 0 && i < CHAIN_NODES && i != s->broken;
}

/* Acceleration of component c of a node whose neighbours are at `before` and `after`, NULL beyond an end. */
static inline double chain_pull(const double *before, const double *x, const double *after, int c)
{
    return chain_stiffness * ((before != NULL ? before[c] - x[c] : 0.0) + (after != NULL ? after[c] - x[c] : 0.0));
}

static inline dem_status chain_begin_step(const void *self, const double *y0, const double *y1)
{
    (void)self, (void)y0, (void)y1;
    return DEM_OK;
}

static inline dem_status chain_add_neighbours(const void *self, local_nodes *nodes, dem_index first, dem_index last)
{
    (void)self;
    for (dem_index j = first; j < last; j++) {
        const dem_index i = nodes->list[j];
        if (i > 0) assert_ok(local_nodes_add(nodes, i - 1));
        if (i < CHAIN_NODES - 1) assert_ok(local_nodes_add(nodes, i + 1));
    }
    return DEM_OK;
}

static inline void chain_accelerate_one(const void *self, dem_index i, const double *y, double *a)
{
    const state_layout *l = &((const chain *)self)->layout;
    const chain *s = self;
    const double *before = chain_has(s, i) ? state_x(l, y, i - 1) : NULL,
                 *after = chain_has(s, i + 1) ? state_x(l, y, i + 1) : NULL;
    for (int c = 0; c < l->dim; c++) a[c] = chain_pull(before, state_x(l, y, i), after, c);
}

static inline dem_status chain_gather(void *self, const local_nodes *nodes)
{
    (void)self;
    (void)nodes;
    return DEM_OK;
}

static inline void chain_accelerate(void *self, const local_nodes *nodes, int ring, const local_state *s, double *a)
{
    const state_layout *l = &((const chain *)self)->layout;
    for (dem_index j = 0; j < nodes->end[ring]; j++) {
        const dem_index i = nodes->list[j];
        const double *before = chain_has(self, i) ? s->x + state_row(l, look_number(nodes, i - 1)) : NULL,
                     *after = chain_has(self, i + 1) ? s->x + state_row(l, look_number(nodes, i + 1)) : NULL;
        for (int c = 0; c < l->dim; c++) a[state_row(l, j) + c] = chain_pull(before, s->x + state_row(l, j), after, c);
    }
}

static inline bool chain_are_exact(const void *self)
{
    (void)self;
    return true;
}

static inline void chain_evaluate_external(void *self, const local_nodes *nodes, int ring, const local_state *s)
{
    (void)self;
    (void)nodes;
    (void)ring;
    (void)s;
}

/* Derivative of a state; prescribed components keep their velocity. */
static inline void chain_derive(const chain *s, const double *y, double *f)
{
    const state_layout *l = &s->layout;
    memset(f, 0, sizeof s->f0);
    for (dem_index i = 0; i < CHAIN_NODES; i++) {
        double *a = f + state_velocities(l) + state_row(l, i);
        state_copy_row(l, f + state_row(l, i), state_v(l, y, i));
        chain_accelerate_one(s, i, y, a);
        for (int c = 0; c < l->dim; c++)
            if (s->held[i] & (1u << c)) a[c] = 0.0;
    }
}

/* y + h f */
static inline void chain_go(const chain *s, const double *y, double h, const double *f, double *out)
{
    for (dem_index k = 0; k < state_size(&s->layout); k++) out[k] = y[k] + h * f[k];
}

/* One step of the classical Runge-Kutta method. */
static inline void chain_integrate(const chain *s, double h, const double *y, double *out)
{
    double k[4][CHAIN_STATE], z[CHAIN_STATE];
    chain_derive(s, y, k[0]);
    chain_go(s, y, 0.5 * h, k[0], z);
    chain_derive(s, z, k[1]);
    chain_go(s, y, 0.5 * h, k[1], z);
    chain_derive(s, z, k[2]);
    chain_go(s, y, h, k[2], z);
    chain_derive(s, z, k[3]);
    memset(out, 0, sizeof z);
    for (dem_index q = 0; q < state_size(&s->layout); q++)
        out[q] = y[q] + h / 6.0 * (k[0][q] + 2.0 * k[1][q] + 2.0 * k[2][q] + k[3][q]);
}

/* A step of a chain whose components are some of three motions. Motion 2 of node `held` is prescribed; -1: none is. The
 * chain must stay where it is. */
static inline void chain_open(chain *s, int dim, const int *axes, dem_index held, bool parabolic)
{
    *s = (chain){.layout = state_layout_of(dim, CHAIN_NODES, 0, false)};
    assert_true(state_size(&s->layout) <= CHAIN_STATE);
    for (int c = 0; c < dim; c++) {
        s->axis[c] = axes[c];
        if (held >= 0 && axes[c] == 2) s->held[held] = (unsigned char)(1u << c);
    }
    s->forces = (local_forces){.self = s,
                               .held = held >= 0 ? s->held : NULL,
                               .begin_step = chain_begin_step,
                               .add_neighbours = chain_add_neighbours,
                               .accelerate_one = chain_accelerate_one,
                               .gather = chain_gather,
                               .renew = chain_gather,
                               .accelerate = chain_accelerate,
                               .are_exact = chain_are_exact,
                               .evaluate_external = chain_evaluate_external};
    for (dem_index i = 0; i < CHAIN_NODES; i++)
        for (int c = 0; c < dim; c++) {
            const double phase = (double)(i + 5 * axes[c] * i + 2 * axes[c]);
            s->y0[state_row(&s->layout, i) + c] = sin(phase);
            s->y0[state_velocities(&s->layout) + state_row(&s->layout, i) + c] = 10.0 * cos(phase);
        }
    chain_integrate(s, chain_step, s->y0, s->y1);
    chain_derive(s, s->y0, s->f0);
    chain_derive(s, s->y1, s->f1);
    s->step = (dense_output){s->layout, 0.0, chain_step, chain_step, s->y0, s->f0, s->y1, s->f1, parabolic, NULL};
}

/* Components of all nodes in a state, or a derivative, are those of another chain that has the same motions. */
static inline void chain_check_components(const chain *a, const double *of_a, const chain *b, const double *of_b)
{
    const state_layout *l = &a->layout, *m = &b->layout;
    for (int c = 0; c < l->dim; c++)
        for (int d = 0; d < m->dim; d++)
            for (dem_index i = 0; i < CHAIN_NODES && a->axis[c] == b->axis[d]; i++) {
                assert_memory_equal(state_x(l, of_a, i) + c, state_x(m, of_b, i) + d, sizeof *of_a);
                assert_memory_equal(state_v(l, of_a, i) + c, state_v(m, of_b, i) + d, sizeof *of_a);
            }
}

#endif
