/* SPDX-License-Identifier: BSD-3-Clause */
#include "unit/close.h"

#include "kinds.h"

TEST(pairs_are_distinguished_and_in_order)
{
    const kinds_pair pairs[] = {{2.0, 1.0}, {1.0, 5.0}, {2.0, 0.5}, {1.0, 5.0}, {0.0, 7.0}, {2.0, 1.0}};
    const dem_index of[] = {3, 1, 2, 1, 0, 3};
    outcome o = {0};
    const task t = {.outcome = &o};
    CLEANUP(kinds_free) kinds k;
    assert_true(kinds_find(&k, &t, 6, pairs));
    assert_int_equal(k.n, 4);
    assert_memory_equal(k.of, of, sizeof of);
    assert_close(k.values[2].b, 0.5, 0.0);
    assert_close(k.values[3].a, 2.0, 0.0);
}

/* First numbers that differ by rounding must not keep equal second ones apart. */
TEST(rounding_makes_no_kind)
{
    const double e = 1e-15;
    const kinds_pair pairs[] = {{1.0, 3.0}, {1.0 + e, 2.0}, {1.0 + 2.0 * e, 3.0 - 4.0 * e}, {1.0 - e, 2.0 + e}};
    const dem_index of[] = {1, 0, 1, 0};
    outcome o = {0};
    const task t = {.outcome = &o};
    CLEANUP(kinds_free) kinds k;
    assert_true(kinds_find(&k, &t, 4, pairs));
    assert_int_equal(k.n, 2);
    assert_memory_equal(k.of, of, sizeof of);
}

/* Each is near to the next, the last is not near to the first. */
TEST(small_differences_do_not_add_up)
{
    kinds_pair pairs[8];
    outcome o = {0};
    const task t = {.outcome = &o};
    CLEANUP(kinds_free) kinds k;
    for (int j = 0; j < 8; j++) pairs[j] = (kinds_pair){1.0, 1.0 + 0.4e-12 * (double)j};
    assert_true(kinds_find(&k, &t, 8, pairs));
    assert_int_equal(k.n, 3);
    kinds_free(&k);
    for (int j = 0; j < 8; j++) pairs[j] = (kinds_pair){1.0 + 0.4e-12 * (double)j, 1.0};
    assert_true(kinds_find(&k, &t, 8, pairs));
    assert_int_equal(k.n, 3);
}

TEST(of_nothing_there_are_none)
{
    outcome o = {0};
    const task t = {.outcome = &o};
    CLEANUP(kinds_free) kinds k;
    assert_true(kinds_find(&k, &t, 0, NULL));
    assert_int_equal(k.n, 0);
}
