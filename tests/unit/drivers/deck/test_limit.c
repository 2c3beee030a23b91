/* SPDX-License-Identifier: BSD-3-Clause */
/* limit.c: what a run may take, where that comes from, and what is said of one that takes more. */
#include "unit/close.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limit.h"
#include "unit/scratch.h"

static const char *at(const char *name)
{
    return folder_at(&scratch, name);
}

static void put(const char *name, const char *text)
{
    file_put(at(name), text, strlen(text));
}

/* ---- options ---- */

TEST(by_default_memory_is_the_machines_and_steps_have_an_end)
{
    const limits most = limit_default();
    assert_close(most.steps, 1e10, 0.0);
    assert_true(isinf(most.disk));
    assert_true(most.memory > 1e6 && most.memory <= (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE));
}

TEST(numbers_above_zero_set_limits)
{
    double limit = 7.0;
    assert_true(limit_set(&limit, "1.5", 1e9));
    assert_close(limit, 1.5e9, 0.0);
    assert_true(limit_set(&limit, "1e3", 1.0));
    assert_close(limit, 1e3, 0.0);
    static const char *const bad[] = {"", "x", "1GB", "0", "-1", "nan", "inf", "1e999", " ", NULL};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) assert_false(limit_set(&limit, bad[k], 1.0));
    assert_close(limit, 1e3, 0.0);
}

/* ---- what there is ---- */

TEST(the_least_limit_of_all_groups_above_counts)
{
    assert_int_equal(mkdir(at("a"), 0700), 0);
    assert_int_equal(mkdir(at("a/b"), 0700), 0);
    put("memory.max", "5000000\n");
    put("a/memory.max", "3000000\n");
    put("a/b/memory.max", "max\n");
    put("groups", "1:cpu:/elsewhere\n0::/a/b\n");
    assert_close(limit_of_groups(scratch.path, at("groups")), 3e6, 0.0);
    put("a/b/memory.max", "1000000\n");
    assert_close(limit_of_groups(scratch.path, at("groups")), 1e6, 0.0);
    put("groups", "0::/\n");
    assert_close(limit_of_groups(scratch.path, at("groups")), 5e6, 0.0);
    put("groups", "1:cpu:/a\n");
    assert_true(isinf(limit_of_groups(scratch.path, at("groups"))));
    assert_true(isinf(limit_of_groups(scratch.path, at("none"))));
    static const char *const made[] = {"a/b/memory.max", "a/memory.max", "memory.max", "groups", "a/b", "a"};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) assert_int_equal(remove(at(made[k])), 0);
}

TEST(the_disk_has_what_is_free_but_for_a_run_that_goes_on)
{
    limits most = limit_default();
    put("runner.vtkhdf", "another one's\n");
    put("run.json", "of a run that came to nothing\n");
    assert_true(limit_see_disk(&most, scratch.path, "run"));
    assert_true(most.disk > 0.0 && isfinite(most.disk));
    most.disk = INFINITY;
    put("run.part.vtkhdf", "begun\n");
    assert_true(limit_see_disk(&most, scratch.path, "run"));
    assert_true(isinf(most.disk));
    /* a file system without blocks, and missing folders on it */
    static const char *const without[] = {"/proc", "/proc/none", "/proc/none//deep/"};
    for (size_t k = 0; k < sizeof without / sizeof *without; k++)
        assert_false(limit_see_disk(&most, without[k], "run"));
    assert_true(isinf(most.disk));
    const char *const missing[] = {at("none/deep/"), "none", "none/deep", "/none-of-these", "//none-of-these/deep"};
    for (size_t k = 0; k < sizeof missing / sizeof *missing; k++) {
        most.disk = INFINITY;
        assert_true(limit_see_disk(&most, missing[k], "run"));
        assert_true(most.disk > 0.0 && isfinite(most.disk));
    }
    static const char *const made[] = {"runner.vtkhdf", "run.json", "run.part.vtkhdf"};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) assert_int_equal(unlink(at(made[k])), 0);
}

TEST_GROUP(scratch_make, scratch_remove);
