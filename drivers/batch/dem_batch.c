/* SPDX-License-Identifier: BSD-3-Clause */
/* The batch driver. Exit codes: docs/cluster.md. */
#include <dem/trajectory.h>

#include "case_pool.h"
#include "job.h"
#include "launcher.h"
#include "preview.h"
#include "schema.h"
#include "signals.h"
#include "streams.h"

/* One after the other, whatever becomes of each, until one is stopped; the largest code is the worst. */
static exit_code do_in_turn(const command *c, const cases *all)
{
    exit_code worst = EXIT_DONE;
    for (size_t k = 0; k < all->n; k++) {
        const exit_code code = worst == EXIT_STOPPED ? job_leave(c, all->paths[k]) : job_do(c, all->paths[k], NULL);
        if (code > worst) worst = code;
        (void)fflush(stdout);
    }
    return worst;
}

/* Several processes would each do all of it, and get in each other's way. */
static bool is_alone(const command *c)
{
    const launcher l = launcher_find();
    if (c->action != COMMAND_RUN || c->serial || l.processes == 1) return true;
    if (l.reports)
        (void)fprintf(
            stderr,
            "dem_batch: error: %s says that %ld processes were started, and a run is one process so far: start "
            "it without mpirun or srun, or with --serial where each has an output of its own\n",
            l.variable, l.processes);
    launcher_let_report(&l);
    return false;
}

static exit_code do_all(const command *c)
{
    outcome found = {0};
    cases all;
    exit_code worst = EXIT_DONE;
    if (!is_alone(c)) return EXIT_USAGE;
    if (!cases_find(&all, c, &found))
        worst = found.code;
    else
        worst = c->jobs > 1 ? case_pool_do(c, &all) : do_in_turn(c, &all);
    cases_free(&all);
    return worst;
}

static exit_code act(const command *c)
{
    char versions[256];
    switch (c->action) {
    case COMMAND_TEMPLATE:
        schema_template(stdout);
        break;
    case COMMAND_KEYS:
        schema_document(stdout);
        break;
    case COMMAND_HELP:
        command_help(stdout);
        break;
    case COMMAND_VERSION:
        preview_versions(versions, sizeof versions);
        (void)puts(versions);
        break;
    case COMMAND_RUN:
    case COMMAND_CHECK:
    case COMMAND_ECHO:
        return do_all(c);
    }
    return EXIT_DONE;
}

int main(int argc, char **argv)
{
    command c;
    streams_begin();
    signals_catch();
    dem_hdf5_skip_exit();
    exit_code code = command_parse(&c, argc, argv);
    if (c.action == COMMAND_RUN) signals_catch_end();
    if (code == EXIT_DONE) code = act(&c);
    command_free(&c);
    return streams_end("dem_batch", code);
}
