/* SPDX-License-Identifier: BSD-3-Clause */
/* The command line of dem_batch. */
#ifndef DEM_COMMAND_H
#define DEM_COMMAND_H

#include <stdbool.h>
#include <stdio.h>

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
    command_action action;
    const char *deck, *outdir;
} command;

/** False if something is wrong with it, which is said on standard error. */
bool command_parse(command *c, int argc, char **argv);

void command_help(FILE *out);

#endif
