/* SPDX-License-Identifier: BSD-3-Clause */
/* Where things stand in a state y = (x, v) and in its derivative f = (u, a). Each of x, v, u and a is an array of rows
 * of `dim` components. The first rows are those of the nodes. The last are those of the quadratures, which are
 * integrated along as if they were nodes: their accelerations are rates, their velocities the integrals. There is a
 * row for the impulse of each obstacle's lasting contacts, then one for the frictional part of each; behind them stand
 * the totals, one in each component. The rows between nodes and quadratures are padding, so that v begins at a cache
 * line where y does. Nobody else multiplies by the number of components, or adds one part's length to find the next. */
#ifndef DEM_BASE_STATE_H
#define DEM_BASE_STATE_H

#include <stdbool.h>

#include <dem/dem.h>

#include "base/aligned.h"

enum { STATE_DIM_MOST = 3 };

/** Quadratures of the whole: energies that friction and damping take, J, the work from outside, J, the time, s; and,
 *  where obstacles move, the work that they do in lasting contacts, J. */
typedef enum state_total {
    STATE_FRICTION,
    STATE_DAMPING,
    STATE_WORK,
    STATE_TIME,
    STATE_OBSTACLE,
    STATE_TOTALS
} state_total;

typedef struct state_layout {
    int dim;               /* components of a row, 2 or 3 */
    dem_index n_nodes;     /* of the model, ghosts of other ranks included (domain/domain.h) */
    dem_index n_obstacles; /* whose impulses are integrated along */
    int n_totals;          /* STATE_TOTALS, or without the last where no obstacle moves */
    dem_index n_rows;      /* all: of nodes, ghosts, padding and quadratures */
} state_layout;

/** Rows that the totals take. */
static inline dem_index state_n_total_rows(const state_layout *l)
{
    return (l->n_totals + l->dim - 1) / l->dim;
}

static inline dem_index state_n_quadratures(const state_layout *l)
{
    return 2 * l->n_obstacles + state_n_total_rows(l);
}

/** The layout of a simulation. */
static inline state_layout state_layout_of(int dim, dem_index n_nodes, dem_index n_obstacles, bool obstacles_move)
{
    const dem_index line = ALIGNED_TO / sizeof(double);
    state_layout l = {.dim = dim,
                      .n_nodes = n_nodes,
                      .n_obstacles = n_obstacles,
                      .n_totals = obstacles_move ? STATE_TOTALS : STATE_OBSTACLE};
    l.n_rows = l.n_nodes + state_n_quadratures(&l);
    while (l.dim * l.n_rows % line != 0) l.n_rows++;
    return l;
}

/* ---- indices, the same to read and to write, in states and in derivatives ---- */

/** Of the first component of a row, in each of x, v, u and a. */
static inline dem_index state_row(const state_layout *l, dem_index row)
{
    return l->dim * row;
}

/** Of the first velocity in y, and of the first acceleration in f. */
static inline dem_index state_velocities(const state_layout *l)
{
    return l->dim * l->n_rows;
}

/** How many numbers y has, and f. */
static inline dem_index state_size(const state_layout *l)
{
    return 2 * state_velocities(l);
}

/** Rows of the impulse of an obstacle, of its frictional part, the first one of the totals, and that of the time. */
static inline dem_index state_impulse(const state_layout *l, dem_index obstacle)
{
    return l->n_rows - state_n_quadratures(l) + obstacle;
}

static inline dem_index state_friction_impulse(const state_layout *l, dem_index obstacle)
{
    return state_impulse(l, l->n_obstacles + obstacle);
}

static inline dem_index state_total_rows(const state_layout *l)
{
    return state_impulse(l, 2 * l->n_obstacles);
}

static inline dem_index state_time_row(const state_layout *l)
{
    return state_total_rows(l) + STATE_TIME / l->dim;
}

/** Of a total in v, and of its rate in a. */
static inline dem_index state_total_index(const state_layout *l, state_total which)
{
    return state_row(l, state_total_rows(l)) + (dem_index)which;
}

/** Whether a state has this total. */
static inline bool state_has_total(const state_layout *l, state_total which)
{
    return (int)which < l->n_totals;
}

/* ---- values ---- */

/** Copies a row; two components at once, for vector instructions. */
static inline void state_copy_row(const state_layout *l, double *to, const double *from)
{
    const double first = from[0], second = from[1];
    if (l->dim > 2) to[2] = from[2];
    to[0] = first;
    to[1] = second;
}

/** Puts a - b into a row, which may be one of both. */
static inline void state_subtract_rows(const state_layout *l, double *to, const double *a, const double *b)
{
    const double first = a[0] - b[0], second = a[1] - b[1];
    if (l->dim > 2) to[2] = a[2] - b[2];
    to[0] = first;
    to[1] = second;
}

/** Adds s times a row to another. */
static inline void state_add_row(const state_layout *l, double *to, double s, const double *from)
{
    const double first = to[0] + s * from[0], second = to[1] + s * from[1];
    if (l->dim > 2) to[2] += s * from[2];
    to[0] = first;
    to[1] = second;
}

static inline bool state_is_zero_row(const state_layout *l, const double *row)
{
    return row[0] == 0.0 && row[1] == 0.0 && (l->dim < 3 || row[2] == 0.0);
}

/** Position, velocity [dim] of a row of y. */
static inline const double *state_x(const state_layout *l, const double *y, dem_index row)
{
    return y + state_row(l, row);
}

static inline const double *state_v(const state_layout *l, const double *y, dem_index row)
{
    return y + state_velocities(l) + state_row(l, row);
}

static inline double state_total_of(const state_layout *l, const double *y, state_total which)
{
    return y[state_velocities(l) + state_total_index(l, which)];
}

/** The time of y as integrated along, s. */
static inline double state_time(const state_layout *l, const double *y)
{
    return state_total_of(l, y, STATE_TIME);
}

/** Copies the quadratures of a state into another one, which may be of other nodes.
 *  \param l, of_from  layouts of `to`, and of `from` */
static inline void state_copy_quadratures(double *to, const state_layout *l, const double *from,
                                          const state_layout *of_from)
{
    const dem_index n = state_row(l, state_n_quadratures(l)), v = state_velocities(l),
                    from_v = state_velocities(of_from);
    double *into = to + state_row(l, state_impulse(l, 0));
    const double *out = from + state_row(of_from, state_impulse(of_from, 0));
    for (dem_index k = 0; k < n; k++) {
        into[k] = out[k];
        into[v + k] = out[from_v + k];
    }
}

/** That of a state of no nodes with the same quadratures. */
static inline state_layout state_layout_without_nodes(const state_layout *of)
{
    return state_layout_of(of->dim, 0, of->n_obstacles, state_has_total(of, STATE_OBSTACLE));
}

#endif
