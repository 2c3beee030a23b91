/* SPDX-License-Identifier: BSD-3-Clause */
/* Round numbers, and how they are written beside axes. */
#ifndef DEM_TICKS_H
#define DEM_TICKS_H

/** A prefix of the SI: a number is divided by `factor` and its unit named `name`. */
typedef struct ticks_prefix {
    double factor;
    const char *name;
} ticks_prefix;

/** The prefix with which `largest` has one to three digits before the point; none for 0 and what is out of range. */
ticks_prefix ticks_prefix_of(double largest);

/** The first round number not below x > 0: 1, 1.5, 2, 3, 4, 5, 6 or 8 times a power of ten. */
double ticks_above(double x);

/** The last of 1, 2 or 5 times a power of ten that is not above x > 0. */
double ticks_below(double x);

enum { TICKS_MOST = 12, TICKS_TEXT = 32 };

typedef struct ticks {
    int n;
    double at[TICKS_MOST];
    int decimals; /* with which they are written */
} ticks;

/** Multiples of 1, 2 or 5 times a power of ten in [lo, hi], lo < hi: no more than `most`, which is 2 to TICKS_MOST; but
 *  two at least, for which it may take five. */
ticks ticks_linear(double lo, double hi, int most);

/** Powers of ten in [lo, hi], 0 < lo < hi: every one, or every second, third ... so that there are no more than
 *  `most`. */
ticks ticks_decades(double lo, double hi, int most);

/** The decimals that `step` needs to be written to a thousandth of itself, at most 9. */
int ticks_decimals(double step);

/** With a true minus sign. */
void ticks_print(char text[TICKS_TEXT], double value, int decimals);

/** A power of ten as text: "10" and its exponent, raised. */
void ticks_print_power(char text[TICKS_TEXT], double value);

#endif
