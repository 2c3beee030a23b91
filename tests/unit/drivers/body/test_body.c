/* SPDX-License-Identifier: BSD-3-Clause */
/* body.c: from groups to a lattice in its place, with numbers worked out by hand. A tolerance of 1e-12 is the rounding
 * of a lattice of some metres. What is wrong is looked at for its place and the words that name it; whole sentences are
 * test_deck's. */
#include "unit/reading.h"

#include <stdlib.h>

#include "body.h"

#define RUN    "&run t_end = 1 /\n"
#define RUBBER "&material name = 'rubber', youngs_modulus = 1e7, density = 1000, thickness = 0.5 /\n"
#define BLOCK  "&body shape = 'rectangle', size = 4, 2, spacing = 0.5, material = 'rubber'"
#define JAGGED BLOCK ", outline = 'lattice'"
#define FLOOR  "&obstacle points = -9, 0, 9, 0 /\n"
#define DISC   "&body shape = 'disc', radius = 1, spacing = 0.25, material = 'rubber'"

static const double tiny = 1e-12, quarter = 1.5707963267948966; /* rad */
static const double floor_points[4] = {-9.0, 0.0, 9.0, 0.0}, low_points[4] = {-9.0, -3.0, 9.0, -3.0};
static const dem_obstacle flat_floors[2] = {
    {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = low_points, .restitution = 0.0},
    {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points, .restitution = 0.0}};
static const double wall_points[4] = {0.1, -5.0, 0.1, 5.0};
static const dem_obstacle floor_and_wall[2] = {
    {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = low_points, .restitution = 0.0},
    {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall_points, .restitution = 0.0}};

/* A body built from a text. Tests free it with drop_built(). */
typedef struct built {
    resolved from;
    namelist_errors errors;
    body_scene scene;
    body_facts facts;
    body_start start;
    dem_lattice lattice;
} built;

/* In place: the scene points to the deck. */
static void build(built *b, const char *text, size_t k, const dem_obstacle *obstacles, dem_index n_obstacles)
{
    *b = (built){.from = resolve_clean(text)};
    const double *gravity = schema_value_of(schema_get(&b->from.deck, "run", 0), "gravity")->reals;
    b->scene = (body_scene){&b->from.deck, "", obstacles, n_obstacles, {gravity[0], gravity[1]}};
    body_check_all(&b->from.deck, &b->errors);
    if (b->errors.n > 0) fail_msg("'%s' gives '%s'", text, b->errors.list[0].text);
    assert_true(body_build(&b->lattice, &b->facts, &b->start, &b->scene, k, &b->errors));
}

static void build_good(built *b, const char *text, const dem_obstacle *obstacles, dem_index n_obstacles)
{
    build(b, text, 0, obstacles, n_obstacles);
    if (b->errors.n > 0) fail_msg("'%s' gives '%s'", text, b->errors.list[0].text);
    assert_true(b->lattice.n_nodes > 0);
}

static void drop_built(built *b)
{
    dem_lattice_free(&b->lattice);
    strengths_free(&b->facts.strengths);
    namelist_errors_free(&b->errors);
    drop_resolved(&b->from);
}

static void expect_box(const dem_lattice *lattice, double left, double bottom, double right, double top)
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (dem_index k = 0; k < 2 * lattice->n_nodes; k++) {
        least[k % 2] = fmin(least[k % 2], lattice->x[k]);
        most[k % 2] = fmax(most[k % 2], lattice->x[k]);
    }
    assert_close(least[0], left, tiny);
    assert_close(least[1], bottom, tiny);
    assert_close(most[0], right, tiny);
    assert_close(most[1], top, tiny);
}

static double mass_of(const dem_lattice *lattice)
{
    double mass = 0.0;
    for (dem_index i = 0; i < lattice->n_nodes; i++) mass += lattice->mass[i];
    return mass;
}

/* Distance of the node nearest to a point. */
static double distance_to(const dem_lattice *lattice, double x, double y)
{
    double least = INFINITY;
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        least = fmin(least, hypot(lattice->x[2 * i] - x, lattice->x[2 * i + 1] - y));
    return least;
}

/* Rows are sqrt(3)/2 of the spacing apart: five of them make the block's height. */
static const double height = 5.0 * 0.5 * 0.86602540378443865;

/* ---- shape, material ---- */

