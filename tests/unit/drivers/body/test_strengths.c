/* SPDX-License-Identifier: BSD-3-Clause */
/* strengths.c: what a lattice and its copies get of what they draw. How it is distributed is test_weibull.c's. */
#include "unit/solids.h"

#include <stdlib.h>
#include <string.h>

#include "strengths.h"

enum { most = 400 };

static dem_lattice make_brittle(double strength, double critical_stretch)
{
    dem_material m = rubber;
    m.strength = strength;
    m.critical_stretch = critical_stretch;
    m.compressive_strength = 9.0 * strength;
    dem_lattice lattice = make_rectangle(0.05, 0.05, 0.01);
    assert_int_equal(dem_lattice_assemble(&lattice, &m), DEM_OK);
    assert_true(lattice.n_triangles <= most && lattice.n_springs <= most);
    return lattice;
}

static dem_weibull law(double shape)
{
    return (dem_weibull)SIZED(dem_weibull, .shape = shape, .volume = 2e-5, .seed = 1);
}

/* Factors by the library, as body 6 of a deck, which no other one has. */
static void factors(double *triangles, double *springs, const dem_lattice *l, double shape, size_t copy)
{
    dem_weibull w = law(shape);
    w.body = 50000 + (dem_index)copy;
    assert_int_equal(dem_lattice_weibull(l, &w, 1, NULL, triangles, springs), DEM_OK);
}

static strengths draw(dem_lattice *l, double shape, size_t n_copies)
{
    dem_weibull w = law(shape);
    const strengths_rule rule = {.laws = &w, .n_laws = 1, .body = 5, .n_copies = n_copies};
    strengths s;
    assert_int_equal(strengths_draw(&s, l, &rule), DEM_OK);
    return s;
}

TEST(a_strength_is_that_of_the_material_times_what_is_drawn)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_brittle(3e6, 0.1);
    double triangles[most], springs[most], least = 1e9;
    factors(triangles, springs, &lattice, 8.0, 0);
    CLEANUP(strengths_free) strengths s = draw(&lattice, 8.0, 1);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        assert_close(lattice.strength[t], 3e6 * triangles[t], 0.0);
        least = fmin(least, lattice.strength[t]);
    }
    for (dem_index k = 0; k < lattice.n_springs; k++) assert_close(lattice.critical_stretch[k], 0.1 * springs[k], 0.0);
    assert_int_equal(s.triangles.n, lattice.n_triangles);
    assert_int_equal(s.springs.n, lattice.n_springs);
    assert_int_equal(s.triangles.n_raised, 0);
    assert_close(s.triangles.least, least, 0.0);
    assert_true(s.triangles.most > 3e6 && s.springs.least < 0.1 && s.springs.most > 0.1);
}

/* With a shape of 1 every fifth or so draws less than 0.2. */
TEST(what_is_drawn_below_a_fifth_is_raised_and_counted)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_brittle(3e6, 0.0);
    double triangles[most];
    dem_index n_raised = 0;
    factors(triangles, NULL, &lattice, 1.0, 0);
    CLEANUP(strengths_free) strengths s = draw(&lattice, 1.0, 1);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        assert_close(lattice.strength[t], 3e6 * fmax(triangles[t], 0.2), 0.0);
        n_raised += triangles[t] < 0.2;
    }
    assert_true(n_raised > 3);
    assert_int_equal(s.triangles.n_raised, n_raised);
    assert_close(s.triangles.least, 6e5, 0.0);
    assert_int_equal(s.springs.n, 0);
}

