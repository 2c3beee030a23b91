/* SPDX-License-Identifier: BSD-3-Clause */
/* assemble.c: springs, masses and what triangles have, of triangulations and of square cells. */
#include <stdbool.h>

#include "unit/solids.h"
#include "harness/message.h"

static const double spacing = 2.5e-3; /* m */

/* Triangles with both ends of a spring among their corners. */
static int triangles_at(const dem_lattice *lattice, dem_index spring)
{
    int n = 0;
    for (dem_index t = 0; t < lattice->n_triangles; t++) {
        int shared = 0;
        for (int c = 0; c < 3; c++)
            for (int e = 0; e < 2; e++) shared += lattice->triangles[3 * t + c] == lattice->ends[2 * spring + e];
        n += shared == 2;
    }
    return n;
}

#define assert_refused(call, status, message)                                                                          \
    do {                                                                                                               \
        assert_int_equal(call, status);                                                                                \
        assert_message_parts(message);                                                                                 \
    } while (0)

/* ---- triangulations ---- */

TEST(springs_come_by_lower_then_upper_node_without_duplicates)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.03, 0.03, spacing);
    assert_int_equal(lattice.n_nodes - lattice.n_springs + lattice.n_triangles, 1); /* Euler */
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        const dem_index *end = lattice.ends + 2 * k;
        assert_true(end[0] < end[1]);
        if (k > 0) assert_true(end[-2] < end[0] || (end[-2] == end[0] && end[-1] < end[1]));
        assert_close(lattice.rest_length[k], spacing, 1e-13 * spacing);
    }
}

TEST(stiffness_is_that_of_finite_elements_and_half_of_it_on_the_boundary)
{
    const double inside = sqrt(3.0) / 2.0 * rubber.youngs_modulus * rubber.thickness * spacing;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.03, 0.03, spacing);
    dem_index n_boundary = 0;
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        const int n = triangles_at(&lattice, k);
        assert_true(n == 1 || n == 2);
        assert_close(lattice.stiffness[k], 0.5 * n * inside, 1e-12 * inside);
        n_boundary += n == 1;
    }
    assert_int_equal(n_boundary, 3 * lattice.n_triangles - 2 * (lattice.n_springs - n_boundary));
}

TEST(masses_guard_thickness_and_modulus_are_those_of_the_triangles)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.08, 0.13, spacing);
    const double share = rubber.density * rubber.thickness * sqrt(3.0) / 12.0 * spacing * spacing;
    double mass = 0.0;
    for (dem_index i = 0; i < lattice.n_nodes; i++) mass += lattice.mass[i];
    assert_close(mass, 3.0 * share * (double)lattice.n_triangles, 1e-12 * mass);
    assert_close(lattice.mass[0], share, 1e-12 * share); /* the corner belongs to one triangle */
    assert_close(lattice.mass[33 + 1], 6.0 * share, 1e-11 * share);
    for (dem_index t = 0; t < lattice.n_triangles; t++) {
        assert_close(lattice.guard[t], 0.02 * 1e7 * 0.5, 1e-9);
        assert_close(lattice.thickness[t], 0.5, 0.0);
        assert_close(lattice.modulus[t], 1e7, 0.0);
    }
}

TEST(a_material_without_guard_leaves_guard_NULL)
{
    dem_material plain = rubber;
    plain.guard = 0.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.03, 0.03, spacing);
    assert_int_equal(dem_lattice_assemble(&lattice, &plain), DEM_OK);
    assert_null(lattice.guard);
    assert_non_null(lattice.mass);
}

TEST(viscosity_is_damping_time_times_stiffness)
{
    dem_material damped = rubber;
    damped.damping_time = 3e-5;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = make_rectangle(0.03, 0.03, spacing), plain = make_solid(0.03, 0.03, spacing);
    assert_null(plain.viscosity);
    assert_int_equal(dem_lattice_assemble(&lattice, &damped), DEM_OK);
    assert_memory_equal(lattice.stiffness, plain.stiffness, (size_t)plain.n_springs * sizeof(double));
    for (dem_index k = 0; k < lattice.n_springs; k++)
        assert_close(lattice.viscosity[k], 3e-5 * plain.stiffness[k], 0.0);
}

/* How much longer the side from one node to another is under x -> (1 + s strain) x. */
static double stretch_of(const dem_lattice *lattice, const dem_index ends[2], const double strain[3], double s)
{
    const double *a = lattice->x + 2 * ends[0], *b = lattice->x + 2 * ends[1];
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    return hypot(dx + s * (strain[0] * dx + strain[2] * dy), dy + s * (strain[2] * dx + strain[1] * dy)) -
           hypot(dx, dy);
}

