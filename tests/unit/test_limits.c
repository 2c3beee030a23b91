/* SPDX-License-Identifier: BSD-3-Clause */
/* limits.c: what a run may take, where that comes from, and what is said of one that takes more. */
#include "close.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limits.h"

static char folder[] = "/tmp/test_limits_XXXXXX";

static const char *at(const char *name)
{
    static char path[256];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void put(const char *name, const char *text)
{
    FILE *file = fopen(at(name), "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* ---- options ---- */

static void numbers_above_zero_set_limits(void **state)
{
    (void)state;
    limits most = limits_default();
    assert_close(most.steps, 1e10, 0.0);
    assert_true(isinf(most.disk));
    assert_true(most.memory > 1e6);
    assert_true(limits_set(&most, "--max-memory", "1.5"));
    assert_true(limits_set(&most, "--max-steps", "1e3"));
    assert_true(limits_set(&most, "--max-disk", "0.25"));
    assert_close(most.memory, 1.5e9, 0.0);
    assert_close(most.steps, 1e3, 0.0);
    assert_close(most.disk, 2.5e8, 0.0);
}

static void what_is_no_number_above_zero_sets_nothing(void **state)
{
    (void)state;
    static const char *const bad[] = {"", "x", "1GB", "0", "-1", "nan", "inf", "1e999", " ", NULL};
    limits most = {1.0, 2.0, 3.0};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) assert_false(limits_set(&most, "--max-steps", bad[k]));
    assert_close(most.steps, 2.0, 0.0);
    assert_true(limits_is_option("--max-disk"));
    assert_false(limits_is_option("--max"));
}

/* ---- what there is ---- */

static void the_least_limit_of_all_groups_above_counts(void **state)
{
    (void)state;
    assert_int_equal(mkdir(at("a"), 0700), 0);
    assert_int_equal(mkdir(at("a/b"), 0700), 0);
    put("memory.max", "5000000\n");
    put("a/memory.max", "3000000\n");
    put("a/b/memory.max", "max\n");
    put("groups", "1:cpu:/elsewhere\n0::/a/b\n");
    assert_close(limits_of_groups(folder, at("groups")), 3e6, 0.0);
    put("a/b/memory.max", "1000000\n");
    assert_close(limits_of_groups(folder, at("groups")), 1e6, 0.0);
    put("groups", "0::/\n");
    assert_close(limits_of_groups(folder, at("groups")), 5e6, 0.0);
    put("groups", "1:cpu:/a\n");
    assert_true(isinf(limits_of_groups(folder, at("groups"))));
    assert_true(isinf(limits_of_groups(folder, at("none"))));
    static const char *const made[] = {"a/b/memory.max", "a/memory.max", "memory.max", "groups", "a/b", "a"};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) assert_int_equal(remove(at(made[k])), 0);
}

/* What a run has written already is room that it does not need once more. */
static void the_disk_has_what_is_free_and_what_the_run_has_taken(void **state)
{
    (void)state;
    limits before = limits_default(), after = before;
    char *bytes = calloc(1, (8 << 20) + 1);
    assert_non_null(bytes);
    memset(bytes, 'x', 8 << 20);
    assert_true(limits_see_disk(&before, folder, "run"));
    assert_true(before.disk > 0.0 && isfinite(before.disk));
    put("run.00001.vtkhdf", bytes);
    put("runner.vtkhdf", "another one's\n");
    assert_true(limits_see_disk(&after, folder, "none"));
    const double others = after.disk;
    assert_true(limits_see_disk(&after, folder, "run"));
    assert_true(after.disk - others > 4e6); /* of 8 MiB: others write to this disk meanwhile */
    assert_false(limits_see_disk(&after, at("none"), "run"));
    assert_int_equal(unlink(at("run.00001.vtkhdf")), 0);
    assert_int_equal(unlink(at("runner.vtkhdf")), 0);
    free(bytes);
}

/* ---- what is refused ---- */

static deck parse(void)
{
    namelist_errors errors = {0};
    deck d;
    put("a.nml", "&run t_end = 1 /\n&material youngs_modulus = 1, density = 1 /\n"
                 "&body shape = 'rectangle', size = 1, 1, spacing = 1 /\n"
                 "&body shape = 'rectangle', size = 1, 1,\n spacing = 1 /\n&output\n frame_interval = 0.1 /\n");
    if (deck_parse(&d, at("a.nml"), &errors) != DECK_OK) fail_msg("%s", errors.list[0].text);
    assert_int_equal(unlink(at("a.nml")), 0);
    return d;
}

static const estimate needed = {
    .nodes = 5e6, .largest = 1, .memory = 6e9, .step = 1e-6, .steps = 1e6, .frames = 11.0, .output = 3e9};

static void expect(limits most, limits_breach expected, const char *told)
{
    namelist_errors errors = {0};
    char all[1024] = "";
    size_t n = 0;
    deck d = parse();
    assert_int_equal(limits_check(&most, &needed, &d, &errors), expected);
    for (size_t k = 0; k < errors.n; k++)
        n += (size_t)snprintf(all + n, sizeof all - n, "%d:%d %s\n", errors.list[k].place.line,
                              errors.list[k].place.column, errors.list[k].text);
    assert_string_equal(all, told);
    namelist_errors_free(&errors);
    deck_free(&d);
}

static void what_keeps_within_its_limits_is_told_nothing(void **state)
{
    (void)state;
    expect((limits){6e9, 1e6, 6e9}, LIMITS_KEPT, "");
    expect((limits){INFINITY, INFINITY, INFINITY}, LIMITS_KEPT, "");
}

static void what_exceeds_one_is_told_which_where_and_by_what_option(void **state)
{
    (void)state;
    expect((limits){5e9, 1e6, 6e9}, LIMITS_MEMORY,
           "5:2 the run takes at least 6 GB of memory for its 5e+06 nodes; the limit is 5 GB, and --max-memory sets "
           "it\n");
    expect((limits){6e9, 5e5, 6e9}, LIMITS_STEPS,
           "1:6 't_end' in &run, 1 s, takes at least 1e+06 steps of 1e-06 s; the limit is 5e+05, and --max-steps sets "
           "it\n");
    expect((limits){6e9, 1e6, 5.9e9}, LIMITS_DISK,
           "7:2 the output takes about 3 GB, 11 frames and 1e+06 steps until 't_end', twice while it is put together; "
           "the limit is 5.9 GB, and --max-disk sets it\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_above_zero_set_limits),
        cmocka_unit_test(what_is_no_number_above_zero_sets_nothing),
        cmocka_unit_test(the_least_limit_of_all_groups_above_counts),
        cmocka_unit_test(the_disk_has_what_is_free_and_what_the_run_has_taken),
        cmocka_unit_test(what_keeps_within_its_limits_is_told_nothing),
        cmocka_unit_test(what_exceeds_one_is_told_which_where_and_by_what_option),
    };
    if (mkdtemp(folder) == NULL) return 1;
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return rmdir(folder) == 0 ? failed : 1;
}
