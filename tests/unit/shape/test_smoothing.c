/* SPDX-License-Identifier: BSD-3-Clause */
/* smoothing.c: rims on the edges of their shapes, sound triangles, areas. */
#include "unit/close.h"

#include <stdlib.h>
#include <string.h>

#include "shape/area.h"
#include "shape/least_angle.h"
#include "shape/shape.h"
#include "shape/smoothing.h"

static const double pi = 3.14159265358979323846;

/* ---- random shapes, of spacing 1 ---- */

/* A linear congruential generator, in [0, 1). */
static double draw(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / 16777216.0;
}

static double between(unsigned *state, double low, double high)
{
    return low + (high - low) * draw(state);
}

/* The angle of a corner inside of a polygon, degrees. */
static double angle_at(const outline *o, size_t k)
{
    const double *p = o->points + 2 * k, *a = o->points + 2 * ((k + o->n_points - 1) % o->n_points);
    const double *b = o->points + 2 * ((k + 1) % o->n_points);
    const double angle = atan2(a[1] - p[1], a[0] - p[0]) - atan2(b[1] - p[1], b[0] - p[0]);
    return 180.0 / pi * (angle < 0.0 ? angle + 2.0 * pi : angle);
}

/* Corners around the origin, none of them sharp to below 40 degrees, from within or from without. */
static outline draw_polygon(unsigned *state, double size)
{
    outline o = {.kind = DEM_OUTLINE_POLYGON, .n_points = 3 + (size_t)(5.0 * draw(state))};
    o.points = calloc(o.n_points, 2 * sizeof *o.points);
    assert_non_null(o.points);
    for (bool good = false; !good;) {
        for (size_t k = 0; k < o.n_points; k++) {
            const double angle = 2.0 * pi * ((double)k + 0.7 * draw(state)) / (double)o.n_points;
            const double radius = size * between(state, 0.7, 1.2);
            o.points[2 * k] = radius * cos(angle);
            o.points[2 * k + 1] = radius * sin(angle);
        }
        good = true;
        for (size_t k = 0; k < o.n_points; k++) good = good && fabs(angle_at(&o, k) - 180.0) < 140.0;
    }
    return o;
}

typedef enum sort { DISC, RING, POLYGON, BLOCK, PLATE, N_SORTS } sort;

static shape draw_shape(unsigned *state, sort kind, double size)
{
    shape s = {.spacing = 1.0, .smooth = true};
    const double radius = size * between(state, 1.0, 1.1), width = size * between(state, 0.8, 2.0);
    const double height = size * between(state, 0.8, 2.0);
    s.outline = (outline){.centre = {0.0, 0.5 * height}, .size = {width, height}};
    if (kind == DISC || kind == RING) s.outline = (outline){.kind = DEM_OUTLINE_DISC, .radius = radius};
    if (kind == RING) s.outline.kind = DEM_OUTLINE_RING, s.outline.inner = radius * between(state, 0.4, 0.75);
    if (kind == POLYGON) s.outline = draw_polygon(state, size);
    if (kind == PLATE) {
        const outline hole = {.kind = DEM_OUTLINE_DISC,
                              .centre = {width * between(state, -0.1, 0.1), height * between(state, 0.4, 0.6)},
                              .radius = between(state, 0.15, 0.3) * fmin(width, height)};
        assert_true(shape_add_void(&s, (outline[]){hole}));
    }
    return s;
}

/* ---- what is judged ---- */

static dem_lattice make(const shape *s, smoothing *out)
{
    dem_lattice l = dem_lattice_empty();
    assert_int_equal(shape_mesh(&l, s), DEM_OK);
    assert_int_equal(smoothing_apply(out, &l, s, NULL), DEM_OK);
    return l;
}

