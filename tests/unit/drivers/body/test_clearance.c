/* SPDX-License-Identifier: BSD-3-Clause */
/* clearance.c: how far along gravity a body is moved. */
#include "unit/close.h"

#include "clearance.h"

static const double down[2] = {0.0, -9.81};

typedef struct scene {
    dem_lattice lattice;
    dem_model *model;
} scene;

/* A triangle of side 1 m, its lower corners at (x, y) and (x + 1, y), over one polyline. */
static scene make_scene(double x, double y, const double *points, dem_index n_points)
{
    const dem_material material =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1000.0, .thickness = 1.0);
    const dem_obstacle obstacle = {.struct_size = sizeof(dem_obstacle), .n_points = n_points, .points = points};
    const double offset[2] = {x + 0.5, y};
    scene s = {.lattice = dem_lattice_empty()};
    assert_int_equal(dem_lattice_rectangle(&s.lattice, 1.0, 1.0, 1.0), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&s.lattice, &material), DEM_OK);
    dem_lattice_move(&s.lattice, 0.0, offset);
    assert_int_equal(dem_model_create(&s.model, &s.lattice, &obstacle, 1), DEM_OK);
    return s;
}

static void free_scene(scene *s)
{
    dem_model_destroy(s->model);
    dem_lattice_free(&s->lattice);
}

static double distance_to(const double x[2], const double *a, const double *b)
{
    const double e[2] = {b[0] - a[0], b[1] - a[1]}, r[2] = {x[0] - a[0], x[1] - a[1]};
    const double place = fmin(fmax((e[0] * r[0] + e[1] * r[1]) / (e[0] * e[0] + e[1] * e[1]), 0.0), 1.0);
    return hypot(r[0] - place * e[0], r[1] - place * e[1]);
}

/* Of nodes to the obstacle, and of its points to the sides of all triangles. */
static double gap_after(const scene *s, const double shift[2])
{
    const dem_lattice *l = &s->lattice;
    const dem_obstacle *obstacle = dem_model_obstacle(s->model, 0);
    double least = (double)INFINITY;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double x[2] = {l->x[2 * i] + shift[0], l->x[2 * i + 1] + shift[1]};
        least = fmin(least, dem_model_gap(s->model, x));
    }
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index a = l->triangles[k], b = l->triangles[k % 3 == 2 ? k - 2 : k + 1];
        for (dem_index i = 0; i < obstacle->n_points; i++) {
            const double *x = obstacle->points + 2 * i, seen[2] = {x[0] - shift[0], x[1] - shift[1]};
            least = fmin(least, distance_to(seen, l->x + 2 * a, l->x + 2 * b));
        }
    }
    return least;
}

static bool shift_to(double shift[2], const dem_model *model, const double gravity[2], double clearance)
{
    bool reached;
    assert_true(clearance_shift(shift, &reached, &(clearance_body){model, NULL, false}, gravity, clearance));
    return reached;
}

/* An apex under the middle of the lower side: from far above, with the apex inside, and nearer than some clearances. */
TEST(an_apex_between_nodes_is_met_at_the_clearance)
{
    const double apex[] = {-9.0, -9.0, 0.49, -1.0, 0.5, 0.2, 0.51, -1.0, 9.0, -9.0};
    const double clearances[] = {0.0, 1e-3, 0.1};
    for (int k = 0; k < 9; k++) {
        double shift[2];
        const double y = k < 3 ? 2.0 : k < 6 ? 0.1 : 0.2 + 5e-4;
        CLEANUP(free_scene) scene s = make_scene(0.0, y, apex, 5);
        assert_true(shift_to(shift, s.model, down, clearances[k % 3]));
        assert_close(y + shift[1], 0.2 + clearances[k % 3], 1e-12);
    }
}

TEST(a_body_above_a_floor_goes_down_to_it)
{
    const double floor[] = {-9.0, 0.5, 9.0, 0.5};
    double shift[2];
    CLEANUP(free_scene) scene s = make_scene(0.0, 3.0, floor, 2);
    assert_true(shift_to(shift, s.model, down, 0.125));
    assert_close(shift[0], 0.0, 0.0);
    assert_close(shift[1], -2.375, 1e-12);
    assert_true(shift_to(shift, s.model, down, 0.0));
    assert_close(shift[1], -2.5, 1e-12);
}

TEST(a_body_in_or_under_a_floor_goes_up_to_it)
{
    const double floor[] = {-90.0, 0.5, 90.0, 0.5};
    double shift[2];
    for (int k = 0; k < 2; k++) {
        CLEANUP(free_scene) scene s = make_scene(0.0, k == 0 ? 0.0 : -7.0, floor, 2);
        assert_true(shift_to(shift, s.model, down, 1e-3));
        assert_close(shift[1], (k == 0 ? 0.5 : 7.5) + 1e-3, 1e-12);
    }
}

