/* SPDX-License-Identifier: BSD-3-Clause */
/* The batch driver: read the deck, build, run, report. Exit codes: README.md. */
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "deck.h"
#include "output.h"
#include "preview.h"
#include "relaxation.h"
#include "report.h"
#include "schema.h"

static const double most_steps = 1e10;

enum exit_code {
    EXIT_DONE = 0,
    EXIT_USAGE = 2,
    EXIT_INVALID = 3,
    EXIT_NUMERICS = 4,
    EXIT_IO = 5,
    EXIT_MEMORY = 6,
    EXIT_TAKEN = 7
};

typedef enum action {
    ACTION_RUN,
    ACTION_CHECK,
    ACTION_ECHO,
    ACTION_TEMPLATE,
    ACTION_KEYS,
    ACTION_VERSION,
    ACTION_HELP
} action;

typedef struct command {
    action action;
    const char *deck, *outdir;
} command;

static const char usage[] =
    "usage: dem_batch [--outdir FOLDER] DECK   run the deck; NAME.vtkhdf is written to FOLDER (default: here)\n"
    "       dem_batch --check DECK             read it, build it, print sizes and estimates, write nothing\n"
    "       dem_batch --echo DECK              print it with every key resolved; the echo is a deck of the same run\n"
    "       dem_batch --template               print a deck with every key, its default and its meaning\n"
    "       dem_batch --keys                   print the description of every key, in Markdown\n"
    "       dem_batch --version | --help\n"
    "exit codes: 0 done, 2 usage, 3 deck invalid, 4 numerics failed, 5 input or output, 6 out of memory,\n"
    "            7 the output exists and belongs to another problem\n";

static int complain(int code, const char *where)
{
    (void)fprintf(stderr, "%s: error: %s\n", where, dem_status_message());
    return code;
}

/* Exit code for a failure of the library. */
static int code_of(dem_status status)
{
    switch (status) {
    case DEM_OK:
    case DEM_STOPPED:
        return EXIT_DONE;
    case DEM_ERROR_MEMORY:
        return EXIT_MEMORY;
    case DEM_ERROR_IO:
        return EXIT_IO;
    case DEM_ERROR_INTEGRATOR:
    case DEM_ERROR_CONTACT:
        return EXIT_NUMERICS;
    case DEM_ERROR_ARGUMENT:
    case DEM_ERROR_MODEL:
        return EXIT_INVALID;
    }
    return EXIT_NUMERICS;
}

/* ---- the run ---- */