TEST(a_rectangle_stands_on_its_origin_and_turns_about_it)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER JAGGED ", position = 10, 20 /", NULL, 0);
    expect_box(&b.lattice, 8.0, 20.0, 12.0, 20.0 + height);
    drop_built(&b);
    build_good(&b, RUN RUBBER JAGGED ", position = 10, 20, angle = 90 /", NULL, 0);
    expect_box(&b.lattice, 10.0 - height, 18.0, 10.0, 22.0);
}

TEST(a_disc_is_placed_by_its_centre)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER DISC ", position = -3, 2, angle = 33 /", NULL, 0);
    assert_close(distance_to(&b.lattice, -3.0, 2.0), 0.0, tiny);
    for (dem_index i = 0; i < b.lattice.n_nodes; i++)
        assert_true(hypot(b.lattice.x[2 * i] + 3.0, b.lattice.x[2 * i + 1] - 2.0) <= 1.0 + tiny);
}

/* 5 rows of 8 and 7 triangles in turn, upwards and downwards: the sawteeth of the sides are missing. */
TEST(mass_is_density_times_thickness_times_area)
{
    CLEANUP(drop_built) built b;
    const double triangle = 0.25 * 0.43301270189221932; /* spacing^2 sqrt(3)/4, m^2 */
    build_good(&b, RUN RUBBER JAGGED " /", NULL, 0);
    assert_int_equal(b.lattice.n_triangles, 5 * 15);
    assert_close(mass_of(&b.lattice), 1000.0 * 0.5 * 75.0 * triangle, 1e-9); /* rounding of 1e4 kg */
    assert_close(b.start.rest_length, 0.5, tiny);
}

TEST(the_material_is_found_by_its_name)
{
    CLEANUP(drop_built) built b, c;
    const char *others = RUN "&material youngs_modulus = 1, density = 3000, thickness = 0.5 /\n" RUBBER;
    char text[512];
    (void)snprintf(text, sizeof text, "%s%s /", others, BLOCK);
    build_good(&b, text, NULL, 0);
    (void)snprintf(text, sizeof text, "%s&body shape = 'rectangle', size = 4, 2, spacing = 0.5 /", others);
    build_good(&c, text, NULL, 0);
    assert_close(mass_of(&c.lattice) / mass_of(&b.lattice), 3.0, tiny); /* 'solid' is the default of both names */
}

/* k = E h/(1 + nu) of a side between two cells, times its length; r k, times its length, of a diagonal. */
TEST(squares_have_the_springs_of_their_diagonal)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER BLOCK ", lattice = 'square', diagonal = 0.25 /", NULL, 0);
    const double k = 1e7 * 0.5 / (4.0 / 3.0);
    assert_int_equal(b.lattice.n_nodes, 9 * 5);
    assert_int_equal(b.lattice.n_springs, 8 * 5 + 9 * 4 + 2 * 8 * 4);
    for (dem_index s = 0; s < b.lattice.n_springs; s++) {
        const double length = b.lattice.rest_length[s], share = b.lattice.stiffness[s] / (k * length);
        assert_true(length > 0.6 ? fabs(share - 0.25) < tiny : fabs(share - 1.0) < tiny || fabs(share - 0.5) < tiny);
    }
    assert_close(mass_of(&b.lattice), 1000.0 * 0.5 * 8.0, 1e-9);
}

/* By default where there are couplings; a square's diagonals are springs of their own, whatever its material says. */
TEST(springs_of_moved_nodes_are_coupled)
{
    static const char *const materials[3] = {"", "springs = 'coupled'", "springs = 'independent'"};
    for (int k = 0; k < 3; k++) {
        char text[512];
        (void)snprintf(text, sizeof text,
                       RUN "&material name = 'rubber', youngs_modulus = 1e7, density = 1000, %s /\n" BLOCK
                           ", jitter = 0.2 /\n" BLOCK ", jitter = 0.2, lattice = 'square' /",
                       materials[k]);
        CLEANUP(drop_built) built triangles, squares, regular;
        build_good(&triangles, text, NULL, 0);
        build(&squares, text, 1, NULL, 0);
        build_good(&regular, RUN RUBBER JAGGED " /", NULL, 0);
        assert_int_equal(triangles.lattice.coupling != NULL, k < 2);
        assert_int_equal(squares.errors.n, 0);
        assert_null(squares.lattice.coupling);
        assert_null(regular.lattice.coupling);
    }
}

