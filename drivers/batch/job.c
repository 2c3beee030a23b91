/* SPDX-License-Identifier: BSD-3-Clause */
/* Read the deck, build, claim the output, run, report. */
#include "job.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "ask.h"
#include "base/numbered_file.h"
#include "checkpoint_file.h"
#include "decimal.h"
#include "deck.h"
#include "estimate.h"
#include "lock.h"
#include "looks.h"
#include "output.h"
#include "preview.h"
#include "rank_group.h"
#include "refusal.h"
#include "relaxation.h"
#include "report.h"
#include "result.h"
#include "slab_plan.h"
#include "step_report.h"
#include "wall_clock.h"

typedef struct job {
    const command *command;
    const char *file; /* of the deck */
    deck deck;
    limits most;
    dem_model *model;
    dem_simulation *simulation;
    char path[OUTPUT_PATH]; /* of the output */
    dem_peaks *peaks;       /* NULL: not wanted */
    dem_trajectory *trajectory;
    run_log log;
    report report;
    relaxation rest;
    dem_options options;
    checkpoint_source source; /* from which the run goes on */
    checkpoint_file checkpoint;
    lock lock;
    time_t start;
    double wall_start; /* s */
    bool claimed;      /* the output is ours */
    bool reported;     /* the result */
    outcome outcome;
} job;

/* Whether all is well; reports what is not. */
static bool passes(job *j, dem_status status, const char *where)
{
    if (status != DEM_OK) outcome_fail_status(&j->outcome, status, where);
    return status == DEM_OK;
}

/* ---- the run ---- */

static dem_status write_provenance(const job *j)
{
    const deck *d = &j->deck;
    char versions[256], problem[OUTPUT_HASH], hash[OUTPUT_HASH], start[32], t_end[DECIMAL_SIZE];
    char history_interval[DECIMAL_SIZE], peak_every[DECIMAL_SIZE];
    struct tm utc;
    preview_versions(versions, sizeof versions);
    output_print_hash(problem, d->hash);
    output_print_hash(hash, d->run_hash);
    decimal_print(t_end, d->t_end);
    decimal_print(history_interval, d->history_interval);
    decimal_print(peak_every, (double)d->peak_every);
    (void)strftime(start, sizeof start, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&j->start, &utc));
    const char *const provenance[][2] = {{"versions", j->source.lineage != NULL ? j->source.lineage : versions},
                                         {"kernel", dem_kernel_name(ask_options(j->simulation).kernel)},
                                         {"problem", problem},
                                         {"run", hash},
                                         {"t_end", t_end},
                                         {"history_interval", history_interval},
                                         {"peak_every", peak_every},
                                         {"start", start},
                                         {"deck", d->source},
                                         {"resolved", d->echo},
                                         {"title", d->title},
                                         {"physics", d->physics}};
    dem_status status = DEM_OK;
    for (size_t k = 0; k < sizeof provenance / sizeof provenance[0] && status == DEM_OK; k++)
        status = dem_trajectory_note(j->trajectory, provenance[k][0], provenance[k][1]);
    return status;
}

static dem_status stop_at_overlap(void *context, const dem_simulation *simulation)
{
    (void)context;
    return ask_overlap(simulation).node >= 0 ? DEM_STOPPED : DEM_OK;
}

static dem_trajectory_options frames_of(const job *j)
{
    const deck *d = &j->deck;
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = d->frame_interval;
    options.history_interval = d->history_interval;
    options.stays_open = true;
    options.writers = (int)j->command->writers;
    options.double_precision = d->double_precision;
    options.deflate = d->deflate;
    options.events = d->events;
    options.breaks = d->breaks;
    options.fragments = d->fragments;
    options.fields = d->fields;
    options.peaks = j->peaks;
    options.most_stressed = d->most_stressed;
    options.n_probes = d->n_probes;
    options.probes = d->probes;
    return options;
}

static dem_status begin(job *j)
{
    dem_status status = DEM_OK;
    if (j->deck.peak_every > 0) status = dem_peaks_create(&j->peaks, j->model, j->deck.peak_every);
    const dem_trajectory_options options = frames_of(j);
    return status == DEM_OK ? dem_trajectory_create(&j->trajectory, j->path, j->simulation, &options) : status;
}

