/* SPDX-License-Identifier: BSD-3-Clause */
/* obstacles.c: keys that go together, polylines that are made, and how they stand at the beginning. What decks report
 * is test_deck's. */
#include "unit/reading.h"

#include "obstacles.h"

/* A deck of obstacles alone, which lacks all else. */
static resolved resolve_obstacles(const char *text)
{
    resolved r = resolve(text);
    namelist_errors_free(&r.errors);
    r.errors = (namelist_errors){0};
    return r;
}

TEST(obstacles_are_made_in_their_order)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_obstacles(
        "&obstacle points = 0,0, 1,0, 1,2, restitution = 0.25, friction = 0.5 /\n"
        "&obstacle restitution = 0, points = 0,5, 4,5, profile = 'smooth', resolution = 1, spin = 3,\n"
        "motion = 'rotate', friction_law = 'paper', friction = 0.75 /\n");
    obstacles_check(&r.deck, &r.errors);
    obstacles_drop_unused(&r.deck);
    dem_obstacle *made = obstacles_make(&r.deck, &r.errors);
    assert_non_null(made);
    assert_int_equal(r.errors.n, 0);
    assert_int_equal(made[0].n_points, 3);
    assert_true(made[0].points[5] == 2.0 && made[0].restitution == 0.25 && made[0].friction == 0.5);
    assert_int_equal(made[0].friction_law, DEM_FRICTION_COULOMB);
    assert_int_equal(made[1].n_points, 5);
    assert_true(made[1].points[2] == 1.0 && made[1].points[3] == 5.0 && made[1].spin == 3.0);
    assert_int_equal(made[1].friction_law, DEM_FRICTION_PAPER);
    obstacles_free(made, 2);
}

TEST(faults_name_their_obstacle)
{
    CLEANUP(drop_resolved)
    resolved r =
        resolve_obstacles("&obstacle restitution = 0, points = 0,0, 1,0 /\n"
                          "&obstacle restitution = 0, points = 1,0, 0,0, profile = 'smooth', roughness = 1e-3 /\n");
    obstacles_check(&r.deck, &r.errors);
    assert_int_equal(r.errors.n, 2);
    assert_non_null(strstr(r.errors.list[0].text, "'roughness'"));
    assert_non_null(strstr(r.errors.list[1].text, "point 2 of obstacle 2"));
}

/* That is seen when it is made, as that of a profile has to be. */
TEST(a_polyline_that_meets_itself_is_reported)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_obstacles(
        "&obstacle restitution = 0, points = 0,0, 1,0 /\n&obstacle restitution = 0, points = 0,0, 2,0, 1,1, 1,-1 /\n");
    obstacles_check(&r.deck, &r.errors);
    assert_int_equal(r.errors.n, 0);
    dem_obstacle *made = obstacles_make(&r.deck, &r.errors);
    assert_non_null(made);
    assert_int_equal(r.errors.n, 1);
    assert_non_null(strstr(r.errors.list[0].text, "segment 1 of obstacle 2 meets segment 3"));
    obstacles_free(made, 2);
}

TEST(a_motion_that_cannot_be_computed_with_is_reported)
{
    CLEANUP(drop_resolved)
    resolved r = resolve_obstacles("&obstacle restitution = 0, points = 0,0, 1,0 /\n"
                                   "&obstacle restitution = 0, points = 0,0, 1,0, motion = 'rotate', spin = 1e200 /\n");
    obstacles_check(&r.deck, &r.errors);
    assert_int_equal(r.errors.n, 0);
    dem_obstacle *made = obstacles_make(&r.deck, &r.errors);
    assert_non_null(made);
    assert_int_equal(r.errors.n, 1);
    assert_string_equal(r.errors.list[0].text,
                        "obstacle 2: spin makes it move by up to 1e+200 m/s and inf m/s^2, which "
                        "cannot be computed with");
    obstacles_free(made, 2);
}

TEST(a_still_obstacle_is_where_the_moving_one_begins)
{
    const double points[4] = {0.0, 1.0, 2.0, 1.0};
    const dem_obstacle table = {.struct_size = sizeof table,
                                .n_points = 2,
                                .points = points,
                                .friction = 0.5,
                                .velocity = {9.0, 9.0},
                                .amplitude = {0.0, 0.25},
                                .frequency = 3.0,
                                .phase = 90.0};
    dem_obstacle *still = obstacles_still(&table, 1);
    assert_non_null(still);
    assert_false(dem_obstacle_moves(still, NULL));
    assert_true(still->points[0] == 0.0 && still->points[1] == 1.25 && still->points[3] == 1.25);
    assert_close(still->friction, 0.5, 0.0);
    obstacles_free(still, 1);
}
