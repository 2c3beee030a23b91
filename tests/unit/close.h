/* SPDX-License-Identifier: BSD-3-Clause */
/* Comparison of doubles as doubles: CMocka 1.1.5 compares floats. */
#ifndef DEM_TEST_CLOSE_H
#define DEM_TEST_CLOSE_H

#include "harness/test.h"

/** Fails unless |actual - expected| <= tolerance; a NaN fails. */
#define assert_close(actual, expected, tolerance)                                                                      \
    do {                                                                                                               \
        const double close_a_ = (actual), close_e_ = (expected), close_t_ = (tolerance);                               \
        if (!(fabs(close_a_ - close_e_) <= close_t_))                                                                  \
            fail_msg("%s = %.17g, expected %.17g within %g, off by %.3g", #actual, close_a_, close_e_, close_t_,       \
                     close_a_ - close_e_);                                                                             \
    } while (0)

#endif