static double area_of_triangle(const dem_lattice *l, dem_index t)
{
    const dem_index *n = l->triangles + 3 * t;
    const double *a = l->x + 2 * n[0], *b = l->x + 2 * n[1], *c = l->x + 2 * n[2];
    return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

static double area_of_all(const dem_lattice *l)
{
    double area = 0.0;
    for (dem_index t = 0; t < l->n_triangles; t++) area += area_of_triangle(l, t);
    return area;
}

/* How far the rim is from the edges of its shape, m. */
static double rim_error(const dem_lattice *l, const shape *s)
{
    dem_index *n_edges = calloc((size_t)l->n_nodes, sizeof *n_edges);
    double error = 0.0;
    assert_non_null(n_edges);
    assert_int_equal(dem_lattice_rims(l, n_edges), DEM_OK);
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (n_edges[i] > 0) error = fmax(error, fabs(shape_distance(s, l->x + 2 * i)));
    free(n_edges);
    return error;
}

static void expect_sound(const dem_lattice *l)
{
    double angle;
    for (dem_index t = 0; t < l->n_triangles; t++) assert_true(area_of_triangle(l, t) > 0.0);
    assert_int_equal(dem_lattice_least_angle(l, &angle), DEM_OK);
    assert_true(angle * 180.0 / pi >= 20.0 - 1e-12); /* the constant 20 degrees is rounded */
}

static double distance_of_node(const dem_lattice *l, const double x[2])
{
    double least = (double)INFINITY;
    for (dem_index i = 0; i < l->n_nodes; i++) least = fmin(least, hypot(l->x[2 * i] - x[0], l->x[2 * i + 1] - x[1]));
    return least;
}

/* ---- tests ---- */

static void expect_good(unsigned *state, sort kind, double size, double relative)
{
    CLEANUP(shape_free) shape s = draw_shape(state, kind, size);
    smoothing out;
    CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
    /* A chord c of a circle of radius r cuts off c^3/(12 r), hence all chords pi c^2/6; chords are up to 1.25 long. */
    const double circles = (double[]){1.0, 2.0, 0.0, 0.0, 1.0}[kind], cut_off = pi * 1.25 * 1.25 / 6.0;
    expect_sound(&l);
    assert_int_equal(out.n_off, 0);
    assert_true(rim_error(&l, &s) <= 1e-13 * size);
    assert_close(area_of_all(&l), area_of(&s), circles * cut_off + 1e-12 * size * size);
    assert_close(area_of_all(&l) / area_of(&s), 1.0, relative);
}

TEST(rims_lie_on_the_edges_and_triangles_are_sound)
{
    unsigned state = 1;
    for (int kind = 0; kind < N_SORTS; kind++)
        for (int k = 0; k < 60; k++) expect_good(&state, (sort)kind, 10.0 + 10.0 * (k % 2), 0.01);
}

/* 0.5 % at R/10 is what is asked for; found are 0.15 % and 0.03 %. */
TEST(areas_of_discs_and_rings_are_true)
{
    unsigned state = 7;
    for (int k = 0; k < 40; k++) {
        expect_good(&state, DISC, 10.0, 0.002);
        expect_good(&state, RING, 10.0, 0.001);
    }
}

TEST(corners_have_nodes)
{
    unsigned state = 3;
    for (int k = 0; k < 60; k++) {
        CLEANUP(shape_free) shape s = draw_shape(&state, k % 2 == 0 ? POLYGON : BLOCK, 12.0);
        smoothing out;
        CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
        assert_int_equal(out.n_cut, 0);
        for (size_t c = 0; c < outline_corners(&s.outline); c++)
            assert_close(distance_of_node(&l, outline_corner_at(&s.outline, c).x), 0.0, 0.0);
    }
}

/* Walls of a spacing, holes of a third of one and needles cannot lie on their edges and be sound. */
TEST(triangles_are_sound_where_the_shape_is_finer_than_the_lattice)
{
    double needle[] = {0, 0, 20, 0, 0, 3}, star[] = {0, 0, 5, 4, 10, 0, 6, 5, 10, 10, 5, 6, 0, 10, 4, 5};
    const outline fine[] = {{.kind = DEM_OUTLINE_RING, .radius = 10.0, .inner = 9.0},
                            {.kind = DEM_OUTLINE_POLYGON, .n_points = 3, .points = needle},
                            {.kind = DEM_OUTLINE_POLYGON, .n_points = 8, .points = star},
                            {.kind = DEM_OUTLINE_DISC, .radius = 1.0},
                            {.centre = {0.0, 0.7}, .size = {6.0, 1.4}}};
    for (int k = 0; k < 5; k++) {
        const shape s = {.outline = fine[k], .spacing = 1.0, .smooth = true};
        smoothing out;
        CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
        expect_sound(&l);
    }
    for (int k = 0; k < 40; k++) {
        CLEANUP(shape_free)
        shape s = {.outline = {.centre = {0.0, 4.0}, .size = {8.0, 8.0}}, .spacing = 1.0, .smooth = true};
        const outline hole = {.kind = DEM_OUTLINE_DISC, .centre = {0.05 * k, 4.0}, .radius = 0.2 + 0.02 * k};
        smoothing out;
        assert_true(shape_add_void(&s, (outline[]){hole}));
        CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
        expect_sound(&l);
    }
}

/* The tip of a void is narrower than a triangle for two spacings. It is reported, and no rim passes a node twice. */
TEST(sharp_tips_are_cut_off_and_counted)
{
    CLEANUP(shape_free)
    shape s = {.outline = {.centre = {0.0, 8.0}, .size = {20.0, 16.0}}, .spacing = 1.0, .smooth = true};
    double tip[] = {2, 4, 6, 4, 4, 12};
    outline hole = {.kind = DEM_OUTLINE_POLYGON, .n_points = 3, .points = malloc(sizeof tip)};
    smoothing out;
    assert_non_null(hole.points);
    memcpy(hole.points, tip, sizeof tip);
    assert_true(shape_add_void(&s, &hole));
    CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
    expect_sound(&l);
    assert_int_equal(out.n_cut, 1);
    dem_index *n_edges = calloc((size_t)l.n_nodes, sizeof *n_edges);
    assert_non_null(n_edges);
    assert_int_equal(dem_lattice_rims(&l, n_edges), DEM_OK);
    for (dem_index i = 0; i < l.n_nodes; i++) assert_true(n_edges[i] <= 2);
    free(n_edges);
}

/* Voids that open a side or each other: the corners between them have nodes, and the rim is on the edge between. */
TEST(edges_that_cross_have_nodes_where_they_do)
{
    const outline holes[] = {{.kind = DEM_OUTLINE_DISC, .centre = {0.3, 12.0}, .radius = 4.0},
                             {.kind = DEM_OUTLINE_DISC, .centre = {-10.0, 0.4}, .radius = 4.1},
                             {.centre = {6.0, 2.0}, .size = {3.0, 9.0}},
                             {.kind = DEM_OUTLINE_DISC, .centre = {6.0, 6.0}, .radius = 2.5}};
    const double corner[][2] = {{4.3, 12.0}, {-3.7, 12.0}, {-10.0, 4.5}, {7.5, 4.0},
                                {4.5, 4.0},  {4.5, 0.0},   {7.5, 0.0}};
    CLEANUP(shape_free)
    shape s = {.outline = {.centre = {0.0, 6.0}, .size = {20.0, 12.0}}, .spacing = 1.0, .smooth = true};
    smoothing out;
    for (int k = 0; k < 4; k++) {
        outline hole = holes[k];
        assert_true(shape_add_void(&s, &hole));
    }
    CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
    expect_sound(&l);
    assert_int_equal(out.n_off, 0);
    for (size_t k = 0; k < 7; k++) assert_close(distance_of_node(&l, corner[k]), 0.0, 1e-14);
    assert_true(rim_error(&l, &s) <= 1e-12);
    assert_close(area_of_all(&l) / area_of(&s), 1.0, 0.02);
}

/* Beside a shallow notch the nearest point of its circle may be beyond the side. */
TEST(shallow_notches_are_followed)
{
    for (int k = 0; k < 40; k++) {
        const double middle = 0.03 * k, above = 0.08 * k, chord = sqrt(16.0 - above * above);
        CLEANUP(shape_free)
        shape s = {.outline = {.centre = {0.0, 6.0}, .size = {20.0, 12.0}}, .spacing = 1.0, .smooth = true};
        outline hole = {.kind = DEM_OUTLINE_DISC, .centre = {middle, 12.0 + above}, .radius = 4.0};
        smoothing out;
        assert_true(shape_add_void(&s, &hole));
        CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
        expect_sound(&l);
        assert_int_equal(out.n_off, 0);
        assert_true(rim_error(&l, &s) <= 1e-12);
        for (int side = -1; side <= 1; side += 2)
            assert_close(distance_of_node(&l, (double[2]){middle + side * chord, 12.0}), 0.0, 1e-13);
    }
}

/* More than three layers behind the rim all nodes are where the grid has them. */
TEST(the_inside_stays_as_it_was)
{
    const shape s = {.outline = {.kind = DEM_OUTLINE_DISC, .radius = 20.0}, .spacing = 1.0, .smooth = true};
    smoothing out;
    CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
    dem_index n = 0;
    for (dem_index i = 0; i < l.n_nodes; i++) {
        const double x = l.x[2 * i], y = l.x[2 * i + 1], row = round(y / sqrt(0.75));
        if (hypot(x, y) > 15.0) continue; /* four sides reach 3.5 at least, and the rim is within 0.6 of the edge */
        n++;
        assert_close(y, row * sqrt(0.75), 1e-14 * 20.0);
        assert_close(2.0 * x, round(2.0 * x), 0.0);
    }
    assert_close((double)n / (pi * 225.0 / sqrt(0.75)), 1.0, 0.02);
}

static int by_place(const void *a, const void *b)
{
    const double *p = a, *q = b;
    if (p[1] != q[1]) return p[1] < q[1] ? -1 : 1;
    return (p[0] > q[0]) - (p[0] < q[0]);
}

/* To the bit: the places sorted are those of the mirror image sorted. */
TEST(symmetric_shapes_have_symmetric_lattices)
{
    for (int k = 0; k < 3; k++) {
        CLEANUP(shape_free) shape s = {.spacing = 1.0, .smooth = true};
        smoothing out;
        s.outline = (outline){.kind = k == 0 ? DEM_OUTLINE_DISC : DEM_OUTLINE_RING, .radius = 12.3, .inner = 7.1};
        if (k == 2) s.outline = (outline){.centre = {0.0, 6.0}, .size = {17.0, 12.0}};
        if (k == 2)
            assert_true(
                shape_add_void(&s, (outline[]){{.kind = DEM_OUTLINE_DISC, .centre = {0.0, 7.0}, .radius = 3.2}}));
        CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out);
        const size_t n = (size_t)l.n_nodes;
        double *mirrored = calloc(n, 2 * sizeof *mirrored);
        assert_non_null(mirrored);
        for (size_t i = 0; i < n; i++) {
            mirrored[2 * i] = 0.0 - l.x[2 * i];
            mirrored[2 * i + 1] = l.x[2 * i + 1];
        }
        qsort(mirrored, n, 2 * sizeof *mirrored, by_place);
        qsort(l.x, n, 2 * sizeof *l.x, by_place);
        for (size_t i = 0; i < 2 * n; i++) assert_true(mirrored[i] == l.x[i]);
        free(mirrored);
    }
}

