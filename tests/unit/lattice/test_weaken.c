/* SPDX-License-Identifier: BSD-3-Clause */
/* weaken.c: other strengths, and what stays with them. */
#include <stdlib.h>

#include "harness/message.h"
#include "lattice/crack_band.h"
#include "unit/solids.h"

enum { most = 400 };

static dem_lattice make_breakable(void)
{
    dem_material m = rubber;
    m.strength = 3e6;
    m.critical_stretch = 0.1;
    m.compressive_strength = 2.4e7;
    m.plane = DEM_PLANE_STRAIN;
    dem_lattice lattice = make_rectangle(0.05, 0.05, 0.01);
    assert_int_equal(dem_lattice_assemble(&lattice, &m), DEM_OK);
    assert_true(lattice.n_triangles <= most && lattice.n_springs <= most);
    return lattice;
}

TEST(strengths_and_critical_stretches_are_multiplied)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_breakable();
    double triangles[most], springs[most];
    for (int k = 0; k < most; k++) triangles[k] = 0.5 + k, springs[k] = 2.0 + k;
    lattice.strength[3] = (double)INFINITY;
    assert_int_equal(dem_lattice_weaken(&lattice, triangles, NULL, springs), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t++)
        assert_true(lattice.strength[t] == (t == 3 ? (double)INFINITY : 3e6 * triangles[t]));
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        assert_close(lattice.compressive_strength[t], 2.4e7 * triangles[t], 0.0);
        assert_close(lattice.confinement[t], 8.0, 0.0);
    }
    for (dem_index k = 0; k < lattice.n_springs; k++) assert_close(lattice.critical_stretch[k], 0.1 * springs[k], 0.0);
    assert_null(lattice.softening);
    assert_int_equal(dem_lattice_weaken(&lattice, NULL, NULL, NULL), DEM_OK);
    assert_close(lattice.strength[0], 1.5e6, 0.0);
}

/* The toughness G E/(strength^2 a) of crack_band.c; a brittle triangle has none that could stay. Twice as strong would
 * be too much at q = 5: 7.35/4 is less than 3.4. */
TEST(where_triangles_soften_the_energy_of_a_crack_stays)
{
    static const double factors[] = {0.1, 0.5, 0.9, 1.0, 1.1, 1.4, 2.0, 100.0};
    enum { n = sizeof factors / sizeof *factors };
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_breakable();
    double factor[most];
    lattice.softening = calloc((size_t)lattice.n_triangles, sizeof *lattice.softening);
    assert_non_null(lattice.softening);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        lattice.softening[t] = t < n ? 5.0 : (t < 2 * n ? 1.5 : 1.0);
        factor[t] = factors[t % n];
    }
    assert_int_equal(dem_lattice_weaken(&lattice, factor, NULL, NULL), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        const double before = t < n ? 7.35 : (t < 2 * n ? 3.77 : 3.4), f = lattice.strength[t] / 3e6;
        if (t >= 2 * n) {
            assert_close(f, factor[t], 1e-15 * factor[t]);
            assert_close(lattice.softening[t], 1.0, 0.0);
            continue;
        }
        assert_close(crack_band_toughness(crack_band_of(CRACK_BAND_CORNERS), lattice.softening[t]) * f * f, before,
                     1e-13 * before);
        assert_close(f, fmin(factor[t], sqrt(before / 3.4)), 1e-14 * f);
        assert_true((lattice.softening[t] > 1.0) == (factor[t] < sqrt(before / 3.4)));
    }
}

