/* SPDX-License-Identifier: BSD-3-Clause */
/* sorted.h: every number of lists of every length, and what is between, before and behind them. */
#include "base/sorted.h"

#include "harness/test.h"

TEST(a_number_is_found_where_it_is_and_others_nowhere)
{
    enum { MOST = 17 };
    dem_index list[MOST];
    for (dem_index k = 0; k < MOST; k++) list[k] = 3 * k + k % 2; /* gaps of 2 and 4 */
    for (dem_index n = 0; n <= MOST; n++)
        for (dem_index number = -2; number < 3 * MOST + 3; number++) {
            dem_index expected = -1;
            for (dem_index k = 0; k < n; k++)
                if (list[k] == number) expected = k;
            assert_int_equal(sorted_find(list, n, number), expected);
        }
}
