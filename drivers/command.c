/* SPDX-License-Identifier: BSD-3-Clause */
#include "command.h"

#include <stdarg.h>
#include <string.h>

static const char usage[] =
    "usage: dem_batch [--outdir FOLDER] DECK   run the deck; NAME.vtkhdf is written to FOLDER (default: here)\n"
    "       dem_batch --check DECK             read it, build it, print sizes and estimates, write nothing\n"
    "       dem_batch --echo DECK              print it with every key resolved; the echo is a deck of the same run\n"
    "       dem_batch --template               print a deck with every key, its default and its meaning\n"
    "       dem_batch --keys                   print the description of every key, in Markdown\n"
    "       dem_batch --version | --help\n"
    "exit codes: 0 done, 2 usage, 3 deck invalid, 4 numerics failed, 5 input or output, 6 out of memory,\n"
    "            7 the output exists and belongs to another problem\n";

typedef struct action_word {
    const char *word;
    command_action action;
} action_word;

static const action_word action_words[] = {{"--check", COMMAND_CHECK},       {"--echo", COMMAND_ECHO},
                                           {"--template", COMMAND_TEMPLATE}, {"--keys", COMMAND_KEYS},
                                           {"--version", COMMAND_VERSION},   {"--help", COMMAND_HELP}};
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
static const char *word_of(command_action wanted)
{
    for (size_t k = 0; k < n_actions; k++)
        if (action_words[k].action == wanted) return action_words[k].word;
    return "";
}

static bool parse_word(command *c, const char *word)
{
    for (size_t k = 0; k < n_actions; k++) {
        if (strcmp(word, action_words[k].word) != 0) continue;
        if (c->action != COMMAND_RUN) return refuse("'%s' does not go with '%s'", word, word_of(c->action));
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

bool command_parse(command *c, int argc, char **argv)
{
    *c = (command){.action = COMMAND_RUN, .outdir = "."};
    for (int k = 1; k < argc; k++) {
        const bool outdir = strcmp(argv[k], "--outdir") == 0;
        if (!(outdir ? parse_outdir(c, argv[++k]) : parse_word(c, argv[k]))) return false;
    }
    const bool needs_deck = c->action == COMMAND_RUN || c->action == COMMAND_CHECK || c->action == COMMAND_ECHO;
    if (needs_deck && c->deck == NULL) return refuse("no deck");
    if (!needs_deck && c->deck != NULL) return refuse("'%s' takes no deck, got '%s'", word_of(c->action), c->deck);
    return true;
}

void command_help(FILE *out)
{
    (void)fputs(usage, out);
}