/* Energy (1), of couplings and of the area term under x -> (1 + s strain) x; strain = xx, yy, xy. */
static double energy_of(const dem_lattice *lattice, const double strain[3], double s)
{
    const double J = (1.0 + s * strain[0]) * (1.0 + s * strain[1]) - s * s * strain[2] * strain[2];
    double energy = 0.0;
    for (dem_index t = 0; t < lattice->n_triangles && lattice->area_stiffness != NULL; t++)
        energy += 0.5 * lattice->area_stiffness[t] * area_of(lattice, t) * (J - 1.0) * (J - 1.0);
    for (dem_index k = 0; k < lattice->n_springs; k++) {
        const double stretch = stretch_of(lattice, lattice->ends + 2 * k, strain, s);
        energy += 0.5 * lattice->stiffness[k] * stretch * stretch / lattice->rest_length[k];
    }
    for (dem_index k = 0; k < 3 * lattice->n_triangles && lattice->coupling != NULL; k++) {
        const dem_index *corner = lattice->triangles + 3 * (k / 3), here = corner[k % 3];
        energy += lattice->coupling[k] * stretch_of(lattice, (dem_index[]){here, corner[(k + 1) % 3]}, strain, s) *
                  stretch_of(lattice, (dem_index[]){here, corner[(k + 2) % 3]}, strain, s);
    }
    return energy;
}

/* Hooke's law of a solid in three dimensions: of plane strain as it is, of plane stress with the strain across that
 * leaves no stress there. The third order in s cancels in the mean of s and -s; the fourth is of order s^2. */
static void expect_energy_of(const dem_material *solid, double jitter, const double e[3])
{
    const double nu = solid->poissons_ratio, s = 1e-4, G = 0.5 * solid->youngs_modulus / (1.0 + nu);
    const double lambda = 2.0 * G * nu / (1.0 - 2.0 * nu);
    const double across = solid->plane == DEM_PLANE_STRAIN ? 0.0 : -nu / (1.0 - nu) * (e[0] + e[1]);
    const double trace = e[0] + e[1] + across;
    const double squares = e[0] * e[0] + e[1] * e[1] + across * across + 2.0 * e[2] * e[2];
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.03, 0.05, spacing);
    const double volume = (double)lattice.n_triangles * sqrt(3.0) / 4.0 * spacing * spacing * solid->thickness;
    assert_int_equal(dem_lattice_jitter(&lattice, jitter * spacing, 3), DEM_OK); /* the boundary stays */
    assert_int_equal(dem_lattice_assemble(&lattice, solid), DEM_OK);
    assert_int_equal(lattice.coupling != NULL, jitter > 0.0);
    const double expected = s * s * volume * (0.5 * lambda * trace * trace + G * squares);
    const double mean = 0.5 * (energy_of(&lattice, e, s) + energy_of(&lattice, e, -s));
    assert_close(mean / expected, 1.0, 1e-7);
}

/* Independent springs of equilateral triangles; coupled ones of any. */
TEST(a_uniformly_strained_block_has_the_energy_of_its_solid)
{
    static const double strains[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, 0}, {1, 1, 0}, {0.3, -0.7, 0.5}};
    static const double ratios[] = {-0.3, 0.0, 0.1, 0.25, 1.0 / 3.0, 0.45};
    dem_material solid = rubber;
    for (int plane = 0; plane < 2; plane++)
        for (size_t n = 0; n < sizeof ratios / sizeof *ratios; n++)
            for (size_t k = 0; k < sizeof strains / sizeof *strains; k++) {
                solid.plane = plane == 0 ? DEM_PLANE_STRESS : DEM_PLANE_STRAIN;
                solid.poissons_ratio = ratios[n];
                solid.springs = DEM_SPRINGS_INDEPENDENT;
                expect_energy_of(&solid, 0.0, strains[k]);
                solid.springs = DEM_SPRINGS_COUPLED;
                expect_energy_of(&solid, 0.3, strains[k]);
            }
}

/* To the bit; without couplings. */
TEST(coupled_springs_of_equilateral_triangles_are_independent)
{
    dem_material solid = rubber;
    solid.springs = DEM_SPRINGS_COUPLED;
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = make_rectangle(0.08, 0.13, spacing), plain = make_solid(0.08, 0.13, spacing);
    assert_int_equal(dem_lattice_assemble(&lattice, &solid), DEM_OK);
    assert_memory_equal(lattice.stiffness, plain.stiffness, (size_t)plain.n_springs * sizeof *plain.stiffness);
    assert_null(lattice.coupling);
}

/* kappa = E h (3 nu - 1)/(2 (1 - nu^2)): at 0.5 E h/3; springs alone have 1/3 in plane stress, 1/4 in plane strain. */
TEST(area_stiffness_is_that_of_poissons_ratio_and_NULL_where_springs_have_it)
{
    const dem_plane planes[3] = {DEM_PLANE_STRESS, DEM_PLANE_STRESS, DEM_PLANE_STRAIN};
    const double ratios[3] = {0.5, 1.0 / 3.0, 0.25};
    for (int k = 0; k < 3; k++) {
        dem_material solid = rubber;
        solid.poissons_ratio = ratios[k], solid.plane = planes[k];
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(0.03, 0.03, spacing);
        assert_int_equal(dem_lattice_assemble(&lattice, &solid), DEM_OK);
        for (dem_index t = 0; k == 0 && t < lattice.n_triangles; t++)
            assert_close(lattice.area_stiffness[t], 1e7 * 0.5 / 3.0, 1e-8);
        if (k > 0) assert_null(lattice.area_stiffness);
    }
}

