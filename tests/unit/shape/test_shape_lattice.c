/* SPDX-License-Identifier: BSD-3-Clause */
/* shape_lattice.c: lattices, areas and pores of shapes, against closed forms. */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include <dem/shape.h>

#include "harness/lattice_area.h"
#include "harness/message.h"

static const double pi = 3.14159265358979323846;
static const dem_outline plate = {.struct_size = sizeof plate, .centre = {0.0, 1.0}, .size = {3.0, 2.0}};
static const dem_outline disc = {.struct_size = sizeof disc, .kind = DEM_OUTLINE_DISC, .radius = 1.0};
static const dem_outline ring = {
    .struct_size = sizeof ring, .kind = DEM_OUTLINE_RING, .centre = {5.0, -3.0}, .radius = 2.0, .inner_radius = 1.0};
static const double corners[] = {0.0, 0.0, 4.0, 0.0, 4.0, 3.0, 2.0, 1.0, 0.0, 3.0};
static const dem_outline notched = {
    .struct_size = sizeof notched, .kind = DEM_OUTLINE_POLYGON, .n_points = 5, .points = corners};

static dem_lattice make(const dem_shape *s)
{
    dem_lattice l = dem_lattice_empty();
    if (dem_shape_lattice(&l, s, NULL) != DEM_OK) fail_msg("%s", dem_status_message());
    return l;
}

static double true_area(const dem_shape *s)
{
    double area = -1.0;
    assert_int_equal(dem_shape_area(s, &area), DEM_OK);
    return area;
}

/* Rims that are stepped miss the area by a spacing times the edge at most, smooth ones by far less. */
TEST(areas_are_those_of_the_formulas)
{
    const dem_outline hole = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .centre = {0.5, 1.0}, .radius = 0.4);
    const struct {
        dem_shape shape;
        double area, edge;
    } cases[] = {
        {SIZED(dem_shape, .outline = &plate, .spacing = 0.05), 6.0, 10.0},
        {SIZED(dem_shape, .outline = &disc, .spacing = 0.05), pi, 2.0 * pi},
        {SIZED(dem_shape, .outline = &ring, .spacing = 0.05), 3.0 * pi, 6.0 * pi},
        {SIZED(dem_shape, .outline = &notched, .spacing = 0.05), 8.0, 16.0},
        {SIZED(dem_shape, .outline = &plate, .spacing = 0.05, .n_voids = 1, .voids = &hole), 6.0 - 0.16 * pi, 13.0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        dem_shape s = cases[k].shape;
        assert_close(true_area(&s), cases[k].area, 1e-4 * cases[k].area);
        for (int squares = 0; squares < 2; squares++) {
            s.grid = squares ? DEM_GRID_SQUARES : DEM_GRID_TRIANGLES;
            CLEANUP(dem_lattice_free) dem_lattice stepped = make(&s);
            assert_close(lattice_area(&stepped), cases[k].area, cases[k].edge * s.spacing);
        }
        s.grid = DEM_GRID_TRIANGLES, s.edge = DEM_EDGE_SMOOTH;
        CLEANUP(dem_lattice_free) dem_lattice smooth = make(&s);
        assert_close(lattice_area(&smooth), cases[k].area, 3e-3 * cases[k].area);
    }
}

TEST(a_smooth_edge_is_reported_with_its_nodes_and_sound_triangles)
{
    const dem_shape s = SIZED(dem_shape, .outline = &ring, .spacing = 0.1, .edge = DEM_EDGE_SMOOTH);
    dem_shape_report report = SIZED(dem_shape_report, .n_off = 7);
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    double angle, distance[2000];
    dem_index on_edge = 0;
    assert_int_equal(dem_shape_lattice(&l, &s, &report), DEM_OK);
    assert_true(report.n_rim > 150 && report.n_off == 0 && report.n_cut == 0 && report.idle_void == -1);
    assert_true(l.n_nodes <= 2000);
    assert_int_equal(dem_outline_distance(&ring, l.x, l.n_nodes, distance), DEM_OK);
    for (dem_index i = 0; i < l.n_nodes; i++) on_edge += fabs(distance[i]) < 1e-9;
    assert_true(on_edge >= report.n_rim);
    assert_int_equal(dem_lattice_least_angle(&l, &angle), DEM_OK);
    assert_true(angle >= 20.0 * pi / 180.0 && angle < pi / 3.0);
}

