/* SPDX-License-Identifier: BSD-3-Clause */
/* A look that notes the bound costs more than one without it. Where it does not save enough of these it is tried again
 * a few steps later only: no result depends on that. */
#include "surface_contact/approach_bound.h"

#include <math.h>

enum { pause = 16 /* steps */ };

static const double rounding = 1.0 + 1e-6;

void approach_bound_create(approach_bound *out, step_reach reach, double longest_step, int worth_noting)
{
    *out = (approach_bound){.reach = reach,
                            .longest_step = longest_step,
                            .at_start = INFINITY,
                            .largest = INFINITY,
                            .last = INFINITY,
                            .worth_noting = worth_noting};
}

void approach_bound_lose(approach_bound *b)
{
    if (b->is_known && b->n_saved < b->worth_noting) b->n_to_wait = pause;
    b->is_known = false;
}

/* The bound of how far nodes move relative to each other in a step so long, m. */
static double way_in(const approach_bound *b, double h)
{
    return rounding * h * (b->reach.time * b->speed + 2.0 * b->reach.position * h * b->largest);
}

/* Written so that what is not a number bounds nothing. */
static bool is_within(const approach_bound *b)
{
    return b->is_known && way_in(b, b->longest_step) <= b->left;
}

bool approach_bound_begin_step(approach_bound *b)
{
    b->largest = b->at_start;
    if (is_within(b)) return false;
    approach_bound_lose(b);
    if (b->n_to_wait > 0) b->n_to_wait--;
    return b->n_to_wait == 0 && isfinite(b->at_start);
}

void approach_bound_note(approach_bound *b, double left, double speed)
{
    b->is_known = true;
    b->left = left;
    b->speed = speed;
    b->n_saved = 0;
    if (!is_within(b)) approach_bound_lose(b);
}

bool approach_bound_holds(approach_bound *b)
{
    const bool holds = is_within(b);
    b->n_saved += holds;
    return holds;
}

void approach_bound_take(approach_bound *b, double acceleration)
{
    b->last = acceleration;
    if (!(acceleration <= b->largest)) b->largest = acceleration;
}

void approach_bound_end_step(approach_bound *b, double length)
{
    b->left -= way_in(b, length);
    b->speed += rounding * 2.0 * b->reach.velocity * length * b->largest;
    b->at_start = b->last;
}

bool approach_bound_pass_step(approach_bound *b, double length, double acceleration)
{
    (void)approach_bound_begin_step(b);
    if (!approach_bound_holds(b)) return false;
    approach_bound_take(b, acceleration);
    approach_bound_end_step(b, length);
    return true;
}

void approach_bound_forget(approach_bound *b)
{
    approach_bound_lose(b);
    b->at_start = b->last = INFINITY;
}