/* ---- springs of one stiffness ---- */

/* All of E_ij, on the boundary too; no area term. The guard is that of the E h for which the rule of triangles gives
 * E_ij inside: E_ij = sqrt(3)/2 E h a. */
TEST(every_spring_may_have_the_same_stiffness)
{
    const dem_material raw = SIZED(dem_material, .bond_stiffness = 300.0, .density = 1050.0, .thickness = 0.5,
                                   .guard = 0.02, .damping_time = 1e-3);
    CLEANUP(dem_lattice_free)
    dem_lattice lattice = make_rectangle(0.03, 0.03, spacing), plain = make_solid(0.03, 0.03, spacing);
    assert_int_equal(dem_lattice_assemble(&lattice, &raw), DEM_OK);
    assert_int_equal(lattice.n_springs, plain.n_springs);
    assert_memory_equal(lattice.ends, plain.ends, 2 * (size_t)plain.n_springs * sizeof *plain.ends);
    assert_memory_equal(lattice.mass, plain.mass, (size_t)plain.n_nodes * sizeof *plain.mass);
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        assert_close(lattice.stiffness[k], 300.0, 0.0);
        assert_close(lattice.viscosity[k], 0.3, 1e-16);
    }
    for (dem_index t = 0; t < lattice.n_triangles; t++)
        assert_close(lattice.guard[t], 0.02 * 300.0 * 2.0 / sqrt(3.0) / spacing, 1e-9);
    assert_null(lattice.area_stiffness);
    assert_null(lattice.modulus);
}

/* ---- squares ---- */

static dem_lattice make_squares(double width, double height)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_squares(&lattice, width, height, spacing), DEM_OK);
    return lattice;
}

/* Sides k = E h/(1 + nu), half of it on the boundary; diagonals r k; times their lengths. Masses: quarters of cells. */
TEST(squares_have_sides_and_both_diagonals)
{
    const double r = 0.3, k = 1e7 * 0.5 / (1.0 + 1.0 / 3.0), cell = 1050.0 * 0.5 * spacing * spacing;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_squares(4.0 * spacing, 3.0 * spacing);
    dem_index n_sides = 0, n_diagonals = 0;
    assert_int_equal(dem_lattice_assemble_squares(&lattice, &rubber, r), DEM_OK);
    for (dem_index s = 0; s < lattice.n_springs; s++) {
        const dem_index i = lattice.ends[2 * s], j = lattice.ends[2 * s + 1];
        const double *a = lattice.x + 2 * i, *b = lattice.x + 2 * j;
        const bool across = a[0] != b[0] && a[1] != b[1];
        const bool rim =
            (a[0] == b[0] && fabs(a[0]) > 1.5 * spacing) || (a[1] == b[1] && fabs(a[1] - 1.5 * spacing) > spacing);
        const double length = across ? sqrt(2.0) * spacing : spacing, expected = across ? r * k : (rim ? 0.5 * k : k);
        assert_close(lattice.rest_length[s], length, 1e-13 * length);
        assert_close(lattice.stiffness[s], expected * length, 1e-12 * k * length);
        n_sides += !across, n_diagonals += across;
    }
    assert_int_equal(n_sides, 4 * 4 + 5 * 3);
    assert_int_equal(n_diagonals, 2 * 12);
    assert_close(lattice.mass[0], 0.25 * cell, 1e-15 * cell);
    assert_close(lattice.mass[1], 0.5 * cell, 1e-15 * cell);
    assert_close(lattice.mass[6], cell, 1e-15 * cell);
    assert_close(lattice.mass[7], cell, 1e-15 * cell);
    for (dem_index t = 0; t < lattice.n_triangles; t++) assert_close(lattice.guard[t], 0.02 * 1e7 * 0.5, 1e-9);
}

/* C11 = E/(1 - nu^2), C12 = nu C11, C66 = r E/(1 + nu) of plane stress: per area
 * 1/2 (C11 (xx^2 + yy^2) + 2 C12 xx yy + 4 C66 xy^2). Fourth order as above. */
