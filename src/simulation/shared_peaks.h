/* SPDX-License-Identifier: BSD-3-Clause */
/* Peaks of a run that rank 0 leads: each rank looks for those of its part, and rank 0 has the others' only while they
 * are wanted: by a checkpoint, or by the program. */
#ifndef DEM_SIMULATION_SHARED_PEAKS_H
#define DEM_SIMULATION_SHARED_PEAKS_H

#include "base/rows_taker.h"
#include "domain/migration.h"
#include "simulation/peaks.h"
#include "simulation/rank_call.h"

/** What a rank has of the peaks of a run, which have numbers. */
typedef struct shared_peaks {
    dem_peaks *whole[OBSERVERS_MOST]; /* the program's, on rank 0; NULL: none */
    dem_peaks *part[OBSERVERS_MOST];  /* of the part; NULL: none yet */
    dem_peaks kept[OBSERVERS_MOST];   /* their entries in the last checkpoint */
    rows_taker *take;                 /* of what the call in hand hands over, on rank 0, */
    void *context;                    /* and its argument */
} shared_peaks;

/** The number of the program's peaks; -1: they have none. On rank 0. */
int shared_peaks_number(const shared_peaks *s, const dem_peaks *whole);

/** Answers one of the calls RANK_CALL_PEAKS_... Collective.  \return DEM_ERROR_MEMORY, on all ranks */
dem_status shared_peaks_answer(shared_peaks *s, const dem_simulation *part, const rank_call *what);

/** Takes peaks number k of a new part over from those that the ranks had before, and keeps them as entries of the last
 *  checkpoint. Collective.  \return DEM_ERROR_MEMORY, on all ranks; then there are none */
dem_status shared_peaks_migrate(shared_peaks *s, const dem_model *m, int k, migrating_rows *of_nodes,
                                migrating_rows *of_springs);

/** Frees those of the part. */
void shared_peaks_drop(shared_peaks *s);

#endif
