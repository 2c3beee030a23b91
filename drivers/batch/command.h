/* SPDX-License-Identifier: BSD-3-Clause */
/* The command line of dem_batch. */
#ifndef DEM_COMMAND_H
#define DEM_COMMAND_H

#include <stdbool.h>
#include <stdio.h>

#include "host.h"
#include "limit.h"
#include "outcome.h"
#include "setting.h"

typedef enum command_action {
    COMMAND_RUN,
    COMMAND_CHECK,
    COMMAND_ECHO,
    COMMAND_TEMPLATE,
    COMMAND_KEYS,
    COMMAND_VERSION,
    COMMAND_HELP
} command_action;

/** Texts are those of argv. */
typedef struct command {
    const host *host;
    command_action action;
    const char *outdir; /* made when the first output is to be written */
    bool overwrite, resume_anyway, verbose;
    bool serial;                    /* by itself, though a launcher has started several processes */
    bool mpi;                       /* by ranks, whatever the environment says of a launcher */
    const struct rank_group *ranks; /* that make each run; NULL: this process alone does */
    bool json;                      /* results go to standard output, too: as asked for, or where programs read it */
    long writers;                   /* ranks that write frames; 1: rank 0 alone */
    double slab_nodes;              /* bodies of as many are made in slabs by the ranks */
    long jobs;                      /* cases at once, in processes of their own if more than one */
    limits most;                    /* of each case; disk infinite: what is free */
    bool memory_given;              /* else the cases that are done at once share the machine's */
    double checkpoint_interval, max_wall; /* s on the wall */
    double wall_start;                    /* s, of the whole command */
    long index;                           /* of the only deck, from 1; 0: all of them */
    size_t n_decks, n_settings;
    const char **decks; /* [n_decks] files, and lists with an '@' before their names */
    setting *settings;  /* [n_settings] */
} command;

/** What is wrong with it is said to the host, which is kept. To be freed in any case. */
exit_code command_parse(command *c, const host *h, int argc, char **argv);
void command_free(command *c);

void command_help(FILE *out);

#endif
