/* SPDX-License-Identifier: BSD-3-Clause */
/* cores.c: quotas of control groups of both versions, and affinity, as files say them. */
#include "base/cores.h"

#include <math.h>
#include <sys/stat.h>

#include "../scratch.h"

/* The groups of a process, and the quota that is found. */
static double quota_of(scratch_folder *f, const char *groups)
{
    file_put(folder_at(f, "groups"), groups, strlen(groups));
    return cores_quota(folder_at(f, "groups"), f->path);
}

static void put(scratch_folder *f, const char *name, const char *text)
{
    file_put(folder_at(f, name), text, strlen(text));
}

TEST(a_quota_is_that_of_the_group_or_of_one_that_it_is_in)
{
    CLEANUP(folder_close) scratch_folder f;
    folder_open(&f);
    (void)folder_file(&f, "groups");
    (void)folder_file(&f, "cpu.max");
    (void)folder_file(&f, "job/cpu.max");
    assert_int_equal(mkdir(folder_at(&f, "job"), 0700), 0);
    assert_true(quota_of(&f, "0::/job\n") == (double)INFINITY);
    put(&f, "cpu.max", "max 100000\n");
    put(&f, "job/cpu.max", "150000 100000\n");
    assert_true(quota_of(&f, "0::/job\n") == 1.5);
    assert_true(quota_of(&f, "0::/job/step\n") == 1.5);
    assert_true(quota_of(&f, "0::/other\n") == (double)INFINITY);
    put(&f, "cpu.max", "50000 100000\n");
    assert_true(quota_of(&f, "0::/job\n") == 0.5);
    assert_true(quota_of(&f, "0::/other\n") == 0.5);
    folder_sweep(&f);
    assert_int_equal(rmdir(folder_at(&f, "job")), 0);
}

TEST(groups_of_the_first_version_have_a_folder_for_each_set_of_controllers)
{
    CLEANUP(folder_close) scratch_folder f;
    folder_open(&f);
    (void)folder_file(&f, "groups");
    (void)folder_file(&f, "cpu,cpuacct/cpu.cfs_quota_us");
    (void)folder_file(&f, "cpu,cpuacct/cpu.cfs_period_us");
    assert_int_equal(mkdir(folder_at(&f, "cpu,cpuacct"), 0700), 0);
    put(&f, "cpu,cpuacct/cpu.cfs_period_us", "20000\n");
    put(&f, "cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
    assert_true(quota_of(&f, "5:memory:/\n4:cpu,cpuacct:/\n") == (double)INFINITY);
    put(&f, "cpu,cpuacct/cpu.cfs_quota_us", "60000\n");
    assert_true(quota_of(&f, "5:memory:/\n4:cpu,cpuacct:/\n") == 3.0);
    folder_sweep(&f);
    assert_int_equal(rmdir(folder_at(&f, "cpu,cpuacct")), 0);
}

TEST(affinity_is_the_number_of_bits_in_a_mask)
{
    CLEANUP(folder_close) scratch_folder f;
    folder_open(&f);
    (void)folder_file(&f, "status");
    assert_int_equal(cores_affinity(folder_at(&f, "status")), 0);
    put(&f, "status", "Name:\tdem\nCpus_allowed:\tff,0000a001\nCpus_allowed_list:\t0,13,15,32-39\n");
    assert_int_equal(cores_affinity(folder_at(&f, "status")), 11);
    put(&f, "status", "Name:\tdem\n");
    assert_int_equal(cores_affinity(folder_at(&f, "status")), 0);
}

TEST(what_cannot_be_read_is_no_quota)
{
    CLEANUP(folder_close) scratch_folder f;
    folder_open(&f);
    (void)folder_file(&f, "groups");
    (void)folder_file(&f, "cpu.max");
    assert_true(cores_quota(folder_at(&f, "none"), f.path) == (double)INFINITY);
    put(&f, "cpu.max", "many 100000\n");
    assert_true(quota_of(&f, "0::/\n") == (double)INFINITY);
    put(&f, "cpu.max", "50000\n");
    assert_true(quota_of(&f, "0::/\n") == (double)INFINITY);
    assert_true(quota_of(&f, "no line of a group\n") == (double)INFINITY);
    assert_true(cores_allowed() >= 1);
}