static dem_status write_provenance(dem_trajectory *trajectory, const deck *d, dem_kernel kernel)
{
    char versions[256], problem[OUTPUT_HASH], hash[OUTPUT_HASH], start[32];
    const time_t now = time(NULL);
    struct tm utc;
    preview_versions(versions, sizeof versions);
    output_print_hash(problem, d->hash);
    output_print_hash(hash, d->run_hash);
    (void)strftime(start, sizeof start, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
    const char *const notes[][2] = {{"versions", versions}, {"kernel", dem_kernel_name(kernel)},
                                    {"problem", problem},   {"run", hash},
                                    {"start", start},       {"deck", d->source},
                                    {"resolved", d->echo},  {"title", d->title},
                                    {"physics", d->physics}};
    dem_status status = DEM_OK;
    for (size_t k = 0; k < sizeof notes / sizeof notes[0] && status == DEM_OK; k++)
        status = dem_trajectory_note(trajectory, notes[k][0], notes[k][1]);
    return status;
}

static dem_status stop_at_overlap(void *context, const dem_simulation *simulation)
{
    (void)context;
    return dem_simulation_overlap(simulation).node >= 0 ? DEM_STOPPED : DEM_OK;
}

/* Who watches a run. */
typedef struct audience {
    dem_peaks *peaks; /* NULL: not wanted */
    dem_trajectory *trajectory;
    report log;
    relaxation rest;
} audience;

static dem_status gather(audience *a, const deck *d, const dem_simulation *simulation, const char *path)
{
    dem_trajectory_options options = dem_trajectory_options_default();
    dem_status status = DEM_OK;
    if (d->peak_every > 0) status = dem_peaks_create(&a->peaks, dem_simulation_model(simulation), d->peak_every);
    options.frame_interval = d->frame_interval;
    options.double_precision = d->double_precision;
    options.deflate = d->deflate;
    options.events = d->events;
    options.fields = d->fields;
    options.peaks = a->peaks;
    options.most_stressed = d->most_stressed;
    options.n_probes = d->n_probes;
    options.probes = d->probes;
    return status == DEM_OK ? dem_trajectory_create(&a->trajectory, path, simulation, &options) : status;
}

static void dismiss(audience *a)
{
    dem_trajectory_destroy(a->trajectory);
    dem_peaks_destroy(a->peaks);
}

/* What a quasi-static run ends at is a frame of its own, and where it stops at an overlap. */
static dem_status advance(const deck *d, dem_simulation *simulation, audience *a)
{
    const dem_observer frames = dem_trajectory_observer(a->trajectory), followed = report_observer(&a->log);
    const dem_observer peaks = dem_peaks_observer(a->peaks), resting = relaxation_observer(&a->rest);
    const dem_observer overlapping = {.step = stop_at_overlap};
    dem_status status = write_provenance(a->trajectory, d, dem_simulation_options(simulation).kernel);
    if (status == DEM_OK && a->peaks != NULL) status = dem_simulation_observe(simulation, &peaks);
    if (status == DEM_OK) status = dem_simulation_observe(simulation, &frames);
    if (status == DEM_OK) status = dem_simulation_observe(simulation, &followed);
    if (status == DEM_OK && d->residual > 0.0) status = dem_simulation_observe(simulation, &resting);
    if (status == DEM_OK && d->stop_at_overlap) status = dem_simulation_observe(simulation, &overlapping);
    if (status == DEM_OK) status = dem_simulation_advance(simulation, d->t_end);
    if (status == DEM_STOPPED) status = frames.frame(frames.context, simulation);
    return status;
}

/* Whether a run has come to what the deck asks for, and says so. One that has not has no result: its output stays
 * unfinished. */
static bool succeeds(const deck *d, const dem_simulation *simulation, const relaxation *rest)
{
    const dem_overlap o = dem_simulation_overlap(simulation);
    if (d->stop_at_overlap && o.node >= 0) {
        (void)fprintf(stderr, "%s: error: node %lld is inside triangle %lld of a body at (%g, %g) m, t = %.6g s\n",
                      d->path, (long long)o.node, (long long)o.triangle, o.x[0], o.x[1], o.t);
        return false;
    }
    if (d->residual > 0.0 && !rest->done) {
        (void)fprintf(stderr, "%s: error: not at rest at t_end = %g s: the residual is %.3g, %.3g is asked for\n",
                      d->path, d->t_end, rest->reached, d->residual);
        return false;
    }
    if (d->residual > 0.0) (void)printf("rest       residual %.3g at %.6g s\n", rest->reached, rest->t);
    return true;
}

/* Whether the run has an end; says so if it has none. */
static bool ends(const deck *d, const dem_simulation *simulation)
{
    const double step = dem_simulation_options(simulation).max_step, steps = d->t_end / step;
    if (steps <= most_steps) return true;
    (void)fprintf(stderr, "%s: error: t_end = %g s takes at least %.3g steps of %.3g s; the limit is %.0e\n", d->path,
                  d->t_end, steps, step, most_steps);
    return false;
}

/* Without a reader of its log it goes on all the same: main() tells in the end. */
static int run(const deck *d, dem_simulation *simulation, const char *path)
{
    (void)signal(SIGPIPE, SIG_IGN);
    (void)signal(SIGXFSZ, SIG_IGN); /* a limit on file sizes is a full disk */
    audience a = {0};
    dem_status status = gather(&a, d, simulation, path);
    if (status != DEM_OK) {
        dismiss(&a);
        return complain(code_of(status), path);
    }
    preview_print(stdout, d, simulation, path);
    report_start(&a.log, stdout, isatty(STDOUT_FILENO) == 1, d);
    a.log.peaks = a.peaks;
    a.rest = relaxation_start(d->residual, &d->options);
    status = advance(d, simulation, &a);
    if (status == DEM_OK) report_summary(&a.log, simulation);
    const bool good = status == DEM_OK && succeeds(d, simulation, &a.rest);
    if (good) status = dem_trajectory_finish(a.trajectory);
    const int code = status != DEM_OK ? complain(code_of(status), d->path) : (good ? EXIT_DONE : EXIT_NUMERICS);
    dismiss(&a);
    return code;
}

/* Runs unless the output is there already; nothing has been written so far. */
static int run_where_free(const deck *d, dem_simulation *simulation, const char *outdir)
{
    char path[4096], reason[512];
    if (!output_path(path, sizeof path, outdir, d->name)) {
        (void)fprintf(stderr, "%s: error: the path of the output is too long\n", d->path);
        return EXIT_INVALID;
    }
    switch (output_claim(path, d, reason, sizeof reason)) {
    case OUTPUT_FREE:
        return run(d, simulation, path);
    case OUTPUT_DONE:
        (void)printf("%s: done already, %s\n", path, reason);
        return EXIT_DONE;
    case OUTPUT_TAKEN:
        break;
    }
    (void)fprintf(stderr, "%s: error: %s\n", path, reason);
    return EXIT_TAKEN;
}

/* The model has a copy of the deck's lattice, which is not needed any more. */
static int build_and_run(const command *c, deck *d)
{
    dem_model *model = NULL;
    dem_simulation *simulation = NULL;
    dem_status status = dem_model_create(&model, &d->lattice, d->obstacles, d->n_obstacles);
    dem_options options = d->options;
    dem_lattice_free(&d->lattice);
    if (status == DEM_OK && d->residual > 0.0 && options.mass_damping == 0.0)
        options.mass_damping = relaxation_damping(model);
    if (status == DEM_OK) status = dem_simulation_create(&simulation, model, &options);
    int code;
    if (status != DEM_OK) {
        code = complain(code_of(status), d->path);
    } else if (!ends(d, simulation)) {
        code = EXIT_INVALID;
    } else if (c->action == ACTION_CHECK) {
        preview_print(stdout, d, simulation, NULL);
        code = EXIT_DONE;
    } else {
        code = run_where_free(d, simulation, c->outdir);
    }
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    return code;
}

static void print_errors(const char *path, const namelist_errors *errors)
{
    for (size_t k = 0; k < errors->n; k++) {
        const namelist_error *e = &errors->list[k];
        if (e->place.line > 0)
            (void)fprintf(stderr, "%s:%d:%d: error: %s\n", path, e->place.line, e->place.column, e->text);
        else
            (void)fprintf(stderr, "%s: error: %s\n", path, e->text);
    }
}

static int with_deck(const command *c)
{
    deck d;
    namelist_errors errors = {0};
    const deck_status status = deck_read(&d, c->deck, &errors);
    int code = status == DECK_MEMORY ? EXIT_MEMORY : EXIT_INVALID;
    if (status == DECK_OK && c->action == ACTION_ECHO) {
        (void)fputs(d.echo, stdout);
        code = EXIT_DONE;
    } else if (status == DECK_OK) {
        code = build_and_run(c, &d);
    } else if (status == DECK_MEMORY) {
        (void)fprintf(stderr, "%s: error: out of memory\n", c->deck);
    }
    print_errors(c->deck, &errors);
    namelist_errors_free(&errors);
    deck_free(&d);
    return code;
}

/* ---- the command line ---- */

typedef struct action_word {
    const char *word;
    action action;
} action_word;

static const action_word action_words[] = {{"--check", ACTION_CHECK},       {"--echo", ACTION_ECHO},
                                           {"--template", ACTION_TEMPLATE}, {"--keys", ACTION_KEYS},
                                           {"--version", ACTION_VERSION},   {"--help", ACTION_HELP}};
static const size_t n_actions = sizeof action_words / sizeof action_words[0];

__attribute__((format(printf, 1, 2))) static bool refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fprintf(stderr, "dem_batch: error: ");
    (void)vfprintf(stderr, format, arguments);
    (void)fprintf(stderr, "\n%s", usage);
    va_end(arguments);
    return false;
}

