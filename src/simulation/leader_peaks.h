/* SPDX-License-Identifier: BSD-3-Clause */
/* Peaks of a run that rank 0 leads: the parts look for them, and the program has copies when it asks. */
#ifndef DEM_SIMULATION_LEADER_PEAKS_H
#define DEM_SIMULATION_LEADER_PEAKS_H

#include "simulation/led_ranks.h"

/** All parts look for larger peaks; from then on they have them, and the program's are given up. */
dem_status leader_peaks_look(const dem_simulation *whole, dem_peaks *peaks);

/** Hands over the peaks that the parts have.  \return as gather_chunks() */
dem_status leader_peaks_visit_nodes(const dem_simulation *whole, const dem_peaks *peaks, rows_taker *take,
                                    void *context);
dem_status leader_peaks_visit_springs(const dem_simulation *whole, const dem_peaks *peaks, rows_taker *take,
                                      void *context);

/** The parts keep theirs as entries of the checkpoint that is being taken; and hand these over, as
 *  checkpoint_entries_refer() has it.
 *  \param peaks  dem_peaks */
dem_status leader_peaks_keep(const dem_simulation *whole, const dem_peaks *peaks);
dem_status leader_peaks_visit_kept_nodes(void *peaks, rows_taker *take, void *taker);
dem_status leader_peaks_visit_kept_springs(void *peaks, rows_taker *take, void *taker);

/** Copies them to the program's, where room is made.  \return as before, and DEM_ERROR_MEMORY */
dem_status leader_peaks_bring_nodes(dem_peaks *peaks);
dem_status leader_peaks_bring_springs(dem_peaks *peaks);

/** Tells the parts that nobody wants theirs. */
void leader_peaks_forget(const dem_simulation *whole, const dem_peaks *peaks);

/** Brings all that are away, before the parts end. */
dem_status leader_peaks_bring_all(led_run *l);

/** The run has ended: peaks that could not be brought are gone. */
void leader_peaks_forget_run(led_run *l);

#endif
