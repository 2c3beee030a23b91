/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/gauss_rule.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

enum { newton_steps = 8 }; /* from Tricomi's estimate 4 are enough for n <= 64; the others change nothing */

/* P_n and its derivative at |x| < 1: k P_k = (2 k - 1) x P_(k-1) - (k - 1) P_(k-2), (1 - x^2) P_n' = n (P_(n-1) - x
 * P_n). */
static double legendre(int n, double x, double *slope)
{
    double p = 1.0, before = 0.0;
    for (int k = 1; k <= n; k++) {
        const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
        before = p;
        p = next;
    }
    *slope = n * (before - x * p) / (1.0 - x * x);
    return p;
}

gauss_rule gauss_rule_of(int n)
{
    gauss_rule rule = {.n = n};
    for (int k = 0; k < (n + 1) / 2; k++) {
        double x = cos(pi * (k + 0.75) / (n + 0.5)), slope;
        if (2 * k + 1 == n) x = 0.0;
        for (int step = 0; step < newton_steps; step++) {
            const double p = legendre(n, x, &slope);
            x -= p / slope;
        }
        (void)legendre(n, x, &slope);
        rule.x[k] = -x;
        rule.x[n - 1 - k] = x;
        rule.weight[k] = rule.weight[n - 1 - k] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    return rule;
}
