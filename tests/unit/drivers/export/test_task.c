/* SPDX-License-Identifier: BSD-3-Clause */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include "task.h"

TEST(a_failure_of_the_library_is_the_outcome)
{
    outcome o = {0};
    const task t = {.outcome = &o};
    dem_reader *reader = NULL;
    assert_true(task_holds(&t, DEM_OK));
    assert_int_equal(o.code, EXIT_DONE);
    assert_false(task_holds(&t, dem_reader_open(&reader, "none.vtkhdf")));
    assert_int_equal(o.code, EXIT_IO);
    assert_non_null(strstr(o.message, "dem_export: error: none.vtkhdf: cannot be opened"));
}

TEST(arrays_are_zeroed_and_never_of_no_bytes)
{
    outcome o = {0};
    const task t = {.outcome = &o};
    CLEANUP(free_memory) double *none = task_allocate(&t, 0, sizeof *none), *some = task_allocate(&t, 3, sizeof *some);
    assert_true(none != NULL && some != NULL && some[2] == 0.0);
}
