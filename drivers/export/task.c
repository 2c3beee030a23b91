/* SPDX-License-Identifier: BSD-3-Clause */
#include "task.h"

#include <stdio.h>
#include <stdlib.h>

void task_warn(const task *t, const char *what)
{
    (void)fprintf(stderr, "dem_export: %s: warning: %s\n", t->input, what);
}

bool task_holds(const task *t, dem_status status)
{
    if (status != DEM_OK) outcome_fail_status(t->outcome, status, "dem_export");
    return status == DEM_OK;
}

void *task_allocate(const task *t, dem_index n, size_t size)
{
    void *array = calloc((size_t)n + 1, size);
    if (array == NULL) outcome_fail(t->outcome, EXIT_MEMORY, "dem_export", "out of memory");
    return array;
}
