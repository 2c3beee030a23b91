/* SPDX-License-Identifier: BSD-3-Clause */
/* struct_size.c: structs of callers whose header is older or newer than the library. Each is allocated with exactly the
 * size it says, so that a memory checker sees any access beyond it. */
#include "unit/close.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/struct_size.h"
#include "harness/message.h"

/* The library's: its first version ended with `old`. */
typedef struct thing {
    size_t struct_size;
    double old;
    double added[2];
} thing;

static const struct_kind kind = {"thing", STRUCT_SIZE_WITH(thing, old), sizeof(thing)};
static const thing ours = {sizeof ours, 1.0, {2.0, 3.0}};

/* A caller's struct of `size` bytes, all of `fill` but its size. */
static void *make_theirs(size_t size, int fill)
{
    unsigned char *theirs = malloc(size);
    assert_non_null(theirs);
    memset(theirs, fill, size);
    memcpy(theirs, &size, sizeof size);
    return theirs;
}

static void check_read(size_t size, const thing *expected)
{
    thing out = ours;
    CLEANUP(free_memory) void *theirs = make_theirs(size, 0);
    assert_int_equal(struct_size_read(&kind, &out, theirs), DEM_OK);
    assert_memory_equal(&out, expected, sizeof out);
}

TEST(what_an_older_caller_does_not_know_keeps_its_default)
{
    check_read(16, &(thing){sizeof(thing), 0.0, {2.0, 3.0}});
    check_read(24, &(thing){sizeof(thing), 0.0, {0.0, 3.0}});
}

TEST(a_caller_of_the_same_version_sets_all)
{
    check_read(sizeof(thing), &(thing){sizeof(thing), 0.0, {0.0, 0.0}});
}

TEST(a_newer_caller_may_leave_what_is_unknown_here_at_zero)
{
    check_read(sizeof(thing) + 8, &(thing){sizeof(thing), 0.0, {0.0, 0.0}});
    check_read(STRUCT_SIZE_MOST, &(thing){sizeof(thing), 0.0, {0.0, 0.0}});
}

static void refuse(size_t size, unsigned char last, const char *message)
{
    thing out = ours;
    unsigned char *theirs = make_theirs(size, 0);
    if (size > sizeof size) theirs[size - 1] = last;
    assert_int_equal(struct_size_read(&kind, &out, theirs), DEM_ERROR_ARGUMENT);
    assert_message_parts(message);
    assert_memory_equal(&out, &ours, sizeof out);
    free(theirs);
}

TEST(a_newer_caller_may_not_set_what_is_unknown_here)
{
    refuse(sizeof(thing) + 8, 1, "thing: struct_size * 40 * byte 39 * 32");
}

TEST(sizes_of_no_version_are_refused)
{
    size_t none = 0;
    thing out = ours;
    refuse(sizeof(size_t), 0, "thing: struct_size * 8 * 16");
    refuse(15, 0, "thing: struct_size * 15 * 16");
    refuse(STRUCT_SIZE_MOST + 1, 0, "thing: struct_size * 4097 * 4096");
    assert_int_equal(struct_size_read(&kind, &out, &none), DEM_ERROR_ARGUMENT);
    assert_message_parts("thing: struct_size * 0 * 16");
}

/* All bytes are 0xff where nothing has been written: a member of which not all bytes lie within is left alone. */
TEST(what_is_written_ends_where_the_callers_struct_ends)
{
    const double written[3] = {1.0, 2.0, 3.0};
    for (size_t size = sizeof(size_t); size <= sizeof(thing) + 16; size++) {
        unsigned char *theirs = make_theirs(size, 0xff), *expected = make_theirs(size, 0xff);
        const size_t whole = size < sizeof(thing) ? size - size % sizeof(double) : sizeof(thing);
        const bool fits = size >= kind.first;
        if (fits) memcpy(expected + sizeof size, written, whole - sizeof size);
        assert_int_equal(struct_size_write(&kind, theirs, &ours), fits ? DEM_OK : DEM_ERROR_ARGUMENT);
        assert_memory_equal(theirs, expected, size);
        free(expected);
        free(theirs);
    }
}