TEST(the_same_shape_has_the_same_lattice)
{
    unsigned state = 5;
    CLEANUP(shape_free) shape s = draw_shape(&state, PLATE, 15.0);
    smoothing first, second;
    CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &first), m = make(&s, &second);
    assert_int_equal(l.n_nodes, m.n_nodes);
    assert_int_equal(l.n_triangles, m.n_triangles);
    assert_memory_equal(l.x, m.x, 2 * (size_t)l.n_nodes * sizeof *l.x);
    assert_memory_equal(l.triangles, m.triangles, 3 * (size_t)l.n_triangles * sizeof *l.triangles);
}

/* ---- parts, and any order of triangles ---- */

/* Far inside of its outline, so that its rim stays where it is, and so flat that no triangle is sound. */
static dem_lattice make_flat(double height)
{
    dem_lattice l = dem_lattice_empty();
    assert_int_equal(dem_lattice_rectangle(&l, 20.0, height, 1.0), DEM_OK);
    for (dem_index i = 0; i < l.n_nodes; i++) l.x[2 * i] *= 0.3;
    return l;
}

static smoothing smooth_flat(double height, smoothing_part part)
{
    const shape s = {.spacing = 1.0, .smooth = true, .outline = {.size = {1e3, 1e3}}};
    smoothing out;
    CLEANUP(dem_lattice_free) dem_lattice l = make_flat(height);
    assert_int_equal(smoothing_apply(&out, &l, &s, &part), DEM_OK);
    return out;
}

