/* SPDX-License-Identifier: BSD-3-Clause */
/* The change d of a motion x(t) that follows from an event at t* inside a step (docs/algorithms.md, Local correction):
 *   d'' = a(x + d, contacts after) - a(x, contacts before),   from t* to the end of the step,
 * by one step of an embedded Runge-Kutta pair with stages q. Before the event, open() computes at all stages x_q, v_q
 * from the dense output and a_q from the contacts before. After it, close() starts from d_0, the jumps that the event
 * has made, and takes the stages of the change:
 *   dx_q = dx_0 + h sum of a_qr dv_r,   dv_q = dv_0 + h sum of a_qr da_r,   da_q = a(x_q + dx_q, after) - a_q.
 * d is 0 beyond a few rings of neighbours, see reach(): on these rings the step of the pair is the same as on the whole
 * body. Quadratures are changed along, by their rates after less those before. Resolving the event is the source's
 * part; which events come, and in which order, is event_queue.c's. */
#include "events/local_correction.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array_ops.h"
#include "base/row_pair.h"
#include "base/status.h"

enum { END = LOCAL_CORRECTION_STAGES }; /* the end of the step, behind the stages */

/* Methods above order 2 have their changes integrated by Fehlberg's pair, the others by Heun's, whose own two stages
 * are enough. Where springs are damped the third stage, which ARKODE needs, is kept for its ring: that far Verlet's
 * forces at the end of the step become those at the velocities there. */
static dem_status load_table(butcher_table *out, int order, bool damped)
{
    if (order > 2) return butcher_load(out, DEM_METHOD_FEHLBERG45);
    return damped ? butcher_load(out, DEM_METHOD_HEUN12) : butcher_load_own(out, DEM_METHOD_HEUN12);
}

/* `last` is the stage at the end of the step: forces there are known from the accepted step. One ring more than the
 * change reaches is gathered, as the nodes there act on those that move. */
dem_status local_correction_create(local_correction *out, const state_layout *l, const local_forces *f,
                                   const constraints *c, const local_correction_rule *rule)
{
    local_correction p = {.rule = *rule};
    TRY(load_table(&p.table, rule->order, f->couple_velocities));
    while (p.table.c[p.last] != 1.0) p.last++;
    TRY(neighbourhood_create(&p.near, l, f, c, 1 + (f->couple_velocities ? p.table.stages : p.table.stages / 2)));
    *out = p;
    return DEM_OK;
}

void local_correction_destroy(local_correction *p)
{
    neighbourhood_destroy(&p->near);
    free(p->rows);
    free(p->motions);
    free(p->block);
    *p = (local_correction){0};
}

/* The last ring on which the motion changes; one more is gathered, whose nodes are only read. */
static int last_ring(const local_correction *p)
{
    return p->near.nodes.n_rings - 1;
}

/* How many nodes have a change of their own: those of all rings but the last. */
static dem_index n_moving(const local_correction *p)
{
    return local_nodes_n_moving(&p->near.nodes);
}

/* How many numbers n nodes have in x, v or a. */
static dem_index components(const local_correction *p, dem_index n)
{
    return state_row(&p->near.layout, n);
}

/* How many rings around ring 0 accelerations change on at a stage. dx_q has dv of the stages before, dv_q has da of
 * them, and da_q depends on dx_q of a node and its neighbours: so the change spreads by one ring in two stages. It
 * begins with ring 1, not 0, because a node may be put back on its surface, which its neighbours feel at once; but with
 * ring 0 where an event changes the forces between the seeds alone. Where springs are damped, da_q depends on dv_q of
 * the neighbours too, and every stage brings a ring. */
static int spread(const local_correction *p, int stage)
{
    const int before = stage == END ? p->table.stages : stage, first = neighbourhood_is_short(&p->near) ? 0 : 1;
    return first + (p->near.forces->couple_velocities ? before : before / 2);
}

/* The last ring on which accelerations change at a stage. At the end of the step they change one ring beyond the last
 * that moves: event_queue.c computes them again. */
static int reach(const local_correction *p, int stage)
{
    const int rings = spread(p, stage);
    return rings < last_ring(p) ? rings : last_ring(p);
}