/* As it stands on the command line; "" for a run, which needs no word. */
static const char *word_of(action wanted)
{
    for (size_t k = 0; k < n_actions; k++)
        if (action_words[k].action == wanted) return action_words[k].word;
    return "";
}

static bool parse_word(command *c, const char *word)
{
    for (size_t k = 0; k < n_actions; k++) {
        if (strcmp(word, action_words[k].word) != 0) continue;
        if (c->action != ACTION_RUN) return refuse("'%s' does not go with '%s'", word, word_of(c->action));
        c->action = action_words[k].action;
        return true;
    }
    if (word[0] == '-') return refuse("'%s' is no option", word);
    if (c->deck != NULL) return refuse("'%s' is a second deck, behind '%s'", word, c->deck);
    c->deck = word;
    return true;
}

static bool parse_outdir(command *c, const char *folder)
{
    if (folder == NULL || folder[0] == '\0') return refuse("'--outdir' needs a folder");
    c->outdir = folder;
    return true;
}

static bool parse(command *c, int argc, char **argv)
{
    *c = (command){.action = ACTION_RUN, .outdir = "."};
    for (int k = 1; k < argc; k++) {
        const bool outdir = strcmp(argv[k], "--outdir") == 0;
        if (!(outdir ? parse_outdir(c, argv[++k]) : parse_word(c, argv[k]))) return false;
    }
    const bool needs_deck = c->action == ACTION_RUN || c->action == ACTION_CHECK || c->action == ACTION_ECHO;
    if (needs_deck && c->deck == NULL) return refuse("no deck");
    if (!needs_deck && c->deck != NULL) return refuse("'%s' takes no deck, got '%s'", word_of(c->action), c->deck);
    return true;
}

static int act(const command *c)
{
    char versions[256];
    switch (c->action) {
    case ACTION_TEMPLATE:
        schema_template(stdout);
        break;
    case ACTION_KEYS:
        schema_document(stdout);
        break;
    case ACTION_HELP:
        (void)fputs(usage, stdout);
        break;
    case ACTION_VERSION:
        preview_versions(versions, sizeof versions);
        (void)puts(versions);
        break;
    case ACTION_RUN:
    case ACTION_CHECK:
    case ACTION_ECHO:
        return with_deck(c);
    }
    return EXIT_DONE;
}

/* A file must not get the number of a closed standard stream: what is printed would go into it. */
static void fill_streams(void)
{
    for (int k = 0; k <= STDERR_FILENO; k++)
        if (fcntl(k, F_GETFD) < 0) (void)open("/dev/null", O_RDONLY);
}

int main(int argc, char **argv)
{
    command c;
    fill_streams();
    if (!parse(&c, argc, argv)) return EXIT_USAGE;
    const int code = act(&c);
    const bool printed = fflush(stdout) == 0 && ferror(stdout) == 0;
    if (!printed) (void)fprintf(stderr, "dem_batch: error: standard output cannot be written\n");
    return printed || code != EXIT_DONE ? code : EXIT_IO;
}