TEST(slopes_and_vertices_are_met_at_the_clearance_exactly)
{
    const double rough[] = {-30.0, 0.2, -0.3, 0.1, 0.4, 0.7, 0.41, -2.0, 0.9, -1.5, 1.3, 0.9, 30.0, -5.0};
    const double gravities[][2] = {{0.0, -9.81}, {3.0, -9.0}, {-2.0, -1.0}};
    const double clearances[] = {0.0, 2e-4, 0.3};
    for (int place = 0; place < 12; place++) {
        CLEANUP(free_scene) scene s = make_scene(-1.2 + 0.2 * place, place % 2 == 0 ? 4.0 : -0.5, rough, 7);
        for (int g = 0; g < 3; g++)
            for (int c = 0; c < 3; c++) {
                double shift[2];
                assert_true(shift_to(shift, s.model, gravities[g], clearances[c]));
                assert_close(gap_after(&s, shift), clearances[c], 1e-12);
                assert_close(shift[0] * gravities[g][1], shift[1] * gravities[g][0], 1e-12);
            }
    }
}

TEST(a_body_inside_a_closed_obstacle_stays_inside)
{
    const double box[] = {-5.0, 0.0, 5.0, 0.0, 5.0, 8.0, -5.0, 8.0, -5.0, 0.0};
    double shift[2];
    CLEANUP(free_scene) scene s = make_scene(0.0, 4.0, box, 5);
    assert_true(shift_to(shift, s.model, down, 0.25));
    assert_close(shift[1], -3.75, 1e-12);
}

TEST(a_vertex_exactly_below_a_node_is_not_missed)
{
    const double peak[] = {-9.0, -9.0, 0.1, 0.3, 9.0, -9.0};
    double shift[2];
    CLEANUP(free_scene) scene s = make_scene(0.1, 5.0, peak, 3);
    assert_true(shift_to(shift, s.model, down, 0.0));
    assert_close(shift[1], -4.7, 1e-12);
    assert_true(shift_to(shift, s.model, down, 2e-4));
    assert_close(shift[1], -4.7 + 2e-4, 1e-12);
}

TEST(a_body_that_touches_already_stays)
{
    const double floor[] = {-9.0, 0.5, 9.0, 0.5}, slope[] = {-9.0, -9.0, 9.0, 9.0},
                 peak[] = {-9.0, -9.0, 0.1, 0.3, 9.0, -9.0};
    const struct {
        const double *points;
        dem_index n;
        double x, y; /* of the lower left corner */
    } cases[] = {{floor, 2, 0.0, 0.5},  {floor, 2, -9.0, 0.5}, {floor, 2, 9.0, 0.5}, {slope, 2, -0.3, 0.7},
                 {slope, 2, -1.0, 0.0}, {peak, 3, 0.1, 0.3},   {peak, 3, -0.9, 0.3}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        double shift[2];
        CLEANUP(free_scene) scene s = make_scene(cases[k].x, cases[k].y, cases[k].points, cases[k].n);
        assert_true(fabs(gap_after(&s, (double[2]){0.0, 0.0})) < 1e-15);
        assert_true(shift_to(shift, s.model, down, 0.0));
        assert_close(shift[1], 0.0, 1e-12);
    }
}

/* The needle ends 3 m above the body, which goes up by what is missing: its lower side meets the point first. */
TEST(a_body_with_an_obstacle_through_its_side_goes_back)
{
    const double needle[] = {0.45, -4.0, 0.5, 3.0, 0.55, -4.0};
    double shift[2];
    CLEANUP(free_scene) scene s = make_scene(0.0, 0.0, needle, 3);
    assert_true(shift_to(shift, s.model, down, 0.25));
    assert_close(shift[0], 0.0, 1e-15);
    assert_close(shift[1], 3.25, 1e-12);
}

TEST(the_side_that_an_obstacle_goes_through_is_found)
{
    const double needle[] = {0.4, -4.0, 0.45, 3.0, 0.5, -4.0};
    clearance_pierced found;
    CLEANUP(free_scene) scene s = make_scene(0.0, 0.0, needle, 3);
    assert_true(clearance_find_pierced(&found, &(clearance_body){s.model, &s.lattice, false}));
    assert_int_equal(found.obstacle, 0);
    /* the second segment falls 7 on 0.05, and meets the side 0.45 + 0.05 * 3/7 from the left corner */
    assert_int_equal(found.point, 1);
    assert_close(found.depth, (0.45 + 0.05 * 3.0 / 7.0) * 7.0 / hypot(7.0, 0.05), 1e-14);
    assert_close(found.x[0], 0.5, 1e-14);
    assert_close(found.x[1], 0.0, 1e-14);
    dem_lattice_move(&s.lattice, 0.0, (double[2]){0.0, 3.0});
    assert_true(clearance_find_pierced(&found, &(clearance_body){s.model, &s.lattice, false}));
    assert_close(found.depth, 0.0, 1e-14);
    dem_lattice_move(&s.lattice, 0.0, (double[2]){0.0, -0.25});
    assert_true(clearance_find_pierced(&found, &(clearance_body){s.model, &s.lattice, false}));
    assert_close(found.depth, 0.25, 1e-14); /* the point is 0.25 above the side */
}

