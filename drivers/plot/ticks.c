/* SPDX-License-Identifier: BSD-3-Clause */
#include "ticks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const prefixes[] = {"p", "n", "µ", "m", "", "k", "M", "G", "T"};
enum { UNIT = 4, PREFIXES = sizeof prefixes / sizeof *prefixes };

ticks_prefix ticks_prefix_of(double largest)
{
    const ticks_prefix none = {1.0, ""};
    if (!(largest > 0.0) || isinf(largest)) return none;
    const int thousands = (int)floor(log10(largest * (1.0 + 1e-12)) / 3.0);
    if (thousands < -UNIT || thousands >= PREFIXES - UNIT) return none;
    return (ticks_prefix){pow(10.0, 3.0 * thousands), prefixes[thousands + UNIT]};
}

static const double slack = 1e-9; /* of rounding: 0.3 is three times 0.1 */

double ticks_above(double x)
{
    static const double round[] = {1, 1.5, 2, 3, 4, 5, 6, 8, 10};
    const double power = pow(10.0, floor(log10(x)));
    int k = 0;
    while (round[k] < 10 && round[k] * power < x * (1.0 - slack)) k++;
    return round[k] * power;
}

double ticks_below(double x)
{
    const double power = pow(10.0, floor(log10(x * (1.0 + slack)))), digit = x * (1.0 + slack) / power;
    return (digit >= 5 ? 5 : digit >= 2 ? 2 : 1) * power;
}

int ticks_decimals(double step)
{
    double scaled = fabs(step);
    for (int decimals = 0; decimals < 9; decimals++, scaled *= 10.0)
        if (fabs(scaled - round(scaled)) <= 1e-3 * fabs(step) * pow(10.0, decimals) && round(scaled) > 0)
            return decimals;
    return 9;
}

static ticks multiples(double step, double lo, double hi)
{
    const double rounding = slack * (hi - lo);
    ticks found = {.decimals = ticks_decimals(step)};
    for (double k = ceil((lo - rounding) / step); k * step <= hi + rounding && found.n < TICKS_MOST; k++)
        found.at[found.n++] = k * step;
    return found;
}

ticks ticks_linear(double lo, double hi, int most)
{
    const double room = (hi - lo) / (most - 1);
    double step = ticks_below(room);
    if (step < room * (1.0 - slack)) step = ticks_below(2.5 * step);
    ticks found = multiples(step, lo, hi);
    while (found.n < 2) {
        step = ticks_below(0.5 * step);
        found = multiples(step, lo, hi);
    }
    return found;
}

ticks ticks_decades(double lo, double hi, int most)
{
    ticks found = {.decimals = 0};
    const int first = (int)ceil(log10(lo) - slack), last = (int)floor(log10(hi) + slack);
    const int every = (last - first) / most + 1;
    for (int k = first; k <= last && found.n < TICKS_MOST; k += every) found.at[found.n++] = pow(10.0, k);
    return found;
}

void ticks_print(char text[TICKS_TEXT], double value, int decimals)
{
    char digits[TICKS_TEXT - 4];
    (void)snprintf(digits, sizeof digits, "%.*f", decimals, fabs(value));
    const int zero = strspn(digits, "0.") == strlen(digits);
    (void)snprintf(text, TICKS_TEXT, "%s%s", value < 0 && !zero ? "−" : "", digits);
}

void ticks_print_power(char text[TICKS_TEXT], double value)
{
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const int power = (int)lround(log10(value)), size = power < 0 ? -power : power;
    (void)snprintf(text, TICKS_TEXT, "10%s%s%s", power < 0 ? "⁻" : "", size < 10 ? "" : raised[size / 10 % 10],
                   raised[size % 10]);
}
