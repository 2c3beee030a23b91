/* SPDX-License-Identifier: BSD-3-Clause */
/* output.c: what a run finds in its folder, made by runs of one node. */
#include "verification/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <sys/stat.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "decimal.h"
#include "output.h"
#include "unit/scratch.h"

static const char *path, *part;

static const deck mine = {.hash = 0x0123456789abcdef, .run_hash = 0xfedcba9876543210, .t_end = 1.0};

/* What a run of this deck leaves; without an end it is the part. */
static void leave_run(const deck *d, int finished)
{
    double x[2] = {0.0, 0.0}, mass = 1.0;
    char problem[OUTPUT_HASH], hash[OUTPUT_HASH], t_end[DECIMAL_SIZE];
    dem_options options = dem_options_default();
    dem_trajectory_options trajectory_options = dem_trajectory_options_default();
    dem_trajectory *trajectory;
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = 1, lattice.x = x, lattice.mass = &mass;
    options.spacing = 1.0, options.max_step = 1.0, options.v_scale = 1.0;
    dem_model *model = support_model(&lattice, NULL, 0);
    dem_simulation *simulation = support_simulation(model, &options);
    assert_ok(dem_trajectory_create(&trajectory, path, simulation, &trajectory_options));
    output_print_hash(problem, d->hash);
    output_print_hash(hash, d->run_hash);
    assert_ok(dem_trajectory_note(trajectory, "problem", problem));
    assert_ok(dem_trajectory_note(trajectory, "run", hash));
    decimal_print(t_end, d->t_end);
    assert_ok(dem_trajectory_note(trajectory, "t_end", t_end));
    if (finished) assert_ok(dem_trajectory_finish(trajectory));
    dem_trajectory_destroy(trajectory);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
}

static void leave_text(const char *name)
{
    file_put(name, "something else", strlen("something else"));
}

/* Whatever it finds, it says so, and it touches nothing. */
static void expect_claim(output_state expected)
{
    char reason[OUTPUT_REASON] = "";
    struct stat before[2] = {0}, after[2] = {0};
    const int n_before = (stat(path, &before[0]) == 0) + (stat(part, &before[1]) == 0);
    const output_state got = output_claim(path, &mine, reason);
    const int n_after = (stat(path, &after[0]) == 0) + (stat(part, &after[1]) == 0);
    if (got != expected) fail_msg("%d, expected %d: %s", (int)got, (int)expected, reason);
    if (got != OUTPUT_FREE) assert_true(strlen(reason) > 0);
    assert_int_equal(n_after, n_before);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(after[k].st_size, before[k].st_size);
        assert_int_equal(after[k].st_mtim.tv_nsec, before[k].st_mtim.tv_nsec);
    }
}

/* ---- names ---- */

TEST_WITH(a_hash_has_sixteen_digits, NULL, scratch_sweep)
{
    char text[OUTPUT_HASH];
    output_print_hash(text, UINT64_C(0x0123456789abcdef));
    assert_string_equal(text, "0123456789abcdef");
    output_print_hash(text, 0);
    assert_string_equal(text, "0000000000000000");
    output_print_hash(text, UINT64_MAX);
    assert_string_equal(text, "ffffffffffffffff");
}

TEST_WITH(an_output_lies_in_its_folder, NULL, scratch_sweep)
{
    char text[64];
    assert_true(output_path(text, sizeof text, ".", "drop"));
    assert_string_equal(text, "drop.vtkhdf");
    assert_true(output_path(text, sizeof text, "runs/1", "drop"));
    assert_string_equal(text, "runs/1/drop.vtkhdf");
    assert_true(output_path(text, sizeof text, "..", "a.b"));
    assert_string_equal(text, "../a.b.vtkhdf");
}

/* The part's name is longer by ".part": what is accepted leaves room for it. */
TEST_WITH(a_path_that_does_not_fit_is_refused, NULL, scratch_sweep)
{
    char text[64], name[64] = "";
    for (size_t n = 0; n < sizeof name - 1; n++) {
        name[n] = 'x';
        const int fits = output_path(text, sizeof text, "f", name);
        const size_t needed = strlen("f/.part.vtkhdf") + n + 2;
        if (fits) assert_true(needed <= sizeof text);
        if (n == 0) assert_true(fits);
        if (n == sizeof name - 2) assert_false(fits);
    }
}

