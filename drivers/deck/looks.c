/* SPDX-License-Identifier: BSD-3-Clause */
/* A row takes as long as one or two evaluations of the forces, a look at peaks as four to eight
 * (docs/performance.md, Rows of a run): large bodies have them so rarely that both together are a few per cent of a
 * run. The choice depends on nothing that differs in a run that is resumed, or continued by a later t_end. */
#include "looks.h"

#include <math.h>

#include "ask.h"

enum {
    FEW_NODES = 5000,     /* of which fewer take no time that matters */
    ROW_EVALUATIONS = 64, /* of the forces, from row to row, at most */
    ROWS_A_LOOK = 4       /* of larger bodies */
};

/* The largest power of two, so that rows fall on steps that are looked at anyway. */
static dem_index steps_a_row(dem_method method)
{
    dem_method_traits traits = {.struct_size = sizeof traits};
    dem_index steps = 1;
    if (dem_method_describe(&traits, method) != DEM_OK) return steps;
    while (2 * steps * traits.evaluations <= ROW_EVALUATIONS) steps *= 2;
    return steps;
}

double looks_row_interval(dem_method method, double nodes, double step)
{
    const dem_index steps = steps_a_row(method);
    return nodes < FEW_NODES || !isfinite(step) || steps == 1 ? 0.0 : (double)steps * step;
}

dem_index looks_peak_every(dem_method method, double nodes)
{
    return nodes < FEW_NODES ? LOOKS_FEW_STEPS : ROWS_A_LOOK * steps_a_row(method);
}

/* No method takes steps that are much longer, whatever the deck allows. */
static double longest_step(const dem_simulation *simulation)
{
    const double omega = dem_model_omega_max(dem_simulation_model(simulation));
    return omega > 0.0 ? fmin(ask_options(simulation).max_step, 2.0 / omega) : (double)INFINITY;
}

/* What may break is loaded until it does, and so has all rows. */
void looks_settle(deck *d, const dem_simulation *simulation)
{
    const dem_model *model = dem_simulation_model(simulation);
    const dem_method method = d->options.method;
    const double nodes = d->facts.may_break ? 0.0 : (double)ask_sizes(model).n_nodes;
    if (d->history_interval < 0.0) d->history_interval = looks_row_interval(method, nodes, longest_step(simulation));
    if (d->peak_every < 0) d->peak_every = looks_peak_every(method, nodes);
}