TEST(a_bond_stiffness_is_that_of_every_spring)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN "&material name = 'rubber', bond_stiffness = 700, density = 1000 /\n" BLOCK " /", NULL, 0);
    for (dem_index s = 0; s < b.lattice.n_springs; s++) assert_close(b.lattice.stiffness[s], 700.0, 0.0);
    assert_null(b.lattice.area_stiffness);
}

/* By the law of cosines, degrees. */
static double least_angle(const dem_lattice *l)
{
    double least = 180.0;
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
        const dem_index t = 3 * (k / 3);
        const double *p = l->x + 2 * l->triangles[k], *q = l->x + 2 * l->triangles[t + (k + 1) % 3];
        const double *r = l->x + 2 * l->triangles[t + (k + 2) % 3];
        const double a = hypot(r[0] - q[0], r[1] - q[1]), b = hypot(r[0] - p[0], r[1] - p[1]);
        const double c = hypot(q[0] - p[0], q[1] - p[1]);
        least = fmin(least, acos((b * b + c * c - a * a) / (2.0 * b * c)) / quarter * 90.0);
    }
    return least;
}

/* Jitter comes after the rim, and cracks take triangles away: the log has the angle of what is left. */
TEST(the_least_angle_is_that_of_the_lattice_in_the_end)
{
    const char *jitter[] = {"", ", jitter = 0.2"};
    double least[2];
    for (int k = 0; k < 2; k++) {
        char text[400];
        (void)snprintf(text, sizeof text, "%s", RUN RUBBER DISC ", outline = 'smooth'");
        (void)snprintf(text + strlen(text), sizeof text - strlen(text), "%s /\n&crack points = 0,0, 0.6,0.1 /\n",
                       jitter[k]);
        CLEANUP(drop_built) built b;
        build_good(&b, text, NULL, 0);
        least[k] = b.facts.least_angle;
        assert_close(least[k], least_angle(&b.lattice), 1e-12); /* rounding, found 1e-14 */
    }
    assert_true(least[1] < least[0] - 1.0);
}

/* By the centres of triangles: 1500 kg/m^2 for 500 in as many of them as the report says. */
TEST(an_inclusion_has_its_own_material)
{
    CLEANUP(drop_built) built b;
    const double triangle = 0.25 * 0.43301270189221932;
    build_good(&b,
               RUN "&material name = 'heavy', youngs_modulus = 1e9, density = 3000, thickness = 0.5 /\n" RUBBER JAGGED
                   " /\n&inclusion material = 'heavy', centre = 0, 1, radius = 0.7 /",
               NULL, 0);
    assert_true(b.facts.n_included > 8);
    assert_close(mass_of(&b.lattice), (500.0 * 75.0 + 1000.0 * (double)b.facts.n_included) * triangle, 1e-9);
    assert_close(b.facts.true_mass, 500.0 * 8.0 + 1000.0 * 0.49 * 2.0 * quarter, 0.1);
}

TEST(all_nodes_have_the_velocity)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER BLOCK ", velocity = 3, -4, angle = 45 /", NULL, 0);
    assert_non_null(b.lattice.velocity);
    for (dem_index k = 0; k < 2 * b.lattice.n_nodes; k++)
        assert_close(b.lattice.velocity[k], k % 2 ? -4.0 : 3.0, 0.0); /* not turned with the body */
}

/* ---- voids and pores ---- */

TEST(a_void_turns_with_its_body)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER JAGGED ", position = 10, 20, angle = 90 /\n&void centre = 1, 1, radius = 0.6 /", NULL, 0);
    const double hole = distance_to(&b.lattice, 10.0 - 1.0, 20.0 + 1.0); /* (1, 1) turned by a quarter */
    assert_true(hole >= 0.6 - tiny);
    assert_true(distance_to(&b.lattice, 10.0 - 1.0, 20.0 - 1.0) < 0.3); /* (-1, 1) is full of nodes */
}

TEST(voids_and_pores_of_other_bodies_do_nothing)
{
    CLEANUP(drop_built) built b, c;
    build_good(&b, RUN RUBBER BLOCK " /", NULL, 0);
    build_good(&c,
               RUN RUBBER BLOCK " /\n" DISC " /\n&void body = 2, centre = 0, 0, radius = 0.3 /\n"
                                "&pores body = 2, number = 1, radius = 0.1, 0.1, wall = 0.05 /",
               NULL, 0);
    assert_int_equal(b.lattice.n_nodes, c.lattice.n_nodes);
    assert_memory_equal(b.lattice.x, c.lattice.x, 2 * (size_t)b.lattice.n_nodes * sizeof(double));
}

