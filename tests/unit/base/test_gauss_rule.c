/* SPDX-License-Identifier: BSD-3-Clause */
/* gauss_rule.c: powers are integrated exactly as far as they should be, points and weights are those of GSL. */
#include "base/gauss_rule.h"

#include <gsl/gsl_integration.h>
#include <math.h>

#include "../close.h"

TEST(powers_are_integrated_exactly_up_to_twice_the_number_of_points)
{
    for (int n = 1; n <= GAUSS_RULE_MOST; n++) {
        const gauss_rule rule = gauss_rule_of(n);
        for (int power = 0; power < 2 * n; power++) {
            double sum = 0.0;
            for (int k = 0; k < n; k++) sum += rule.weight[k] * pow(rule.x[k], power);
            assert_close(sum, power % 2 == 0 ? 2.0 / (power + 1.0) : 0.0, 1e-14);
        }
    }
}

TEST(points_ascend_and_are_those_of_gsl)
{
    for (int n = 1; n <= GAUSS_RULE_MOST; n++) {
        const gauss_rule rule = gauss_rule_of(n);
        gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc((size_t)n);
        assert_non_null(table);
        for (int k = 0; k < n; k++) {
            double x, weight;
            assert_int_equal(gsl_integration_glfixed_point(-1.0, 1.0, (size_t)k, &x, &weight, table), 0);
            assert_close(rule.x[k], x, 4e-16);
            assert_close(rule.weight[k], weight, 2e-11); /* a table of GSL's has errors of 1e-11 */
            assert_true(k == 0 || rule.x[k] > rule.x[k - 1]);
            assert_true(rule.x[k] == -rule.x[n - 1 - k] && rule.weight[k] == rule.weight[n - 1 - k]);
        }
        gsl_integration_glfixed_table_free(table);
    }
}
