/* SPDX-License-Identifier: BSD-3-Clause */
/* Bytes that each rank collects for each other one, and that all send at once. Who receives them need not know how many
 * there are. */
#ifndef DEM_BASE_BUNDLE_H
#define DEM_BASE_BUNDLE_H

#include <stdbool.h>

#include <dem/dem.h>

#include "base/ranks.h"

typedef struct bundle {
    dem_index n, capacity; /* bytes */
    unsigned char *bytes;  /* [n] */
} bundle;

/** Appends bytes.  \return false without memory; then nothing is appended */
bool bundle_add(bundle *b, const void *bytes, size_t size);

/** Copies the next bytes and goes on behind them.
 *  \param[in,out] at  where they begin in the bundle */
void bundle_take(const bundle *b, dem_index *at, void *bytes, size_t size);

/** Hands what each rank has for each other one over; what one has for itself is left alone. Collective.
 *  \param sent           [ranks]
 *  \param[out] received  [ranks] overwritten; to be freed with bundles_free(), after a failure, too
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status bundles_exchange(const ranks *r, const bundle *sent, bundle *received);

/** Ends n bundles, each of which is empty then. */
void bundles_free(bundle *list, int n);

#endif
