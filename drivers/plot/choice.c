/* SPDX-License-Identifier: BSD-3-Clause */
#include "choice.h"

bool choice_find(frame_list *out, const dem_reader *reader, const request *asked, outcome *o)
{
    dem_index n;
    const char *fault = NULL;
    const double *t = dem_reader_times(reader, &n);
    if (n == 0) return outcome_fail(o, EXIT_INVALID, "dem_plot", "%s: has no frames", asked->input), false;
    if (asked->frames != NULL && !frame_list_parse(out, asked->frames, n, &fault))
        return outcome_fail(o, EXIT_INVALID, "dem_plot", "%s: '--frames %s' %s: there are 0 to %lld", asked->input,
                            asked->frames, fault, (long long)n - 1),
               false;
    if (asked->times != NULL && !frame_list_parse_times(out, asked->times, n, t, &fault))
        return outcome_fail(o, EXIT_INVALID, "dem_plot", "'--times %s' %s", asked->times, fault), false;
    return true;
}
