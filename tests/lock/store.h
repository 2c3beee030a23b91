/* SPDX-License-Identifier: BSD-3-Clause */
/* The hashes that are stored, one line "CASE HASH" for each case. */
#ifndef DEM_TEST_STORE_H
#define DEM_TEST_STORE_H

#include <stdint.h>

/** \param replaces  1: what is found replaces what is stored, once all of it is known; 0: it is compared with it */
void store_open(const char *path, int replaces);

/** Tells of a case that is not as stored. */
void store_check(const char *name, uint64_t hash);

/** Tells of a kernel that gives another hash than the portable one. */
void store_disagree(const char *name, const char *kernel, uint64_t hash);

/** How many faults were printed so far. */
int store_differences(void);

/** How many cases are stored that were not checked; each is printed. */
int store_missing(void);

/** Writes the file again with what was found. */
void store_replace(void);

#endif
