/* SPDX-License-Identifier: BSD-3-Clause */
/* Units of the numbers in a trajectory, by name (docs/output.md). */
#ifndef DEM_OUTPUT_UNITS_H
#define DEM_OUTPUT_UNITS_H

/** "m", "N s", ...; "1" for a ratio; "" for a count, a number that names something, or an unknown name.
 *  \param table  in which the column is; NULL: an array of frames */
const char *units_of(const char *table, const char *name);

#endif
