/* SPDX-License-Identifier: BSD-3-Clause */
/* The history of a run as charts, and as a picture of them one below the other over one axis of time. */
#ifndef DEM_TIMELINE_H
#define DEM_TIMELINE_H

#include <stdint.h>

#include <dem/reader.h>

#include "chart.h"
#include "outcome.h"
#include "request.h"

enum { TIMELINE_CHARTS = 5, TIMELINE_ARRAYS = 64, TIMELINE_NAME = 32 };

typedef struct timeline {
    const dem_reader *reader;
    outcome *o;
    size_t n;  /* rows */
    double *t; /* [n] s */
    int n_arrays, n_charts;
    double *array[TIMELINE_ARRAYS]; /* all that has to be freed */
    char name[TIMELINE_CHARTS][CHART_LINES][TIMELINE_NAME];
    chart chart[TIMELINE_CHARTS]; /* [n_charts] */
    uint64_t hash;
} timeline;

/** The charts of a run; `path` is its file's name for messages. NULL after a fault, which is reported: without history,
 *  too. */
timeline *timeline_open(const dem_reader *reader, const char *path, outcome *o);

/** Accepts NULL. */
void timeline_close(timeline *of);

/** Energies, reactions of obstacles, forces of boundaries, contacts and steps, of those that the trajectory has; what
 *  was drawn is written to `log`. False after a fault, which is reported. */
bool timeline_draw(const dem_reader *reader, const request *asked, FILE *log, outcome *o);

#endif