TEST(a_uniformly_strained_block_of_squares_is_cubic)
{
    static const double strains[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0.3, -0.7, 0.5}};
    static const double solids[][2] = {{-0.3, 0.2},      {0.0, 0.2},  {0.0, 0.45},
                                       {1.0 / 3.0, 0.5}, {0.45, 0.5}, {0.45, 1.3}};
    const double s = 1e-4;
    for (size_t n = 0; n < sizeof solids / sizeof *solids; n++) {
        const double nu = solids[n][0], r = solids[n][1], C11 = 5e6 / (1.0 - nu * nu), C66 = r * 5e6 / (1.0 + nu);
        dem_material solid = rubber;
        solid.poissons_ratio = nu;
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_squares(0.03, 0.05);
        assert_int_equal(dem_lattice_assemble_squares(&lattice, &solid, r), DEM_OK);
        const double area = 0.5 * (double)lattice.n_triangles * spacing * spacing;
        for (size_t k = 0; k < sizeof strains / sizeof *strains; k++) {
            const double *e = strains[k], squares = e[0] * e[0] + e[1] * e[1];
            const double expected =
                s * s * area * (0.5 * C11 * (squares + 2.0 * nu * e[0] * e[1]) + 2.0 * C66 * e[2] * e[2]);
            const double mean = 0.5 * (energy_of(&lattice, e, s) + energy_of(&lattice, e, -s));
            assert_close(mean / expected, 1.0, 1e-7);
        }
    }
}

/* nu = r/(1 + r), up to rounding; at r = 1/2, nu = 1/3 exactly. */
TEST(squares_need_no_area_term_at_the_ratio_of_their_diagonals)
{
    dem_material solid = rubber;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_squares(0.03, 0.03);
    assert_int_equal(dem_lattice_assemble_squares(&lattice, &solid, 0.5), DEM_OK);
    assert_null(lattice.area_stiffness);
    dem_lattice_free(&lattice);
    lattice = make_squares(0.03, 0.03);
    solid.poissons_ratio = 0.3 / 1.3;
    assert_int_equal(dem_lattice_assemble_squares(&lattice, &solid, 0.3), DEM_OK);
    for (dem_index t = 0; lattice.area_stiffness != NULL && t < lattice.n_triangles; t++)
        assert_close(lattice.area_stiffness[t], 0.0, 1e-15 * 1e7);
}

/* A rhombus and a trapezium: all mass and no more, springs along all six lines. */
TEST(cells_may_be_any_convex_quadrilaterals)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_squares(2.0 * spacing, spacing);
    lattice.x[2 * 1] += 0.3 * spacing;
    lattice.x[2 * 4 + 1] -= 0.2 * spacing;
    double area = 0.0, mass = 0.0;
    for (dem_index t = 0; t < lattice.n_triangles; t++) area += area_of(&lattice, t);
    assert_int_equal(dem_lattice_assemble_squares(&lattice, &rubber, 0.5), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) mass += lattice.mass[i];
    assert_close(mass, 1050.0 * 0.5 * area, 1e-14 * mass);
    assert_int_equal(lattice.n_springs, 11);
}

TEST(squares_refuse_what_is_no_cell)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_squares(2.0 * spacing, 2.0 * spacing);
    assert_refused(dem_lattice_assemble_squares(&lattice, &rubber, 0.0), DEM_ERROR_ARGUMENT,
                   "stiffness * diagonal * > 0: 0");
    assert_refused(dem_lattice_assemble_squares(&lattice, &rubber, 1.5), DEM_ERROR_ARGUMENT,
                   "stiffness * diagonal * 1 * Poisson's ratio 0.333333 * plane stress: 1.5");
    dem_material coupled = rubber;
    coupled.springs = DEM_SPRINGS_COUPLED;
    assert_refused(dem_lattice_assemble_squares(&lattice, &coupled, 0.5), DEM_ERROR_ARGUMENT,
                   "coupled springs * triangles * cells");
    lattice.n_triangles = 7;
    assert_refused(dem_lattice_assemble_squares(&lattice, &rubber, 0.5), DEM_ERROR_MODEL,
                   "7 triangles do not pair up to cells");
    lattice.n_triangles = 8;
    for (int c = 0; c < 3; c++) {
        const dem_index other = lattice.triangles[3 + c];
        lattice.triangles[3 + c] = lattice.triangles[21 + c];
        lattice.triangles[21 + c] = other;
    }
    assert_refused(dem_lattice_assemble_squares(&lattice, &rubber, 0.5), DEM_ERROR_MODEL,
                   "triangles 0 and 1 * cell, share * edge");
    dem_lattice_free(&lattice);
    lattice = make_squares(spacing, spacing);
    lattice.x[0] += 0.6 * spacing; /* the lower left corner beyond the diagonal of its neighbours */
    lattice.x[1] += 0.6 * spacing;
    assert_refused(dem_lattice_assemble_squares(&lattice, &rubber, 0.5), DEM_ERROR_MODEL,
                   "cell * nodes 1, 3, 2 and 0 * convex");
    assert_null(lattice.mass);
}

/* ---- refusals ---- */

/* ---- several materials ---- */

static const dem_material steel =
    SIZED(dem_material, .youngs_modulus = 2e8, .poissons_ratio = 0.2, .plane = DEM_PLANE_STRAIN, .density = 7800.0,
          .thickness = 0.25, .guard = 0.03, .damping_time = 2e-6);

