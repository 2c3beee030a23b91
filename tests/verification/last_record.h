/* SPDX-License-Identifier: BSD-3-Clause */
/* The last record of a simulation, for tests that go on from it. */
#ifndef DEM_TESTS_LAST_RECORD_H
#define DEM_TESTS_LAST_RECORD_H

#include "base/checkpoint_entries.h"
#include "verification/support.h"

/** A copy, of a simulation that keeps records; free with dem_checkpoint_destroy(). */
static inline dem_checkpoint *last_record(const dem_simulation *simulation)
{
    dem_checkpoint *checkpoint;
    assert_ok(dem_checkpoint_create(&checkpoint));
    assert_ok(checkpoint_entries_copy(checkpoint, dem_simulation_checkpoint(simulation)));
    return checkpoint;
}

#endif
