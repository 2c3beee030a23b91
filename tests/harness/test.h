/* SPDX-License-Identifier: BSD-3-Clause */
/* CMocka with its includes in their order, and tests that enter themselves into the list of their program. main.c runs
 * them in the order of their lines. A program with arguments has its own main(), which calls test_run(). */
#ifndef DEM_TEST_TEST_H
#define DEM_TEST_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/cleanup.h"

/** The initializer of a struct of the library, which begins with its size: `SIZED(dem_obstacle, .n_points = 2)`. */
#define SIZED(type, ...)                                                                                               \
    {                                                                                                                  \
        .struct_size = sizeof(type), __VA_ARGS__                                                                       \
    }

/** Enters a test, which runs after those of lower places. */
void test_add(const struct CMUnitTest *test, int place);

/** What runs before the first test and after the last one. */
void test_group(CMFixtureFunction setup, CMFixtureFunction teardown);

/** Runs all tests.
 *  \returns how many failed */
int test_run(void);

/** Enters a function as a test; one function may be entered more than once, with an `id` for each. */
#define TEST_ENTER(id, function, setup, teardown, place)                                                               \
    static void function(void **state);                                                                                \
    __attribute__((constructor)) static void test_enter_##id(void)                                                     \
    {                                                                                                                  \
        test_add(&(const struct CMUnitTest){#function, function, setup, teardown, NULL}, place);                       \
    }

/** A test between a setup and a teardown of its own, either of which may be NULL. `*test_state` is what the setup, or
 *  that of the group, made it. */
#define TEST_WITH(name, setup, teardown)                                                                               \
    TEST_ENTER(name, name, setup, teardown, 2 * __LINE__)                                                              \
    static void name(__attribute__((unused)) void **test_state)

/** A test. Its name is a sentence. */
#define TEST(name) TEST_WITH(name, NULL, NULL)

/** One test twice, after one setup and after another. */
#define TEST_TWICE(name, first_setup, second_setup)                                                                    \
    TEST_ENTER(name##_first, name, first_setup, NULL, 2 * __LINE__)                                                    \
    TEST_ENTER(name##_second, name, second_setup, NULL, 2 * __LINE__ + 1)                                              \
    static void name(__attribute__((unused)) void **test_state)

/** What runs before the first test of a file and after its last one; either may be NULL. */
#define TEST_GROUP(setup, teardown)                                                                                    \
    __attribute__((constructor)) static void test_enter_group(void)                                                    \
    {                                                                                                                  \
        test_group(setup, teardown);                                                                                   \
    }                                                                                                                  \
    static void test_enter_group(void)

#endif