/* How many nodes have a dx_q that may be other than 0: one ring less than accelerate otherwise. */
static dem_index n_moved_at(const local_correction *p, int stage)
{
    const int ring = spread(p, stage) - 1;
    if (ring < 0) return 0;
    return p->near.nodes.end[ring < last_ring(p) ? ring : last_ring(p)];
}

/* ---- memory ---- */

enum {
    ARRAYS = 6 * LOCAL_CORRECTION_STAGES + 6,
    CHANGES = 3 * LOCAL_CORRECTION_STAGES
}; /* CHANGES: the first of dx, dv, da */

/* The k-th of the arrays that share one block: first x, v, a of all stages, then the changes, then the scratch. */
static double **array_of(local_correction *p, int k)
{
    double **const before[] = {p->x, p->v, p->a}, **const change[] = {p->dx, p->dv, p->da, p->changed};
    if (k < CHANGES) return &before[k / LOCAL_CORRECTION_STAGES][k % LOCAL_CORRECTION_STAGES];
    return &change[(k - CHANGES) / (LOCAL_CORRECTION_STAGES + 1)][(k - CHANGES) % (LOCAL_CORRECTION_STAGES + 1)];
}

/* Makes room for n nodes and rows of the quadratures, and keeps the first `used` of them. */
static dem_status reserve(local_correction *p, dem_index n, dem_index used)
{
    if (n <= p->capacity) return DEM_OK;
    const size_t more = 2 * (size_t)n + 64, length = (size_t)components(p, (dem_index)more);
    double *block = calloc(length * ARRAYS, sizeof *block);
    CHECK(block != NULL, DEM_ERROR_MEMORY, "out of memory for what is near an event");
    for (int k = 0; k < ARRAYS; k++) {
        double **array = array_of(p, k), *moved = block + length * (size_t)k;
        if (used > 0) memcpy(moved, *array, (size_t)components(p, used) * sizeof *moved);
        *array = moved;
    }
    free(p->block);
    p->block = block;
    p->capacity = 0;
    motion_polynomial *motions = realloc(p->motions, more * sizeof *motions);
    if (motions != NULL) p->motions = motions;
    dem_index *rows = realloc(p->rows, more * sizeof *rows);
    if (rows != NULL) p->rows = rows;
    CHECK(motions != NULL && rows != NULL, DEM_ERROR_MEMORY, "out of memory for what is near an event");
    p->capacity = (dem_index)more;
    return DEM_OK;
}

/* ---- quadratures ---- */

/* The number of a row of the quadratures, by its place in a state. Rows get numbers behind those of the nodes when they
 * first change; the changes of a new one are 0 at all stages so far. */
static dem_status find_quadrature(local_correction *p, dem_index place, dem_index *out)
{
    const dem_index n = p->near.nodes.n;
    for (dem_index b = 0; b < p->n_quadratures; b++) {
        *out = n + b;
        if (p->rows[b] == place) return DEM_OK;
    }
    *out = n + p->n_quadratures;
    TRY(reserve(p, *out + 1, *out));
    p->rows[p->n_quadratures++] = place;
    const dem_index first = components(p, *out), last = components(p, *out + 1);
    for (int k = CHANGES; k < ARRAYS; k++)
        for (dem_index c = first; c < last; c++) (*array_of(p, k))[c] = 0.0;
    return DEM_OK;
}

/* Rates [dim] with a sign at a stage: what constraints add goes there. */
typedef struct signed_rates {
    local_correction *correction;
    int stage;
    double sign;
} signed_rates;

/* Adds a rate with its sign to the change of a row at a stage. Zeros are left out: most events concern one obstacle,
 * and no row is needed for the others. */
static dem_status add_rate(void *context, dem_index row, const double *rate)
{
    const signed_rates *to = context;
    local_correction *p = to->correction;
    dem_index number;
    if (state_is_zero_row(&p->near.layout, rate)) return DEM_OK;
    TRY(find_quadrature(p, row, &number));
    state_add_row(&p->near.layout, p->da[to->stage] + components(p, number), to->sign, rate);
    return DEM_OK;
}

/* Adds, with this sign, the rates of the quadratures that come from the neighbourhood, in a state that the constraints
 * are solved for: those of closed contacts, and the power of forces. With -1 before the event and 1 after it, what
 * remains is the change of the rates. */
