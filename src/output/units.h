/* SPDX-License-Identifier: BSD-3-Clause */
/* Units of what a trajectory holds, by name: docs/output.md. A name has the same unit in all tables. */
#ifndef DEM_OUTPUT_UNITS_H
#define DEM_OUTPUT_UNITS_H

/** "m", "N s", ...; "1" of a ratio; "" of a number that counts, names or is not known. */
const char *units_of(const char *name);

#endif
