/* SPDX-License-Identifier: BSD-3-Clause */
#include "command.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "wall_clock.h"

static const char usage[] =
    "usage: dem_batch [OPTION]... DECK...          run the decks; NAME.vtkhdf and NAME.json are written for each\n"
    "       dem_batch --check [OPTION]... DECK...  read, build, print sizes and estimates, write nothing\n"
    "       dem_batch --echo [OPTION]... DECK...   print with every key resolved; the echo is a deck of the same run\n"
    "       dem_batch --template                   print a deck with every key, its default and its meaning\n"
    "       dem_batch --keys                       print the description of every key, in Markdown\n"
    "       dem_batch --version | --help\n"
    "decks: files, or @LIST for those in a file, one a line, relative to its folder; '#' begins a comment\n"
    "options:\n"
    "  --outdir FOLDER        where to write; made where it is missing (default: here)\n"
    "  --set GROUP.KEY=VALUE  give a key, spelt as in a deck; GROUP(K).KEY in the K-th such group; any number of "
    "times\n"
    "  --verbose              log all details, too, where else there are about ten lines: bodies, loads, energies, "
    "...\n"
    "  --index N              take only the N-th deck, from 1: for job arrays\n"
    "  --jobs N               do N decks at once, in processes; what they print comes in the order of the decks\n"
    "  --json                 print results as lines of JSON on a terminal, too\n"
    "  --overwrite            rename output of another problem that is in the way to NAME.old\n"
    "  --max-memory GB        refuse what takes more (default: the memory of the machine, over N of --jobs)\n"
    "  --max-steps N          refuse what takes more (default: 1e10)\n"
    "  --max-disk GB          refuse what takes more (default: what is free)\n"
    "  --max-wall SECONDS     end with a checkpoint, exit code 75; the same command goes on\n"
    "  --checkpoint-interval SECONDS  on the wall, between checkpoints (default: 600; the first after 30)\n"
    "  --resume-anyway        go on from a checkpoint of another version: not to the same bits\n"
    "  --mpi                  run as ranks of MPI; under mpirun or srun with several processes this is so anyway\n"
    "  --writers W            frames go to W files beside each file of the run, by W ranks; at most as many as ranks\n"
    "  --slab-nodes N         a body of N nodes and more is made by the ranks, each its part (default: 1e6)\n"
    "  --serial               run under mpirun or srun: each process by itself, with an output of its own\n"
    "signals: SIGUSR1 writes a checkpoint; SIGTERM, SIGINT, SIGXCPU and SIGUSR2 end as --max-wall does\n"
    "exit codes: 0 done, 2 usage, 3 deck invalid, 4 numerics failed, 5 input or output, also over --max-disk,\n"
    "            6 out of memory, or over --max-memory or --max-steps, 7 the output belongs to another problem or\n"
    "            process, 75 stopped, run me again; of several decks the largest\n";

typedef struct action_word {
    const char *word;
    command_action action;
} action_word;

static const action_word action_words[] = {{"--check", COMMAND_CHECK},       {"--echo", COMMAND_ECHO},
                                           {"--template", COMMAND_TEMPLATE}, {"--keys", COMMAND_KEYS},
                                           {"--version", COMMAND_VERSION},   {"--help", COMMAND_HELP}};
static const size_t n_actions = sizeof action_words / sizeof action_words[0];

__attribute__((format(printf, 2, 3))) static bool refuse(const command *c, const char *format, ...)
{
    FILE *err = c->host->err;
    va_list arguments;
    va_start(arguments, format);
    (void)fprintf(err, "dem_batch: error: ");
    (void)vfprintf(err, format, arguments);
    (void)fprintf(err, "\n%s", usage);
    va_end(arguments);
    return false;
}

/* As it stands on the command line; "" for a run, which needs no word. */
static const char *word_of(command_action wanted)
{
    for (size_t k = 0; k < n_actions; k++)
        if (action_words[k].action == wanted) return action_words[k].word;
    return "";
}

/* ---- options with a value; NULL: there is none ---- */

static bool parse_outdir(command *c, const char *folder)
{
    if (folder == NULL || folder[0] == '\0') return refuse(c, "'--outdir' needs a folder");
    c->outdir = folder;
    return true;
}

/* A number from 1 on, of so many digits at most. */
static bool parse_count(const command *c, long *out, size_t digits, const char *needs, const char *number)
{
    const size_t n = number == NULL ? 0 : strspn(number, "0123456789");
    if (n == 0 || n > digits || number[n] != '\0' || (*out = strtol(number, NULL, 10)) < 1)
        return refuse(c, "%s%s%s", needs, number == NULL ? "" : ", got ", number == NULL ? "" : number);
    return true;
}

static bool parse_index(command *c, const char *number)
{
    return parse_count(c, &c->index, 9, "'--index' needs the number of a deck, from 1", number);
}

static bool parse_jobs(command *c, const char *number)
{
    return parse_count(c, &c->jobs, 4, "'--jobs' needs a number from 1 to 9999", number);
}

static bool parse_writers(command *c, const char *number)
{
    return parse_count(c, &c->writers, 6, "'--writers' needs a number of ranks, from 1", number);
}

static bool parse_slab_nodes(command *c, const char *number)
{
    long n = 0;
    if (!parse_count(c, &n, 18, "'--slab-nodes' needs a number of nodes, from 1", number)) return false;
    c->slab_nodes = (double)n;
    return true;
}