static dem_status add_rates(local_correction *p, int stage, double sign, constraint_state state)
{
    const neighbourhood *near = &p->near;
    const constraints *c = near->constraints;
    const state_layout *l = &near->layout;
    const int ring = reach(p, stage);
    if (near->n_groups == 0 && !near->forces->have_power) return DEM_OK;
    double totals[STATE_TOTALS + STATE_DIM_MOST] = {0.0}; /* whole rows of them */
    signed_rates at_stage = {p, stage, sign};
    const constraint_rates rates = {&at_stage, add_rate, totals};
    for (dem_index g = 0; g < near->n_groups; g++)
        if (near->groups[g].ring <= ring) TRY(c->add_rates(c->self, near->groups[g].group, state, &rates));
    if (near->forces->have_power) near->forces->add_power(near->forces->self, &near->nodes, ring, state.y, totals);
    for (dem_index k = 0; k < state_n_total_rows(l); k++)
        TRY(add_rate(&at_stage, state_total_rows(l) + k, totals + state_row(l, k)));
    return DEM_OK;
}

/* ---- stages ---- */

/* s. The stage at the end of the step has its time to the bit. */
static double stage_time(const local_correction *p, const dense_output *step, int stage)
{
    return stage == p->last ? step->t1 : p->t + p->table.c[stage] * p->h;
}

/* Puts the time into a state, for forces that depend on it. */
static void put_time(const local_correction *p, const dense_output *step, int stage, double *y)
{
    const dem_index row = state_time_row(&step->layout);
    if (!p->near.forces->are_driven) return;
    dense_output_velocity(step, stage_time(p, step, stage), row,
                          y + state_velocities(&step->layout) + state_row(&step->layout, row));
}

/* Whether anything reads the state of all nodes at a stage, or velocities: forces other than those of springs and
 * triangles, and the quadratures. */
static bool needs_state(const local_correction *p)
{
    const local_forces *f = p->near.forces;
    return p->near.n_groups > 0 || f->have_power || (f->read_state != NULL && f->read_state(f->self));
}

/* Positions of the first n nodes at a stage, and velocities if anything reads them, without the event: of their
 * polynomials at s = c_q. */
static void fetch_stage(local_correction *p, int stage, dem_index n)
{
    const double s = p->table.c[stage];
    for (dem_index j = 0; j < n; j++) motion_polynomial_position(&p->motions[j], s, p->x[stage] + components(p, j));
    for (dem_index j = 0; j < n && needs_state(p); j++)
        motion_polynomial_velocity(&p->motions[j], s, p->v[stage] + components(p, j));
}

/* Accelerations a_q and rates at a stage, without the event. Nodes are fetched one ring beyond those that are
 * accelerated, as these depend on their neighbours. */
static dem_status open_stage(local_correction *p, const dense_output *step, int stage, double *y)
{
    const local_state s = {stage_time(p, step, stage), p->x[stage], p->v[stage], y};
    const dem_index n = p->near.nodes.end[reach(p, stage) + 1];
    fetch_stage(p, stage, n);
    if (needs_state(p)) neighbourhood_put(&p->near, &s, n, y);
    put_time(p, step, stage, y);
    neighbourhood_accelerate(&p->near, reach(p, stage), &s, p->a[stage]);
    return add_rates(p, stage, -1.0, (constraint_state){s.t, y});
}

/* Whether this waits until the event is resolved. */
static bool evaluates_late(const local_correction *p, int stage)
{
    return p->opens_late && stage != p->last && stage != END;
}

/* The same where positions are all that matters, right before the stage is evaluated with the event. At the event
 * itself x_0 is not quite that of the polynomials, see open_start(). */
static void open_late(local_correction *p, const dense_output *step, int stage)
{
    const int ring = reach(p, stage);
    double *x = stage > 0 ? p->x[stage] : p->changed[0];
    const local_state s = {.t = stage_time(p, step, stage), .x = x};
    if (stage > 0) fetch_stage(p, stage, p->near.nodes.end[ring + 1]);
    for (dem_index j = 0; j < p->near.nodes.end[ring + 1] && stage == 0; j++)
        state_copy_row(&p->near.layout, x + components(p, j), p->motions[j].x[0]);
    p->near.forces->accelerate(p->near.forces->self, &p->near.nodes, ring, &s, p->a[stage]);
}

