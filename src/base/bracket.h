/* SPDX-License-Identifier: BSD-3-Clause */
/* The search for a root in time by secants. */
#ifndef DEM_BASE_BRACKET_H
#define DEM_BASE_BRACKET_H

#include <math.h>
#include <stdbool.h>

/* A root between a time when a function is above 0 and one when it is not. Trials are secants in which the value at an
 * end that stays a second time is halved (Illinois): both ends then move, and convergence is faster than linear. A
 * function that jumps may defeat secants: after most_secants of them the middle is taken. */
typedef struct bracket {
    double before, after; /* s */
    double above, below;  /* the values there, of which one may be halved */
    int n, side;          /* trials; which end moved last */
} bracket;

/* A secant is kept half a width off both ends, so that trials near a root close the bracket from both sides. */
static inline double bracket_trial(const bracket *b, double width)
{
    enum { most_secants = 24 };
    const double secant = b->before + (b->after - b->before) * b->above / (b->above - b->below);
    if (b->n >= most_secants || !(secant >= b->before && secant <= b->after)) return 0.5 * (b->before + b->after);
    const double low = b->before + 0.5 * width, high = b->after - 0.5 * width;
    const double up = secant > low ? secant : low; /* fmax() is a call */
    return up < high ? up : high;
}

/* Narrows the bracket to the side of t on which the root is; `beyond` says that the event has happened at t. */
static inline void bracket_close(bracket *b, double t, double value, bool beyond)
{
    const int side = beyond ? 1 : -1;
    const bool again = side == b->side;
    b->n++;
    b->side = side;
    if (beyond) {
        b->after = t;
        b->below = value;
        if (again) b->above *= 0.5;
    } else {
        b->before = t;
        b->above = value;
        if (again) b->below *= 0.5;
    }
}

#endif
