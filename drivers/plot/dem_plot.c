/* SPDX-License-Identifier: BSD-3-Clause */
/* Pictures of runs. Exit codes: docs/cluster.md. */
#include <stdio.h>

#include <dem/reader.h>

#include "commit.h"
#include "page.h"
#include "request.h"
#include "show.h"
#include "sizes.h"
#include "streams.h"
#include "timeline.h"

static void draw(const request *asked, outcome *o)
{
    dem_reader *reader = NULL;
    const dem_status status = dem_reader_open(&reader, asked->input);
    if (status != DEM_OK)
        outcome_fail_status(o, status, "dem_plot");
    else if (asked->action == REQUEST_HISTORY)
        (void)timeline_draw(reader, asked, stdout, o);
    else if (asked->action == REQUEST_SIZES)
        (void)sizes_draw(reader, asked, stdout, o);
    else if (asked->action == REQUEST_PAGE)
        (void)page_draw(reader, asked, stdout, o);
    else if (asked->action == REQUEST_ANIMATION)
        (void)show_animation(reader, asked, stdout, o);
    else
        (void)show_strip(reader, asked, stdout, o);
    dem_reader_close(reader);
}

int main(int argc, char **argv)
{
    request asked;
    streams_begin();
    outcome o = {.code = request_parse(&asked, argc > 0 ? argv + 1 : argv)};
    if (o.code != EXIT_DONE) return (int)o.code;
    if (asked.action == REQUEST_HELP)
        request_help(stdout);
    else if (asked.action == REQUEST_VERSION)
        (void)printf("dem_plot of dem %s (%s)\n", dem_version(), DEM_COMMIT);
    else
        draw(&asked, &o);
    return streams_end("dem_plot", o.code);
}
