/* SPDX-License-Identifier: BSD-3-Clause */
/* Units of the numbers in a trajectory, by name (docs/output.md). A name has the same unit in all tables. */
#ifndef DEM_OUTPUT_UNITS_H
#define DEM_OUTPUT_UNITS_H

/** "m", "N s", ...; "1" for a ratio; "" for a count, a number that names something, or an unknown name. */
const char *units_of(const char *name);

#endif
