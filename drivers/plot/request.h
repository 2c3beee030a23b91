/* SPDX-License-Identifier: BSD-3-Clause */
/* The command line of dem_plot. */
#ifndef DEM_REQUEST_H
#define DEM_REQUEST_H

#include <stdbool.h>
#include <stdio.h>

#include "box.h"
#include "outcome.h"

typedef enum request_action {
    REQUEST_STRIP,
    REQUEST_ANIMATION,
    REQUEST_HISTORY,
    REQUEST_SIZES,
    REQUEST_PAGE,
    REQUEST_HELP,
    REQUEST_VERSION
} request_action;

/** Texts are those of argv. */
typedef struct request {
    request_action action;
    const char *input;
    const char *output;         /* a file; NULL for an animation and a page */
    const char *folder;         /* of an animation */
    const char *page;           /* a file */
    double max_size;            /* of a page, bytes */
    const char *frames, *times; /* NULL: as it is by default */
    const char *color;          /* NULL: what there is */
    bool has_range, has_zoom, has_cracks, prints_hash;
    double lo, hi;  /* of the range; lo is -infinity where only a limit is given */
    box zoom;       /* m */
    double width;   /* pixels */
    size_t columns; /* 0: what fits */
} request;

/** What is wrong with it is said on standard error; the exit code for it. */
exit_code request_parse(request *r, char **argv);

void request_help(FILE *out);

#endif