/* Where there are ranks they make the run of a simulation. */
static dem_status share(const job *j, const dem_checkpoint *checkpoint)
{
    const rank_group *ranks = j->command->ranks;
    return ranks != NULL ? rank_group_lead(ranks, j->simulation, &j->options, checkpoint) : DEM_OK;
}

static dem_status simulate(job *j)
{
    dem_status status = dem_simulation_create(&j->simulation, j->model, &j->options);
    if (status == DEM_OK) status = share(j, NULL);
    if (status == DEM_OK) looks_settle(&j->deck, j->simulation);
    return status;
}

/* The counterpart of begin() and simulate(). */
static dem_status resume(job *j)
{
    const dem_checkpoint *checkpoint = j->source.checkpoint;
    dem_simulation_destroy(j->simulation);
    j->simulation = NULL;
    dem_status status = dem_simulation_resume(&j->simulation, j->model, &j->options, checkpoint);
    if (status == DEM_OK) status = share(j, checkpoint);
    if (status == DEM_OK && j->deck.peak_every > 0)
        status = dem_peaks_resume(&j->peaks, j->model, j->deck.peak_every, checkpoint);
    const dem_trajectory_options options = frames_of(j);
    if (status == DEM_OK) status = dem_trajectory_resume(&j->trajectory, j->path, j->simulation, &options, checkpoint);
    if (status == DEM_OK) status = report_resume(&j->report, checkpoint, j->simulation);
    return status == DEM_OK && j->deck.residual > 0.0 ? relaxation_resume(&j->rest, checkpoint) : status;
}

/* Steps from one look at a run to the next where nothing touches: as many as Verlet's method takes at once, where rows
 * of the history are rarer than steps; 0: all are looked at. What may break is loaded until it does. */
static dem_index between_looks(const job *j)
{
    const bool all = !(j->deck.history_interval > 0.0) || j->deck.facts.may_break;
    return !all && ask_options(j->simulation).method == DEM_METHOD_VERLET ? 16 : 0;
}

static dem_status observe(job *j)
{
    const dem_index every = between_looks(j);
    const struct {
        bool wanted;
        dem_observer observer;
    } all[] = {{true, ask_trajectory_observer(j->trajectory)}, /* measures what peaks ask for, too */
               {j->peaks != NULL, ask_peaks_observer(j->peaks)},
               {true, report_observer(&j->report, every)},
               {j->deck.residual > 0.0, relaxation_observer(&j->rest)},
               {j->deck.stop_at_overlap != 0,
                {.struct_size = sizeof(dem_observer), .step = stop_at_overlap, .step_every = every}},
               {true, checkpoint_file_observer(&j->checkpoint, every)}};
    dem_status status = DEM_OK;
    for (size_t k = 0; k < sizeof all / sizeof *all && status == DEM_OK; k++)
        if (all[k].wanted) status = dem_simulation_observe(j->simulation, &all[k].observer);
    return status;
}

/* A fixed step that is too long is the likely cause, whether the motion overflows or passes through an obstacle. Or a
 * body was turned inside out: its surface then has its front inside, and neither bodies nor obstacles push it. */
static void report_failure(job *j, dem_status status)
{
    char why[STEP_REPORT_WHY];
    const bool surfaces = j->options.bodies != DEM_BODIES_NONE || status == DEM_ERROR_CONTACT;
    const dem_index inverted = surfaces ? ask_strain(j->simulation).inverted : 0;
    if (step_report_is_long(j->simulation, why))
        outcome_fail(&j->outcome, EXIT_NUMERICS, j->deck.path, "%s; %s", dem_status_message(), why);
    else if (inverted > 0)
        outcome_fail(&j->outcome, EXIT_NUMERICS, j->deck.path,
                     "%s; %lld triangles are turned inside out, whose surfaces cannot push: 'guard' in &material "
                     "prevents that",
                     dem_status_message(), (long long)inverted);
    else
        (void)passes(j, status, j->deck.path);
}

