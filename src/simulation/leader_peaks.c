/* SPDX-License-Identifier: BSD-3-Clause */
/* Those of a program get a number when they are first looked for, by which parts have theirs (shared_peaks.h). */
#include "simulation/leader_peaks.h"

#include "base/status.h"
#include "simulation/rank_call.h"

static dem_status pass(led_run *l, rank_call_kind what, int number)
{
    TRY(led_ranks_check(l));
    const rank_call o = rank_call_send(&l->ranks, (rank_call){.kind = what, .number = number});
    led_ranks_enter(l);
    const dem_status status = shared_peaks_answer(&l->peaks, l->part, &o);
    led_ranks_leave(l);
    return status;
}

/* Those of the program get a number when they are first looked for. */
static dem_status send(led_run *l, dem_peaks *peaks)
{
    int k = shared_peaks_number(&l->peaks, peaks);
    const bool is_known = k >= 0 && l->peaks.part[k] != NULL;
    if (k < 0) k = shared_peaks_number(&l->peaks, NULL);
    CHECK(k >= 0, DEM_ERROR_ARGUMENT, "a run has more than %d peaks", OBSERVERS_MOST);
    l->peaks.whole[k] = peaks;
    peaks->away = l->whole;
    if (!is_known) TRY(pass(l, RANK_CALL_PEAKS_TAKE, k));
    peaks_give_up(peaks);
    peaks->are_away = true;
    return DEM_OK;
}

dem_status leader_peaks_look(const dem_simulation *whole, dem_peaks *peaks)
{
    led_run *l = whole->leads;
    TRY(send(l, peaks));
    return pass(l, RANK_CALL_PEAKS_LOOK, shared_peaks_number(&l->peaks, peaks));
}

static dem_status visit(const dem_simulation *whole, const dem_peaks *peaks, rank_call_kind what, rows_taker *take,
                        void *context)
{
    led_run *l = whole->leads;
    l->peaks.take = take;
    l->peaks.context = context;
    return pass(l, what, shared_peaks_number(&l->peaks, peaks));
}

dem_status leader_peaks_visit_nodes(const dem_simulation *whole, const dem_peaks *peaks, rows_taker *take,
                                    void *context)
{
    return visit(whole, peaks, RANK_CALL_PEAKS_NODES, take, context);
}

dem_status leader_peaks_visit_springs(const dem_simulation *whole, const dem_peaks *peaks, rows_taker *take,
                                      void *context)
{
    return visit(whole, peaks, RANK_CALL_PEAKS_SPRINGS, take, context);
}

dem_status leader_peaks_keep(const dem_simulation *whole, const dem_peaks *peaks)
{
    led_run *l = whole->leads;
    return pass(l, RANK_CALL_PEAKS_KEEP, shared_peaks_number(&l->peaks, peaks));
}

dem_status leader_peaks_visit_kept_nodes(void *peaks, rows_taker *take, void *taker)
{
    const dem_peaks *p = peaks;
    return visit(p->away, p, RANK_CALL_PEAKS_KEPT_NODES, take, taker);
}

dem_status leader_peaks_visit_kept_springs(void *peaks, rows_taker *take, void *taker)
{
    const dem_peaks *p = peaks;
    return visit(p->away, p, RANK_CALL_PEAKS_KEPT_SPRINGS, take, taker);
}

dem_status leader_peaks_bring_nodes(dem_peaks *peaks)
{
    TRY(peaks_make_node_room(peaks));
    rows_copy all = {sizeof *peaks->nodes, peaks->nodes};
    return leader_peaks_visit_nodes(peaks->away, peaks, rows_taker_copy, &all);
}

dem_status leader_peaks_bring_springs(dem_peaks *peaks)
{
    TRY(peaks_make_spring_room(peaks));
    rows_copy all = {sizeof *peaks->springs, peaks->springs};
    return leader_peaks_visit_springs(peaks->away, peaks, rows_taker_copy, &all);
}

void leader_peaks_forget(const dem_simulation *whole, const dem_peaks *peaks)
{
    shared_peaks *s = &whole->leads->peaks;
    s->whole[shared_peaks_number(s, peaks)] = NULL;
}

/* Those of nodes and of springs. */
static dem_status bring(dem_peaks *whole)
{
    if (whole == NULL || !whole->are_away) return DEM_OK;
    peaks_give_up(whole);
    dem_status status = leader_peaks_bring_nodes(whole);
    if (status == DEM_OK) status = leader_peaks_bring_springs(whole);
    if (status == DEM_OK)
        whole->are_away = false;
    else
        peaks_give_up(whole);
    return status;
}

/* Before the parts end. */
dem_status leader_peaks_bring_all(led_run *l)
{
    for (int k = 0; k < OBSERVERS_MOST; k++) TRY(bring(l->peaks.whole[k]));
    return DEM_OK;
}

void leader_peaks_forget_run(led_run *l)
{
    for (int k = 0; k < OBSERVERS_MOST; k++) {
        dem_peaks *whole = l->peaks.whole[k];
        if (whole == NULL) continue;
        whole->away = NULL;
        whole->are_away = false;
    }
}
