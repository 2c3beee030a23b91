/* SPDX-License-Identifier: BSD-3-Clause */
/* Sections of a deflated stream that rank 0 has, and that the ranks of a run which it leads deflate: each a block of
 * them, with the same number of sections but for one. */
#ifndef DEM_SIMULATION_SHARED_SECTIONS_H
#define DEM_SIMULATION_SHARED_SECTIONS_H

#include "base/ranks.h"
#include "base/section.h"

/** Packs the sections. Collective.
 *  \param z         of each rank, as the team is
 *  \param sections  [n] on rank 0, as section_pack_by_ranks() has them; not looked at elsewhere
 *  \return DEM_ERROR_MEMORY, DEM_ERROR_IO, on all ranks */
dem_status shared_sections_pack(const ranks *r, section_streams *z, team *t, section *sections, int n);

#endif
