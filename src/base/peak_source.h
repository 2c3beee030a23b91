/* SPDX-License-Identifier: BSD-3-Clause */
/* Peaks for those who look at one after the other, or at the largest: they may be those of ranks, and come from them.
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

/** Finds the largest ones, as dem_peaks_most_stressed_nodes() and dem_peaks_most_strained_springs() list them.
 *  \param[in,out] n   how many are wanted; how many there are
 *  \param[out] list   [n] their numbers
 *  \param[out] peaks  [n]
 *  \return DEM_ERROR_MEMORY */
DEM_API dem_status dem_private_peaks_largest_nodes(const dem_peaks *p, dem_index *n, dem_index *list,
                                                   dem_node_peak *peaks);
DEM_API dem_status dem_private_peaks_largest_springs(const dem_peaks *p, dem_index *n, dem_index *list,
                                                     dem_spring_peak *peaks);

#endif