TEST(the_seed_makes_the_pores)
{
    static const char *const seeds[] = {"7", "7", "8"};
    built b[3];
    for (int k = 0; k < 3; k++) {
        char text[512];
        (void)snprintf(text, sizeof text,
                       "%s&body shape = 'rectangle', size = 4, 2, spacing = 0.05, material = "
                       "'rubber' /\n&pores number = 5, radius = 0.1, 0.2, seed = %s /",
                       RUN RUBBER, seeds[k]);
        build_good(&b[k], text, NULL, 0);
    }
    const size_t size = 2 * (size_t)b[0].lattice.n_nodes * sizeof(double);
    assert_int_equal(b[0].lattice.n_nodes, b[1].lattice.n_nodes);
    assert_memory_equal(b[0].lattice.x, b[1].lattice.x, size);
    assert_true(b[0].lattice.n_nodes != b[2].lattice.n_nodes || memcmp(b[0].lattice.x, b[2].lattice.x, size) != 0);
    for (int k = 0; k < 3; k++) drop_built(&b[k]);
}

/* ---- how it starts ---- */

/* Turned counter-clockwise by a little, the left lower corner sinks. */
TEST(the_start_is_that_of_the_lowest_node)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER BLOCK ", position = 1, 0.25, angle = 1e-3 /", flat_floors, 2);
    const double sunk = 2.0 * sin(1e-3 * quarter / 90.0);
    assert_close(b.start.depth, sunk - 0.25, tiny);
    assert_close(b.start.x[0], 1.0 - 2.0 * cos(1e-3 * quarter / 90.0), tiny);
    assert_close(b.start.x[1], 0.25 - sunk, tiny);
    drop_built(&b);
    build_good(&b, RUN RUBBER BLOCK " /", NULL, 0);
    assert_true(isinf(b.start.depth) && b.start.depth < 0);
}

/* Gravity along (3, -4)/5: a move by s changes the gap by 0.8 s and x by 0.6 s. */
TEST(clearance_moves_along_gravity)
{
    CLEANUP(drop_built) built b;
    build_good(&b, "&run t_end = 1, gravity = 6, -8 /\n" RUBBER BLOCK ", position = 0, 4, clearance = 0.5 /\n" FLOOR,
               flat_floors + 1, 1);
    const double moved = (4.0 - 0.5) / 0.8;
    /* 1e-6: the clearance is found as the root of the gap */
    assert_close(distance_to(&b.lattice, -2.0 + 0.6 * moved, 0.5), 0.0, 1e-6);
    assert_close(distance_to(&b.lattice, 2.0 + 0.6 * moved, 0.5), 0.0, 1e-6);
    assert_close(b.start.depth, -0.5, 1e-6);
}

TEST(a_start_is_refused_if_deeper_than_the_penetration_tolerance)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER BLOCK ", position = 0, -0.25 /", flat_floors, 2);
    assert_close(b.start.depth, 0.25, tiny);
    assert_true(body_check_start(&b.scene, 0, &b.start, 0.26, &b.errors));
    assert_int_equal(b.errors.n, 0);
    assert_true(body_check_start(&b.scene, 0, &b.start, 0.24, &b.errors));
    assert_int_equal(b.errors.n, 1);
    assert_int_equal(b.errors.list[0].place.line, 3);
    assert_non_null(strstr(b.errors.list[0].text, "body 1"));
    assert_non_null(strstr(b.errors.list[0].text, "obstacle 2")); /* it is in front of the first */
}

/* The wall goes through both long sides of the block, and its ends are in the open. */
TEST(a_start_is_refused_if_an_obstacle_goes_through_a_side)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER BLOCK " /", floor_and_wall, 2);
    assert_close(b.start.pierced.depth, 0.1, 1e-12); /* nodes are at 0 and at 0.5 m */
    b.start.depth = b.start.spike.depth = 0.0;
    assert_true(body_check_start(&b.scene, 0, &b.start, 0.11, &b.errors));
    assert_int_equal(b.errors.n, 0);
    assert_true(body_check_start(&b.scene, 0, &b.start, 0.09, &b.errors));
    assert_int_equal(b.errors.n, 1);
    assert_int_equal(b.errors.list[0].place.line, 3);
    assert_non_null(strstr(b.errors.list[0].text, "obstacle 2, after its point 1, through its side"));
}