/* An upright plate and a disc are those of dem/lattice.h, to the bit. */
TEST(the_lattices_of_plates_and_discs_are_the_same_as_without_a_shape)
{
    const dem_shape of_plate = SIZED(dem_shape, .outline = &plate, .spacing = 0.3);
    const dem_shape of_disc = SIZED(dem_shape, .outline = &disc, .spacing = 0.3);
    CLEANUP(dem_lattice_free) dem_lattice a = make(&of_plate), b = make(&of_disc), c = dem_lattice_empty();
    CLEANUP(dem_lattice_free) dem_lattice d = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&c, 3.0, 2.0, 0.3), DEM_OK);
    assert_int_equal(dem_lattice_disc(&d, 1.0, 0.3), DEM_OK);
    assert_int_equal(a.n_nodes, c.n_nodes);
    assert_int_equal(b.n_nodes, d.n_nodes);
    assert_memory_equal(a.x, c.x, 2 * (size_t)a.n_nodes * sizeof *a.x);
    assert_memory_equal(b.x, d.x, 2 * (size_t)b.n_nodes * sizeof *b.x);
}

/* Its lowest row is its lower side, and both its sides have nodes. */
TEST(a_plate_may_be_anywhere)
{
    const dem_outline far = SIZED(dem_outline, .centre = {8.0, -4.0}, .size = {3.0, 2.0});
    for (int squares = 0; squares < 2; squares++) {
        const dem_shape s =
            SIZED(dem_shape, .outline = &far, .spacing = 0.25, .grid = squares ? DEM_GRID_SQUARES : DEM_GRID_TRIANGLES);
        CLEANUP(dem_lattice_free) dem_lattice l = make(&s);
        double box[4] = {99.0, 99.0, -99.0, -99.0};
        for (dem_index k = 0; k < 2 * l.n_nodes; k++) {
            box[k % 2] = fmin(box[k % 2], l.x[k]);
            box[k % 2 + 2] = fmax(box[k % 2 + 2], l.x[k]);
        }
        assert_true(box[0] == 6.5 && box[1] == -5.0 && box[2] == 9.5);
        assert_close(box[3], -3.0, squares ? 0.0 : 0.125); /* whole rows */
    }
}

/* A turned plate is cut out of a grid; the shifted disc has its nodes, shifted. */
TEST(figures_need_not_be_upright_at_the_origin)
{
    const dem_outline turned = SIZED(dem_outline, .centre = {7.0, 1.0}, .angle = 0.3, .size = {3.0, 2.0});
    const dem_outline far = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .centre = {8.0, -4.0}, .radius = 1.0);
    const dem_shape of_turned = SIZED(dem_shape, .outline = &turned, .spacing = 0.05, .edge = DEM_EDGE_SMOOTH);
    const dem_shape of_far = SIZED(dem_shape, .outline = &far, .spacing = 0.25);
    const dem_shape of_disc = SIZED(dem_shape, .outline = &disc, .spacing = 0.25);
    CLEANUP(dem_lattice_free) dem_lattice a = make(&of_turned), b = make(&of_far), c = make(&of_disc);
    assert_close(lattice_area(&a), 6.0, 0.02);
    assert_int_equal(b.n_nodes, c.n_nodes);
    for (dem_index k = 0; k < 2 * b.n_nodes; k++) assert_close(b.x[k] - (k % 2 == 0 ? 8.0 : -4.0), c.x[k], 1e-15 * 8);
}

TEST(a_shape_may_be_drawn_in_pixels)
{
    static const unsigned char pixels[6] = {1, 1, 1, 255, 1, 0};
    const dem_image image = SIZED(dem_image, .width = 3, .height = 2, .pixel = 2.0, .solid = pixels);
    const dem_shape s = SIZED(dem_shape, .image = &image, .spacing = 0.05);
    CLEANUP(dem_lattice_free) dem_lattice l = make(&s);
    assert_close(true_area(&s), 20.0, 1e-13);
    assert_close(lattice_area(&l), 20.0, 20.0 * s.spacing);
    for (dem_index i = 0; i < l.n_nodes; i++) assert_true(l.x[2 * i] < 1.0 + 1e-9 || l.x[2 * i + 1] > 2.0 - 1e-9);
}