/* The end of the step, whose state and derivative are known: nothing is evaluated but the external force, whose power
 * the rates need. Verlet's method is the exception: its forces at the end are those at the velocities v_0 + h a_0, not
 * those of the state, so that they would not cancel against those with the event. The rates count for the end and for
 * the stage `last`, which is at the same time. */
static dem_status open_end(local_correction *p, const dense_output *step)
{
    const state_layout *l = &step->layout;
    const local_nodes *nodes = &p->near.nodes;
    const local_forces *f = p->near.forces;
    const local_state s = {step->t1, p->x[p->last], p->v[p->last], step->y1};
    for (dem_index j = 0; j < nodes->n; j++) {
        const dem_index to = components(p, j);
        state_copy_row(l, p->x[p->last] + to, state_x(l, step->y1, nodes->list[j]));
        state_copy_row(l, p->v[p->last] + to, state_v(l, step->y1, nodes->list[j]));
        state_copy_row(l, p->a[p->last] + to, state_v(l, step->f1, nodes->list[j]));
    }
    if (p->parabolic)
        neighbourhood_accelerate(&p->near, reach(p, END), &s, p->a[p->last]);
    else
        f->evaluate_external(f->self, nodes, reach(p, END), &s);
    const constraint_state state = {step->t1, step->y1};
    TRY(add_rates(p, END, -1.0, state));
    return add_rates(p, p->last, -1.0, state);
}

/* The state at the event, into y, for the source that resolves it. Ring 0, with which the event was found, gets the
 * bits of the dense output; those of a polynomial may differ by rounding, and with them the gap by which the event was
 * found. */
static void open_start(local_correction *p, const dense_output *step, double *y)
{
    const local_nodes *nodes = &p->near.nodes;
    const local_state s = {p->t, p->x[0], p->v[0], y};
    for (dem_index j = nodes->end[1]; j < nodes->n; j++) {
        state_copy_row(&step->layout, p->x[0] + components(p, j), p->motions[j].x[0]);
        state_copy_row(&step->layout, p->v[0] + components(p, j), p->motions[j].v[0]);
    }
    dense_output_put_nodes(step, p->t, nodes->end[1], nodes->list, p->x[0], p->v[0]);
    neighbourhood_put(&p->near, &s, nodes->n, y);
    put_time(p, step, 0, y);
}

/* The motions after the event as if there were none, in powers of s from t* to the end of the step. */
static void find_motions(local_correction *p, const dense_output *step)
{
    const local_nodes *nodes = &p->near.nodes;
    dense_output_motions(step, nodes->n, nodes->list, p->motions);
    for (dem_index j = 0; j < nodes->n; j++) motion_polynomial_restart(&p->motions[j], p->t, step->t1);
}

/* The stage at the end of the step needs no evaluation; the others do, the first at t* itself. Where nothing but
 * positions matters, and no element changes, they wait until the event is resolved. */
dem_status local_correction_open(local_correction *p, const dense_output *step, neighbourhood_seeds seeds, double t,
                                 double *state)
{
    p->t = t;
    p->h = step->t1 - t;
    p->parabolic = step->parabolic;
    p->n_quadratures = 0;
    TRY(neighbourhood_gather(&p->near, seeds));
    TRY(reserve(p, p->near.nodes.n, 0));
    find_motions(p, step);
    TRY(open_end(p, step));
    p->opens_late = p->near.forces->accelerate_moved != NULL && !needs_state(p) && !seeds.by_forces;
    for (int stage = 0; stage < p->table.stages && !p->opens_late; stage++)
        if (stage != p->last) TRY(open_stage(p, step, stage, state));
    open_start(p, step, state);
    return DEM_OK;
}

/* ---- the change ---- */

/* How many numbers of dv_q may be other than 0: those of the nodes that accelerate otherwise at the stages before. The
 * event itself moves ring 0 alone, which is among them. */
static dem_index n_changed_at(const local_correction *p, int stage)
{
    const int before = stage == END ? p->table.stages - 1 : stage - 1;
    return components(p, p->near.nodes.end[reach(p, before)]);
}