/* What a quasi-static run ends at is a frame of its own, and where it stops at an overlap or fails. */
static dem_status advance(job *j)
{
    const dem_observer frames = ask_trajectory_observer(j->trajectory);
    dem_status status = write_provenance(j);
    if (status == DEM_OK) status = observe(j);
    if (status != DEM_OK) return status;
    status = dem_simulation_advance(j->simulation, j->deck.t_end);
    const bool failed = status == DEM_ERROR_INTEGRATOR || status == DEM_ERROR_CONTACT;
    if (failed) report_failure(j, status);
    if (j->checkpoint.ended != NULL || (status != DEM_STOPPED && !failed)) return status;
    return frames.frame(frames.context, j->simulation);
}

/* Whether a run has come to what the deck asks for. One that has not has no result: its output stays unfinished. */
static void check_success(job *j)
{
    const deck *d = &j->deck;
    const relaxation *rest = &j->rest;
    const dem_overlap o = ask_overlap(j->simulation);
    if (d->stop_at_overlap && o.node >= 0)
        outcome_fail(&j->outcome, EXIT_NUMERICS, d->path,
                     "node %lld is inside triangle %lld of a body at (%g, %g) m, t = %.6g s", (long long)o.node,
                     (long long)o.triangle, o.x[0], o.x[1], o.t);
    else if (d->residual > 0.0 && !rest->done)
        outcome_fail(&j->outcome, EXIT_NUMERICS, d->path,
                     "not at rest at t_end = %g s: the residual is %.3g, %.3g is asked for", d->t_end, rest->reached,
                     d->residual);
    else if (d->residual > 0.0)
        (void)fprintf(j->log.out, "rest       residual %.3g at %.6g s\n", rest->reached, rest->t);
    if (d->options.pause > 0.0)
        (void)fprintf(j->log.out, "pause      ramps are at %.6g s, they stood still after breaks\n",
                      dem_simulation_ramp_time(j->simulation));
}

/* What has no result is kept as it is, for a look and for a later end. */
static void finish(job *j)
{
    const bool good = j->outcome.code == EXIT_DONE;
    dem_status status =
        good ? dem_trajectory_finish(j->trajectory) : checkpoint_file_save(&j->checkpoint, j->simulation);
    if (good && status == DEM_OK) status = checkpoint_file_close(&j->checkpoint, j->simulation);
    (void)passes(j, status, j->deck.path);
}

static void stop(job *j)
{
    const checkpoint_file *c = &j->checkpoint;
    const double t = ask_progress(j->simulation).t;
    run_log_tell(&j->log, "stopped    at %.6g s by %s; the same command goes on from %s\n", t, c->ended,
                 c->t_written >= 0.0 ? c->path : "the beginning");
    outcome_set(&j->outcome, EXIT_STOPPED, "%s: stopped by %s", j->deck.path, c->ended);
}

static void print_preview(job *j, const char *output)
{
    const rank_group *ranks = j->command->ranks;
    preview_print(&j->log, &j->deck, j->simulation, output);
    if (ranks != NULL) rank_group_print(ranks, j->simulation, j->deck.slabs.are_made, j->log.out);
    (void)fflush(j->log.out);
}

static void run(job *j)
{
    j->checkpoint.trajectory = j->trajectory;
    j->checkpoint.log = &j->log;
    j->report.peaks = j->peaks;
    print_preview(j, j->path);
    if (j->source.checkpoint != NULL) {
        report_warn_again(&j->report, j->simulation);
        run_log_tell(&j->log, "resumed    from %.6g s, %s\n", j->source.t, j->checkpoint.path);
    }
    dem_checkpoint_destroy(j->source.checkpoint);
    j->source.checkpoint = NULL;
    const dem_status status = advance(j);
    if (j->checkpoint.ended != NULL && status == DEM_STOPPED) {
        stop(j);
        return;
    }
    if (!passes(j, status, j->deck.path)) return;
    if (j->outcome.code == EXIT_DONE) report_summary(&j->report, j->simulation);
    if (j->outcome.code == EXIT_DONE) check_success(j);
    finish(j);
}

/* ---- the result ---- */