/* ---- what is found ---- */

TEST_WITH(an_empty_folder_is_free, NULL, scratch_sweep)
{
    expect_claim(OUTPUT_FREE);
}

TEST_WITH(the_same_run_is_done, NULL, scratch_sweep)
{
    leave_run(&mine, 1);
    expect_claim(OUTPUT_DONE);
}

TEST_WITH(another_run_of_the_same_problem_may_go_on_to_a_later_end, NULL, scratch_sweep)
{
    const deck shorter = {.hash = mine.hash, .run_hash = 5, .t_end = 0.75};
    const deck as_long = {.hash = mine.hash, .run_hash = 5, .t_end = mine.t_end};
    const deck longer = {.hash = mine.hash, .run_hash = 5, .t_end = 1.5};
    leave_run(&shorter, 1);
    expect_claim(OUTPUT_SHORTER);
    leave_run(&as_long, 1);
    expect_claim(OUTPUT_SHORTER);
    leave_run(&longer, 1);
    expect_claim(OUTPUT_TAKEN);
}

TEST_WITH(another_problem_is_not_replaced, NULL, scratch_sweep)
{
    const deck other = {.hash = 5, .run_hash = mine.run_hash};
    leave_run(&other, 1);
    expect_claim(OUTPUT_TAKEN);
}

TEST_WITH(a_file_of_another_kind_is_not_replaced, NULL, scratch_sweep)
{
    leave_text(path);
    expect_claim(OUTPUT_TAKEN);
}

TEST_WITH(a_part_of_the_same_problem_may_be_replaced, NULL, scratch_sweep)
{
    const deck longer = {.hash = mine.hash, .run_hash = 5};
    leave_run(&mine, 0);
    expect_claim(OUTPUT_FREE);
    leave_run(&longer, 0);
    expect_claim(OUTPUT_FREE);
}

TEST_WITH(a_part_of_another_problem_is_not_replaced, NULL, scratch_sweep)
{
    const deck other = {.hash = 5, .run_hash = mine.run_hash};
    leave_run(&other, 0);
    expect_claim(OUTPUT_TAKEN);
}

TEST_WITH(a_part_cut_off_at_its_beginning_may_be_replaced, NULL, scratch_sweep)
{
    leave_run(&mine, 0);
    assert_int_equal(truncate(part, 100), 0);
    expect_claim(OUTPUT_FREE);
}

TEST_WITH(the_result_counts_more_than_a_part, NULL, scratch_sweep)
{
    const deck other = {.hash = 5, .run_hash = 5};
    leave_run(&mine, 1);
    leave_run(&other, 0);
    expect_claim(OUTPUT_DONE);
}

TEST_WITH(folders_are_made_down_to_the_last, NULL, scratch_sweep)
{
    char deep[SCRATCH_PATH], deeper[SCRATCH_PATH + 8], at[OUTPUT_PATH], reason[OUTPUT_REASON];
    struct stat found;
    (void)snprintf(deep, sizeof deep, "%s/x", scratch.path);
    (void)snprintf(deeper, sizeof deeper, "%s//y/", deep);
    assert_true(output_make_folder(".", at, reason));
    assert_true(output_make_folder("/", at, reason));
    for (int k = 0; k < 2; k++) { /* the second time they are there */
        assert_true(output_make_folder(deeper, at, reason));
        assert_int_equal(stat(deeper, &found), 0);
        assert_true(S_ISDIR(found.st_mode));
    }
    assert_int_equal(rmdir(deeper), 0);
    assert_int_equal(rmdir(deep), 0);
}