/* Without the void there are the same triangles with the same numbers, and those of the void. */
TEST(numbers_of_triangles_do_not_depend_on_voids)
{
    const dem_outline hole = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .centre = {0.0, 1.0}, .radius = 0.5);
    dem_shape s = SIZED(dem_shape, .outline = &plate, .spacing = 0.1, .numbered = true);
    CLEANUP(dem_lattice_free) dem_lattice whole = make(&s);
    s.n_voids = 1, s.voids = &hole;
    CLEANUP(dem_lattice_free) dem_lattice holed = make(&s);
    assert_true(holed.n_triangles < whole.n_triangles);
    for (dem_index t = 0; t < whole.n_triangles; t++) assert_true(whole.strength[t] == (double)t);
    for (dem_index t = 0; t < holed.n_triangles; t++) {
        const dem_index before = (dem_index)holed.strength[t];
        for (int c = 0; c < 3; c++) {
            const double *a = holed.x + 2 * holed.triangles[3 * t + c],
                         *b = whole.x + 2 * whole.triangles[3 * before + c];
            assert_true(a[0] == b[0] && a[1] == b[1]);
        }
    }
    s.numbered = false;
    CLEANUP(dem_lattice_free) dem_lattice plain = make(&s);
    assert_null(plain.strength);
}

static void expect_failure(const dem_shape *s, dem_status status, dem_index idle_void, const char *pattern)
{
    dem_lattice l = dem_lattice_empty();
    dem_shape_report report = SIZED(dem_shape_report, .idle_void = 77);
    assert_int_equal(dem_shape_lattice(&l, s, &report), status);
    assert_message_parts(pattern);
    assert_int_equal(report.idle_void, idle_void);
    assert_true(l.x == NULL && l.n_nodes == 0);
}

TEST(failures_name_what_is_at_fault)
{
    static const double bow[] = {0.0, 0.0, 2.0, 2.0, 2.0, 0.0, 0.0, 2.0};
    const dem_outline voids[] = {SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .centre = {0.0, 1.0}, .radius = 0.2),
                                 SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .centre = {0.0, -9.0}, .radius = 0.2)};
    const dem_outline all = SIZED(dem_outline, .size = {9.0, 9.0});
    const dem_outline crossed = SIZED(dem_outline, .kind = DEM_OUTLINE_POLYGON, .n_points = 4, .points = bow);
    dem_shape s = SIZED(dem_shape, .outline = &plate, .spacing = 0.1, .n_voids = 2, .voids = voids);
    expect_failure(&s, DEM_ERROR_MODEL, 1, "void 1 * the shape * (0, -9) m");
    s.n_voids = 1, s.voids = &all, s.name = "plate 2";
    expect_failure(&s, DEM_ERROR_MODEL, -1, "plate 2 * leave none of");
    s.n_voids = 0, s.spacing = 1e-7;
    expect_failure(&s, DEM_ERROR_ARGUMENT, -1, "plate 2 * 2^40 * 1e-07 m");
    s.outline = &crossed, s.spacing = 0.1;
    expect_failure(&s, DEM_ERROR_ARGUMENT, -1, "meets itself * edge 1");
    expect_failure(NULL, DEM_ERROR_ARGUMENT, -1, "shape is NULL");
}

/* ---- pores ---- */

static const dem_pores uniform = {
    .struct_size = sizeof uniform, .number = 12, .radius_min = 0.05, .radius_max = 0.1, .wall = 0.05, .seed = 3};

