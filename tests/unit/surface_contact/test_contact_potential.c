/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_potential.h against the formulas of its law in long double. */
#include "surface_contact/contact_potential.h"

#include "../close.h"

/* What the logarithm loses by cancellation at u = 0.875, where the series takes over: 1e-16/7e-4. Long doubles lose as
 * much at u = 0.98, where the comparison ends. */
static const double cancelled = 2e-13;

static long double energy(long double u)
{
    return -logl(u) - 2.0L * (1.0L - u) + 0.5L * (1.0L - u * u);
}

TEST(the_energy_is_that_of_the_law_at_any_distance)
{
    for (double u = 1e-9; u < 1.0; u = fmin(1.01 * u, u + 0.0009)) {
        const double exact = (double)energy((long double)u);
        if (1.0 - u > 0.02) assert_close(contact_potential_energy(u) / exact, 1.0, cancelled);
    }
}

/* Near the thickness the energy is w^3/3 (1 + 3 w/4 + ...) with w = 1 - u: there even long doubles cancel. */
TEST(surfaces_begin_to_push_with_the_third_power_of_the_depth)
{
    for (double w = 1e-3; w > 1e-7; w *= 0.1) {
        const double u = 1.0 - w, depth = 1.0 - u; /* as rounded in u */
        assert_close(contact_potential_energy(u) / (depth * depth * depth / 3.0), 1.0, depth);
        assert_close(contact_potential_pressure(u) / (depth * depth), 1.0, 2.0 * depth);
        assert_close(contact_potential_stiffness(u) / (2.0 * depth), 1.0, 2.0 * depth);
    }
}

/* Differences of fourth order: what they leave out is h^4 times the fifth derivative over 30, below 1e-11 of the value,
 * beside the rounding of the energy over h. */
TEST(pressure_and_stiffness_are_its_derivatives)
{
    for (double u = 0.1; u < 0.98; u += 0.0137) {
        const double h = 1e-4;
        const double p = -(8.0 * (contact_potential_energy(u + h) - contact_potential_energy(u - h)) -
                           (contact_potential_energy(u + 2.0 * h) - contact_potential_energy(u - 2.0 * h))) /
                         (12.0 * h);
        const double k = -(8.0 * (contact_potential_pressure(u + h) - contact_potential_pressure(u - h)) -
                           (contact_potential_pressure(u + 2.0 * h) - contact_potential_pressure(u - 2.0 * h))) /
                         (12.0 * h);
        assert_close(p, contact_potential_pressure(u), 1e-10 * (1.0 + contact_potential_pressure(u)));
        assert_close(k, contact_potential_stiffness(u), 1e-9 * (1.0 + contact_potential_stiffness(u)));
    }
}
