/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_plan.h"

#include "page_blocks.h"

enum {
    FRAME_FACTS = 160,    /* bytes of what is said of a frame, at most */
    QUANTITY_FACTS = 2000 /* of a quantity, with its colours */
};

static const double history_share = 0.25;

/* An even number of rows, two of each bin. */
static void bound_history(page_content *p, double most)
{
    const double rows = 2.0 * floor(0.5 * history_share * most / page_blocks_per_row(p));
    if (p->history != NULL && rows < (double)p->n_rows) p->n_rows = (size_t)rows;
}

static double fixed_of(const page_content *p, double texts)
{
    return texts + (double)p->n_quantities * QUANTITY_FACTS + page_blocks_fixed(p) +
           (double)p->n_rows * page_blocks_per_row(p);
}

static double per_frame(const page_content *p)
{
    return FRAME_FACTS + page_blocks_per_frame(p);
}

static double frames_that_fit(const page_content *p, double texts, double most)
{
    return floor((most - fixed_of(p, texts)) / per_frame(p));
}

/* The bytes with which a frame fits: the history has a quarter of them, or all its rows. */
static double least_of(const page_content *p, double texts)
{
    const double row = page_blocks_per_row(p), all = p->history != NULL ? (double)p->history->n * row : 0.0;
    const double others = fixed_of(p, texts) - (double)p->n_rows * row + per_frame(p);
    return fmin(others + all, others / (1.0 - history_share));
}

bool page_plan_fit(page_content *p, double texts, double most, outcome *o)
{
    const double wanted = fmin((double)p->frames.n, PAGE_PLAN_FRAMES), everything = (double)p->frames.n;
    bound_history(p, most);
    if (frames_that_fit(p, texts, most) < everything)
        while (p->n_quantities > 1 && frames_that_fit(p, texts, most) < wanted) p->n_quantities--;
    const double fit = frames_that_fit(p, texts, most);
    if (fit < 1.0) {
        outcome_fail(o, EXIT_INVALID, "dem_plot", "%s: '--max-size' has to be %.1f MB at least, for one frame",
                     p->asked->input, 0.1 * ceil(1e-5 * least_of(p, texts)));
        return false;
    }
    if (fit < everything) page_content_thin(p, (size_t)fit);
    return true;
}
