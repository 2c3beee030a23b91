/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of the state of the whole are positions of nodes, padding and quadratures, and the velocities of all of these
 * (base/state.h). Ranks have the nodes, and rank 0, as all others, the rest. */
#include "simulation/leader_checkpoint.h"

#include <stdlib.h>
#include <string.h>

#include "base/checkpoint_entries.h"
#include "base/status.h"
#include "domain/gather.h"
#include "simulation/rank_call.h"
#include "simulation/shared_checkpoint.h"

static const char entry[] = "state";

static bool is_no_state(const char *name)
{
    return strcmp(name, entry) != 0;
}

dem_status leader_checkpoint_answer(const led_run *l, dem_index number, rows_taker *take, void *context)
{
    const dem_model *m = l->part->model;
    const state_layout *here = &l->part->layout;
    const gather_items nodes = gather_nodes(m->domain);
    const double *rows = shared_checkpoint_state(l->part) + number * state_velocities(here);
    return gather_chunks(m->ranks, &nodes, (size_t)here->dim * sizeof *rows, rows, take, context);
}

/* Rows that come behind others. */
typedef struct behind {
    rows_taker *take;
    void *taker;
    dem_index n_before;
} behind;

static dem_status take_behind(void *context, dem_index first, dem_index n, const void *rows)
{
    const behind *b = context;
    return b->take(b->taker, b->n_before + first, n, rows);
}

static dem_status ask(led_run *l, dem_index number, behind *b)
{
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_STATE, .number = number});
    led_ranks_enter(l);
    const dem_status status = leader_checkpoint_answer(l, number, take_behind, b);
    led_ranks_leave(l);
    return status;
}

/* What is behind the nodes. */
static dem_status hand_over_rest(const led_run *l, dem_index number, behind *b)
{
    const state_layout *here = &l->part->layout, *of = &l->part->shared.whole;
    const dem_index n = of->n_rows - of->n_nodes, n_quadratures = state_n_quadratures(of);
    double *rest = calloc((size_t)state_row(of, n), sizeof *rest);
    CHECK_MEMORY(rest);
    memcpy(rest + state_row(of, n - n_quadratures),
           shared_checkpoint_state(l->part) + number * state_velocities(here) + state_row(here, state_impulse(here, 0)),
           (size_t)state_row(of, n_quadratures) * sizeof *rest);
    const dem_status status = take_behind(b, of->n_nodes, n, rest);
    free(rest);
    return status;
}

static dem_status visit(void *run, rows_taker *take, void *taker)
{
    led_run *l = run;
    behind b = {take, taker, 0};
    TRY(led_ranks_check(l));
    for (dem_index number = 0; number < 2; number++) {
        b.n_before = number * l->part->shared.whole.n_rows;
        TRY(ask(l, number, &b));
        TRY(hand_over_rest(l, number, &b));
    }
    return DEM_OK;
}

dem_status leader_checkpoint_take(led_run *l, dem_checkpoint *from)
{
    const state_layout *of = &l->part->shared.whole;
    const checkpoint_rows rows = {visit, l, (size_t)of->dim * sizeof(double), 2 * of->n_rows};
    TRY(checkpoint_entries_move(l->whole->checkpoint, from, is_no_state));
    return checkpoint_entries_refer(l->whole->checkpoint, entry, &rows);
}
