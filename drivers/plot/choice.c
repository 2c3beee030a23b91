/* SPDX-License-Identifier: BSD-3-Clause */
#include "choice.h"

#include "canvas.h"

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

colour_range choice_range(const request *asked, palette_kind scale, colour_range_extent reach)
{
    if (scale == PALETTE_PIECES) return (colour_range){.hi = PALETTE_SIZE - 1};
    const bool both_sides = scale == PALETTE_DIVERGING;
    if (!asked->has_range) return colour_range_around(reach, both_sides);
    const double lo = isinf(asked->lo) ? (both_sides ? -asked->hi : 0.0) : asked->lo;
    return colour_range_given(lo, asked->hi, reach);
}

palette choice_palette(const quantity *shown, colour_range range)
{
    if (shown->source == NULL) return palette_plain(canvas_grey);
    return palette_make(palette_between(shown->scale, range.lo, range.hi));
}