/* The second of two columns is 5 m to the right, where the floor still is, the second row in the air. */
TEST(a_copy_is_the_body_moved_and_looked_at_where_it_is)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN RUBBER BLOCK ", position = -6, -0.25, angle = 90, copies = 2, 2, pitch = 5, 3 /", flat_floors,
               2);
    CLEANUP(dem_lattice_free) dem_lattice first = dem_lattice_empty();
    assert_int_equal(dem_lattice_append(&first, &b.lattice), DEM_OK);
    assert_int_equal(b.facts.further, 3);
    for (size_t k = 1; k < 4; k++) {
        const double way[2] = {k % 2 == 1 ? 5.0 : 0.0, k > 1 ? 3.0 : 0.0};
        assert_true(body_copy(&b.lattice, &b.facts, &b.start, &b.scene, 0, &b.errors));
        assert_int_equal(b.start.copy, k);
        for (dem_index i = 0; i < 2 * first.n_nodes; i++) assert_close(b.lattice.x[i], first.x[i] + way[i % 2], tiny);
        /* two metres of it are below its origin; rows are 3 m apart */
        assert_close(b.start.depth, 2.25 - way[1], tiny);
    }
    assert_true(body_check_start(&b.scene, 0, &b.start, 0.1, &b.errors));
    assert_int_equal(b.errors.n, 0);
    b.start.depth = 0.5;
    assert_true(body_check_start(&b.scene, 0, &b.start, 0.1, &b.errors));
    assert_non_null(strstr(b.errors.list[0].text, "body 1 (copy 4) starts 0.5 m inside"));
}

/* ---- strengths ---- */

#define GLASS                                                                                                          \
    "&material name = 'rubber', youngs_modulus = 1e7, density = 1000, thickness = 0.5,\n fracture = 'stress', "        \
    "strength = 1e5, weibull = 8, weibull_volume = 0.05 /\n"

