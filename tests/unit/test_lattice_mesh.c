/* SPDX-License-Identifier: BSD-3-Clause */
/* lattice_mesh.c and sides.c: shapes, holes in them, springs and masses by the finite-element rule. */
#include "solids.h"

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
        assert_string_equal(dem_status_message(), message);                                                            \
    } while (0)

/* ---- rectangle ---- */

static void the_papers_rectangle_has_1983_nodes_in_61_rows(void **state)
{
    (void)state;
    dem_lattice lattice = make_rectangle(0.08, 0.13, spacing);
    dem_index rows = 1;
    for (dem_index i = 1; i < lattice.n_nodes; i++) rows += lattice.x[2 * i + 1] > lattice.x[2 * i - 1];
    assert_int_equal(lattice.struct_size, sizeof lattice);
    assert_int_equal(lattice.dim, 2);
    assert_int_equal(rows, 61);
    assert_int_equal(lattice.n_nodes, 1983); /* 31 rows of 33, 30 of 32 */
    assert_int_equal(lattice.n_triangles, 60 * 63);
    assert_int_equal(lattice.n_springs, 0);
    assert_close(lattice.x[0], -0.04, 0.0);
    assert_close(lattice.x[1], 0.0, 0.0);
    assert_close(lattice.x[2 * lattice.n_nodes - 1], 60.0 * sqrt(0.75) * spacing, 1e-16);
    dem_lattice_free(&lattice);
}

static void every_triangle_is_equilateral_and_counter_clockwise(void **state)
{
    (void)state;
    const double expected = sqrt(3.0) / 4.0 * spacing * spacing;
    dem_lattice shapes[2] = {make_rectangle(0.04, 0.03, spacing)};
    assert_int_equal(dem_lattice_disc(&shapes[1], 0.03, spacing), DEM_OK);
    for (int s = 0; s < 2; s++) {
        for (dem_index t = 0; t < shapes[s].n_triangles; t++)
            assert_close(area_of(&shapes[s], t), expected, 1e-12 * expected); /* rounding of coordinates over spacing */
        for (dem_index k = 0; k < 3 * shapes[s].n_triangles; k++) {
            const dem_index i = shapes[s].triangles[k], j = shapes[s].triangles[k % 3 == 2 ? k - 2 : k + 1];
            const double dx = shapes[s].x[2 * j] - shapes[s].x[2 * i];
            const double dy = shapes[s].x[2 * j + 1] - shapes[s].x[2 * i + 1];
            assert_close(sqrt(dx * dx + dy * dy), spacing, 1e-13 * spacing);
        }
        dem_lattice_free(&shapes[s]);
    }
}

static void rows_are_mirror_symmetric_to_the_bit(void **state)
{
    (void)state;
    dem_lattice lattice = make_rectangle(0.0811, 0.13, 1.7e-3);
    for (dem_index first = 0; first < lattice.n_nodes;) {
        dem_index end = first;
        while (end < lattice.n_nodes && lattice.x[2 * end + 1] == lattice.x[2 * first + 1]) end++;
        for (dem_index k = 0; k < end - first; k++)
            assert_true(lattice.x[2 * (first + k)] == -lattice.x[2 * (end - 1 - k)]);
        first = end;
    }
    dem_lattice_free(&lattice);
}

static void a_rectangle_of_one_spacing_is_one_triangle(void **state)
{
    (void)state;
    dem_lattice lattice = make_rectangle(1.0, 1.0, 1.0);
    assert_int_equal(lattice.n_nodes, 3);
    assert_int_equal(lattice.n_triangles, 1);
    dem_lattice_free(&lattice);
}

static void a_rectangle_refuses_impossible_sizes(void **state)
{
    (void)state;
    dem_lattice lattice = {.n_nodes = 7};
    assert_refused(dem_lattice_rectangle(&lattice, 1.0, 1.0, 2.0), DEM_ERROR_ARGUMENT,
                   "a rectangle of 1 m x 1 m cannot have the spacing 2 m");
    assert_refused(dem_lattice_rectangle(&lattice, 1.0, 1.0, 0.0), DEM_ERROR_ARGUMENT,
                   "a rectangle of 1 m x 1 m cannot have the spacing 0 m");
    assert_int_equal(dem_lattice_rectangle(&lattice, (double)NAN, 1.0, 0.1), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_rectangle(&lattice, 1.0, (double)INFINITY, 0.1), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_rectangle(NULL, 1.0, 1.0, 0.1), DEM_ERROR_ARGUMENT);
    assert_refused(
        dem_lattice_rectangle(&lattice, 0.08, 0.13, 1e-12), DEM_ERROR_MODEL,
        "a rectangle of 0.08 m x 0.13 m with the spacing 1e-12 m would have 1.2e+22 nodes; the limit is 1.1e+12");
    assert_refused(
        dem_lattice_rectangle(&lattice, 1e300, 1e300, 1e-300), DEM_ERROR_MODEL,
        "a rectangle of 1e+300 m x 1e+300 m with the spacing 1e-300 m would have inf nodes; the limit is 1.1e+12");
    assert_int_equal(lattice.n_nodes, 7);
}