/* 7.35 g f^-2 of what it is over strength^2 a/E; at less than 3.4 it is brittle, with the strength of that energy. */
TEST(an_energy_is_multiplied_where_triangles_soften)
{
    static const double energies[] = {0.1, 0.4, 0.9, 1.0, 3.0}, strengths[] = {0.5, 1.0, 1.3};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_breakable();
    double of_energy[most], of_strength[most];
    lattice.softening = calloc((size_t)lattice.n_triangles, sizeof *lattice.softening);
    assert_non_null(lattice.softening);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        lattice.softening[t] = t < 15 ? 5.0 : 1.0;
        of_energy[t] = energies[t % 5];
        of_strength[t] = strengths[t % 3];
    }
    assert_int_equal(dem_lattice_weaken(&lattice, of_strength, of_energy, NULL), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        const double f = lattice.strength[t] / 3e6, energy = 7.35 * of_energy[t];
        if (t < 15)
            assert_close(crack_band_toughness(crack_band_of(CRACK_BAND_CORNERS), lattice.softening[t]) * f * f, energy,
                         1e-13 * energy);
        assert_close(f, t < 15 ? fmin(of_strength[t], sqrt(energy / 3.4)) : of_strength[t], 1e-14 * f);
    }
}

/* By their own stress triangles have another toughness, and soften by q = 3 at least. */
TEST(the_energy_stays_where_the_stress_of_elements_lets_them_soften)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_breakable();
    double factor[most];
    lattice.softening = calloc((size_t)lattice.n_triangles, sizeof *lattice.softening);
    lattice.own_stress = calloc((size_t)lattice.n_triangles, 1);
    assert_true(lattice.softening != NULL && lattice.own_stress != NULL);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        lattice.softening[t] = 6.0;
        lattice.own_stress[t] = 1;
        factor[t] = 0.5 + 0.1 * (double)(t % 12);
    }
    assert_int_equal(dem_lattice_weaken(&lattice, factor, NULL, NULL), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        const double f = lattice.strength[t] / 3e6, before = 0.2 + 0.48 * 6.0;
        assert_close((0.2 + 0.48 * lattice.softening[t]) * f * f, before, 1e-13 * before);
        assert_close(f, fmin(factor[t], sqrt(before / (0.2 + 0.48 * 3.0))), 1e-14 * f);
    }
}

/* Halves of cells have the toughness of cells. */
TEST(the_energy_of_softening_cells_stays)
{
    dem_material m = rubber;
    m.strength = 3e6;
    m.fracture_energy = 30.0 * m.strength * m.strength * 0.01 / m.youngs_modulus;
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_squares(&lattice, 0.05, 0.05, 0.01), DEM_OK);
    assert_int_equal(dem_lattice_assemble_squares(&lattice, &m, 0.5), DEM_OK);
    const crack_band *band = crack_band_of(CRACK_BAND_CELLS);
    const double before = crack_band_toughness(band, lattice.softening[0]);
    double factor[most];
    for (dem_index t = 0; t < lattice.n_triangles; t++) factor[t] = 0.6 + 0.1 * (double)(t % 12);
    assert_int_equal(dem_lattice_weaken(&lattice, factor, NULL, NULL), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t++)
        assert_close(crack_band_toughness(band, lattice.softening[t]) * factor[t] * factor[t], before, 1e-13 * before);
}

TEST(factors_that_are_none_change_nothing)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_breakable();
    static const double bad[] = {0.0, -1.0, (double)NAN, (double)INFINITY};
    double factor[most];
    for (int k = 0; k < 12; k++) {
        for (int i = 0; i < most; i++) factor[i] = 0.5;
        factor[7] = bad[k % 4];
        const double *of_strength = k < 4 ? factor : NULL, *of_energy = k >= 4 && k < 8 ? factor : NULL;
        assert_int_equal(dem_lattice_weaken(&lattice, of_strength, of_energy, k < 8 ? NULL : factor),
                         DEM_ERROR_ARGUMENT);
        assert_message_parts(k < 8 ? "triangle 7 * factor * > 0" : "spring 7 * factor * > 0");
        assert_close(lattice.strength[0], 3e6, 0.0);
        assert_close(lattice.critical_stretch[0], 0.1, 0.0);
    }
    assert_int_equal(dem_lattice_weaken(NULL, NULL, NULL, NULL), DEM_ERROR_ARGUMENT);
}
