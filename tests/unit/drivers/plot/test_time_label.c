/* SPDX-License-Identifier: BSD-3-Clause */
/* time_label.c: times as texts. */
#include "unit/close.h"

#include "time_label.h"

static void expect(size_t n, const double *t, const char *const *texts)
{
    const time_label s = time_label_for(n, t);
    for (size_t k = 0; k < n; k++) {
        char text[TIME_LABEL_TEXT];
        time_label_print(&s, t[k], text);
        assert_string_equal(text, texts[k]);
    }
}

TEST(the_largest_has_the_unit)
{
    expect(3, (const double[]){0, 5e-3, 20e-3}, (const char *const[]){"0 ms", "5 ms", "20 ms"});
    expect(2, (const double[]){0, 1.5e-5}, (const char *const[]){"0 µs", "15 µs"});
    expect(2, (const double[]){0.5, 2}, (const char *const[]){"0.5 s", "2.0 s"});
    expect(1, (const double[]){0}, (const char *const[]){"0 s"});
}

TEST(decimals_tell_frames_apart)
{
    expect(3, (const double[]){0, 2.5e-3, 5e-3}, (const char *const[]){"0.0 ms", "2.5 ms", "5.0 ms"});
    expect(3, (const double[]){0, 1e-3 / 3, 2e-3 / 3}, (const char *const[]){"0 µs", "333 µs", "667 µs"});
    expect(2, (const double[]){10.0, 10.001}, (const char *const[]){"10.000 s", "10.001 s"});
}
