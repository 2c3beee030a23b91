/* SPDX-License-Identifier: BSD-3-Clause */
/* A step of an explicit Runge-Kutta method as one pass over the bands of a state: all stages, its end and the sum of
 * squares of its error, to the bits of an evaluation of stage after stage. Of a stage only the bands exist that others
 * still read, so that they stay in the cache. What bands are is in ode_problem.h, how they follow each other in the .c
 * file. */
#ifndef DEM_TIME_STAGE_WAVE_H
#define DEM_TIME_STAGE_WAVE_H

#include "time/butcher.h"
#include "time/error_weights.h"
#include "time/ode_problem.h"

enum {
    STAGE_WAVE_GIVEN = 2, /* arrays that a step begins with, at most */
    STAGE_WAVE_RATES = BUTCHER_STAGES - 1,
    STAGE_WAVE_SUMS = STAGE_WAVE_RATES + 2,
    STAGE_WAVE_TERMS = STAGE_WAVE_GIVEN + STAGE_WAVE_RATES
};

/** A sum of factor times operand, in this order. Operand k is the given array of that number, or behind these the
 *  derivative at stage k - STAGE_WAVE_GIVEN. */
typedef struct stage_sum {
    int n;
    double factor[STAGE_WAVE_TERMS];
    int operand[STAGE_WAVE_TERMS];
} stage_sum;

/** What a step consists of; arrays as long as a state, at a cache line. */
typedef struct stage_program {
    const double *given[STAGE_WAVE_GIVEN];
    int n_stages;                    /* whose derivatives are evaluated, */
    double t[STAGE_WAVE_RATES];      /* at these times, s, */
    stage_sum sums[STAGE_WAVE_SUMS]; /* in these states; behind them come the end of the step and its error */
    double *end;                     /* is written, and is none of those given */
    const error_weights *weights;
    double scale; /* of the squares: those of scale times weight times error are summed up */
} stage_program;

typedef struct stage_wave stage_wave;

/** Room for the bands of steps of at most so many stages; borrows the problem. NULL without memory, or if a wave does
 *  not pay: if evaluations are not by bands, or the arrays of whole stages are in the cache anyway. Free with
 *  stage_wave_free(). */
stage_wave *stage_wave_create(const ode_problem *problem, int n_stages);
void stage_wave_free(stage_wave *w);

/** Takes the step.  \return false if something is not finite, or was not to be had by bands; the end is undefined
 *  then */
bool stage_wave_run(stage_wave *w, const stage_program *program, array_ops_sum *squares);

#endif