TEST(pores_keep_their_walls_and_the_lattice_leaves_them_out)
{
    const dem_outline hole = SIZED(dem_outline, .kind = DEM_OUTLINE_DISC, .centre = {0.5, 1.0}, .radius = 0.4);
    dem_shape s = SIZED(dem_shape, .outline = &plate, .spacing = 0.05, .n_voids = 1, .voids = &hole);
    double pores[3 * 24], area = true_area(&s);
    dem_index n = 0, more = 0;
    assert_int_equal(dem_shape_place_pores(&s, &uniform, pores, 12, &n), DEM_OK);
    assert_int_equal(n, 12);
    s.n_pores = n, s.pores = pores;
    assert_int_equal(dem_shape_place_pores(&s, &uniform, pores + 3 * n, 12, &more), DEM_OK);
    s.n_pores = n += more;
    for (dem_index k = 0; k < n; k++) {
        const double *p = pores + 3 * k;
        area -= pi * p[2] * p[2];
        assert_true(p[2] >= 0.05 && p[2] <= 0.1);
        assert_true(fmin(1.5 - fabs(p[0]), 1.0 - fabs(p[1] - 1.0)) >= p[2] + 0.05);
        assert_true(hypot(p[0] - 0.5, p[1] - 1.0) >= 0.4 + p[2] + 0.05);
        for (dem_index q = 0; q < k; q++)
            assert_true(hypot(p[0] - pores[3 * q], p[1] - pores[3 * q + 1]) >= p[2] + pores[3 * q + 2] + 0.05);
    }
    assert_close(true_area(&s), area, 6e-4);
    CLEANUP(dem_lattice_free) dem_lattice l = make(&s);
    for (dem_index i = 0; i < l.n_nodes; i++)
        for (dem_index k = 0; k < n; k++)
            assert_true(hypot(l.x[2 * i] - pores[3 * k], l.x[2 * i + 1] - pores[3 * k + 1]) > pores[3 * k + 2] - 1e-9);
}

TEST(pores_may_have_an_area)
{
    const dem_shape s = SIZED(dem_shape, .outline = &disc, .spacing = 0.05);
    const dem_pores recipe =
        SIZED(dem_pores, .area = 0.2 * pi, .radius_min = 0.03, .radius_max = 0.08, .wall = 0.01, .seed = 1);
    CLEANUP(free_memory) double *pores = calloc(DEM_PORES_MAX, 3 * sizeof *pores);
    double area = 0.0;
    dem_index n = 0;
    assert_non_null(pores);
    assert_int_equal(dem_shape_place_pores(&s, &recipe, pores, DEM_PORES_MAX, &n), DEM_OK);
    for (dem_index k = 0; k < n; k++) area += pi * pores[3 * k + 2] * pores[3 * k + 2];
    assert_close(area, 0.2 * pi, 0.5 * pi * 0.08 * 0.08);
    assert_int_equal(dem_shape_place_pores(&s, &recipe, pores, n - 1, &n), DEM_ERROR_ARGUMENT);
    assert_message_parts("room for");
}

static void expect_no_pores(const dem_pores *recipe, dem_status status, dem_index n_expected, const char *pattern)
{
    const dem_shape s = SIZED(dem_shape, .outline = &plate, .spacing = 0.1);
    CLEANUP(free_memory) double *pores = calloc(DEM_PORES_MAX, 3 * sizeof *pores);
    dem_index n = -5;
    assert_non_null(pores);
    assert_int_equal(dem_shape_place_pores(&s, recipe, pores, DEM_PORES_MAX, &n), status);
    assert_message_parts(pattern);
    assert_int_equal(n, n_expected);
}

TEST(pores_that_cannot_be_are_refused_by_their_numbers)
{
    dem_pores p = uniform;
    p.radius_min = p.radius_max = 0.9;
    expect_no_pores(&p, DEM_ERROR_MODEL, 1, "pore 2 of 12 * radius 0.9 m * the shape * walls of 0.05 m");
    p = uniform;
    p.number = 0, p.area = 1.0, p.radius_min = p.radius_max = 1e-3;
    expect_no_pores(&p, DEM_ERROR_MODEL, DEM_PORES_MAX, "1 m^2 * more than 10000");
    p = uniform;
    p.distribution = DEM_PORE_RADII_NORMAL, p.mean = 5.0, p.deviation = 1e-3;
    expect_no_pores(&p, DEM_ERROR_ARGUMENT, -5, "mean 5 m * deviation 0.001 m");
    p.distribution = (dem_pore_radii)3;
    expect_no_pores(&p, DEM_ERROR_ARGUMENT, -5, "distribution of radii * 3");
    p = uniform;
    p.radius_min = 0.0;
    expect_no_pores(&p, DEM_ERROR_ARGUMENT, -5, "radii from 0 m");
    p.number = DEM_PORES_MAX + 1;
    expect_no_pores(&p, DEM_ERROR_ARGUMENT, -5, "10001");
    expect_no_pores(NULL, DEM_ERROR_ARGUMENT, -5, "recipe is NULL");
}
