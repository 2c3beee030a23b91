/* SPDX-License-Identifier: BSD-3-Clause */
/* panel.c: a frame in its place. */
#include "unit/drivers/plot/trajectory_fixture.h"
#include "unit/drivers/plot/canvas_spy.h"

#include "panel.h"

typedef struct view {
    quantity q;
    snapshot s;
    palette p;
    panel_look look;
    panel at;
    canvas_spy paper;
} view;

/* The last frame with 2 px to the mm, drawn. */
static void draw(view *v, const trajectory_fixture *f, const char *name, bool is_binned)
{
    outcome o = {0};
    assert_true(quantity_find(&v->q, f->reader, name, &o));
    assert_true(snapshot_create(&v->s, f->reader, &v->q, &o));
    assert_true(snapshot_load(&v->s, TRAJECTORY_FIXTURE_FRAMES - 1, &o));
    v->p = palette_make(v->q.scale);
    v->look = (panel_look){&v->p, colour_range_around(v->s.reach, v->q.scale == PALETTE_DIVERGING), 1.0, is_binned};
    v->at = (panel){{-0.02, -0.02, 0.04, 0.04}, {10, 20, 130, 140}};
    v->paper = canvas_spy_new();
    assert_true(panel_draw(&v->at, &v->s, &v->look, &v->paper.face));
    assert_int_equal(v->paper.depth, 0);
}

TEST(scale_is_pixels_by_metres)
{
    const panel p = {{0, 0, 0.5, 1}, {0, 0, 100, 200}};
    assert_close(panel_scale(&p), 200.0, 1e-12);
    assert_true(panel_thickness(0.1) > 0.5 && panel_thickness(1e3) < 5.0);
}

/* All springs, the loose node, and the frame around. */
TEST(springs_points_and_ground_are_drawn)
{
    trajectory_fixture *f = *test_state;
    view v;
    draw(&v, f, "strain", false);
    assert_int_equal(v.paper.strokes, v.s.lattice->n_springs + 2);
    assert_int_equal(v.paper.fills, 1);
    assert_non_null(strstr(v.paper.attributes, "id=\"frame-5\" data-time=\"0.001\""));
    snapshot_free(&v.s);
}

static dem_status lost(void *context, double t, dem_pose *pose)
{
    (void)context, (void)t;
    pose->angle = (double)NAN;
    return DEM_OK;
}

/* As of a run whose record of a motion is damaged. */
TEST(an_obstacle_without_a_place_is_not_drawn)
{
    trajectory_fixture *f = *test_state;
    view v;
    dem_obstacle *slope = (dem_obstacle *)(uintptr_t)dem_reader_obstacle(f->reader, 0);
    const dem_obstacle was = *slope;
    slope->motion = lost, slope->most_speed = slope->most_acceleration = 1.0;
    draw(&v, f, "strain", false);
    assert_int_equal(v.paper.fills, 0);
    assert_int_equal(v.paper.strokes, v.s.lattice->n_springs + 2);
    *slope = was;
    snapshot_free(&v.s);
}

TEST(numbers_of_nodes_fill_triangles)
{
    trajectory_fixture *f = *test_state;
    view v;
    draw(&v, f, "speed", false);
    assert_int_equal(v.paper.fills, v.s.lattice->n_triangles + 1);
    assert_int_equal(v.paper.strokes, 2);
    snapshot_free(&v.s);
}

/* Each pixel of the image stands for a quarter of one of the picture; 20 mm are 40 px. */
TEST(binned_ones_are_an_image)
{
    trajectory_fixture *f = *test_state;
    view v;
    draw(&v, f, "speed", true);
    assert_int_equal(v.paper.images, 1);
    assert_int_equal(v.paper.image.width, 240);
    assert_int_equal(v.paper.image.height, 240);
    assert_close((double)v.paper.opaque, 80.0 * 80.0, 0.15 * 80.0 * 80.0); /* compressed, and in whole triangles */
    assert_int_equal(v.paper.strokes, 2);
    snapshot_free(&v.s);
    draw(&v, f, "strain", true);
    assert_true(v.paper.opaque > 2000 && v.paper.opaque < 6400); /* lines have gaps between */
    snapshot_free(&v.s);
}

/* Triangles, springs, and triangles binned: with an edge of 4 mm each is of 111 pixels. */
TEST(what_is_broken_is_left_out)
{
    CLEANUP(trajectory_fixture_close) trajectory_fixture f = trajectory_fixture_run(true);
    view v;
    draw(&v, &f, "speed", false);
    assert_int_equal(v.paper.fills, v.s.lattice->n_triangles - TRAJECTORY_FIXTURE_BROKEN + 1);
    snapshot_free(&v.s);
    draw(&v, &f, "strain", false);
    assert_in_range((size_t)v.s.lattice->n_springs + 2 - v.paper.strokes, 1, 3 * TRAJECTORY_FIXTURE_BROKEN);
    snapshot_free(&v.s);
    draw(&v, &f, "speed", true);
    const size_t without = v.paper.opaque;
    memset(v.s.broken_triangles, 0, (size_t)v.s.lattice->n_triangles);
    v.paper = canvas_spy_new();
    assert_true(panel_draw(&v.at, &v.s, &v.look, &v.paper.face));
    assert_in_range(v.paper.opaque - without, 250, 600);
    snapshot_free(&v.s);
}

TEST(what_is_out_of_view_is_left_out)
{
    trajectory_fixture *f = *test_state;
    view v;
    draw(&v, f, "strain", false);
    v.at.view = (box){1.0, 1.0, 1.06, 1.06};
    v.paper = canvas_spy_new();
    assert_true(panel_draw(&v.at, &v.s, &v.look, &v.paper.face));
    assert_int_equal(v.paper.strokes, 2);
    snapshot_free(&v.s);
}

TEST_GROUP(trajectory_fixture_begin, trajectory_fixture_end);
