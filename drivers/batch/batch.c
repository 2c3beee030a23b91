/* SPDX-License-Identifier: BSD-3-Clause */
#include "batch.h"

#include "job.h"
#include "launcher.h"
#include "preview.h"
#include "rank_group.h"
#include "schema.h"

/* One after the other, whatever becomes of each, until one is stopped; the largest code is the worst. */
static exit_code do_in_turn(const command *c, const cases *all)
{
    exit_code worst = EXIT_DONE;
    for (size_t k = 0; k < all->n; k++) {
        const exit_code code = worst == EXIT_STOPPED ? job_leave(c, all->paths[k]) : job_do(c, all->paths[k]);
        if (code > worst) worst = code;
        (void)fflush(c->host->out);
    }
    return worst;
}

static exit_code do_cases(const command *c, batch_pool pool)
{
    outcome found = {.err = c->host->err};
    cases all;
    exit_code worst = EXIT_DONE;
    if (!cases_find(&all, c, &found))
        worst = found.code;
    else
        worst = c->jobs > 1 && pool != NULL ? pool(c, &all) : do_in_turn(c, &all);
    cases_free(&all);
    return worst;
}

/* Without MPI several processes would each do all of it, and get in each other's way. */
static exit_code refuse_copies(const command *c, const launcher *l, const char *why)
{
    if (l->reports)
        (void)fprintf(c->host->err,
                      "dem_batch: error: %s says that %ld processes were started, which cannot be ranks (%s): start it "
                      "without mpirun or srun, or with --serial where each has an output of its own\n",
                      l->variable != NULL ? l->variable : "--mpi", l->processes, why);
    launcher_let_report(l);
    return EXIT_USAGE;
}

static bool has_writers(const command *c, long ranks)
{
    if (c->writers <= ranks) return true;
    (void)fprintf(c->host->err,
                  "dem_batch: error: %ld writers ('--writers') are more than the %ld rank%s that there %s\n",
                  c->writers, ranks, ranks == 1 ? "" : "s", ranks == 1 ? "is" : "are");
    return false;
}

/* Rank 0 does what is asked for, and the others help. */
static exit_code do_as_ranks(const command *c, const launcher *l, batch_pool pool)
{
    char why[RANK_GROUP_REASON];
    rank_group group;
    command own = *c;
    exit_code code = EXIT_DONE;
    if (pool == NULL) return refuse_copies(c, l, "MPI is not initialised in the process of another program");
    if (c->jobs > 1) return refuse_copies(c, l, "with --jobs a process does cases by itself");
    if (!launcher_knows_all(l) && !c->mpi)
        return refuse_copies(c, l, "their number is not known; --mpi tells that they are");
    if (!rank_group_begin(&group, c->host, why)) return refuse_copies(c, l, why);
    if (group.size < l->processes) {
        (void)snprintf(why, sizeof why, "this MPI knows of %d only: it is not that of the launcher", group.size);
        (void)rank_group_end(&group, EXIT_USAGE);
        return refuse_copies(c, l, why);
    }
    own.ranks = &group;
    if (group.rank == 0) code = has_writers(c, group.size) ? do_cases(&own, pool) : EXIT_USAGE;
    return (exit_code)rank_group_end(&group, (int)code);
}

static exit_code do_all(const command *c, batch_pool pool)
{
    const launcher l = launcher_find();
    const bool is_alone = c->serial || (l.processes == 1 && !c->mpi);
    if (!is_alone) return do_as_ranks(c, &l, pool);
    return has_writers(c, 1) ? do_cases(c, pool) : EXIT_USAGE;
}

exit_code batch_do(const command *c, batch_pool pool)
{
    FILE *out = c->host->out;
    char versions[256];
    switch (c->action) {
    case COMMAND_TEMPLATE:
        schema_template(out);
        break;
    case COMMAND_KEYS:
        schema_document(out);
        break;
    case COMMAND_HELP:
        command_help(out);
        break;
    case COMMAND_VERSION:
        preview_versions(versions, sizeof versions);
        (void)fprintf(out, "%s\n", versions);
        break;
    case COMMAND_RUN:
    case COMMAND_CHECK:
    case COMMAND_ECHO:
        return do_all(c, pool);
    }
    return EXIT_DONE;
}