static bool parse_seconds(const command *c, double *out, const char *option, const char *text)
{
    char *end = NULL;
    const double seconds = text == NULL ? 0.0 : strtod(text, &end);
    if (text == NULL || end == text || *end != '\0' || !(seconds > 0.0))
        return refuse(c, "'%s' needs seconds, > 0%s%s", option, text == NULL ? "" : ", got ", text == NULL ? "" : text);
    *out = seconds;
    return true;
}

static bool parse_interval(command *c, const char *text)
{
    return parse_seconds(c, &c->checkpoint_interval, "--checkpoint-interval", text);
}

static bool parse_max_wall(command *c, const char *text)
{
    return parse_seconds(c, &c->max_wall, "--max-wall", text);
}

static bool parse_set(command *c, const char *text)
{
    if (text == NULL || !setting_parse(&c->settings[c->n_settings], text))
        return refuse(c, "'--set' needs group.key=value or group(k).key=value%s%s", text == NULL ? "" : ", got ",
                      text == NULL ? "" : text);
    c->n_settings++;
    return true;
}

static bool set_limit(const command *c, double *limit, const char *option, const char *number, double unit)
{
    return limit_set(limit, number, unit) || refuse(c, "'%s' needs a number above 0%s%s", option,
                                                    number == NULL ? "" : ", got ", number == NULL ? "" : number);
}

static bool parse_memory(command *c, const char *number)
{
    c->memory_given = true;
    return set_limit(c, &c->most.memory, "--max-memory", number, 1e9);
}

static bool parse_steps(command *c, const char *number)
{
    return set_limit(c, &c->most.steps, "--max-steps", number, 1.0);
}

static bool parse_disk(command *c, const char *number)
{
    return set_limit(c, &c->most.disk, "--max-disk", number, 1e9);
}

static const struct {
    const char *word;
    bool (*parse)(command *c, const char *value);
} options[] = {{"--outdir", parse_outdir},
               {"--index", parse_index},
               {"--writers", parse_writers},
               {"--jobs", parse_jobs},
               {"--slab-nodes", parse_slab_nodes},
               {"--set", parse_set},
               {"--max-memory", parse_memory},
               {"--max-steps", parse_steps},
               {"--max-disk", parse_disk},
               {"--max-wall", parse_max_wall},
               {"--checkpoint-interval", parse_interval}};

/* ---- words ---- */

static bool parse_word(command *c, const char *word)
{
    for (size_t k = 0; k < n_actions; k++) {
        if (strcmp(word, action_words[k].word) != 0) continue;
        if (c->action != COMMAND_RUN) return refuse(c, "'%s' does not go with '%s'", word, word_of(c->action));
        c->action = action_words[k].action;
        return true;
    }
    const struct {
        const char *word;
        bool *set;
    } flags[] = {{"--overwrite", &c->overwrite},
                 {"--resume-anyway", &c->resume_anyway},
                 {"--verbose", &c->verbose},
                 {"--serial", &c->serial},
                 {"--mpi", &c->mpi},
                 {"--json", &c->json}};
    for (size_t k = 0; k < sizeof flags / sizeof *flags; k++) {
        if (strcmp(word, flags[k].word) != 0) continue;
        *flags[k].set = true;
        return true;
    }
    if (word[0] == '-' || word[0] == '\0') return refuse(c, "'%s' is no option", word);
    c->decks[c->n_decks++] = word;
    return true;
}

static bool parse_all(command *c, char **argv)
{
    for (char **word = argv; *word != NULL; word++) {
        size_t k = 0;
        while (k < sizeof options / sizeof *options && strcmp(*word, options[k].word) != 0) k++;
        const bool valued = k < sizeof options / sizeof *options;
        if (!(valued ? options[k].parse(c, *++word) : parse_word(c, *word))) return false;
    }
    const bool needs_deck = c->action == COMMAND_RUN || c->action == COMMAND_CHECK || c->action == COMMAND_ECHO;
    if (needs_deck && c->n_decks == 0) return refuse(c, "no deck");
    c->json = c->json || !c->host->terminal;
    if (!c->memory_given) c->most.memory /= (double)c->jobs;
    if (!needs_deck && c->n_decks > 0)
        return refuse(c, "'%s' takes no deck, got '%s'", word_of(c->action), c->decks[0]);
    return true;
}

exit_code command_parse(command *c, const host *h, int argc, char **argv)
{
    const size_t n = (size_t)argc + 1;
    *c = (command){.host = h,
                   .action = COMMAND_RUN,
                   .outdir = ".",
                   .most = limit_default(),
                   .jobs = 1,
                   .writers = 1,
                   .slab_nodes = 1e6,
                   .checkpoint_interval = 600.0,
                   .max_wall = (double)INFINITY,
                   .wall_start = wall_clock()};
    c->decks = calloc(n, sizeof *c->decks);
    c->settings = calloc(n, sizeof *c->settings);
    if (c->decks != NULL && c->settings != NULL) return parse_all(c, argv + 1) ? EXIT_DONE : EXIT_USAGE;
    (void)fprintf(h->err, "dem_batch: error: out of memory\n");
    return EXIT_MEMORY;
}

void command_free(command *c)
{
    free(c->decks);
    free(c->settings);
    *c = (command){0};
}

void command_help(FILE *out)
{
    (void)fputs(usage, out);
}
