/* SPDX-License-Identifier: BSD-3-Clause */
/* namelist_errors.c: faults that are collected. */
#include "unit/close.h"

#include "namelist_errors.h"

TEST(errors_are_sorted_by_place_and_else_stay_in_order)
{
    namelist_errors errors = {0};
    static const namelist_place places[] = {{2, 1}, {1, 7}, {1, 3}, {1, 7}, {1, 3}};
    for (int k = 0; k < 5; k++) namelist_errors_add(&errors, places[k], "%d", k);
    namelist_errors_sort(&errors);
    const char *expected[] = {"2", "4", "1", "3", "0"};
    for (size_t k = 0; k < 5; k++) assert_string_equal(errors.list[k].text, expected[k]);
    namelist_errors_free(&errors);
    assert_int_equal(errors.n, 0);
}

TEST(the_thousandth_stands_for_all_that_follow)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    for (int k = 0; k < 2000; k++) namelist_errors_add(&errors, (namelist_place){1, k}, "%d", k);
    assert_int_equal(errors.n, 1000);
    assert_string_equal(errors.list[998].text, "998");
    assert_string_equal(errors.list[999].text, "too many errors");
    assert_false(errors.out_of_memory);
}
