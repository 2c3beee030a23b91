/* SPDX-License-Identifier: BSD-3-Clause */
/* The log of a run from its start on: a progress line, and what came out. */
#ifndef DEM_REPORT_H
#define DEM_REPORT_H

#include <stdbool.h>

#include "deck.h"
#include "fracture_report.h"
#include "rebound.h"
#include "relaxation.h"
#include "run_log.h"
#include "step_report.h"
#include "surface_report.h"

/** What the report of a run needs, and its checkpoints keep. */
typedef struct report_progress {
    double energy_start; /* J, total at t = 0 */
    double energy_max;   /* J, largest kinetic + elastic + area + guard + contact so far: what is compared */
    double elastic_share_max, elastic_share_t; /* of energy_max as it was then */
    dem_strain strain_min, strain_max;         /* the states with the extreme strains */
    double strain_min_t, strain_max_t, area_min, area_min_t;
    dem_index guarded_max, inverted_max;
    step_report step_report;
    surface_report surface_report;
    rebound rebound;
    fracture_report fracture_report;
    double warned_closure, warned_t; /* of the ledger's warning */
    double looked_t;                 /* s, when energies and strains were looked at last; -INFINITY: not yet */
    bool warned, overlapped;
} report_progress;

typedef struct report {
    run_log *log;
    const deck *deck;
    int32_t *touched;              /* [n_nodes] of a node that touched an obstacle its number, from 1; NULL: none did */
    double t_end;                  /* s */
    double span;                   /* s, of which progress is shown at every tenth or twentieth */
    const relaxation *rest;        /* of a run that ends at rest; NULL: of another */
    double closure;                /* from which on the ledger is warned of */
    double settled;                /* s, when the last ramp ends */
    double wall_start, wall_shown; /* s */
    double t_start, t_shown;       /* s */
    dem_index steps_start;         /* before this process */
    dem_index every;               /* steps from one look to the next where nothing touches; 0: all are looked at */
    report_progress so_far;
    const dem_peaks *peaks; /* for the summary; to be set behind report_start(), NULL: none */
    dem_index most_stressed;
} report;

/** Starts the log of a run. */
void report_start(report *r, run_log *log, const deck *d);

/** Shows progress as the residual of a run that will be at rest about then.  \param rest  borrowed */
void report_expect_rest(report *r, const relaxation *rest, double t);

/** To be called in any case. */
void report_end(report *r);

/** Goes on from the checkpoint of a simulation that has been resumed from it.  \return DEM_ERROR_IO */
dem_status report_resume(report *r, const dem_checkpoint *checkpoint, const dem_simulation *simulation);

/** Keeps the warnings that an earlier process of the run has printed, in their order. */
void report_warn_again(report *r, const dem_simulation *simulation);

/** To be handed to the simulation: follows extremes and prints progress.
 *  \param every  steps from one look to the next where nothing touches; 0: all are looked at */
dem_observer report_observer(report *r, dem_index every);

/** First and last contact, rebound, what was stressed most, the energy ledger and its closure, obstacles that carry,
 *  boundaries; with the details of a verbose log all obstacles, strains, energies, counts and wall time. */
void report_summary(report *r, const dem_simulation *simulation);

/** Whether a node is on an edge that its lattice follows in steps: edges.h. */
bool report_is_stepped(const report *r, const dem_model *model, dem_index node);

/** The obstacle, from 1, that a node has touched last in this run; 0: none. */
int32_t report_touched(const report *r, dem_index node);

/** What the ledger has gained, over the largest energy so far. */
double report_closure(const report *r, dem_energy e);

#endif