static bool is_right(const dem_lattice *l, dem_index t)
{
    const dem_index *c = l->triangles + 3 * t;
    return l->x[2 * c[0]] + l->x[2 * c[1]] + l->x[2 * c[2]] > 0.0;
}

/* Halves of an assembled lattice and what two materials make of it: each half as it is alone, the nodes and springs of
 * the seam x = 0 the mean. */
static void expect_mean_on_the_seam(const dem_lattice *mixed, const dem_lattice *left, const dem_lattice *right)
{
    dem_index n_seam = 0;
    for (dem_index k = 0; k < mixed->n_springs; k++) {
        const dem_index i = mixed->ends[2 * k], j = mixed->ends[2 * k + 1];
        const double x = mixed->x[2 * i] + mixed->x[2 * j], low = left->stiffness[k], high = right->stiffness[k];
        const double expected = fabs(x) < 1e-9 ? 0.5 * (low + high) : (x < 0.0 ? low : high);
        assert_close(mixed->stiffness[k], expected, 1e-12 * expected);
        const double damped = fabs(x) < 1e-9 ? 0.5 * 2e-6 * high : (x < 0.0 ? 0.0 : 2e-6 * high);
        assert_close(mixed->viscosity[k], damped, 1e-12 * high);
        n_seam += fabs(x) < 1e-9 && fabs(mixed->x[2 * i]) < 1e-9;
    }
    assert_int_equal(n_seam, 4);
    for (dem_index i = 0; i < mixed->n_nodes; i++) {
        const double x = mixed->x[2 * i], low = left->mass[i], high = right->mass[i];
        assert_close(mixed->mass[i], fabs(x) < 1e-9 ? 0.5 * (low + high) : (x < 0.0 ? low : high), 1e-15);
    }
    for (dem_index t = 0; t < mixed->n_triangles; t++) {
        const dem_lattice *own = is_right(mixed, t) ? right : left;
        assert_close(mixed->guard[t], own->guard[t], 0.0);
        assert_close(mixed->thickness[t], own->thickness[t], 0.0);
        assert_close(mixed->modulus[t], own->modulus[t], 0.0);
        assert_close(mixed->area_stiffness[t], own->area_stiffness == NULL ? 0.0 : own->area_stiffness[t], 0.0);
    }
}

TEST(a_spring_between_two_materials_is_half_of_each)
{
    const dem_material both[2] = {rubber, steel};
    CLEANUP(dem_lattice_free)
    dem_lattice mixed = make_squares(6.0 * spacing, 4.0 * spacing), left = make_squares(6.0 * spacing, 4.0 * spacing),
                right = make_squares(6.0 * spacing, 4.0 * spacing);
    dem_index of[48];
    assert_int_equal(mixed.n_triangles, 48);
    for (dem_index t = 0; t < 48; t++) of[t] = is_right(&mixed, t);
    assert_int_equal(dem_lattice_assemble_mixed(&mixed, both, 2, of, 0.4), DEM_OK);
    assert_int_equal(dem_lattice_assemble_squares(&left, &rubber, 0.4), DEM_OK);
    assert_int_equal(dem_lattice_assemble_squares(&right, &steel, 0.4), DEM_OK);
    expect_mean_on_the_seam(&mixed, &left, &right);
}

TEST(a_mixture_refuses_what_cannot_be_mixed)
{
    dem_material both[2] = {rubber, steel};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_squares(spacing, spacing);
    dem_index of[2] = {0, 1};
    assert_refused(dem_lattice_assemble_mixed(&lattice, both, 2, of, 0.4), DEM_ERROR_MODEL,
                   "triangles 0 and 1 * cell * materials");
    of[1] = 2;
    assert_refused(dem_lattice_assemble_mixed(&lattice, both, 2, of, 0.0), DEM_ERROR_ARGUMENT,
                   "triangle 1 * material 2 * 2");
    of[1] = -1;
    assert_refused(dem_lattice_assemble_mixed(&lattice, both, 2, of, 0.0), DEM_ERROR_ARGUMENT,
                   "triangle 1 * material -1 * 2");
    of[1] = 1, both[1].youngs_modulus = 0.0, both[1].bond_stiffness = 7.0;
    assert_refused(dem_lattice_assemble_mixed(&lattice, both, 2, of, 0.0), DEM_ERROR_ARGUMENT,
                   "bond stiffness, 7 N * one material");
    assert_refused(dem_lattice_assemble_mixed(&lattice, both, 0, of, 0.0), DEM_ERROR_ARGUMENT, "materials * > 0: 0");
    assert_refused(dem_lattice_assemble_mixed(&lattice, NULL, 2, of, 0.0), DEM_ERROR_ARGUMENT, "material is NULL");
    both[1] = steel, both[1].density = 0.0;
    assert_refused(dem_lattice_assemble_mixed(&lattice, both, 2, of, 0.0), DEM_ERROR_ARGUMENT,
                   "density * > 0: 0 kg/m^3");
    assert_refused(dem_lattice_assemble_mixed(&lattice, both, 2, of, -1.0), DEM_ERROR_ARGUMENT,
                   "stiffness * diagonal * > 0: -1");
    assert_null(lattice.mass);
}

