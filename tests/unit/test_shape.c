/* SPDX-License-Identifier: BSD-3-Clause */
/* shape.c: depth in the material, voids, pores, lattices. */
#include "close.h"

#include "shape.h"

static const dem_material rubber = {
    .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0};
static const shape_void round_void = {.outline = {.disc = true, .radius = 0.5}, .centre = {1.0, 2.0}};
static const shape_void square_void = {.outline = {.size = {2.0, 1.0}}, .centre = {-1.0, 4.0}};

static shape make_rectangle(void)
{
    const shape s = {.outline = {.size = {6.0, 8.0}}, .spacing = 0.1};
    return s;
}

static double depth_at(const shape *s, double x, double y)
{
    const double point[2] = {x, y};
    return shape_depth(s, point);
}

static void depth_in_a_rectangle_is_the_distance_to_its_nearest_edge(void **state)
{
    (void)state;
    const shape s = make_rectangle();
    assert_close(depth_at(&s, 0.0, 4.0), 3.0, 1e-15);
    assert_close(depth_at(&s, 2.5, 4.0), 0.5, 1e-15);
    assert_close(depth_at(&s, 0.0, 0.25), 0.25, 1e-15);
    assert_close(depth_at(&s, -6.0, -4.0), -5.0, 1e-15);
}

static void depth_in_a_disc_is_counted_from_its_rim(void **state)
{
    (void)state;
    const shape s = {.outline = {.disc = true, .radius = 2.0}, .spacing = 0.1};
    assert_close(depth_at(&s, 0.6, -0.8), 1.0, 1e-15);
    assert_close(depth_at(&s, 3.0, 0.0), -1.0, 1e-15);
}

static void voids_are_not_material(void **state)
{
    (void)state;
    shape s = make_rectangle();
    assert_true(shape_add_void(&s, &round_void));
    assert_true(shape_add_void(&s, &square_void));
    assert_close(depth_at(&s, 1.0, 2.0), -0.5, 1e-15);
    assert_close(depth_at(&s, 1.0, 1.25), 0.25, 1e-15);
    assert_close(depth_at(&s, -1.0, 4.0), -0.5, 1e-15);
    assert_close(depth_at(&s, 0.3, 4.9), 0.5, 1e-15); /* corner of the square one at (0, 4.5): 3-4-5 */
    shape_free(&s);
}

static void the_lattice_leaves_voids_out(void **state)
{
    (void)state;
    shape s = make_rectangle();
    dem_lattice lattice;
    double mass = 0.0;
    assert_true(shape_add_void(&s, &round_void));
    assert_true(shape_add_void(&s, &square_void));
    assert_int_equal(shape_mesh(&lattice, &s), DEM_OK);
    assert_int_equal(shape_cut(&lattice, &s), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&lattice, &rubber), DEM_OK);
    for (dem_index i = 0; i < lattice.n_nodes; i++) {
        const double x = lattice.x[2 * i], y = lattice.x[2 * i + 1];
        assert_true(hypot(x - 1.0, y - 2.0) > 0.5 - 1e-9);
        assert_true(fabs(x + 1.0) > 1.0 - 1e-9 || fabs(y - 4.0) > 0.5 - 1e-9);
        mass += lattice.mass[i];
    }
    assert_close(mass / (1050.0 * (48.0 - 2.0 - 0.785398)), 1.0, 0.02); /* rims are jagged by a spacing */
    assert_true(lattice.n_springs > 0);
    dem_lattice_free(&lattice);
    shape_free(&s);
}

static void a_void_takes_nodes_only_where_they_are(void **state)
{
    (void)state;
    const shape_void between = {.outline = {.disc = true, .radius = 0.04}, .centre = {0.05, 0.03}};
    const shape_void outside = {.outline = {.disc = true, .radius = 0.5}, .centre = {0.0, -1.0}};
    shape s = make_rectangle();
    dem_lattice lattice;
    assert_int_equal(shape_mesh(&lattice, &s), DEM_OK);
    assert_true(shape_takes(&s, &round_void, &lattice));
    assert_true(shape_takes(&s, &square_void, &lattice));
    assert_false(shape_takes(&s, &between, &lattice));
    assert_false(shape_takes(&s, &outside, &lattice));
    assert_true(shape_outline_depth(&s, between.centre) > 0.0);
    assert_close(shape_outline_depth(&s, outside.centre), -1.0, 1e-15);
    dem_lattice_free(&lattice);
}

static void a_void_of_everything_leaves_no_lattice(void **state)
{
    (void)state;
    const shape_void all = {.outline = {.disc = true, .radius = 50.0}};
    shape s = {.outline = {.disc = true, .radius = 1.0}, .spacing = 0.5};
    dem_lattice lattice;
    assert_int_equal(shape_mesh(&lattice, &s), DEM_OK);
    const dem_index n = lattice.n_nodes;
    assert_int_equal(shape_cut(&lattice, &s), DEM_OK);
    assert_int_equal(lattice.n_nodes, n);
    assert_true(shape_add_void(&s, &all));
    assert_int_equal(shape_cut(&lattice, &s), DEM_ERROR_MODEL);
    dem_lattice_free(&lattice);
    shape_free(&s);
}

static void pores_keep_away_from_edges_and_voids(void **state)
{
    (void)state;
    for (int disc = 0; disc < 2; disc++) {
        shape s = make_rectangle();
        pores_recipe recipe = {.number = 6, .radius_min = 0.3, .radius_max = 0.4, .wall = 0.2, .seed = 3};
        size_t n;
        double radius;
        s.outline.disc = disc != 0, s.outline.radius = 4.0;
        assert_true(shape_add_void(&s, &round_void));
        assert_int_equal(shape_add_pores(&s, &recipe, &n, &radius), DEM_OK);
        assert_int_equal(s.n_voids, 7);
        const shape without = {.outline = s.outline, .n_voids = 1, .voids = s.voids};
        for (size_t k = 1; k < 7; k++) {
            const shape_void *v = &s.voids[k];
            assert_true(shape_depth(&without, v->centre) >= v->outline.radius + 0.2);
        }
        shape_free(&s);
    }
}

static void a_pore_without_a_place_is_told(void **state)
{
    (void)state;
    shape s = make_rectangle();
    pores_recipe recipe = {.number = 3, .radius_min = 2.0, .radius_max = 2.0, .wall = 0.2, .seed = 3};
    size_t n;
    double radius;
    assert_int_equal(shape_add_pores(&s, &recipe, &n, &radius), DEM_ERROR_MODEL);
    assert_int_equal(n, 1);
    assert_close(radius, 2.0, 0.0);
    assert_int_equal(s.n_voids, 0);
    shape_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth_in_a_rectangle_is_the_distance_to_its_nearest_edge),
        cmocka_unit_test(depth_in_a_disc_is_counted_from_its_rim),
        cmocka_unit_test(voids_are_not_material),
        cmocka_unit_test(the_lattice_leaves_voids_out),
        cmocka_unit_test(a_void_takes_nodes_only_where_they_are),
        cmocka_unit_test(a_void_of_everything_leaves_no_lattice),
        cmocka_unit_test(pores_keep_away_from_edges_and_voids),
        cmocka_unit_test(a_pore_without_a_place_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