TEST(every_copy_draws_anew)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_brittle(3e6, 0.1);
    CLEANUP(strengths_free) strengths s = draw(&lattice, 8.0, 3);
    CLEANUP(dem_lattice_free) dem_lattice plain = make_brittle(3e6, 0.1);
    for (size_t c = 0; c < 3; c++) {
        double triangles[most], springs[most];
        strengths_put(&lattice, &s, c);
        factors(triangles, springs, &plain, 8.0, c);
        for (dem_index t = 0; t < lattice.n_triangles; t++) assert_close(lattice.strength[t], 3e6 * triangles[t], 0.0);
        for (dem_index t = 0; t < lattice.n_triangles; t++)
            assert_close(lattice.compressive_strength[t], 2.7e7 * triangles[t], 0.0);
        for (dem_index k = 0; k < lattice.n_springs; k++)
            assert_close(lattice.critical_stretch[k], 0.1 * springs[k], 0.0);
    }
    assert_int_equal(s.triangles.n, lattice.n_triangles); /* of one copy */
}

/* 3.4 at 1, 2.0 + 1.07 q from 2 on, 8.42 + 1.29 (q - 6) from 6 on (crack_band.c): times the square of the strength it
 * is the energy. */
static double energy_of(double strength, double softening)
{
    double toughness = 3.4 + 0.74 * (softening - 1.0);
    if (softening >= 2.0) toughness = 2.0 + 1.07 * softening;
    if (softening >= 6.0) toughness = 8.42 + 1.29 * (softening - 6.0);
    return toughness * strength * strength;
}

TEST(copies_that_soften_keep_the_energy_of_a_crack)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_brittle(3e6, 0.0);
    lattice.softening = calloc((size_t)lattice.n_triangles, sizeof *lattice.softening);
    assert_non_null(lattice.softening);
    for (dem_index t = 0; t < lattice.n_triangles; t++) lattice.softening[t] = 5.0;
    const double energy = energy_of(3e6, 5.0);
    CLEANUP(strengths_free) strengths s = draw(&lattice, 4.0, 2);
    for (size_t c = 0; c < 2; c++) {
        dem_index n_brittle = 0;
        strengths_put(&lattice, &s, c);
        for (dem_index t = 0; t < lattice.n_triangles; t++) {
            assert_close(energy_of(lattice.strength[t], lattice.softening[t]), energy, 1e-12 * energy);
            n_brittle += lattice.softening[t] == 1.0;
        }
        assert_true(n_brittle < lattice.n_triangles / 2);
        assert_true(lattice.softening[0] != 5.0);
    }
}

TEST(without_a_law_strengths_stay)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_brittle(3e6, 0.0);
    CLEANUP(strengths_free) strengths s = draw(&lattice, 0.0, 2);
    strengths_put(&lattice, &s, 1);
    for (dem_index t = 0; t < lattice.n_triangles; t++) assert_close(lattice.strength[t], 3e6, 0.0);
    assert_int_equal(s.triangles.n + s.springs.n, 0);
    assert_null(lattice.critical_stretch);
}

/* The first ten have a law of their own, by which they do not scatter. */
TEST(triangles_without_a_law_do_not_count)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_brittle(3e6, 0.0);
    dem_weibull laws[2] = {law(8.0), law(0.0)};
    dem_index of[most];
    for (dem_index t = 0; t < lattice.n_triangles; t++) of[t] = t < 10;
    const strengths_rule rule = {.laws = laws, .n_laws = 2, .of = of, .n_copies = 1};
    CLEANUP(strengths_free) strengths s;
    assert_int_equal(strengths_draw(&s, &lattice, &rule), DEM_OK);
    for (dem_index t = 0; t < lattice.n_triangles; t++) assert_true((lattice.strength[t] == 3e6) == (t < 10));
    assert_int_equal(s.triangles.n, lattice.n_triangles - 10);
}

TEST(what_never_breaks_draws_nothing)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_brittle(3e6, 0.0);
    for (dem_index t = 0; t < 10; t++) lattice.strength[t] = (double)INFINITY;
    CLEANUP(strengths_free) strengths s = draw(&lattice, 8.0, 1);
    for (dem_index t = 0; t < 10; t++) assert_true(isinf(lattice.strength[t]));
    assert_int_equal(s.triangles.n, lattice.n_triangles - 10);
    assert_true(isfinite(s.triangles.most));
}