/* ---- disc ---- */

static void a_disc_fills_its_radius_and_has_a_node_at_the_centre(void **state)
{
    (void)state;
    const double radius = 25.0 * spacing, cell = sqrt(0.75) * spacing * spacing;
    int at_centre = 0, on_rim = 0;
    dem_lattice lattice;
    assert_int_equal(dem_lattice_disc(&lattice, radius, spacing), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double r = hypot(lattice.x[2 * i], lattice.x[2 * i + 1]);
        assert_true(r <= radius * (1.0 + 1e-9));
        at_centre += r == 0.0;
        on_rim += r > radius * (1.0 - 1e-9);
    }
    assert_int_equal(at_centre, 1);
    assert_int_equal(on_rim, 6); /* radius is whole spacings: one node in each direction of a spring */
    assert_close((double)lattice.n_nodes * cell / (3.14159265358979 * radius * radius), 1.0, 0.01);
    dem_lattice_free(&lattice);
}

static void a_disc_is_mirror_symmetric_about_both_axes(void **state)
{
    (void)state;
    for (int k = 0; k < 20; k++) {
        dem_lattice lattice;
        dem_index mirrored = 0;
        assert_int_equal(dem_lattice_disc(&lattice, 0.01 * (1.0 + 0.05 * k), spacing), DEM_OK);
        for (dem_index i = 0; i < lattice.n_nodes; i++)
            for (dem_index j = 0; j < lattice.n_nodes; j++) {
                const double *a = lattice.x + 2 * i, *b = lattice.x + 2 * j;
                mirrored += a[0] == -b[0] && a[1] == b[1];
                mirrored += a[0] == b[0] && a[1] == -b[1];
            }
        assert_int_equal(mirrored, 2 * lattice.n_nodes);
        dem_lattice_free(&lattice);
    }
}

static void a_disc_of_one_spacing_is_a_hexagon(void **state)
{
    (void)state;
    dem_lattice lattice;
    assert_int_equal(dem_lattice_disc(&lattice, spacing, spacing), DEM_OK);
    assert_int_equal(lattice.n_nodes, 7);
    assert_int_equal(lattice.n_triangles, 6);
    dem_lattice_free(&lattice);
}

static void a_disc_refuses_impossible_sizes(void **state)
{
    (void)state;
    dem_lattice lattice = {.n_nodes = 7};
    assert_refused(dem_lattice_disc(&lattice, 1.0, 1.5), DEM_ERROR_ARGUMENT,
                   "a disc of radius 1 m cannot have the spacing 1.5 m");
    assert_int_equal(dem_lattice_disc(&lattice, 1.0, -1.0), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_disc(&lattice, (double)INFINITY, 1.0), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_lattice_disc(NULL, 1.0, 1.0), DEM_ERROR_ARGUMENT);
    assert_refused(dem_lattice_disc(&lattice, 0.065, 1e-12), DEM_ERROR_MODEL,
                   "a disc of radius 0.065 m with the spacing 1e-12 m would have 1.95e+22 nodes; the limit is 1.1e+12");
    assert_int_equal(lattice.n_nodes, 7);
}

/* ---- cut ---- */

typedef struct hole {
    double x, y, radius;
} hole;

static int outside_hole(void *context, const double x[2])
{
    const hole *h = context;
    return hypot(x[0] - h->x, x[1] - h->y) > h->radius;
}

static void cutting_a_hole_leaves_the_triangles_outside_it(void **state)
{
    (void)state;
    hole h = {.x = 0.002, .y = 0.03, .radius = 0.01};
    dem_lattice lattice = make_rectangle(0.06, 0.06, spacing);
    const dem_index before = lattice.n_triangles;
    const double cell = sqrt(0.75) * spacing * spacing;
    assert_int_equal(dem_lattice_cut(&lattice, outside_hole, &h), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) assert_true(outside_hole(&h, lattice.x + 2 * i));
    for (dem_index t = 0; t < lattice.n_triangles; t++) assert_close(area_of(&lattice, t), 0.5 * cell, 1e-12 * cell);
    const double lost = (double)(before - lattice.n_triangles) * 0.5 * cell;
    assert_true(lost > 3.1 * h.radius * h.radius && lost < 3.2 * pow(h.radius + spacing, 2.0));
    dem_lattice_free(&lattice);
}