/* The whole would take further passes. In a row of 39 triangles each pass finds two ears: three passes take them away,
 * the last one leaves them, and the 33 triangles that there are then stay unsound. */
TEST(triangles_of_a_part_that_takes_too_many_passes_are_counted)
{
    const double all = (double)INFINITY;
    assert_int_equal(smooth_flat(1.0, (smoothing_part){-all, all}).n_unsettled, 2 + 33);
    assert_int_equal(smooth_flat(1.0, (smoothing_part){5.0, all}).n_unsettled, 0);
    assert_true(smooth_flat(9.0, (smoothing_part){-all, all}).n_unsettled > 100);
    assert_int_equal(smooth_flat(9.0, (smoothing_part){20.0, all}).n_unsettled, 0);
}

TEST(numbers_of_parts_add_up_to_those_of_the_whole)
{
    unsigned state = 8;
    for (int k = 0; k < 20; k++) {
        CLEANUP(shape_free) shape s = draw_shape(&state, (sort)(k % N_SORTS), 12.0);
        smoothing whole, below, above;
        const smoothing_part parts[] = {{-(double)INFINITY, 3.3}, {3.3, (double)INFINITY}};
        CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &whole), m = dem_lattice_empty(), n = dem_lattice_empty();
        assert_int_equal(shape_mesh(&m, &s), DEM_OK);
        assert_int_equal(shape_mesh(&n, &s), DEM_OK);
        assert_int_equal(smoothing_apply(&below, &m, &s, &parts[0]), DEM_OK);
        assert_int_equal(smoothing_apply(&above, &n, &s, &parts[1]), DEM_OK);
        assert_memory_equal(m.x, l.x, 2 * (size_t)l.n_nodes * sizeof *l.x);
        assert_true(below.n_rim > 0 && above.n_rim > 0);
        assert_int_equal(below.n_rim + above.n_rim, whole.n_rim);
        assert_int_equal(below.n_off + above.n_off, whole.n_off);
        assert_int_equal(below.n_cut + above.n_cut, whole.n_cut);
        assert_close(fmax(below.farthest, above.farthest), whole.farthest, 0.0);
    }
}