static clearance_spike find_spike(const dem_lattice *lattice, const double *points, dem_index n)
{
    const double floor[] = {-9.0, -1.0, 9.0, -1.0};
    const dem_obstacle list[] = {{.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor},
                                 {.struct_size = sizeof(dem_obstacle), .n_points = n, .points = points}};
    clearance_spike spike;
    assert_true(clearance_find_spike(&spike, &(clearance_body){NULL, lattice, false}, list, 2));
    return spike;
}

TEST(the_point_deepest_between_nodes_is_found)
{
    const double spikes[] = {-0.1, -1.0, 0.0, 0.02, 0.1, -1.0, 0.2, 0.01, 0.3, -1.0};
    const double inner[] = {-0.5, -1.0, -0.5, 0.25, 0.4, -1.0}; /* on the side that two triangles share */
    const dem_material material =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1000.0, .thickness = 1.0);
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&lattice, 3.0, 1.0, 1.0), DEM_OK);
    assert_int_equal(dem_lattice_assemble(&lattice, &material), DEM_OK);
    clearance_spike found = find_spike(&lattice, spikes, 5);
    assert_int_equal(found.obstacle, 1);
    assert_int_equal(found.point, 1);
    assert_close(found.depth, 0.02, 1e-15);
    assert_close(found.x[1], 0.02, 0.0);
    found = find_spike(&lattice, inner, 3);
    assert_int_equal(found.point, 1);
    assert_close(found.depth, 0.25, 1e-15);
    dem_lattice_move(&lattice, 0.0, (double[2]){0.0, 0.015});
    found = find_spike(&lattice, spikes, 5);
    assert_close(found.depth, 0.005, 1e-12);
    dem_lattice_move(&lattice, 0.0, (double[2]){0.0, 0.006});
    assert_close(find_spike(&lattice, spikes, 5).depth, 0.0, 0.0);
}

TEST(points_on_rims_and_in_fixed_triangles_are_no_spikes)
{
    double x[] = {0, 0, 1, 0, 0, 1}, mass[] = {1, 1, 1};
    dem_index corners[] = {0, 1, 2};
    unsigned char fixed[] = {DEM_NODE_FIXED, DEM_NODE_FIXED, DEM_NODE_FIXED};
    const double rim[] = {0.5, -0.5, 0.5, 0.0, 0.7, -0.5}, inside[] = {0.2, -0.5, 0.2, 0.3, 0.3, -0.5};
    dem_lattice lattice = dem_lattice_empty();
    lattice.n_nodes = 3, lattice.x = x, lattice.mass = mass, lattice.n_triangles = 1, lattice.triangles = corners;
    assert_close(find_spike(&lattice, rim, 3).depth, 0.0, 0.0);
    assert_close(find_spike(&lattice, inside, 3).depth, 0.2, 1e-15);
    corners[0] = 1, corners[1] = 0; /* clockwise */
    assert_close(find_spike(&lattice, inside, 3).depth, 0.2, 1e-15);
    lattice.position = (double[6]){0, 5, 1, 5, 0, 6};
    assert_close(find_spike(&lattice, inside, 3).depth, 0.0, 0.0);
    lattice.position = NULL;
    lattice.flags = fixed;
    assert_close(find_spike(&lattice, inside, 3).depth, 0.0, 0.0);
    fixed[2] = 0;
    assert_close(find_spike(&lattice, inside, 3).depth, 0.2, 1e-15);
    lattice.n_triangles = 0;
    assert_close(find_spike(&lattice, inside, 3).depth, 0.0, 0.0);
}

TEST(without_an_obstacle_below_there_is_no_place)
{
    const double aside[] = {3.0, 0.0, 9.0, 0.0};
    const double up[2] = {0.0, 9.81};
    double shift[2];
    scene s = make_scene(0.0, 1.0, aside, 2);
    assert_false(shift_to(shift, s.model, down, 0.1));
    free_scene(&s);
    s = make_scene(4.0, 1.0, aside, 2);
    assert_true(shift_to(shift, s.model, down, 0.1));
    assert_false(shift_to(shift, s.model, up, 0.1));
    free_scene(&s);
}
