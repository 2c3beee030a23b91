/* SPDX-License-Identifier: BSD-3-Clause */
/* crack_band.c: that strengths and softening give back the fracture energy that they are made from. */
#include "verification/support.h"

#include "lattice/crack_band.h"

static const double modulus = 72e9, strength = 60e6; /* Pa */

/* G E/(strength^2 a) of docs/fracture.md. */
static double toughness(double energy, double of_strength, double size)
{
    return energy * modulus / (of_strength * of_strength * size);
}

TEST(the_size_is_the_edge_of_an_equilateral_triangle)
{
    assert_close(crack_band_size(0.25 * sqrt(3.0) * 0.02 * 0.02), 0.02, 1e-17);
}

TEST(a_brittle_lattice_has_a_toughness_of_3_4)
{
    const double energy = 8.0, size = 1e-3;
    assert_close(toughness(energy, crack_band_strength(crack_band_of(CRACK_BAND_CORNERS), modulus, energy, size), size),
                 3.4, 1e-14);
}

/* 2.0 + 1.07 q from q = 2 to 6 and 8.42 + 1.29 (q - 6) beyond, 1 at the coarsest lattice and beyond it, and no step in
 * between. */
TEST(softening_has_the_toughness_that_was_measured)
{
    const crack_band *band = crack_band_of(CRACK_BAND_CORNERS);
    const double energy = 2.0, coarsest = crack_band_coarsest(band, modulus, energy, strength);
    double last = 1.0;
    assert_close(toughness(energy, strength, coarsest), 3.4, 1e-14);
    assert_close(crack_band_softening_of(band, toughness(energy, strength, 1.5 * coarsest)), 1.0, 0.0);
    assert_close(crack_band_softening_of(band, toughness(energy, strength, coarsest)), 1.0, 1e-14);
    for (double size = coarsest; size > 0.05 * coarsest; size *= 0.99) {
        const double q = crack_band_softening_of(band, toughness(energy, strength, size));
        assert_true(q >= last && q < last + 0.05 * q); /* 1 % of the size is at most 0.041 times 1.07 of q */
        const double of_softening = q < 6.0 ? 2.0 + 1.07 * q : 8.42 + 1.29 * (q - 6.0);
        if (q >= 2.0) assert_close(of_softening, toughness(energy, strength, size), 1e-12 * q);
        last = q;
    }
    assert_true(last > 30.0);
}

/* 0.2 + 0.48 q from q = 3 on, where triangles are as large as they may. */
TEST(softening_by_the_stress_of_elements_has_its_own_toughness)
{
    const crack_band *band = crack_band_of(CRACK_BAND_OWN_STRESS);
    const double energy = 2.0, coarsest = crack_band_coarsest(band, modulus, energy, strength);
    assert_close(toughness(energy, strength, coarsest), 0.2 + 0.48 * 3.0, 1e-14);
    assert_close(crack_band_softening_of(band, toughness(energy, strength, 1.5 * coarsest)), 3.0, 0.0);
    for (double q = 3.0; q < 50.0; q *= 1.1) {
        assert_close(crack_band_toughness(band, q), 0.2 + 0.48 * q, 1e-14 * q);
        assert_close(crack_band_softening_of(band, 0.2 + 0.48 * q), q, 1e-14 * q);
    }
}

/* At q = 1, 2, 3, 6, and straight lines between and beyond. */
TEST(cells_have_the_toughness_that_was_measured)
{
    const crack_band *band = crack_band_of(CRACK_BAND_CELLS);
    const double points[][2] = {{1.0, 3.3}, {1.5, 3.55}, {2.0, 3.8}, {3.0, 4.8}, {6.0, 8.4}, {12.0, 16.8}};
    for (size_t k = 0; k < sizeof points / sizeof *points; k++) {
        assert_close(crack_band_toughness(band, points[k][0]), points[k][1], 1e-14 * points[k][1]);
        assert_close(crack_band_softening_of(band, points[k][1]), points[k][0], 1e-13);
    }
}
