/* SPDX-License-Identifier: BSD-3-Clause */
/* malloc, calloc, realloc and aligned_alloc of what a test links with, which fail as asked: the linker's
 * --wrap leads here. For one test program each. */
#ifndef DEM_TEST_ALLOCATIONS_H
#define DEM_TEST_ALLOCATIONS_H

#include <stdlib.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_realloc(void *old, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

static long allocations, failing; /* the failing-th fails; 0: none */
static int from_then_on;

static int fails(void)
{
    allocations++;
    return failing > 0 && (allocations == failing || (from_then_on && allocations > failing));
}

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t n, size_t size)
{
    return fails() ? NULL : __real_calloc(n, size);
}

void *__wrap_realloc(void *old, size_t size)
{
    return fails() ? NULL : __real_realloc(old, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return fails() ? NULL : __real_aligned_alloc(alignment, size);
}

#endif