/* ---- faults ---- */

TEST(assembling_refuses_what_is_not_a_triangulation)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    const dem_index corner = lattice.triangles[0];
    lattice.triangles[0] = lattice.triangles[1];
    lattice.triangles[1] = corner;
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL,
                   "triangle 0 (nodes 1, 0, 2) * area -0.433013 m^2 * > 0");
    lattice.triangles[0] = 9;
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL, "triangle 0 * node 9 * 5 nodes");
    lattice.triangles[0] = 0, lattice.triangles[1] = 1;
    lattice.n_triangles = 1;
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL, "node 3 * no triangle");
    lattice.n_triangles = 0;
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL,
                   "a lattice without triangles cannot be assembled");
    assert_null(lattice.mass);
    lattice.n_triangles = 2;
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL, "already * 6 springs");
}

TEST(assembling_refuses_impossible_materials)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    dem_material m = rubber;
    m.youngs_modulus = 0.0;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "Young's modulus * > 0: 0 Pa");
    m = rubber, m.bond_stiffness = 3.0;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT,
                   "Young's modulus, 1e+07 Pa * bond stiffness, 3 N");
    m.youngs_modulus = 0.0, m.bond_stiffness = -3.0;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "bond stiffness * > 0: -3 N");
    m.bond_stiffness = 3.0, m.springs = DEM_SPRINGS_COUPLED;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "bond stiffness, 3 N * coupled");
    m = rubber, m.springs = (dem_springs)7;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "springs is 7 * independent nor coupled");
    m = rubber, m.poissons_ratio = 1.0;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT,
                   "Poisson's ratio * (-1, 1) * plane stress: 1");
    m.poissons_ratio = 0.5, m.plane = DEM_PLANE_STRAIN;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT,
                   "Poisson's ratio * (-1, 0.5) * plane strain: 0.5");
    m.plane = (dem_plane)2;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT,
                   "plane is 2, which is neither stress nor strain");
    m = rubber, m.density = -1.0;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "density * > 0: -1 kg/m^3");
    m = rubber, m.thickness = (double)INFINITY;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "thickness * > 0: inf m");
    m = rubber, m.guard = -0.1;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "guard * >= 0: -0.1");
    m = rubber, m.damping_time = -1e-6;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "damping_time * >= 0: -1e-06 s");
    m.damping_time = (double)INFINITY;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "damping_time * >= 0: inf s");
    assert_refused(dem_lattice_assemble(&lattice, NULL), DEM_ERROR_ARGUMENT, "material is NULL");
    assert_refused(dem_lattice_assemble(NULL, &rubber), DEM_ERROR_ARGUMENT, "lattice is NULL");
}

/* Each triangle has the strength of its material, and a spring between two the smaller critical stretch. */
TEST(limits_are_those_of_the_materials)
{
    const dem_material soft = {.struct_size = sizeof(dem_material),
                               .youngs_modulus = 1e7,
                               .density = 1e3,
                               .thickness = 1.0,
                               .strength = 2e5,
                               .critical_stretch = 0.3};
    dem_material of[2] = {soft, soft};
    of[1].strength = 0.0;
    of[1].critical_stretch = 0.1;
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&lattice, 1.0, 1.6, 1.0), DEM_OK);
    assert_int_equal(lattice.n_triangles, 2);
    assert_int_equal(dem_lattice_assemble_mixed(&lattice, of, 2, (const dem_index[]){0, 1}, 0.0), DEM_OK);
    assert_close(lattice.strength[0], 2e5, 0.0);
    assert_true(isinf(lattice.strength[1]));
    const dem_index *first = &lattice.triangles[0], *second = &lattice.triangles[3];
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        int of_second = 0, of_first = 0;
        for (int c = 0; c < 6; c++) {
            of_first += lattice.ends[2 * k + c / 3] == first[c % 3];
            of_second += lattice.ends[2 * k + c / 3] == second[c % 3];
        }
        assert_close(lattice.critical_stretch[k], of_second == 2 ? 0.1 : 0.3, 0.0);
        assert_true(of_first == 2 || of_second == 2);
    }
    of[0].strength = -1.0;
    CLEANUP(dem_lattice_free) dem_lattice other = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&other, 1.0, 1.6, 1.0), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&other, &of[0]), DEM_ERROR_ARGUMENT);
    of[0].strength = 1.0;
    of[0].critical_stretch = NAN;
    assert_int_equal(dem_lattice_assemble(&other, &of[0]), DEM_ERROR_ARGUMENT);
}

/* Alone a fracture energy gives each triangle a strength by its own size, with a strength it gives it a softening.
 * Plane strain is a plate of E/(1 - nu^2). */
