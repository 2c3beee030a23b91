/* SPDX-License-Identifier: BSD-3-Clause */
/* Read the deck, build, claim the output, run, report. */
#include "job.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "deck.h"
#include "estimate.h"
#include "lock.h"
#include "output.h"
#include "preview.h"
#include "relaxation.h"
#include "report.h"
#include "result.h"
#include "wall.h"

typedef struct job {
    const command *command;
    const char *file; /* of the deck */
    deck deck;
    limits most;
    dem_model *model;
    dem_simulation *simulation;
    char path[4096];  /* of the output */
    dem_peaks *peaks; /* NULL: not wanted */
    dem_trajectory *trajectory;
    report log;
    relaxation rest;
    lock lock;
    time_t start;
    double wall_start; /* s */
    bool told;         /* the result */
    outcome outcome;
} job;

/* Whether all is well; tells what is not. */
static bool passes(job *j, dem_status status, const char *where)
{
    if (status != DEM_OK) outcome_fail_status(&j->outcome, status, where);
    return status == DEM_OK;
}

/* ---- the run ---- */

static dem_status write_provenance(const job *j)
{
    const deck *d = &j->deck;
    char versions[256], problem[OUTPUT_HASH], hash[OUTPUT_HASH], start[32];
    const time_t now = time(NULL);
    struct tm utc;
    preview_versions(versions, sizeof versions);
    output_print_hash(problem, d->hash);
    output_print_hash(hash, d->run_hash);
    (void)strftime(start, sizeof start, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
    const char *const notes[][2] = {
        {"versions", versions}, {"kernel", dem_kernel_name(dem_simulation_options(j->simulation).kernel)},
        {"problem", problem},   {"run", hash},
        {"start", start},       {"deck", d->source},
        {"resolved", d->echo},  {"title", d->title},
        {"physics", d->physics}};
    dem_status status = DEM_OK;
    for (size_t k = 0; k < sizeof notes / sizeof notes[0] && status == DEM_OK; k++)
        status = dem_trajectory_note(j->trajectory, notes[k][0], notes[k][1]);
    return status;
}

static dem_status stop_at_overlap(void *context, const dem_simulation *simulation)
{
    (void)context;
    return dem_simulation_overlap(simulation).node >= 0 ? DEM_STOPPED : DEM_OK;
}

static dem_status create_files(job *j)
{
    const deck *d = &j->deck;
    dem_trajectory_options options = dem_trajectory_options_default();
    dem_status status = DEM_OK;
    if (d->peak_every > 0) status = dem_peaks_create(&j->peaks, j->model, d->peak_every);
    options.frame_interval = d->frame_interval;
    options.double_precision = d->double_precision;
    options.deflate = d->deflate;
    options.events = d->events;
    options.fields = d->fields;
    options.peaks = j->peaks;
    options.most_stressed = d->most_stressed;
    options.n_probes = d->n_probes;
    options.probes = d->probes;
    return status == DEM_OK ? dem_trajectory_create(&j->trajectory, j->path, j->simulation, &options) : status;
}

static dem_status observe(job *j)
{
    const struct {
        bool wanted;
        dem_observer observer;
    } all[] = {{j->peaks != NULL, dem_peaks_observer(j->peaks)},
               {true, dem_trajectory_observer(j->trajectory)},
               {true, report_observer(&j->log)},
               {j->deck.residual > 0.0, relaxation_observer(&j->rest)},
               {j->deck.stop_at_overlap != 0, {.step = stop_at_overlap}}};
    dem_status status = DEM_OK;
    for (size_t k = 0; k < sizeof all / sizeof *all && status == DEM_OK; k++)
        if (all[k].wanted) status = dem_simulation_observe(j->simulation, &all[k].observer);
    return status;
}

/* What a quasi-static run ends at is a frame of its own, and where it stops at an overlap. */
static dem_status advance(job *j)
{
    const dem_observer frames = dem_trajectory_observer(j->trajectory);
    dem_status status = write_provenance(j);
    if (status == DEM_OK) status = observe(j);
    if (status == DEM_OK) status = dem_simulation_advance(j->simulation, j->deck.t_end);
    return status == DEM_STOPPED ? frames.frame(frames.context, j->simulation) : status;
}

/* Whether a run has come to what the deck asks for. One that has not has no result: its output stays unfinished. */
static bool succeeds(job *j)
{
    const deck *d = &j->deck;
    const relaxation *rest = &j->rest;
    const dem_overlap o = dem_simulation_overlap(j->simulation);
    if (d->stop_at_overlap && o.node >= 0)
        outcome_fail(&j->outcome, EXIT_NUMERICS, d->path,
                     "node %lld is inside triangle %lld of a body at (%g, %g) m, t = %.6g s", (long long)o.node,
                     (long long)o.triangle, o.x[0], o.x[1], o.t);
    else if (d->residual > 0.0 && !rest->done)
        outcome_fail(&j->outcome, EXIT_NUMERICS, d->path,
                     "not at rest at t_end = %g s: the residual is %.3g, %.3g is asked for", d->t_end, rest->reached,
                     d->residual);
    else if (d->residual > 0.0)
        (void)printf("rest       residual %.3g at %.6g s\n", rest->reached, rest->t);
    return j->outcome.code == EXIT_DONE;
}

static void run(job *j)
{
    if (!passes(j, create_files(j), j->path)) return;
    preview_print(stdout, &j->deck, j->simulation, j->path);
    report_start(&j->log, stdout, isatty(STDOUT_FILENO) == 1, &j->deck);
    j->log.peaks = j->peaks;
    j->rest = relaxation_start(j->deck.residual, &j->deck.options);
    if (!passes(j, advance(j), j->deck.path)) return;
    report_summary(&j->log, j->simulation);
    if (succeeds(j)) (void)passes(j, dem_trajectory_finish(j->trajectory), j->deck.path);
}

/* ---- the result ---- */

static result describe(const job *j)
{
    return (result){.deck = j->file,
                    .command = j->command,
                    .read = j->deck.name != NULL ? &j->deck : NULL,
                    .output = j->path[0] != '\0' ? j->path : NULL,
                    .simulation = j->simulation,
                    .log = j->log.out != NULL ? &j->log : NULL,
                    .rest = &j->rest,
                    .outcome = &j->outcome,
                    .start = j->start,
                    .seconds = wall_clock() - j->wall_start};
}

/* Tells what came out, in NAME.json too if the output is ours. */
static void conclude(job *j)
{
    char path[OUTPUT_PATH];
    const result r = describe(j);
    const exit_code code = j->outcome.code;
    char *line = result_line(&r);
    if (line != NULL && j->lock.file >= 0) {
        output_beside(path, j->path, ".json");
        result_write(path, line, &j->outcome);
    }
    if (j->outcome.code != code) {
        free(line);
        line = result_line(&r);
    }
    if (line == NULL)
        outcome_fail(&j->outcome, EXIT_MEMORY, j->file, "out of memory");
    else
        (void)fputs(line, stdout);
    free(line);
}

/* Whether the same run's result is there; it is then told again. */
static bool is_done(const job *j, const char *reason)
{
    char path[OUTPUT_PATH], hash[OUTPUT_HASH];
    output_beside(path, j->path, ".json");
    output_print_hash(hash, j->deck.run_hash);
    char *line = result_read_done(path, hash);
    output_beside(path, j->path, ".lock");
    if (line != NULL) lock_clear(path);
    if (line != NULL) (void)printf("%s: done already, %s\n%s", j->path, reason, line);
    free(line);
    return line != NULL;
}

/* ---- before the run ---- */

static void tell_error(job *j, exit_code code, const namelist_error *e)
{
    char where[OUTPUT_PATH + 32];
    const int line = e->place.line;
    if (line > 0)
        (void)snprintf(where, sizeof where, "%s:%d:%d", j->file, line, e->place.column);
    else if (line == 0)
        (void)snprintf(where, sizeof where, "%s", j->file);
    else
        (void)snprintf(where, sizeof where, "--set %s", j->command->settings[-1 - line].text);
    outcome_fail(&j->outcome, code, where, "%s", e->text);
}

static void tell_errors(job *j, exit_code code, namelist_errors *errors)
{
    for (size_t k = 0; k < errors->n; k++) tell_error(j, code, &errors->list[k]);
    namelist_errors_free(errors);
}

/* Whether a run keeps its limits; tells which it does not. */
static bool keeps(job *j, const estimate *needed)
{
    namelist_errors errors = {0};
    const estimate_breach breach = estimate_check(needed, &j->most, &j->deck, &errors);
    tell_errors(j, breach == ESTIMATE_DISK ? EXIT_IO : EXIT_MEMORY, &errors);
    return breach == ESTIMATE_KEPT;
}

/* The same, as far as the deck alone tells. */
static bool fits(job *j)
{
    const command *c = j->command;
    estimate needed;
    if (!estimate_deck(&needed, &j->deck)) {
        outcome_fail(&j->outcome, EXIT_MEMORY, j->file, "out of memory");
        return false;
    }
    j->most = c->most;
    if (c->action == COMMAND_ECHO)
        j->most.disk = j->most.steps = (double)INFINITY;
    else if (!isfinite(j->most.disk) && !limit_see_disk(&j->most, c->outdir, j->deck.name))
        (void)fprintf(stderr, "%s: warning: the file system does not tell what is free\n", c->outdir);
    return keeps(j, &needed);
}

static bool ends(job *j)
{
    const estimate needed = estimate_run(&j->deck, j->simulation);
    return keeps(j, &needed);
}

/* The model has a copy of the deck's lattice, which is not needed any more. */
static dem_status build(job *j)
{
    deck *d = &j->deck;
    dem_options options = d->options;
    dem_status status = dem_model_create(&j->model, &d->lattice, d->obstacles, d->n_obstacles);
    dem_lattice_free(&d->lattice);
    if (status != DEM_OK) return status;
    if (d->residual > 0.0 && options.mass_damping == 0.0) options.mass_damping = relaxation_damping(j->model);
    return dem_simulation_create(&j->simulation, j->model, &options);
}

static bool take_lock(job *j)
{
    char path[OUTPUT_PATH], why[512];
    output_beside(path, j->path, ".lock");
    switch (lock_take(&j->lock, path, why, sizeof why)) {
    case LOCK_HELD:
        return true;
    case LOCK_TAKEN:
        outcome_fail(&j->outcome, EXIT_TAKEN, path, "%s", why);
        break;
    case LOCK_FAILED:
        outcome_fail(&j->outcome, EXIT_IO, path, "%s", why);
        break;
    }
    return false;
}

/* Moves what is in the way, if that is wanted. */
static bool make_way(job *j, const char *reason)
{
    char why[2 * OUTPUT_PATH];
    if (!j->command->overwrite) {
        outcome_fail(&j->outcome, EXIT_TAKEN, j->path, "%s", reason);
    } else if (!output_set_aside(j->path, why, sizeof why)) {
        outcome_fail(&j->outcome, EXIT_IO, j->path, "%s", why);
    } else {
        (void)printf("%s: set aside as %s\n", j->path, why);
        return true;
    }
    return false;
}

/* Nothing has been written so far. What can be told before anything is built is. */
static void claim_and_run(job *j)
{
    char reason[OUTPUT_PATH + 256];
    output_state found = output_claim(j->path, &j->deck, reason, sizeof reason);
    if (found == OUTPUT_DONE && is_done(j, reason)) {
        j->told = true;
        return;
    }
    if (found == OUTPUT_TAKEN && !j->command->overwrite) {
        outcome_fail(&j->outcome, EXIT_TAKEN, j->path, "%s", reason);
        return;
    }
    if (!passes(j, build(j), j->deck.path) || !ends(j) || !take_lock(j)) return;
    if (output_claim(j->path, &j->deck, reason, sizeof reason) != OUTPUT_TAKEN || make_way(j, reason)) run(j);
}

static void check(job *j)
{
    if (passes(j, build(j), j->deck.path) && ends(j)) preview_print(stdout, &j->deck, j->simulation, NULL);
}

static bool succeeded(job *j, deck_status status, namelist_errors *errors)
{
    if (status == DECK_MEMORY) outcome_fail(&j->outcome, EXIT_MEMORY, j->file, "out of memory");
    tell_errors(j, EXIT_INVALID, errors);
    return status == DECK_OK;
}

static bool read_deck(job *j)
{
    namelist_errors errors = {0};
    const command *c = j->command;
    if (!succeeded(j, deck_parse(&j->deck, j->file, c->settings, c->n_settings, &errors), &errors)) return false;
    return fits(j) && succeeded(j, deck_build(&j->deck, &errors), &errors);
}

static bool find_path(job *j)
{
    if (output_path(j->path, sizeof j->path, j->command->outdir, j->deck.name)) return true;
    j->path[0] = '\0';
    outcome_fail(&j->outcome, EXIT_INVALID, j->deck.path, "the path of the output is too long");
    return false;
}

static void dismiss(job *j)
{
    dem_trajectory_destroy(j->trajectory);
    dem_peaks_destroy(j->peaks);
    dem_simulation_destroy(j->simulation);
    dem_model_destroy(j->model);
    deck_free(&j->deck);
    lock_release(&j->lock);
}

exit_code job_do(const command *c, const char *path)
{
    job j = {.command = c, .file = path, .lock = {.file = -1}, .start = time(NULL), .wall_start = wall_clock()};
    const bool good = read_deck(&j);
    if (good && c->action == COMMAND_ECHO) (void)fputs(j.deck.echo, stdout);
    if (good && c->action == COMMAND_CHECK) check(&j);
    if (good && c->action == COMMAND_RUN && find_path(&j)) claim_and_run(&j);
    if (c->action == COMMAND_RUN && !j.told) conclude(&j);
    dismiss(&j);
    return j.outcome.code;
}