static result describe(const job *j)
{
    return (result){.deck = j->file,
                    .command = j->command,
                    .read = j->deck.name != NULL ? &j->deck : NULL,
                    .output = j->path[0] != '\0' ? j->path : NULL,
                    .simulation = j->simulation,
                    .report = j->trajectory != NULL ? &j->report : NULL,
                    .rest = &j->rest,
                    .outcome = &j->outcome,
                    .start = j->start,
                    .seconds = wall_clock() - j->wall_start};
}

static void list_stripes(const job *j)
{
    const int n = (int)j->command->writers;
    char end[NUMBERED_FILE], first[OUTPUT_PATH], last[OUTPUT_PATH];
    numbered_file_print(end, (numbered_file){.stripe = 1, .n = n});
    output_beside(first, j->path, end);
    numbered_file_print(end, (numbered_file){.stripe = n, .n = n});
    output_beside(last, j->path, end);
    if (n > 1 && access(first, F_OK) == 0) (void)fprintf(j->log.out, ", %s to %s", first, last);
}

/* What a run that is done has left. */
static void list_files(job *j)
{
    static const char *const ends[] = {".vtkhdf", ".body.vtkhdf", ".obstacle.vtkhdf", ".json", ".checkpoint"};
    char path[OUTPUT_PATH];
    const char *before = "files     ";
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
        output_beside(path, j->path, ends[k]);
        if (access(path, F_OK) != 0) continue;
        (void)fprintf(j->log.out, "%s %s", before, path);
        before = ",";
    }
    list_stripes(j);
    (void)fprintf(j->log.out, "; wall time %.2f s\n", wall_clock() - j->wall_start);
}

/* Reports what came out, in NAME.json too if the output is ours. */
static void conclude(job *j)
{
    char path[OUTPUT_PATH];
    const result r = describe(j);
    const exit_code code = j->outcome.code;
    char *line = result_line(&r);
    if (line != NULL && j->claimed) {
        output_beside(path, j->path, ".json");
        result_write(path, line, &j->outcome);
    }
    if (j->outcome.code != code) {
        free(line);
        line = result_line(&r);
    }
    if (j->claimed && j->outcome.code == EXIT_DONE) list_files(j);
    if (line == NULL)
        outcome_fail(&j->outcome, EXIT_MEMORY, j->file, "out of memory");
    else if (j->command->json)
        (void)fputs(line, j->log.out);
    free(line);
}

/* Whether the same run's result is there; it is then reported again. */
static bool is_done(job *j, const char *reason)
{
    char path[OUTPUT_PATH], hash[OUTPUT_HASH];
    output_beside(path, j->path, ".json");
    output_print_hash(hash, j->deck.run_hash);
    char *line = result_read_done(path, hash);
    output_beside(path, j->path, ".lock");
    if (line != NULL && j->lock.file < 0) lock_clear(path);
    if (line != NULL)
        (void)fprintf(j->log.out, "%s: done already, %s\n%s", j->path, reason, j->command->json ? line : "");
    j->reported = line != NULL;
    free(line);
    return j->reported;
}

/* ---- before the run ---- */

static void report_error(job *j, exit_code code, const namelist_error *e)
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

static void report_errors(job *j, exit_code code, namelist_errors *errors)
{
    for (size_t k = 0; k < errors->n; k++) report_error(j, code, &errors->list[k]);
    namelist_errors_free(errors);
}

/* Whether a run keeps its limits; reports which it does not. */
static bool keeps(job *j, const estimate *needed)
{
    namelist_errors errors = {0};
    const estimate_breach breach = estimate_check(needed, &j->most, &j->deck, &errors);
    report_errors(j, breach == ESTIMATE_DISK ? EXIT_IO : EXIT_MEMORY, &errors);
    return breach == ESTIMATE_KEPT;
}

/* The same, as far as the deck alone shows. */
static bool fits(job *j)
{
    const command *c = j->command;
    estimate needed;
    if (!estimate_deck(&needed, &j->deck)) {
        outcome_fail(&j->outcome, EXIT_MEMORY, j->file, "out of memory");
        return false;
    }
    slab_plan_decide(&j->deck, c, needed.nodes);
    slab_plan_share_memory(&needed, &j->deck);
    j->most = c->most;
    if (c->action == COMMAND_ECHO)
        j->most.disk = j->most.steps = (double)INFINITY;
    else if (!isfinite(j->most.disk) && !limit_see_disk(&j->most, c->outdir, j->deck.name))
        (void)fprintf(c->host->err, "%s: warning: the file system does not say what is free\n", c->outdir);
    return keeps(j, &needed);
}