/* change[stage] = change[0] + h sum of weights rates over the stages before, of numbers first to last - 1. In narrow
 * vectors: what is read has just been written in such, and a wider load would wait until several of them are in the
 * cache. */
static void combine(const local_correction *p, int stage, double *const rates[], double *const change[],
                    dem_index first, dem_index last)
{
    const double *weights = stage == END ? p->table.b : p->table.a + stage * p->table.stages;
    const double *in[1 + LOCAL_CORRECTION_STAGES] = {change[0] + first};
    double by[1 + LOCAL_CORRECTION_STAGES] = {1.0};
    int n = 1;
    for (int q = 0; q < stage && q < p->table.stages; q++) {
        if (weights[q] == 0.0) continue;
        in[n] = rates[q] + first;
        by[n++] = p->h * weights[q];
    }
    array_ops_portable.combine(change[stage] + first, n, by, in, last - first);
}

/* dx_q and dv_q of the nodes that move, and of the quadratures, which are integrated as the nodes are. */
static void advance(local_correction *p, int stage)
{
    const dem_index n_moves = components(p, n_moving(p)), n_changes = n_changed_at(p, stage);
    const dem_index first = components(p, p->near.nodes.n), last = components(p, p->near.nodes.n + p->n_quadratures);
    combine(p, stage, p->dv, p->dx, 0, components(p, n_moved_at(p, stage)));
    combine(p, stage, p->da, p->dv, 0, n_changes);
    memset(p->dv[stage] + n_changes, 0, (size_t)(n_moves - n_changes) * sizeof(double));
    if (last == first) return;
    combine(p, stage, p->dv, p->dx, first, last);
    combine(p, stage, p->da, p->dv, first, last);
}

/* The first n numbers of a state with the change; behind n_changed the change is 0. */
static void add_change(const double *before, const double *change, dem_index n, dem_index n_changed, double *to)
{
    for (dem_index k = 0; k < n_changed; k++) to[k] = before[k] + change[k];
    memcpy(to + n_changed, before + n_changed, (size_t)(n - n_changed) * sizeof *to);
}

/* Prescribed components go on as they do without the event. */
static void hold_prescribed(local_correction *p, int stage)
{
    const local_forces *f = p->near.forces;
    const int dim = p->near.layout.dim;
    for (dem_index j = 0; j < n_moving(p) && f->held != NULL; j++) {
        const unsigned held = local_forces_held(f, p->near.nodes.list[j]);
        for (int c = 0; c < dim; c++)
            if (held & ((unsigned)DEM_COMPONENT_X << c)) p->da[stage][components(p, j) + c] = 0.0;
    }
}

/* Accelerations at a stage with the event. Where they have just been evaluated without it, only some nodes have moved
 * since. */
static void accelerate_changed(local_correction *p, int stage, const local_state *s)
{
    const local_forces *f = p->near.forces;
    const int ring = reach(p, stage);
    if (p->near.n_groups == 0 && evaluates_late(p, stage) && stage > 0)
        f->accelerate_moved(f->self, &p->near.nodes, n_moved_at(p, stage), ring, s, p->changed[2]);
    else
        neighbourhood_accelerate(&p->near, ring, s, p->changed[2]);
}

/* da_q and the change of the rates at a stage, with the event: forces in the state x_q + dx_q, less a_q. Beyond reach()
 * of the stage da_q is 0, without being computed. */
static dem_status change_stage(local_correction *p, const dense_output *step, int stage, double *y)
{
    const int at = stage == END ? p->last : stage, ring = reach(p, stage);
    const dem_index n = p->near.nodes.end[ring + 1], n_changed = n < n_moving(p) ? n : n_moving(p);
    const dem_index size = components(p, n), accelerated = components(p, p->near.nodes.end[ring]);
    const dem_index moving = components(p, n_moving(p));
    const local_state s = {stage_time(p, step, at), p->changed[0], p->changed[1], y};
    add_change(p->x[at], p->dx[stage], size, components(p, n_moved_at(p, stage)), p->changed[0]);
    if (needs_state(p)) {
        add_change(p->v[at], p->dv[stage], size, components(p, n_changed), p->changed[1]);
        neighbourhood_put(&p->near, &s, n, y);
    }
    put_time(p, step, at, y);
    accelerate_changed(p, stage, &s);
    for (dem_index k = 0; k < accelerated; k++) p->da[stage][k] = p->changed[2][k] - p->a[at][k];
    memset(p->da[stage] + accelerated, 0, (size_t)(moving - accelerated) * sizeof(double));
    hold_prescribed(p, stage);
    return add_rates(p, stage, 1.0, (constraint_state){s.t, y});
}

