/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/led_ranks.h"

#include "base/status.h"

dem_status led_ranks_check(const led_run *l)
{
    CHECK(l->part != NULL, DEM_ERROR_ARGUMENT, "the run has ended, as its nodes could not be shared out anew");
    return DEM_OK;
}

void led_ranks_enter(led_run *l)
{
    status_watch_memory(l->ranks.lacks_memory, l->ranks.program);
    l->entered = ranks_busy(&l->ranks);
}

void led_ranks_leave(led_run *l)
{
    const double now = ranks_busy(&l->ranks);
    l->busy += now - l->entered;
    l->entered = now;
    status_watch_memory(NULL, NULL);
}

bool led_ranks_collect_busy(led_run *l)
{
    if (l->ranks.busy == NULL) return false;
    balance_collect(&l->balance, &l->ranks, l->busy + ranks_busy(&l->ranks) - l->entered);
    return true;
}

/* ---- again from a checkpoint ---- */

void led_ranks_pass_checkpoint(led_run *l)
{
    l->made = l->seen = (calls){.step = -1};
}

bool led_ranks_have_seen(led_run *l)
{
    return l->made.n++ < l->seen.n;
}

bool led_ranks_have_seen_step(led_run *l, const dem_simulation *part)
{
    l->made.step = run_count_steps(part);
    return l->made.step <= l->seen.step;
}

bool led_ranks_are_before(const led_run *l, const dem_simulation *part)
{
    return part->in_hand && run_count_steps(part) > l->seen.step;
}

void led_ranks_go_back(led_run *l)
{
    l->seen = l->made;
    l->made = (calls){.step = -1};
}
