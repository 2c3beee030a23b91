/* SPDX-License-Identifier: BSD-3-Clause */
#include "time_label.h"

#include <math.h>
#include <stdio.h>

/* What may be lost of a time: a fiftieth of the shortest way from one to the next. */
static double tolerance(size_t n, const double *t, double largest)
{
    double least = largest;
    for (size_t k = 1; k < n; k++)
        if (t[k] != t[k - 1]) least = fmin(least, fabs(t[k] - t[k - 1]));
    return 0.02 * least;
}

time_label time_label_for(size_t n, const double *t)
{
    double largest = 0.0;
    for (size_t k = 0; k < n; k++) largest = fmax(largest, fabs(t[k]));
    time_label s = {.prefix = ticks_prefix_of(largest)};
    const double lost = tolerance(n, t, largest) / s.prefix.factor;
    for (size_t k = 0; k < n; k++) {
        const double x = t[k] / s.prefix.factor;
        while (s.decimals < 6) {
            const double power = pow(10.0, s.decimals);
            if (fabs(x - round(x * power) / power) <= lost) break;
            s.decimals++;
        }
    }
    return s;
}

void time_label_print(const time_label *s, double t, char text[TIME_LABEL_TEXT])
{
    char digits[TICKS_TEXT];
    ticks_print(digits, t / s->prefix.factor, s->decimals);
    (void)snprintf(text, TIME_LABEL_TEXT, "%s %ss", digits, s->prefix.name);
}