/* The change of node j at a stage: of position, velocity and acceleration. */
static motion_change jump_at(const local_correction *p, int stage, dem_index j)
{
    const state_layout *l = &p->near.layout;
    const dem_index at = components(p, j);
    motion_change out;
    state_copy_row(l, out.x, p->dx[stage] + at);
    state_copy_row(l, out.v, p->dv[stage] + at);
    state_copy_row(l, out.a, p->da[stage] + at);
    return out;
}

/* For parabolas: finds the change of acceleration that makes the slope of the node's velocity at the event its
 * acceleration after the event,
 *   change = a_0 + da_0 - (slope of the motion there),
 * as the slope of the step's own parabola is off by a term of order h^2. A contact that begins to slide is pushed by
 * the small force that exceeds friction: with a slope that is wrong by more it would turn back at once, and again at
 * every attempt. */
static void put_change_of_slope(const local_correction *p, dem_index j, const motion_polynomial *motion, double *change)
{
    const unsigned held = local_forces_held(p->near.forces, p->near.nodes.list[j]);
    const double *a = p->a[0] + components(p, j), *da = p->da[0] + components(p, j);
    const double per_h = p->h > 0.0 ? 1.0 / p->h : 0.0;
    for (int c = 0; c < motion->dim; c++)
        change[c] = held & ((unsigned)DEM_COMPONENT_X << c) ? 0.0 : a[c] + da[c] - per_h * motion->v[1][c];
}

/* Writes the sum of a motion and the change into `to`: by a quintic or, where the step has parabolas, by parabolas.
 * Heun's position at the end lacks j h^3/6, with j the rate at which the acceleration grows, as does the position of
 * the step itself. A quintic would close this gap within the step: after an event from which the acceleration grows
 * from 0 like j t its velocity would be 5 j t^2 too small. That is ten times the true j t^2/2, so a contact that begins
 * to slide would turn back at once. */
static void add_change_of_node(const local_correction *p, dem_index j, const motion_change *end,
                               const motion_polynomial *motion, motion_polynomial *to)
{
    const state_layout *l = &p->near.layout;
    motion_change at = jump_at(p, 0, j), by;
    state_subtract_rows(l, by.x, end->x, at.x);
    state_subtract_rows(l, by.v, end->v, at.v);
    state_subtract_rows(l, by.a, end->a, at.a);
    if (p->parabolic && j < p->near.nodes.end[reach(p, 0)]) put_change_of_slope(p, j, motion, at.a);
    (p->parabolic ? motion_polynomial_add_parabolas : motion_polynomial_add)(motion, p->t + p->h, &at, &by, to);
}

/* Adds the change of a node to the dense output and to the end of the step. */
static dem_status leave(const local_correction *p, changed_motion *tr, dem_index j)
{
    const motion_change end = jump_at(p, END, j);
    const dem_index node = p->near.nodes.list[j];
    motion_polynomial *to;
    TRY(changed_motion_take(tr, node, &to));
    add_change_of_node(p, j, &end, &p->motions[j], to);
    changed_motion_move_end(tr, node, &end);
    return DEM_OK;
}

/* The change of the b-th row of the quadratures, beside those that other events have made. */
static dem_status leave_quadrature(const local_correction *p, changed_motion *tr, dem_index b)
{
    const dem_index j = p->near.nodes.n + b;
    changed_motion_part part = {
        p->rows[b], {.from = p->t, .dim = p->near.layout.dim, .parabolic = p->parabolic}, jump_at(p, END, j)};
    add_change_of_node(p, j, &part.end, &part.motion, &part.motion);
    return changed_motion_add(tr, &part);
}