static int is_not_lower_left(void *context, const double x[2])
{
    (void)context;
    return !(x[1] < 0.1 && x[0] < 0.1);
}

static void a_cut_drops_nodes_left_without_a_triangle(void **state)
{
    (void)state;
    dem_lattice lattice =
        make_rectangle(1.0, 1.6, 1.0); /* two triangles: lower and upper edge of 2, one node between */
    assert_int_equal(lattice.n_nodes, 5);
    assert_int_equal(dem_lattice_cut(&lattice, is_not_lower_left, NULL), DEM_OK);
    assert_int_equal(lattice.n_nodes, 3); /* the other lower corner went too */
    assert_int_equal(lattice.n_triangles, 1);
    assert_close(area_of(&lattice, 0), sqrt(3.0) / 4.0, 1e-15);
    dem_lattice_free(&lattice);
}

static int keep_nothing(void *context, const double x[2])
{
    (void)context, (void)x;
    return 0;
}

static void a_cut_refuses_to_leave_nothing_and_to_cut_springs(void **state)
{
    (void)state;
    dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    assert_refused(dem_lattice_cut(&lattice, keep_nothing, NULL), DEM_ERROR_MODEL, "none of 5 nodes is left");
    assert_int_equal(lattice.n_nodes, 5);
    assert_int_equal(lattice.n_triangles, 2);
    assert_refused(dem_lattice_cut(&lattice, NULL, NULL), DEM_ERROR_ARGUMENT, "keep is NULL");
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    assert_refused(dem_lattice_cut(&lattice, keep_nothing, NULL), DEM_ERROR_MODEL,
                   "a lattice that has springs cannot be cut: 6 springs");
    dem_lattice_free(&lattice);
}

/* ---- assemble ---- */

static void springs_come_by_lower_then_upper_node_without_duplicates(void **state)
{
    (void)state;
    dem_lattice lattice = make_solid(0.03, 0.03, spacing);
    assert_int_equal(lattice.n_nodes - lattice.n_springs + lattice.n_triangles, 1); /* Euler */
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        const dem_index *end = lattice.ends + 2 * k;
        assert_true(end[0] < end[1]);
        if (k > 0) assert_true(end[-2] < end[0] || (end[-2] == end[0] && end[-1] < end[1]));
        assert_close(lattice.rest_length[k], spacing, 1e-13 * spacing);
    }
    dem_lattice_free(&lattice);
}

static void stiffness_is_that_of_finite_elements_and_half_of_it_on_the_boundary(void **state)
{
    (void)state;
    const double inside = sqrt(3.0) / 2.0 * rubber.youngs_modulus * rubber.thickness * spacing;
    dem_lattice lattice = make_solid(0.03, 0.03, spacing);
    dem_index n_boundary = 0;
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        const int n = triangles_at(&lattice, k);
        assert_true(n == 1 || n == 2);
        assert_close(lattice.stiffness[k], 0.5 * n * inside, 1e-12 * inside);
        n_boundary += n == 1;
    }
    assert_int_equal(n_boundary, 3 * lattice.n_triangles - 2 * (lattice.n_springs - n_boundary));
    dem_lattice_free(&lattice);
}

static void masses_guard_thickness_and_modulus_are_those_of_the_triangles(void **state)
{
    (void)state;
    dem_lattice lattice = make_solid(0.08, 0.13, spacing);
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
    dem_lattice_free(&lattice);
}

static void a_material_without_guard_leaves_guard_NULL(void **state)
{
    (void)state;
    dem_material plain = rubber;
    plain.guard = 0.0;
    dem_lattice lattice = make_rectangle(0.03, 0.03, spacing);
    assert_int_equal(dem_lattice_assemble(&lattice, &plain), DEM_OK);
    assert_null(lattice.guard);
    assert_non_null(lattice.mass);
    dem_lattice_free(&lattice);
}

static void viscosity_is_damping_time_times_stiffness(void **state)
{
    (void)state;
    dem_material damped = rubber;
    damped.damping_time = 3e-5;
    dem_lattice lattice = make_rectangle(0.03, 0.03, spacing), plain = make_solid(0.03, 0.03, spacing);
    assert_null(plain.viscosity);
    assert_int_equal(dem_lattice_assemble(&lattice, &damped), DEM_OK);
    assert_memory_equal(lattice.stiffness, plain.stiffness, (size_t)plain.n_springs * sizeof(double));
    for (dem_index k = 0; k < lattice.n_springs; k++)
        assert_close(lattice.viscosity[k], 3e-5 * plain.stiffness[k], 0.0);
    dem_lattice_free(&lattice);
    dem_lattice_free(&plain);
}

