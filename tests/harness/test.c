/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/test.h"

#include <stdlib.h>

enum { MOST_TESTS = 128 };

static struct CMUnitTest tests[MOST_TESTS];
static int places[MOST_TESTS];
static size_t n_tests;
static CMFixtureFunction before, after;

void test_add(const struct CMUnitTest *test, int place)
{
    size_t k = n_tests++;
    if (n_tests > MOST_TESTS) abort();
    for (; k > 0 && places[k - 1] > place; k--) {
        tests[k] = tests[k - 1];
        places[k] = places[k - 1];
    }
    tests[k] = *test;
    places[k] = place;
}

void test_group(CMFixtureFunction setup, CMFixtureFunction teardown)
{
    before = setup;
    after = teardown;
}

/* By the function behind cmocka_run_group_tests(), which asks for an array of known length. */
int test_run(void)
{
    return _cmocka_run_group_tests("tests", tests, n_tests, before, after);
}