TEST(a_fracture_energy_gives_strength_or_softening)
{
    dem_material glass = {.struct_size = sizeof(dem_material),
                          .youngs_modulus = 72e9,
                          .poissons_ratio = 0.22,
                          .plane = DEM_PLANE_STRAIN,
                          .density = 2440.0,
                          .thickness = 0.01,
                          .fracture_energy = 8.0};
    const double modulus = 72e9 / (1.0 - 0.22 * 0.22), edge = 1e-5;
    CLEANUP(dem_lattice_free) dem_lattice brittle = dem_lattice_empty(), soft = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&brittle, 10.0 * edge, 10.0 * edge, edge), DEM_OK);
    assert_int_equal(dem_lattice_jitter(&brittle, 0.2 * edge, 3), DEM_OK);
    assert_int_equal(dem_lattice_append(&soft, &brittle), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&brittle, &glass), DEM_OK);
    glass.strength = 60e6;
    assert_int_equal(dem_lattice_assemble(&soft, &glass), DEM_OK);
    assert_null(brittle.softening);
    for (dem_index t = 0; t < soft.n_triangles; t++) {
        const double area = area_of(&soft, t), size = sqrt(4.0 * area / sqrt(3.0));
        assert_close(brittle.strength[t], sqrt(modulus * 8.0 / (3.4 * size)), 1e-14 * brittle.strength[t]);
        assert_close(soft.strength[t], 60e6, 0.0);
        const double q = 6.0 + (modulus * 8.0 / (60e6 * 60e6 * size) - 8.42) / 1.29;
        assert_close(soft.softening[t], q, 1e-12 * q);
    }
}

/* The same of squares, for which the edge of an equilateral triangle of half their area counts. */
TEST(squares_have_a_toughness_of_their_own)
{
    const double size = sqrt(2.0 / sqrt(3.0)) * spacing, modulus = rubber.youngs_modulus;
    dem_material solid = rubber;
    solid.fracture_energy = 100.0;
    CLEANUP(dem_lattice_free) dem_lattice brittle = make_squares(0.03, 0.03);
    assert_int_equal(dem_lattice_assemble_squares(&brittle, &solid, 0.5), DEM_OK);
    assert_close(brittle.strength[0], sqrt(modulus * 100.0 / (3.3 * size)), 1e-6);
    CLEANUP(dem_lattice_free) dem_lattice soft = make_squares(0.03, 0.03);
    solid.strength = sqrt(modulus * 100.0 / (4.8 * size));
    assert_int_equal(dem_lattice_assemble_squares(&soft, &solid, 0.5), DEM_OK);
    assert_close(soft.softening[0], 3.0, 1e-12);
    CLEANUP(dem_lattice_free) dem_lattice coarse = make_squares(0.03, 0.03);
    solid.strength = 1e6;
    assert_refused(dem_lattice_assemble_squares(&coarse, &solid, 0.5), DEM_ERROR_ARGUMENT,
                   "squares of 0.0025 m are too large for a strength of 1e+06 Pa and a fracture energy of 100 J/m^2 * "
                   "0.000282001 m at most");
}

/* 3.4 times the size that would have this strength and this energy is the length E G/strength^2, here 2 m. */
TEST(triangles_too_large_for_strength_and_fracture_energy_are_refused)
{
    dem_material glass = {.struct_size = sizeof(dem_material),
                          .youngs_modulus = 1e10,
                          .density = 2440.0,
                          .thickness = 1.0,
                          .strength = 1e7,
                          .fracture_energy = 2e4};
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&block, 5.0, 5.0, 1.0), DEM_OK);
    assert_refused(
        dem_lattice_assemble(&block, &glass), DEM_ERROR_ARGUMENT,
        "triangles with edges of 1 m are too large for a strength of 1e+07 Pa and a fracture energy of 20000 "
        "J/m^2 * 0.588235 m at most");
    glass.strength = 5e6;
    assert_int_equal(dem_lattice_assemble(&block, &glass), DEM_OK);
    assert_close(block.softening[0], (8.0 - 2.0) / 1.07, 1e-12);
    glass.fracture_energy = -1.0;
    assert_refused(dem_lattice_assemble(&block, &glass), DEM_ERROR_MODEL, "already has");
    CLEANUP(dem_lattice_free) dem_lattice other = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&other, 5.0, 5.0, 1.0), DEM_OK);
    assert_refused(dem_lattice_assemble(&other, &glass), DEM_ERROR_ARGUMENT, "fracture_energy must be >= 0");
    glass.fracture_energy = 1.0;
    glass.critical_stretch = 0.1;
    assert_refused(dem_lattice_assemble(&other, &glass), DEM_ERROR_ARGUMENT, "neither with a critical stretch");
}

/* Faces of a plate are free; in plane strain pressure across strengthens as much as the law of Mohr and Coulomb says.
 * */