static bool ends(job *j)
{
    estimate needed = estimate_run(&j->deck, j->simulation, estimate_duration(&j->deck));
    slab_plan_share_memory(&needed, &j->deck);
    return keeps(j, &needed);
}

/* The model looks at the deck's lattice as long as there is one, but has velocities of its own. */
static dem_status model_whole(job *j)
{
    deck *d = &j->deck;
    const dem_status status = dem_model_create_borrowing(&j->model, &d->lattice, d->obstacles, d->n_obstacles);
    free(d->lattice.velocity);
    d->lattice.velocity = NULL;
    return status;
}

static dem_status build(job *j)
{
    const deck *d = &j->deck;
    const dem_status status = d->slabs.are_made ? slab_plan_model(&j->model, d, j->command->ranks) : model_whole(j);
    if (status != DEM_OK) return status;
    j->options = d->options;
    if (d->residual > 0.0 && j->options.mass_damping == 0.0)
        j->options.mass_damping = relaxation_damping(j->model, &d->facts);
    return simulate(j);
}

static bool builds(job *j)
{
    namelist_errors errors = {0};
    const dem_status status = build(j);
    /* What fails then is to share it out; but what ranks have in slabs is only seen there. */
    const bool is_created = j->simulation != NULL && !j->deck.slabs.are_made;
    if (status != DEM_ERROR_MODEL || j->model == NULL || is_created) return passes(j, status, j->deck.path);
    refusal_explain(&errors, &j->deck, j->model, &j->options);
    report_errors(j, EXIT_INVALID, &errors);
    return false;
}

/* Only now: what is refused leaves no folder behind. */
static bool make_folder(job *j)
{
    char path[OUTPUT_PATH], why[OUTPUT_REASON];
    const bool good = output_make_folder(j->command->outdir, path, why);
    if (!good) outcome_fail(&j->outcome, EXIT_IO, path, "%s", why);
    return good;
}

