/* SPDX-License-Identifier: BSD-3-Clause */
/* The batch driver as a program. Exit codes: docs/cluster.md. */
#include <unistd.h>

#include <dem/trajectory.h>

#include "batch.h"
#include "case_pool.h"
#include "launcher.h"
#include "signals.h"
#include "streams.h"

int main(int argc, char **argv)
{
    command c;
    streams_begin();
    signals_catch();
    dem_hdf5_skip_exit();
    const launcher l = launcher_find();
    const host h = {.out = stdout,
                    .err = stderr,
                    .terminal = isatty(STDOUT_FILENO) == 1 && !launcher_makes_terminal(&l),
                    .requests = signals_requests()};
    exit_code code = command_parse(&c, &h, argc, argv);
    if (c.action == COMMAND_RUN) signals_catch_end();
    if (code == EXIT_DONE) code = batch_do(&c, case_pool_do);
    command_free(&c);
    return streams_end("dem_batch", code);
}