/* Energy (1) and of the area term under x -> (1 + s strain) x; strain = xx, yy, xy. */
static double energy_of(const dem_lattice *lattice, const double strain[3], double s)
{
    const double J = (1.0 + s * strain[0]) * (1.0 + s * strain[1]) - s * s * strain[2] * strain[2];
    double energy = 0.0;
    for (dem_index t = 0; t < lattice->n_triangles && lattice->area_stiffness != NULL; t++)
        energy += 0.5 * lattice->area_stiffness[t] * area_of(lattice, t) * (J - 1.0) * (J - 1.0);
    for (dem_index k = 0; k < lattice->n_springs; k++) {
        const double *a = lattice->x + 2 * lattice->ends[2 * k], *b = lattice->x + 2 * lattice->ends[2 * k + 1];
        const double dx = b[0] - a[0], dy = b[1] - a[1], rest = lattice->rest_length[k];
        const double length =
            hypot(dx + s * (strain[0] * dx + strain[2] * dy), dy + s * (strain[2] * dx + strain[1] * dy));
        energy += 0.5 * lattice->stiffness[k] * (length - rest) * (length - rest) / rest;
    }
    return energy;
}

/* Hooke's law of a solid in three dimensions: of plane strain as it is, of plane stress with the strain across that
 * leaves no stress there. The third order in s cancels in the mean of s and -s; the fourth is of order s^2. */
static void expect_energy_of(const dem_material *solid, const double e[3])
{
    const double nu = solid->poissons_ratio, s = 1e-4, G = 0.5 * solid->youngs_modulus / (1.0 + nu);
    const double lambda = 2.0 * G * nu / (1.0 - 2.0 * nu);
    const double across = solid->plane == DEM_PLANE_STRAIN ? 0.0 : -nu / (1.0 - nu) * (e[0] + e[1]);
    const double trace = e[0] + e[1] + across;
    const double squares = e[0] * e[0] + e[1] * e[1] + across * across + 2.0 * e[2] * e[2];
    dem_lattice lattice = make_rectangle(0.03, 0.05, spacing);
    assert_int_equal(dem_lattice_assemble(&lattice, solid), DEM_OK);
    const double volume = (double)lattice.n_triangles * sqrt(3.0) / 4.0 * spacing * spacing * solid->thickness;
    const double expected = s * s * volume * (0.5 * lambda * trace * trace + G * squares);
    const double mean = 0.5 * (energy_of(&lattice, e, s) + energy_of(&lattice, e, -s));
    assert_close(mean / expected, 1.0, 1e-7);
    dem_lattice_free(&lattice);
}

static void a_uniformly_strained_block_has_the_energy_of_its_solid(void **state)
{
    (void)state;
    static const double strains[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, 0}, {1, 1, 0}, {0.3, -0.7, 0.5}};
    static const double ratios[] = {-0.3, 0.0, 0.1, 0.25, 1.0 / 3.0, 0.45};
    dem_material solid = rubber;
    for (int plane = 0; plane < 2; plane++)
        for (size_t n = 0; n < sizeof ratios / sizeof *ratios; n++)
            for (size_t k = 0; k < sizeof strains / sizeof *strains; k++) {
                solid.plane = plane == 0 ? DEM_PLANE_STRESS : DEM_PLANE_STRAIN;
                solid.poissons_ratio = ratios[n];
                expect_energy_of(&solid, strains[k]);
            }
}

/* kappa = E h (3 nu - 1)/(2 (1 - nu^2)): at 0.5 E h/3; springs alone have 1/3 in plane stress, 1/4 in plane strain. */
static void area_stiffness_is_that_of_poissons_ratio_and_NULL_where_springs_have_it(void **state)
{
    (void)state;
    const dem_plane planes[3] = {DEM_PLANE_STRESS, DEM_PLANE_STRESS, DEM_PLANE_STRAIN};
    const double ratios[3] = {0.5, 1.0 / 3.0, 0.25};
    for (int k = 0; k < 3; k++) {
        dem_material solid = rubber;
        solid.poissons_ratio = ratios[k], solid.plane = planes[k];
        dem_lattice lattice = make_rectangle(0.03, 0.03, spacing);
        assert_int_equal(dem_lattice_assemble(&lattice, &solid), DEM_OK);
        for (dem_index t = 0; k == 0 && t < lattice.n_triangles; t++)
            assert_close(lattice.area_stiffness[t], 1e7 * 0.5 / 3.0, 1e-8);
        if (k > 0) assert_null(lattice.area_stiffness);
        dem_lattice_free(&lattice);
    }
}

