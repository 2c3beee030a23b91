/* SPDX-License-Identifier: BSD-3-Clause */
/* streams.c: closed standard streams, and a standard output that cannot be written. */
#include "unit/close.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "streams.h"

/* What a child exits with whose stream `number` is that file, or closed, and which prints something. */
static int exit_of(int number, const char *path, exit_code code)
{
    int status = 0;
    (void)fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        (void)close(number);
        if (path != NULL && open(path, O_WRONLY) != number) _exit(99);
        (void)freopen("/dev/null", "w", stderr);
        streams_begin();
        if (fcntl(number, F_GETFD) < 0) _exit(98);
        (void)printf("# a line\n"); /* which a reader of the test's output takes for a comment */
        _exit(streams_end("test", code));
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

TEST(what_cannot_be_printed_is_a_fault)
{
    assert_int_equal(exit_of(STDOUT_FILENO, "/dev/null", EXIT_DONE), EXIT_DONE);
    assert_int_equal(exit_of(STDOUT_FILENO, "/dev/full", EXIT_DONE), EXIT_IO);
    assert_int_equal(exit_of(STDOUT_FILENO, "/dev/full", EXIT_INVALID), EXIT_INVALID);
}

TEST(closed_streams_are_filled)
{
    assert_int_equal(exit_of(STDOUT_FILENO, NULL, EXIT_DONE), EXIT_IO);
    assert_int_equal(exit_of(STDIN_FILENO, NULL, EXIT_DONE), EXIT_DONE);
}