static bool is_high(void *context, const double *x)
{
    (void)context;
    return x[1] > 290.0;
}

/* At its tip a needle is thinner than triangles. */
TEST(corners_are_counted_where_nothing_is_left)
{
    double points[] = {-5.0, 0.0, 5.0, 0.0, 0.0, 300.0};
    const shape s = {
        .spacing = 1.0, .smooth = true, .outline = {.kind = DEM_OUTLINE_POLYGON, .n_points = 3, .points = points}};
    const smoothing_part high = {295.0, (double)INFINITY}, low = {-(double)INFINITY, 295.0};
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    smoothing out = {0};
    assert_int_equal(shape_mesh(&l, &s), DEM_OK);
    assert_int_equal(dem_lattice_cut(&l, is_high, NULL), DEM_OK);
    assert_int_equal(smoothing_apply(&out, &l, &s, &high), DEM_ERROR_MODEL);
    assert_int_equal(out.n_cut, 1);
    assert_int_equal(out.n_rim, 0);
    assert_int_equal(smoothing_apply(&out, &l, &s, &low), DEM_ERROR_MODEL);
    assert_int_equal(out.n_cut, 2); /* which another part has nodes at */
}

/* The spaces between these pores are as wide as triangles, so that many are poor, or unsound. */
static shape draw_sponge(unsigned *state)
{
    shape s = {.spacing = 1.0, .smooth = true, .outline = {.kind = DEM_OUTLINE_DISC, .radius = 30.0}};
    for (int k = 0; k < 60; k++) {
        const outline hole = {.kind = DEM_OUTLINE_DISC,
                              .centre = {between(state, -25.0, 25.0), between(state, -25.0, 25.0)},
                              .radius = between(state, 0.6, 4.0)};
        assert_true(shape_add_void(&s, (outline[]){hole}));
    }
    return s;
}

static void turn_order(dem_lattice *l)
{
    for (dem_index t = 0, u = l->n_triangles - 1; t < u; t++, u--)
        for (int c = 0; c < 3; c++) {
            const dem_index corner = l->triangles[3 * t + c];
            l->triangles[3 * t + c] = l->triangles[3 * u + c];
            l->triangles[3 * u + c] = corner;
        }
}

TEST(places_do_not_depend_on_the_order_of_triangles)
{
    unsigned state = 11;
    for (int k = 0; k < 150; k++) {
        CLEANUP(shape_free) shape s = draw_sponge(&state);
        smoothing out;
        CLEANUP(dem_lattice_free) dem_lattice l = make(&s, &out), m = dem_lattice_empty();
        assert_int_equal(shape_mesh(&m, &s), DEM_OK);
        turn_order(&m);
        assert_int_equal(smoothing_apply(&out, &m, &s, NULL), DEM_OK);
        assert_int_equal(l.n_nodes, m.n_nodes);
        assert_memory_equal(l.x, m.x, 2 * (size_t)l.n_nodes * sizeof *l.x);
    }
}