static void assembling_refuses_what_is_not_a_triangulation(void **state)
{
    (void)state;
    dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    const dem_index corner = lattice.triangles[0];
    lattice.triangles[0] = lattice.triangles[1];
    lattice.triangles[1] = corner;
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL,
                   "triangle 0 (nodes 1, 0, 2) has the area -0.433013 m^2; it must be > 0");
    lattice.triangles[0] = 9;
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL,
                   "triangle 0 has node 9, but there are 5 nodes");
    lattice.triangles[0] = 0, lattice.triangles[1] = 1;
    lattice.n_triangles = 1;
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL, "node 3 belongs to no triangle");
    lattice.n_triangles = 0;
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL,
                   "a lattice without triangles cannot be assembled");
    assert_null(lattice.mass);
    lattice.n_triangles = 2;
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    assert_refused(dem_lattice_assemble(&lattice, &rubber), DEM_ERROR_MODEL, "the lattice already has 6 springs");
    dem_lattice_free(&lattice);
}

static void assembling_refuses_impossible_materials(void **state)
{
    (void)state;
    dem_lattice lattice = make_rectangle(1.0, 1.6, 1.0);
    dem_material m = rubber;
    m.youngs_modulus = 0.0;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "Young's modulus must be > 0: 0 Pa");
    m = rubber, m.poissons_ratio = 1.0;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT,
                   "Poisson's ratio must be in (-1, 1) in plane stress: 1");
    m.poissons_ratio = 0.5, m.plane = DEM_PLANE_STRAIN;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT,
                   "Poisson's ratio must be in (-1, 0.5) in plane strain: 0.5");
    m.plane = (dem_plane)2;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT,
                   "plane is 2, which is neither stress nor strain");
    m = rubber, m.density = -1.0;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "density must be > 0: -1 kg/m^3");
    m = rubber, m.thickness = (double)INFINITY;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "thickness must be > 0: inf m");
    m = rubber, m.guard = -0.1;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "guard must be >= 0: -0.1");
    m = rubber, m.damping_time = -1e-6;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "damping_time must be >= 0: -1e-06 s");
    m.damping_time = (double)INFINITY;
    assert_refused(dem_lattice_assemble(&lattice, &m), DEM_ERROR_ARGUMENT, "damping_time must be >= 0: inf s");
    assert_refused(dem_lattice_assemble(&lattice, NULL), DEM_ERROR_ARGUMENT, "material is NULL");
    assert_refused(dem_lattice_assemble(NULL, &rubber), DEM_ERROR_ARGUMENT, "lattice is NULL");
    dem_lattice_free(&lattice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_papers_rectangle_has_1983_nodes_in_61_rows),
        cmocka_unit_test(every_triangle_is_equilateral_and_counter_clockwise),
        cmocka_unit_test(rows_are_mirror_symmetric_to_the_bit),
        cmocka_unit_test(a_rectangle_of_one_spacing_is_one_triangle),
        cmocka_unit_test(a_rectangle_refuses_impossible_sizes),
        cmocka_unit_test(a_disc_fills_its_radius_and_has_a_node_at_the_centre),
        cmocka_unit_test(a_disc_is_mirror_symmetric_about_both_axes),
        cmocka_unit_test(a_disc_of_one_spacing_is_a_hexagon),
        cmocka_unit_test(a_disc_refuses_impossible_sizes),
        cmocka_unit_test(cutting_a_hole_leaves_the_triangles_outside_it),
        cmocka_unit_test(a_cut_drops_nodes_left_without_a_triangle),
        cmocka_unit_test(a_cut_refuses_to_leave_nothing_and_to_cut_springs),
        cmocka_unit_test(springs_come_by_lower_then_upper_node_without_duplicates),
        cmocka_unit_test(stiffness_is_that_of_finite_elements_and_half_of_it_on_the_boundary),
        cmocka_unit_test(masses_guard_thickness_and_modulus_are_those_of_the_triangles),
        cmocka_unit_test(a_material_without_guard_leaves_guard_NULL),
        cmocka_unit_test(viscosity_is_damping_time_times_stiffness),
        cmocka_unit_test(a_uniformly_strained_block_has_the_energy_of_its_solid),
        cmocka_unit_test(area_stiffness_is_that_of_poissons_ratio_and_NULL_where_springs_have_it),
        cmocka_unit_test(assembling_refuses_what_is_not_a_triangulation),
        cmocka_unit_test(assembling_refuses_impossible_materials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
