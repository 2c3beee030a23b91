/* SPDX-License-Identifier: BSD-3-Clause */
/* lock.c: between processes, which is where such locks are, and within one. */
#include "unit/close.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lock.h"
#include "unit/scratch.h"

static const char *path;

/* What another process gets. */
static lock_status status_elsewhere(char why[256])
{
    int pipes[2], ended;
    assert_int_equal(pipe(pipes), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        lock l = {.file = -1};
        char text[256] = "";
        const lock_status status = lock_take(&l, path, text, sizeof text);
        if (write(pipes[1], text, sizeof text) != sizeof text) _exit(99);
        lock_release(&l);
        _exit((int)status);
    }
    assert_int_equal(read(pipes[0], why, 256), 256);
    assert_int_equal(waitpid(child, &ended, 0), child);
    (void)close(pipes[0]);
    (void)close(pipes[1]);
    assert_true(WIFEXITED(ended));
    return (lock_status)WEXITSTATUS(ended);
}

TEST(only_one_process_holds_it)
{
    char why[256], expected[64];
    lock l = {.file = -1};
    assert_int_equal(lock_take(&l, path, why, sizeof why), LOCK_HELD);
    assert_int_equal(status_elsewhere(why), LOCK_TAKEN);
    (void)snprintf(expected, sizeof expected, "process %ld on ", (long)getpid());
    assert_memory_equal(why, expected, strlen(expected));
    assert_non_null(strstr(why, " is writing this output"));
    lock_release(&l);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_int_equal(status_elsewhere(why), LOCK_HELD);
    lock_release(&l); /* of none is nothing */
}

/* Nor does the one that is refused let go of it. */
TEST(only_one_run_of_a_process_holds_it)
{
    char why[256];
    lock l = {.file = -1}, second = {.file = -1};
    assert_int_equal(lock_take(&l, path, why, sizeof why), LOCK_HELD);
    assert_int_equal(lock_take(&second, path, why, sizeof why), LOCK_TAKEN);
    assert_string_equal(why, "another run of this process is writing this output");
    lock_clear(path);
    assert_int_equal(status_elsewhere(why), LOCK_TAKEN);
    lock_release(&l);
    assert_int_equal(lock_take(&second, path, why, sizeof why), LOCK_HELD);
    lock_release(&second);
}

/* A file that a killed process has left behind locks nobody out, whatever is in it. */
TEST(what_is_left_behind_is_no_lock)
{
    char why[256];
    lock l = {.file = -1};
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int k = 0; k < 1000; k++) (void)fputs("process 1 on elsewhere", file);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(lock_take(&l, path, why, sizeof why), LOCK_HELD);
    assert_int_equal(status_elsewhere(why), LOCK_TAKEN);
    assert_null(strstr(why, "elsewhere"));
    lock_release(&l);
    assert_int_not_equal(access(path, F_OK), 0);
}

TEST(a_folder_that_is_not_there_has_none)
{
    char why[256];
    lock l = {.file = -1};
    assert_int_equal(lock_take(&l, "no/such/folder.lock", why, sizeof why), LOCK_FAILED);
    assert_string_equal(why, "cannot be created (No such file or directory)");
    assert_int_equal(l.file, -1);
}

/* Each child takes the lock, or finds that it is taken, many times; who has it finds nobody else's mark, though files
 * come and go all the time. */
TEST(no_two_hold_it_at_any_time)
{
    enum { children = 4, rounds = 200 };
    const char *mark = scratch_file("mark");
    for (int c = 0; c < children; c++) {
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child > 0) continue;
        int failed = 0;
        for (int k = 0; k < rounds; k++) {
            char why[256];
            lock l = {.file = -1};
            if (lock_take(&l, path, why, sizeof why) != LOCK_HELD) continue;
            FILE *file = fopen(mark, "wx"); /* fails if it is there */
            failed |= file == NULL || fclose(file) != 0 || unlink(mark) != 0;
            lock_release(&l);
        }
        _exit(failed);
    }
    for (int c = 0; c < children; c++) {
        int ended;
        assert_true(wait(&ended) > 0);
        assert_true(WIFEXITED(ended));
        assert_int_equal(WEXITSTATUS(ended), 0);
    }
    assert_int_not_equal(access(path, F_OK), 0);
}

SCRATCH_GROUP({&path, "a.lock"});
