/* SPDX-License-Identifier: BSD-3-Clause */
/* Peaks for those who look at one after the other, or at a few: they may be those of ranks, and then come from them.
 * Defined in simulation/peak_source.c, as those who write files see no more of a run than public headers. What is
 * exported is for dem_batch; no other program may call it. */
#ifndef DEM_BASE_PEAK_SOURCE_H
#define DEM_BASE_PEAK_SOURCE_H

#include <dem/observer.h>

#include "base/rows_taker.h"

/** Hands over those of nodes, dem_node_peak, or of springs, dem_spring_peak.
 *  \return DEM_ERROR_MEMORY, and the failure of `take`, which is not called again then */
dem_status dem_private_peaks_visit_nodes(const dem_peaks *peaks, rows_taker *take, void *context);
dem_status dem_private_peaks_visit_springs(const dem_peaks *peaks, rows_taker *take, void *context);

/** Gets those of n nodes, or springs.  \return DEM_ERROR_MEMORY */
DEM_API dem_status dem_private_peaks_pick_nodes(const dem_peaks *peaks, const dem_index *list, dem_index n,
                                                dem_node_peak *out);
DEM_API dem_status dem_private_peaks_pick_springs(const dem_peaks *peaks, const dem_index *list, dem_index n,
                                                  dem_spring_peak *out);

#endif