TEST(a_compressive_strength_has_the_confinement_of_its_plane)
{
    dem_material of[2] = {{.struct_size = sizeof(dem_material),
                           .youngs_modulus = 1e7,
                           .poissons_ratio = 0.2,
                           .plane = DEM_PLANE_STRAIN,
                           .density = 1e3,
                           .thickness = 1.0,
                           .strength = 2e5,
                           .compressive_strength = 1.5e6}};
    const dem_index first[2] = {0, 1};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty(), plate = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&lattice, 1.0, 1.6, 1.0), DEM_OK);
    assert_int_equal(lattice.n_triangles, 2);
    assert_int_equal(dem_lattice_append(&plate, &lattice), DEM_OK);
    of[1] = of[0];
    of[1].compressive_strength = 0.0;
    assert_int_equal(dem_lattice_assemble_mixed(&lattice, of, 2, first, 0.0), DEM_OK);
    assert_close(lattice.compressive_strength[0], 1.5e6, 0.0);
    assert_close(lattice.confinement[0], 7.5, 0.0);
    assert_true(isinf(lattice.compressive_strength[1]) && lattice.confinement[1] == 0.0);
    of[0].plane = DEM_PLANE_STRESS;
    assert_int_equal(dem_lattice_assemble(&plate, &of[0]), DEM_OK);
    assert_close(plate.compressive_strength[1], 1.5e6, 0.0);
    assert_null(plate.confinement);
}

TEST(a_compressive_strength_that_is_none_is_refused)
{
    const dem_material stone = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = 1e10,
                                .density = 2440.0,
                                .thickness = 1.0,
                                .strength = 1e7};
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&block, 5.0, 5.0, 1.0), DEM_OK);
    dem_material m = stone;
    m.compressive_strength = 9e6;
    assert_refused(dem_lattice_assemble(&block, &m), DEM_ERROR_ARGUMENT, "at least the strength, 1e+07 Pa: 9e+06 Pa");
    m.compressive_strength = -1.0;
    assert_refused(dem_lattice_assemble(&block, &m), DEM_ERROR_ARGUMENT, "compressive_strength must be >= 0");
    m.compressive_strength = (double)NAN;
    assert_refused(dem_lattice_assemble(&block, &m), DEM_ERROR_ARGUMENT, "compressive_strength must be >= 0");
    m.compressive_strength = 1e8;
    m.fracture_energy = 1e5;
    assert_refused(dem_lattice_assemble(&block, &m), DEM_ERROR_ARGUMENT, "without a fracture energy");
    m.fracture_energy = m.strength = 0.0;
    assert_refused(dem_lattice_assemble(&block, &m), DEM_ERROR_ARGUMENT, "goes with a strength");
    m.strength = 1e8;
    assert_int_equal(dem_lattice_assemble(&block, &m), DEM_OK);
}

/* It needs softening, gives another one for the same strength and energy, and is not for cells. */
TEST(the_stress_of_elements_is_for_triangles_that_soften)
{
    dem_material m = {.struct_size = sizeof(dem_material),
                      .youngs_modulus = 1e10,
                      .density = 2440.0,
                      .thickness = 1.0,
                      .strength = 1e7,
                      .stress_average = DEM_STRESS_AVERAGE_ELEMENT};
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty(), cells = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&block, 5.0, 5.0, 1.0), DEM_OK);
    assert_int_equal(dem_lattice_squares(&cells, 5.0, 5.0, 1.0), DEM_OK);
    assert_refused(dem_lattice_assemble(&block, &m), DEM_ERROR_ARGUMENT, "a strength and a fracture energy only");
    m.fracture_energy = 1.5e4; /* 1.5 strength^2 a/E */
    assert_refused(dem_lattice_assemble(&block, &m), DEM_ERROR_ARGUMENT, "too large * which need 0.914634 m at most");
    m.fracture_energy = 5e4;
    assert_refused(dem_lattice_assemble_squares(&cells, &m, 0.5), DEM_ERROR_ARGUMENT, "but cells are asked for");
    m.stress_average = (dem_stress_average)2;
    assert_refused(dem_lattice_assemble(&block, &m), DEM_ERROR_ARGUMENT, "stress_average is 2");
    m.stress_average = DEM_STRESS_AVERAGE_ELEMENT;
    assert_int_equal(dem_lattice_assemble(&block, &m), DEM_OK);
    for (dem_index t = 0; t < block.n_triangles; t++) {
        assert_int_equal(block.own_stress[t], 1);
        assert_close(block.softening[t], (5.0 - 0.2) / 0.48, 1e-10);
    }
}

/* Springs are made anew, and what a lattice had of others is not theirs. */
TEST(new_springs_have_no_old_critical_stretch)
{
    const dem_material plain = {
        .struct_size = sizeof(dem_material), .youngs_modulus = 1e7, .density = 1e3, .thickness = 1.0};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&lattice, 1.0, 1.6, 1.0), DEM_OK);
    lattice.critical_stretch = calloc(1, sizeof *lattice.critical_stretch);
    assert_int_equal(dem_lattice_assemble(&lattice, &plain), DEM_OK);
    assert_null(lattice.critical_stretch);
}