static int by_size(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* (V/V_0) (s/sigma_0)^m is exponentially distributed: Kolmogorov's limit of 5 %. */
TEST(strengths_have_weibulls_distribution_by_the_volumes_of_a_smooth_jittered_body)
{
    CLEANUP(drop_built) built b;
    build_good(&b, RUN GLASS "&body shape = 'disc', radius = 5, spacing = 0.25, jitter = 0.2, material = 'rubber' /",
               NULL, 0);
    const dem_lattice *l = &b.lattice;
    const dem_index n = l->n_triangles;
    double *units = calloc((size_t)n, sizeof *units), most = 0.0;
    assert_true(units != NULL && n > 2000);
    for (dem_index t = 0; t < n; t++) {
        const dem_index *c = l->triangles + 3 * t;
        const double *p = l->x + 2 * c[0], *q = l->x + 2 * c[1], *r = l->x + 2 * c[2];
        const double area = 0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
        units[t] = 0.5 * area / 0.05 * pow(l->strength[t] / 1e5, 8.0);
    }
    qsort(units, (size_t)n, sizeof *units, by_size);
    for (dem_index k = 0; k < n; k++) {
        const double expected = 1.0 - exp(-units[k]);
        most = fmax(most, fmax(expected - (double)k / (double)n, (double)(k + 1) / (double)n - expected));
    }
    assert_true(most * sqrt((double)n) < 1.36);
    assert_int_equal(b.facts.strengths.triangles.n, n);
    free(units);
}

/* The same strengths, or not one the same. */
static void compare_strengths(const char *first, const char *second, bool same)
{
    CLEANUP(drop_built) built a;
    CLEANUP(drop_built) built b;
    build_good(&a, first, NULL, 0);
    build(&b, second, schema_count(&a.from.deck, "body") - 1, NULL, 0);
    assert_int_equal(a.lattice.n_triangles, b.lattice.n_triangles);
    for (dem_index t = 0; t < a.lattice.n_triangles; t++)
        assert_true((a.lattice.strength[t] == b.lattice.strength[t]) == same);
}

TEST(strengths_are_drawn_before_a_body_is_placed)
{
    compare_strengths(RUN GLASS BLOCK " /", RUN GLASS BLOCK ", angle = 33, position = 7, 0.3, spin = 3 /", true);
    compare_strengths(RUN GLASS BLOCK " /", RUN GLASS BLOCK " /\n" DISC " /", true);
}

TEST(a_seed_draws_other_strengths)
{
    compare_strengths(RUN GLASS BLOCK " /",
                      RUN "&material name = 'rubber', youngs_modulus = 1e7, density = 1000, thickness = 0.5, fracture "
                          "= 'stress', strength = 1e5, weibull = 8, weibull_volume = 0.05, strength_seed = 2 /\n" BLOCK
                          " /",
                      false);
}

TEST(every_body_of_a_deck_and_every_copy_has_strengths_of_its_own)
{
    const char *text = RUN GLASS BLOCK ", copies = 2, 2, pitch = 5, 3 /\n" BLOCK ", position = 0, 10 /";
    CLEANUP(drop_built) built first;
    CLEANUP(drop_built) built second;
    build_good(&first, text, NULL, 0);
    build(&second, text, 1, NULL, 0);
    const dem_index n = first.lattice.n_triangles;
    double *before = calloc((size_t)n, sizeof *before);
    assert_non_null(before);
    for (dem_index t = 0; t < n; t++) {
        before[t] = first.lattice.strength[t];
        assert_true(before[t] != second.lattice.strength[t]);
    }
    for (int copy = 1; copy < 4; copy++) {
        assert_true(body_copy(&first.lattice, &first.facts, &first.start, &first.scene, 0, &first.errors));
        for (dem_index t = 0; t < n; t++) {
            assert_true(before[t] != first.lattice.strength[t]);
            before[t] = first.lattice.strength[t];
        }
    }
    free(before);
}

static void centre_of(double centre[2], const dem_lattice *l, dem_index t)
{
    centre[0] = centre[1] = 0.0;
    for (int k = 0; k < 6; k++) centre[k % 2] += l->x[2 * l->triangles[3 * t + k / 2] + k % 2] / 3.0;
}

static dem_index triangle_at(const dem_lattice *l, const double *place)
{
    for (dem_index t = 0; t < l->n_triangles; t++) {
        double centre[2];
        centre_of(centre, l, t);
        if (fabs(centre[0] - place[0]) < 1e-9 && fabs(centre[1] - place[1]) < 1e-9) return t;
    }
    return -1;
}

/* What a void, pores or a crack leave of a body keeps the strengths that it had. */
TEST(cuts_do_not_change_the_strengths_of_what_stays)
{
    static const char *const cuts[] = {"&void centre = 1, 1, radius = 0.4 /", "&crack points = -2, 1.1, 0, 1.1 /",
                                       "&pores number = 2, radius = 0.2, 0.3, wall = 0.5 /"};
    CLEANUP(drop_built) built whole;
    build_good(&whole,
               RUN GLASS "&body shape = 'rectangle', size = 4, 2, spacing = 0.1, outline = 'lattice', material = "
                         "'rubber' /",
               NULL, 0);
    for (size_t k = 0; k < sizeof cuts / sizeof *cuts; k++) {
        char text[1024];
        CLEANUP(drop_built) built cut;
        (void)snprintf(text, sizeof text, "%s%s",
                       RUN GLASS "&body shape = 'rectangle', size = 4, 2, spacing = 0.1, "
                                 "outline = 'lattice', material = 'rubber' /\n",
                       cuts[k]);
        build_good(&cut, text, NULL, 0);
        assert_true(cut.lattice.n_triangles < whole.lattice.n_triangles - 20);
        for (dem_index t = 0; t < cut.lattice.n_triangles; t++) {
            const dem_lattice *l = &cut.lattice;
            double centre[2];
            centre_of(centre, l, t);
            const dem_index there = triangle_at(&whole.lattice, centre);
            assert_true(there >= 0);
            assert_close(l->strength[t], whole.lattice.strength[there], 1e-12 * l->strength[t]);
        }
    }
}

/* ---- what cannot be built ---- */

/* One fault, in a line, with a word; nothing is handed out. */
static void expect_fault(const char *text, size_t k, int line, const char *word)
{
    CLEANUP(drop_built) built b;
    build(&b, text, k, flat_floors, 2);
    assert_one_fault(&b.errors, text, line, word);
    assert_int_equal(b.lattice.n_nodes, 0);
    assert_null(b.lattice.x);
    assert_null(b.lattice.stiffness);
}

TEST(a_fault_is_placed_and_leaves_no_lattice)
{
    const char *two = RUN RUBBER BLOCK " /\n" DISC ", position = 0, 9 /\n";
    char text[512];
    (void)snprintf(text, sizeof text, "%s&void body = 2, centre = 0, 0, radius = 5 /", two);
    expect_fault(text, 1, 4, "body 2");
    (void)snprintf(text, sizeof text, "%s&pores body = 2, number = 99, radius = 0.5, 0.5 /", two);
    expect_fault(text, 1, 5, "body 2");
    expect_fault(RUN RUBBER BLOCK ", position = 99, 0, clearance = 1 /\n" FLOOR, 0, 3, "clearance");
    expect_fault(RUN RUBBER BLOCK " /\n&void shape = 'rectangle', centre = 0.7, 1, size = 0.6, 4 /", 0, 3,
                 "disconnected");
    expect_fault(RUN RUBBER BLOCK ", position = 0, 1e16 /", 0, 3, "coordinates");
    expect_fault(RUN "\n&body shape = 'file', file = 'no/such/file.h5' /", 0, 3, "no/such/file.h5");
}

/* ---- checks without geometry ---- */

static void assert_checked(const char *text, int line, const char *word)
{
    CLEANUP(namelist_errors_free) namelist_errors errors = {0};
    CLEANUP(drop_resolved) resolved r = resolve_clean(text);
    body_check_all(&r.deck, &errors);
    assert_one_fault(&errors, text, line, word);
}

TEST(sizes_of_the_spacing_and_more_pass)
{
    assert_checked(RUN RUBBER "&body shape = 'disc', radius = 1, spacing = 1, material = 'rubber' /", 0, NULL);
    assert_checked(RUN RUBBER "&body shape = 'rectangle', size = 1, 1, spacing = 1, material = 'rubber' /", 0, NULL);
    assert_checked(RUN RUBBER "&body shape = 'rectangle', size = 9, 1,\n spacing = 1.01, material = 'rubber' /", 4,
                   "spacing");
    assert_checked(RUN RUBBER "&body shape = 'rectangle', size = 1, 9,\n spacing = 1.01, material = 'rubber' /", 4,
                   "spacing");
}

/* Of squares alone the key says nothing, and the resolved deck has it no more; inclusions are of their body's cells. */
TEST(springs_are_those_of_triangles)
{
    const char *square =
        RUN "&material name = 'rubber', youngs_modulus = 1, density = 1,\n springs = 'coupled' /\n" BLOCK
            ", lattice = 'square' /\n";
    const char *plain = RUN RUBBER BLOCK ", lattice = 'square' /";
    char text[512];
    assert_checked(square, 3, "springs");
    (void)snprintf(text, sizeof text, "%s&inclusion material = 'rubber', centre = 0, 1, radius = 0.5 /", square);
    assert_checked(text, 3, "springs");
    (void)snprintf(text, sizeof text, "%s" DISC " /", square);
    assert_checked(text, 0, NULL);
    assert_checked(plain, 0, NULL);
    CLEANUP(drop_resolved) resolved r = resolve_clean(plain);
    body_drop_unused(&r.deck);
    assert_int_equal(schema_value_of(schema_get(&r.deck, "material", 0), "springs")->count, 0);
}

TEST(files_need_no_material_and_others_do)
{
    assert_checked(RUN "&body shape = 'file', file = 'a.h5' /", 0, NULL);
    assert_checked(RUN "&body shape = 'file', file = '' /", 2, "file");
    assert_checked(RUN "&body shape = 'disc', radius = 1, spacing = 1 /", 1, "material");
}

TEST(a_long_list_of_materials_is_cut)
{
    static const char name[] = "a_name_of_more_than_forty_characters_and_then_some";
    char text[16384] = RUN;
    for (int k = 0; k < 70; k++) {
        const size_t n = strlen(text);
        (void)snprintf(text + n, sizeof text - n, "&material name = '%s%d', youngs_modulus = 1, density = 1 /\n", name,
                       k);
    }
    (void)strcat(text, "&body shape = 'disc', radius = 1, spacing = 1, material = 'x' /");
    assert_checked(text, 72, "...");
}
