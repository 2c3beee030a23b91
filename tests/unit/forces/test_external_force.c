/* SPDX-License-Identifier: BSD-3-Clause */
/* external_force.c: what is asked, what is answered, and what becomes of a failure. */
#include "forces/external_force.h"

#include <string.h>

#include "harness/message.h"
#include "unit/both_dimensions.h"
#include "unit/close.h"

enum { n_nodes = 4 };

/* Answers with number, place, velocity and time, so that what comes where shows; fails where it is asked to. */
typedef struct source {
    long calls;
    dem_index bad; /* node whose force is not finite; -1: none */
    double bad_value;
    dem_status status;
} source;

static void right(dem_index node, double t, const double *x, const double *v, double *force)
{
    for (int c = 0; c < dim; c++) force[c] = 100.0 * (double)node + t * c + 3.0 * x[c] - 2.0 * v[(c + 1) % dim];
}

static dem_status answer(void *context, const dem_force_query *q, double *force)
{
    source *s = context;
    s->calls++;
    for (dem_index k = 0; k < q->n; k++) {
        for (int c = 0; c < dim; c++) assert_true(force[dim * k + c] == 0.0);
        right(q->nodes[k], q->t, q->x + dim * k, q->v + dim * k, force + dim * k);
        if (q->nodes[k] == s->bad) force[dim * k + dim - 1] = s->bad_value;
    }
    return s->status;
}

static external_force *make(source *s)
{
    dem_options options = dem_options_default();
    external_force *c;
    *s = (source){.bad = -1};
    options.force = answer;
    options.force_context = s;
    assert_int_equal(external_force_create(&c, &options, dim, n_nodes, NULL), DEM_OK);
    assert_non_null(c);
    return c;
}

static const double x[3 * n_nodes] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0};
static const double v[3 * n_nodes] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2};

static void ask_all(external_force *c, double t)
{
    external_force_evaluate(c, &(dem_force_query){t, n_nodes, c->all, x, v});
}

TEST_IN_BOTH(without_a_force_there_is_no_coupling)
{
    const dem_options options = dem_options_default();
    external_force *c = (external_force *)1;
    assert_int_equal(external_force_create(&c, &options, dim, n_nodes, NULL), DEM_OK);
    assert_null(c);
    assert_false(external_force_failed(NULL));
    external_force_destroy(NULL);
}

TEST_IN_BOTH(one_node_has_the_same_answer_as_all)
{
    source s;
    external_force *c = make(&s);
    ask_all(c, 0.25);
    assert_int_equal(s.calls, 1);
    for (dem_index i = 0; i < n_nodes; i++) {
        const size_t size = (size_t)dim * sizeof(double);
        double wanted[3], alone[3];
        right(i, 0.25, x + dim * i, v + dim * i, wanted);
        external_force_of_node(c, 0.25, i, x + dim * i, v + dim * i, alone);
        assert_memory_equal(c->value + dim * i, wanted, size);
        assert_memory_equal(alone, wanted, size);
    }
    assert_int_equal(s.calls, 1 + n_nodes);
    external_force_destroy(c);
}

TEST_IN_BOTH(power_is_force_times_velocity)
{
    source s;
    double power = 0.0;
    external_force *c = make(&s);
    ask_all(c, 2.0);
    for (dem_index i = 0; i < n_nodes; i++) {
        double force[3];
        right(i, 2.0, x + dim * i, v + dim * i, force);
        for (int k = 0; k < dim; k++) power += force[k] * v[dim * i + k];
    }
    exact_sum sum = {0};
    exact_terms terms;
    exact_terms_begin(&terms, &sum);
    external_force_add_power(c, v, &terms);
    exact_terms_end(&terms);
    assert_close(exact_sum_value(&sum), power, 1e-15 * power);
    external_force_destroy(c);
}

/* Nobody is asked any more, and forces are 0, until the failure has been reported. */
static void fail_and_recover(external_force *c, source *s, dem_status status, const char *message)
{
    static const double nothing[3 * n_nodes];
    const size_t row = (size_t)dim * sizeof(double), all = n_nodes * row;
    ask_all(c, 0.5);
    assert_true(external_force_failed(c));
    assert_memory_equal(c->value, nothing, all);
    const long calls = s->calls;
    ask_all(c, 0.75);
    double alone[3];
    external_force_of_node(c, 0.75, 0, x, v, alone);
    assert_memory_equal(c->value, nothing, all);
    assert_memory_equal(alone, nothing, row);
    assert_int_equal(s->calls, calls);
    assert_int_equal(external_force_failure(c), status);
    assert_message_parts(message);
    assert_false(external_force_failed(c));
    *s = (source){.bad = -1};
    ask_all(c, 0.75);
    assert_false(external_force_failed(c));
    assert_int_equal(s->calls, 1);
}

TEST_IN_BOTH(a_failure_lasts_until_it_is_reported)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    source s;
    external_force *c = make(&s);
    s.status = DEM_STOPPED;
    fail_and_recover(c, &s, DEM_STOPPED, "the external force was refused at t = 0.5 s");
    s.status = DEM_ERROR_IO;
    fail_and_recover(c, &s, DEM_ERROR_IO, "the external force was refused at t = 0.5 s");
    for (int k = 0; k < 3; k++) {
        s.bad = 2;
        s.bad_value = bad[k];
        fail_and_recover(c, &s, DEM_ERROR_INTEGRATOR, "the external force on node 2 is not finite at t = 0.5 s");
    }
    external_force_destroy(c);
}