TEST_WITH(what_is_in_the_way_of_a_folder_is_named, NULL, scratch_sweep)
{
    char below[80], at[OUTPUT_PATH], reason[OUTPUT_REASON];
    leave_text(path);
    (void)snprintf(below, sizeof below, "%s/x", path);
    assert_false(output_make_folder(below, at, reason));
    assert_string_equal(at, path);
    assert_string_equal(reason, "the folder cannot be made (Not a directory)");
    assert_int_equal(unlink(path), 0);
    assert_int_equal(symlink("nowhere", path), 0);
    assert_false(output_make_folder(path, at, reason));
    assert_string_equal(at, path);
    assert_string_equal(reason, "the folder cannot be made (No such file or directory)");
}

static void expect_checked(const char *folder, const char *at, const char *reason)
{
    char found[OUTPUT_PATH], why[OUTPUT_REASON] = "";
    assert_int_equal(output_check_folder(folder, found, why), reason[0] == '\0');
    assert_string_equal(why, reason);
    if (reason[0] != '\0') assert_string_equal(found, at);
}

TEST_WITH(a_check_makes_no_folder_and_names_what_is_in_the_way, NULL, scratch_sweep)
{
    char below[SCRATCH_PATH + 8], at[OUTPUT_PATH], reason[OUTPUT_REASON];
    (void)snprintf(below, sizeof below, "%s/x", path);
    expect_checked(".", "", "");
    assert_int_equal(output_check_folder("/", at, reason), access("/", W_OK) == 0); /* it is root's */
    expect_checked(below, "", "");
    assert_int_equal(access(path, F_OK), -1);
    leave_text(path);
    expect_checked(below, path, "the folder cannot be made (Not a directory)");
    assert_int_equal(unlink(path), 0);
    assert_int_equal(symlink("nowhere", path), 0);
    expect_checked(path, path, "the folder cannot be made (No such file or directory)");
}

/* Root may write everywhere: it looks with the rights of another user. */
TEST_WITH(a_check_names_a_folder_that_is_read_only, NULL, scratch_sweep)
{
    const uid_t user = geteuid();
    char at[OUTPUT_PATH], reason[OUTPUT_REASON];
    char first[SCRATCH_PATH + 8], below[SCRATCH_PATH + 8];
    (void)snprintf(first, sizeof first, "%s/x", path);
    (void)snprintf(below, sizeof below, "%s/x/y", path);
    assert_int_equal(chmod(scratch.path, 0755), 0);
    assert_int_equal(mkdir(path, 0555), 0);
    assert_true(user != 0 || seteuid(65534) == 0);
    expect_checked(path, path, "the folder cannot be written to (Permission denied)");
    expect_checked(below, first, "the folder cannot be made (Permission denied)");
    assert_false(output_make_folder(below, at, reason)); /* a run says the same */
    assert_string_equal(at, first);
    assert_string_equal(reason, "the folder cannot be made (Permission denied)");
    assert_int_equal(seteuid(user), 0);
    assert_int_equal(rmdir(path), 0);
}

/* A check that is killed leaves the folder by which it has found out: the next one removes it. */
TEST_WITH(a_check_removes_what_a_killed_one_has_left, NULL, scratch_sweep)
{
    char left[SCRATCH_PATH + 32];
    (void)snprintf(left, sizeof left, "%s/.dem_batch.trial", scratch.path);
    assert_int_equal(mkdir(left, 0700), 0);
    expect_checked(scratch.path, "", "");
    assert_int_equal(access(left, F_OK), -1);
}

/* In /proc nobody makes a file, though its rights let root. */
TEST_WITH(a_check_names_a_folder_that_takes_no_files, NULL, scratch_sweep)
{
    char at[OUTPUT_PATH], reason[OUTPUT_REASON], why[OUTPUT_REASON];
    assert_false(output_check_folder("/proc/x/y", at, reason));
    assert_string_equal(at, "/proc/x");
    assert_false(output_make_folder("/proc/x/y", at, why));
    assert_string_equal(at, "/proc/x");
    assert_string_equal(reason, why);
    assert_false(output_check_folder("/proc", at, reason));
    assert_string_equal(at, "/proc");
}

SCRATCH_GROUP({&path, "a.vtkhdf"}, {&part, "a.part.vtkhdf"});