static bool check_folder(job *j)
{
    char path[OUTPUT_PATH], why[OUTPUT_REASON];
    const bool good = output_check_folder(j->command->outdir, path, why);
    if (!good) outcome_fail(&j->outcome, EXIT_IO, path, "%s", why);
    return good;
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
static bool make_way(job *j, exit_code code, const char *where, const char *reason)
{
    char why[OUTPUT_REASON];
    if (!j->command->overwrite) {
        outcome_fail(&j->outcome, code, where, "%s", reason);
    } else if (!output_set_aside(j->path, why)) {
        outcome_fail(&j->outcome, EXIT_IO, j->path, "%s", why);
    } else {
        (void)fprintf(j->log.out, "%s: set aside as %s\n", j->path, why);
        checkpoint_file_source_free(&j->source);
        return true;
    }
    return false;
}

/* Whether the way is free for this run, to begin or to go on. */
static bool claim(job *j)
{
    char reason[OUTPUT_REASON], saved[OUTPUT_REASON], file[OUTPUT_PATH];
    const output_state found = output_claim(j->path, &j->deck, reason);
    if (found == OUTPUT_DONE && is_done(j, reason)) return false;
    if (found == OUTPUT_TAKEN) return make_way(j, EXIT_TAKEN, j->path, reason);
    output_beside(file, j->path, ".checkpoint");
    switch (checkpoint_file_find(&j->source, j->path, &j->deck, j->command->resume_anyway, saved)) {
    case CHECKPOINT_FOUND:
        return true;
    case CHECKPOINT_NONE:
        return found != OUTPUT_SHORTER || make_way(j, EXIT_TAKEN, j->path, reason);
    case CHECKPOINT_OTHER:
        return make_way(j, EXIT_TAKEN, file, saved);
    case CHECKPOINT_DAMAGED:
        return make_way(j, EXIT_IO, file, saved);
    case CHECKPOINT_MEMORY:
        break;
    }
    outcome_fail(&j->outcome, EXIT_MEMORY, file, "out of memory");
    return false;
}

static void start_log(job *j)
{
    const deck *d = &j->deck;
    report_start(&j->report, &j->log, d);
    j->rest = relaxation_start(d->residual, &d->options);
    if (d->residual > 0.0)
        report_expect_rest(&j->report, &j->rest,
                           relaxation_expected(j->simulation, &d->facts, &d->options, d->residual));
    j->checkpoint = checkpoint_file_start(j->command, j->path, d, &j->source);
}

static bool begin_anew(job *j)
{
    dem_peaks_destroy(j->peaks);
    dem_simulation_destroy(j->simulation);
    j->peaks = NULL;
    j->simulation = NULL;
    if (!passes(j, simulate(j), j->path)) return false;
    report_end(&j->report); /* of a resumption that has failed */
    start_log(j);
    return passes(j, begin(j), j->path);
}

/* What was left behind may turn out to be of no use. */
static bool begin_or_resume(job *j)
{
    char reason[OUTPUT_REASON];
    start_log(j);
    if (j->source.checkpoint == NULL) return passes(j, begin(j), j->path);
    const dem_status status = resume(j);
    if (status != DEM_ERROR_IO) return passes(j, status, j->path);
    (void)snprintf(reason, sizeof reason, "%s; --overwrite sets the output aside and begins anew",
                   dem_status_message());
    return make_way(j, EXIT_IO, j->path, reason) && begin_anew(j);
}

/* Nothing has been written so far. What can be reported before anything is built is. */
static void claim_and_run(job *j)
{
    char reason[OUTPUT_REASON];
    const output_state found = output_claim(j->path, &j->deck, reason);
    if (found == OUTPUT_DONE && is_done(j, reason)) return;
    if (found == OUTPUT_TAKEN && !j->command->overwrite) {
        outcome_fail(&j->outcome, EXIT_TAKEN, j->path, "%s", reason);
        return;
    }
    if (!builds(j) || !ends(j) || !make_folder(j) || !check_folder(j) || !take_lock(j)) return;
    j->claimed = claim(j);
    if (j->claimed && begin_or_resume(j)) run(j);
}

static void check(job *j)
{
    if (builds(j) && ends(j) && check_folder(j)) print_preview(j, NULL);
}

static bool succeeded(job *j, deck_status status, namelist_errors *errors)
{
    if (status == DECK_MEMORY) outcome_fail(&j->outcome, EXIT_MEMORY, j->file, "out of memory");
    report_errors(j, EXIT_INVALID, errors);
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
    report_end(&j->report);
    dem_trajectory_destroy(j->trajectory);
    dem_peaks_destroy(j->peaks);
    dem_simulation_destroy(j->simulation);
    dem_model_destroy(j->model);
    checkpoint_file_source_free(&j->source);
    deck_free(&j->deck);
    lock_release(&j->lock);
}

static job new_job(const command *c, const char *path)
{
    const host *h = c->host;
    return (job){.command = c,
                 .file = path,
                 .log = {.out = h->out,
                         .part = h->part,
                         .requests = h->requests,
                         .terminal = h->terminal,
                         .verbose = c->verbose},
                 .outcome = {.err = h->err},
                 .lock = {.file = -1},
                 .start = time(NULL),
                 .wall_start = wall_clock()};
}

exit_code job_do(const command *c, const char *path)
{
    job j = new_job(c, path);
    const bool good = read_deck(&j);
    if (good && c->action == COMMAND_ECHO) (void)fputs(j.deck.echo, j.log.out);
    if (good && c->action == COMMAND_CHECK) check(&j);
    if (good && c->action == COMMAND_RUN && find_path(&j)) claim_and_run(&j);
    if (c->action == COMMAND_RUN && !j.reported) conclude(&j);
    dismiss(&j);
    return j.outcome.code;
}

exit_code job_leave(const command *c, const char *path)
{
    job j = new_job(c, path);
    outcome_set(&j.outcome, EXIT_STOPPED, "%s: not begun", path);
    if (c->action == COMMAND_RUN) conclude(&j);
    return j.outcome.code;
}
