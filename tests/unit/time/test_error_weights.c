/* SPDX-License-Identifier: BSD-3-Clause */
/* error_weights.c: what each number of a state weighs, and sums of squares of any part of a state, beside sums that are
 * taken number by number; with all nodes here, and with own nodes and ghosts in runs of many lengths. */
#include "unit/close.h"

#include <string.h>

#include "time/error_weights.h"

enum { N_NODES = 3001, N_WHOLE = 5000 };

typedef struct bench {
    unsigned char is_own[N_NODES];
    ode_domain domain;
    ode_problem problem;
    error_weights *weights;
} bench;

/* In place, as the problem keeps the domain's address.  \param run  nodes of a run; 0: all are here */
static void begin(bench *b, int run)
{
    memset(b, 0, sizeof *b);
    for (int i = 0; i < N_NODES && run > 0; i++) b->is_own[i] = i / run % 2 == 0;
    b->domain = (ode_domain){.whole = state_layout_of(2, N_WHOLE, 2, true), .is_own = b->is_own};
    b->problem = (ode_problem){.layout = state_layout_of(2, N_NODES, 2, true),
                               .domain = run > 0 ? &b->domain : NULL,
                               .position_error = 0.25,
                               .velocity_error = 3.0,
                               .ops = array_ops_fastest()};
    b->weights = error_weights_create(&b->problem);
    assert_non_null(b->weights);
}

static void end(bench *b)
{
    error_weights_free(b->weights);
}

/* share/position_error and share/velocity_error, with share^2 = n_rows/n_nodes of the whole. */
static double expected(const bench *b, dem_index k)
{
    const state_layout *l = &b->problem.layout, *whole = b->problem.domain != NULL ? &b->domain.whole : l;
    const dem_index node = k % state_velocities(l) / 2;
    const double share = sqrt((double)whole->n_rows / (double)whole->n_nodes);
    if (node >= N_NODES || (b->problem.domain != NULL && !b->is_own[node])) return 1e-100;
    return share / (k < state_velocities(l) ? 0.25 : 3.0);
}

static double number(dem_index k)
{
    return sin(1.0 + 0.37 * (double)k);
}

static const int runs[] = {0, 1, 2, 7, 300, 512, 700, N_NODES};

TEST(each_number_weighs_what_its_node_does)
{
    for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
        CLEANUP(end) bench b;
        begin(&b, runs[r]);
        for (dem_index k = 0; k < state_size(&b.problem.layout); k++)
            assert_close(error_weights_at(b.weights, k), expected(&b, k), 0.0);
    }
}

/* Number by number, by the sum of one. */
static array_ops_sum sum_of(const bench *b, dem_index first, dem_index n, double scale)
{
    array_ops_sum sum = {0};
    for (dem_index k = first; k < first + n; k++) {
        const double x = number(k), w = expected(b, k);
        b->problem.ops->square(&sum, &x, &w, scale, 1);
    }
    return sum;
}

TEST(squares_of_any_part_have_the_bits_of_one_by_one)
{
    for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
        CLEANUP(end) bench b;
        begin(&b, runs[r]);
        const dem_index size = state_size(&b.problem.layout);
        const dem_index parts[][2] = {{0, size}, {0, 1}, {3, 1024}, {1023, 1026}, {5999, 3000}, {size - 5, 5}, {7, 0}};
        for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
            const dem_index first = parts[p][0], n = parts[p][1];
            CLEANUP(free_memory) double *x = aligned_reals((size_t)n);
            assert_non_null(x);
            for (dem_index k = 0; k < n; k++) x[k] = number(first + k);
            array_ops_sum sum = {0};
            const array_ops_sum whole = sum_of(&b, first, n, 0x1p-2);
            error_weights_square(b.weights, &sum, x, 0x1p-2, first, n);
            assert_memory_equal(&sum, &whole, sizeof sum);
        }
    }
}

/* What does not weigh is not finite all the same. */
TEST(a_ghost_that_is_no_number_shows)
{
    CLEANUP(end) bench b;
    begin(&b, 1);
    const double x[4] = {1.0, 1.0, 1.0, (double)NAN}; /* of an own node and of a ghost */
    array_ops_sum sum = {0};
    error_weights_square(b.weights, &sum, x, 1.0, 0, 4);
    assert_true(isnan(sum.largest) != 0);
}