/* The squared error of the change, the difference of both solutions of the pair,
 *   e = h sum of (b_q - d_q) (dv_q, da_q),
 * in the integrator's norm: a mean over all 2 dim n_nodes unknowns of the bodies, each in units of its tolerance. Nodes
 * out of reach have no error. */
static double squared_error(const local_correction *p)
{
    const double n_unknowns = 2.0 * (double)components(p, p->rule.n_nodes);
    double weights[LOCAL_CORRECTION_STAGES], x_sum = 0.0, v_sum = 0.0;
    for (int q = 0; q < p->table.stages; q++) weights[q] = p->h * (p->table.b[q] - p->table.d[q]);
    for (dem_index j = 0; j < n_moving(p); j++)
        for (int d = 0; d < p->near.layout.dim; d += 2) {
            const dem_index at = components(p, j);
            row_pair x = {0.0, 0.0}, v = {0.0, 0.0};
            for (int q = 0; q < p->table.stages; q++) {
                x += weights[q] * row_pair_at(p->dv[q] + at, d);
                v += weights[q] * row_pair_at(p->da[q] + at, d);
            }
            x_sum = row_pair_add_squares(x_sum, x);
            v_sum = row_pair_add_squares(v_sum, v);
        }
    const double x_scale = p->rule.position_error, v_scale = p->rule.velocity_error;
    return (x_sum / (x_scale * x_scale) + v_sum / (v_scale * v_scale)) / n_unknowns;
}

/* Whether a node of a ring ends elsewhere, by more than a hundredth of what counts as an error. */
static bool moves(const local_correction *p, int ring)
{
    const double most = 0.01 * p->rule.position_error;
    const dem_index first = components(p, local_nodes_begin(&p->near.nodes, ring));
    for (dem_index k = first; k < components(p, p->near.nodes.end[ring]); k++)
        if (!(fabs(p->dx[END][k]) <= most)) return true;
    return false;
}

/* The nodes up to the last ring that moves, and of the next one. */
static dem_index find_felt(const local_correction *p)
{
    int ring = last_ring(p);
    while (ring > 0 && !moves(p, ring)) ring--;
    return p->near.nodes.end[ring + 1];
}

/* Accelerations at the end of the step, where they are those of the state there to the bit: the last stage of the
 * change has evaluated them. Those of the frame have changed without being evaluated. */
static void note_end(const local_correction *p, changed_motion *tr)
{
    const local_forces *f = p->near.forces;
    const local_nodes *nodes = &p->near.nodes;
    const dem_index n_known = p->near.n_groups == 0 && f->are_exact(f->self) ? n_moving(p) : 0;
    for (dem_index j = 0; j < n_known; j++) changed_motion_know(tr, nodes->list[j], p->changed[2] + components(p, j));
    for (dem_index j = n_known; j < nodes->n; j++) changed_motion_doubt(tr, nodes->list[j]);
}

/* `state` is what the source has made of the state at t*: its difference from x_0, v_0 is the jump d_0. The contacts
 * are those after the event. The stages of the change go on to the end of the step, where contact forces are left as
 * solved for the end. */
dem_status local_correction_close(local_correction *p, const dense_output *step, changed_motion *tr, double *state,
                                  double *error)
{
    const state_layout *l = &step->layout;
    const dem_index *list = p->near.nodes.list;
    TRY(neighbourhood_regroup(&p->near));
    for (dem_index j = 0; j < n_moving(p); j++) {
        const dem_index at = components(p, j);
        state_subtract_rows(l, p->dx[0] + at, state_x(l, state, list[j]), p->x[0] + at);
        state_subtract_rows(l, p->dv[0] + at, state_v(l, state, list[j]), p->v[0] + at);
    }
    for (int stage = 0; stage <= p->table.stages; stage++) {
        const int at = stage < p->table.stages ? stage : END;
        if (stage > 0) advance(p, at);
        if (evaluates_late(p, at)) open_late(p, step, at);
        TRY(change_stage(p, step, at, state));
    }
    for (dem_index j = 0; j < n_moving(p); j++) TRY(leave(p, tr, j));
    for (dem_index b = 0; b < p->n_quadratures; b++) TRY(leave_quadrature(p, tr, b));
    note_end(p, tr);
    *error = squared_error(p);
    p->near.n_felt = find_felt(p);
    return DEM_OK;
}
