/* SPDX-License-Identifier: BSD-3-Clause */
/* One node against the vertices of polylines: every outcome is a closed form of ballistics. Tolerances: the
 * penetration tolerance of 1e-13 m, rtol of 1e-12 and the rounding of coordinates near 1 m leave errors well below
 * 1e-9. */
#include "harness/motion.h"
#include "support.h"

static const double g = 9.81;

static void check_state(motion state, double x, double y, double u, double v, double tolerance)
{
    assert_close(state.x[0], x, tolerance);
    assert_close(state.x[1], y, tolerance);
    assert_close(state.v[0], u, tolerance);
    assert_close(state.v[1], v, tolerance);
}

static const double roof[6] = {-1.0, -1.0, 0.0, 0.0, 1.0, -1.0};

/* On the ridge of a roof both flanks are approached alike: the one that ends there is met, and turns (0, -u) into
 * (-u, 0). */
TEST(a_node_falling_on_a_ridge_meets_the_flank_that_ends_there)
{
    const double x[2] = {0.0, 0.5}, v[2] = {0.0, 0.0}, fall = sqrt(2.0 * 0.5 / g), u = g * fall;
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, roof, 3, 1.0);
    const motion state = support_at(&run, fall + 0.01);
    assert_int_equal(run.n_impacts, 1);
    assert_int_equal(run.impacts[0].segment, 0);
    check_state(state, -0.01 * u, -0.5 * g * 1e-4, -u, -0.01 * g, 1e-9);
}

/* With a velocity towards one flank that flank is approached faster. */
TEST(a_node_moving_sideways_over_a_ridge_meets_the_flank_it_runs_into)
{
    const double fall = sqrt(2.0 * 0.5 / g), u = g * fall, drift = -0.5;
    const double x[2] = {-drift * fall, 0.5}, v[2] = {drift, 0.0};
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, roof, 3, 1.0);
    (void)support_at(&run, fall + 0.01);
    assert_int_equal(run.n_impacts, 1);
    assert_int_equal(run.impacts[0].segment, 1);
    assert_close(run.impacts[0].after[0], u,
                 1e-9); /* reflection at the normal (1, 1)/sqrt 2 swaps and turns the components */
    assert_close(run.impacts[0].after[1], -drift, 1e-9);
}

TEST(a_plastic_node_on_a_ridge_slides_down_one_flank)
{
    const double x[2] = {0.0, 0.5}, v[2] = {0.0, 0.0}, fall = sqrt(2.0 * 0.5 / g), u = g * fall, t = 0.1;
    const double along =
        0.5 * sqrt(2.0) * u * t + 0.25 * sqrt(2.0) * g * t * t; /* starts with u sin 45, gains g sin 45 */
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, roof, 3, 0.0);
    const motion state = support_at(&run, fall + t);
    assert_int_equal(state.n_contacts, 1);
    assert_close(hypot(state.x[0], state.x[1]), along, 1e-9);
    assert_close(state.x[0], state.x[1], 1e-12); /* on the left flank */
    assert_close(state.contacts[0].force, g * cos(M_PI / 4.0), 1e-12);
}

TEST(a_node_sliding_off_a_free_end_flies_on)
{
    const double points[4] = {-1.0, 0.0, 1.0, 0.0}, x[2] = {0.0, 0.0}, v[2] = {2.0, 0.0}, t = 0.3;
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, points, 2, 0.5);
    const motion state = support_at(&run, 0.5 + t);
    check_state(state, 1.0 + 2.0 * t, -0.5 * g * t * t, 2.0, -g * t, 1e-9);
    assert_int_equal(ask_counts(run.simulation).passings, 1);
    assert_int_equal(state.n_contacts, 0);
}

/* Off a convex end on to a slope of 45 degrees below: flight of 2 u/g, then it slides with what the slope leaves of
 * its speed. */
TEST(a_node_sliding_over_a_convex_bend_flies_and_lands_on_the_slope)
{
    const double points[6] = {-1.0, 0.0, 0.0, 0.0, 5.0, -5.0}, x[2] = {-0.5, 0.0}, v[2] = {1.0, 0.0};
    const double flight = 2.0 / g, root = sqrt(0.5), t = 0.2;
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, points, 3, 0.0);
    const motion state = support_at(&run, 0.5 + flight + t);
    assert_int_equal(run.n_impacts, 1);
    assert_close(run.impacts[0].t, 0.5 + flight, 1e-9);
    const double speed = root * (1.0 + g * flight), along = flight / root + speed * t + 0.5 * root * g * t * t;
    check_state(state, root * along, -root * along, root * (speed + root * g * t), -root * (speed + root * g * t),
                1e-9);
}

TEST(a_node_glides_over_a_vertex_without_a_bend)
{
    const double points[8] = {-1.0, -0.5, 0.0, 0.0, 1.0, 0.5, 2.0, 1.0}, x[2] = {1.5, 0.75}, v[2] = {0.0, 0.0};
    const double sine = 1.0 / sqrt(5.0), cosine = 2.0 / sqrt(5.0), t = 0.95; /* 0.5 g sine t^2 = 1.98 m down the line */
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, points, 4, 0.3);
    const motion state = support_at(&run, t);
    const double along = 0.5 * g * sine * t * t;
    check_state(state, 1.5 - cosine * along, 0.75 - sine * along, -cosine * g * sine * t, -sine * g * sine * t, 1e-9);
    assert_int_equal(ask_counts(run.simulation).passings, 2);
    assert_int_equal(run.n_impacts, 0);
}

/* A floor that turns up by 30 degrees: plastic keeps cos 30 of the speed at each passage, elastic reflects. */
TEST(a_node_running_into_a_concave_bend_takes_its_impact)
{
    const double c = cos(M_PI / 6.0), s = sin(M_PI / 6.0), points[6] = {-9.0, 0.0, 0.0, 0.0, 4.0 * c, 4.0 * s};
    const double x[2] = {-1.0, 0.0}, v[2] = {2.0, 0.0}, up_and_down = 2.0 * 2.0 * c / (g * s);
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, points, 3, 0.0);
    motion state = support_at(&run, 0.5 + 0.1);
    const double along = 2.0 * c * 0.1 - 0.5 * g * s * 0.01;
    check_state(state, c * along, s * along, c * (2.0 * c - g * s * 0.1), s * (2.0 * c - g * s * 0.1), 1e-9);
    state = support_at(&run, 0.5 + up_and_down + 1.0);
    check_state(state, -2.0 * c * c, 0.0, -2.0 * c * c, 0.0, 1e-9);
    assert_int_equal(run.n_impacts, 2);
    support_close(&run);
    support_point(&run, 1.0, x, v, points, 3, 1.0);
    state = support_at(&run, 0.5 + 0.05);
    check_state(state, 2.0 * cos(M_PI / 3.0) * 0.05, 2.0 * sin(M_PI / 3.0) * 0.05 - 0.5 * g * 0.0025,
                2.0 * cos(M_PI / 3.0), 2.0 * sin(M_PI / 3.0) - g * 0.05, 1e-9);
}

static const double groove[6] = {-1.0, 1.0, 0.0, 0.0, 1.0, 1.0};

TEST(a_plastic_node_falling_into_a_groove_is_held_by_both_flanks)
{
    const double x[2] = {0.0, 0.5}, v[2] = {0.0, 0.0};
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, groove, 3, 0.0);
    const motion state = support_at(&run, 1.5);
    check_state(state, 0.0, 0.0, 0.0, 0.0, 1e-12);
    assert_int_equal(state.n_contacts, 2);
    for (int k = 0; k < 2; k++) assert_close(state.contacts[k].force, g * cos(M_PI / 4.0), 1e-12);
}

/* By Moreau's law both normals act and the velocity is reversed, less restitution. */
TEST(an_elastic_node_falling_into_a_groove_comes_straight_back)
{
    const double x[2] = {0.0, 0.5}, v[2] = {0.0, 0.0}, fall = sqrt(2.0 * 0.5 / g);
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, groove, 3, 1.0);
    const motion state = support_at(&run, 2.0 * fall);
    check_state(state, 0.0, 0.5, 0.0, 0.0, 1e-8);
}

/* Back and forth in a plastic V groove the speed falls by cos(bend) at each passage of the bottom, a series with an
 * end: rest. */
TEST(a_node_sliding_in_a_groove_comes_to_rest_at_the_bottom)
{
    const double points[6] = {-2.0, 1.0, 0.0, 0.0, 2.0, 1.0}, x[2] = {-1.0, 0.5}, v[2] = {0.0, 0.0};
    const double s = 1.0 / sqrt(5.0), keep = 0.6; /* cos of twice the angle of slope 1/2 */
    const double down = sqrt(2.0 * sqrt(1.25) / (g * s)), end = down + 2.0 * down * keep / (1.0 - keep);
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, points, 3, 0.0);
    const motion state = support_at(&run, end + 0.01);
    check_state(state, 0.0, 0.0, 0.0, 0.0, 1e-12);
    assert_int_equal(state.n_contacts, 2);
    assert_close(run.impacts[run.n_impacts - 1].t, end, 1e-4);
    assert_true(run.n_impacts > 10);
}

TEST(a_wall_of_another_obstacle_stops_a_sliding_node)
{
    const double x[2] = {-0.5, 0.0}, v[2] = {1.0, 0.0}, mass = 2.0;
    const double ground[4] = {-1.0, 0.0, 1.0, 0.0}, wall[4] = {0.5, -1.0, 0.5, 1.0};
    const dem_obstacle obstacles[2] = {
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = ground, .restitution = 0.0},
        {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall, .restitution = 0.5}};
    dem_options options = support_options();
    CLEANUP(support_close) support_run run;
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.01;
    options.rtol = 1e-12;
    options.penetration_tolerance = 1e-13;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v);
    support_open(&run, &lattice, obstacles, 2, &options);
    const motion state = support_at(&run, 1.2);
    check_state(state, 0.5 - 0.5 * 0.2, 0.0, -0.5, 0.0, 1e-9);
    assert_close(ask_obstacle(run.simulation, 1).impulse[0], -2.0 * 1.5, 1e-12);
    assert_close(ask_obstacle(run.simulation, 1).impulse[1], 0.0, 1e-12);
    assert_int_equal(run.n_impacts, 1);
}

/* Round the free end from below, up through the back unhindered, and down on the front. */
TEST(a_node_coming_from_behind_passes_and_then_lands_on_the_front)
{
    const double points[4] = {0.0, 0.0, 4.0, 0.0}, x[2] = {-0.05, -0.5}, v[2] = {1.0, 5.0};
    const double through = (5.0 - sqrt(25.0 - 2.0 * g * 0.5)) / g, lands = (5.0 + sqrt(25.0 - 2.0 * g * 0.5)) / g;
    CLEANUP(support_close) support_run run;
    support_point(&run, 1.0, x, v, points, 2, 0.0);
    (void)support_at(&run, 0.5 * (0.05 + through));
    assert_int_equal(ask_counts(run.simulation).behind, 1);
    (void)support_at(&run, 0.5);
    assert_int_equal(ask_counts(run.simulation).behind, 0);
    assert_int_equal(run.n_impacts, 0);
    const motion state = support_at(&run, lands + 0.1);
    assert_int_equal(run.n_impacts, 1);
    assert_close(run.impacts[0].t, lands, 1e-9);
    check_state(state, -0.05 + lands + 0.1, 0.0, 1.0, 0.0, 1e-9);
}

/* Rest at the bottom of valleys from nearly straight to narrow, and in a right corner turned by any angle: held for
 * ever. */
TEST(a_node_at_rest_in_a_corner_stays)
{
    static const double slopes[4] = {1e-6, 4e-3, 1.0, 100.0};
    const double v[2] = {0.0, 0.0};
    support_run run;
    for (int k = 0; k < 4; k++) {
        const double x[2] = {0.0, 0.0}, valley[6] = {-1.0 / slopes[k], 1.0, 0.0, 0.0, 1.0 / slopes[k], 1.0};
        support_point(&run, 1.0, x, v, valley, 3, 0.0);
        const motion state = support_at(&run, 1.0);
        check_state(state, 0.0, 0.0, 0.0, 0.0, 1e-12);
        assert_int_equal(state.n_contacts, 2);
        support_close(&run);
    }
    for (int k = 0; k < 50; k++) {
        const double c = cos(0.015 + 0.03 * k), s = sin(0.015 + 0.03 * k), x[2] = {0.3, 0.1};
        const double corner[6] = {x[0] - c, x[1] + s, x[0], x[1], x[0] + s, x[1] + c};
        support_point(&run, 1.0, x, v, corner, 3, 0.0);
        const motion state = support_at(&run, 0.5);
        check_state(state, x[0], x[1], 0.0, 0.0, 1e-12);
        support_close(&run);
    }
}

/* A block of 2 cm that falls into a valley with a hump, with (10), which lets lasting contacts slide. */
static void open_block(support_run *run, double restitution, double rest_speed)
{
    static const double points[] = {-1.0, 0.2, 0.0, 0.0, 0.004, 0.001, 0.008, 0.0, 1.0, 0.2};
    const dem_obstacle valley = SIZED(dem_obstacle, .n_points = 5, .points = points, .restitution = restitution,
                                      .friction = 0.3, .friction_law = DEM_FRICTION_PAPER);
    const dem_material soft =
        SIZED(dem_material, .youngs_modulus = 1e5, .poissons_ratio = 0.3, .density = 1000.0, .thickness = 0.01);
    const double lift[2] = {0.002, 0.0035}, velocity[2] = {0.3, -1.0};
    dem_options options = support_options();
    options.rest_speed = rest_speed;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(0.02, 0.02, 0.01, &soft);
    dem_lattice_move(&lattice, 0.0, lift);
    assert_ok(dem_lattice_launch(&lattice, velocity));
    support_open(run, &lattice, &valley, 1, &options);
}

/* Whatever its contacts keep up: plastic ones by the corner, others by their rebounds. */
TEST(a_rest_speed_below_the_rule_changes_no_bit)
{
    for (int k = 0; k < 3; k++) {
        CLEANUP(support_close) support_run ruled, slow;
        open_block(&ruled, 0.3 * k, 0.0);
        open_block(&slow, 0.3 * k, 1e-9);
        const motion a = support_at(&ruled, 0.1), b = support_at(&slow, 0.1);
        const size_t size = 2 * (size_t)ask_sizes(ruled.model).n_nodes * sizeof *a.x;
        assert_true(ruled.n_impacts >= 5); /* its lower nodes land, some again */
        assert_int_equal(slow.n_impacts, ruled.n_impacts);
        assert_memory_equal(a.x, b.x, size);
        assert_memory_equal(a.v, b.v, size);
    }
}

/* Floor and wall are two obstacles, the wall stands on the floor or leans over it: at any tilt nothing slips through
 * the joint. */
TEST(a_wall_that_stands_on_another_obstacle_leaves_no_gap)
{
    for (int k = 0; k < 24; k++) {
        const double angle = 0.1 * (k / 2), c = cos(angle), s = sin(angle), lean = k % 2 == 0 ? 0.0 : -0.1;
        const double ground[4] = {-2.0 * c, -2.0 * s, 2.0 * c, 2.0 * s};
        const double wall[4] = {0.5 * c, 0.5 * s, (0.5 + lean) * c - s, (0.5 + lean) * s + c};
        const dem_obstacle obstacles[2] = {
            {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = ground, .restitution = 0.0},
            {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall, .restitution = 0.0}};
        const double x[2] = {0.0, 0.0}, v[2] = {c, s}, mass = 1.0;
        dem_options options = support_options();
        CLEANUP(support_close) support_run run;
        options.gravity[0] = 9.81 * s;
        options.gravity[1] = -9.81 * c;
        options.spacing = options.v_scale = 1.0;
        options.max_step = 1e-3;
        options.penetration_tolerance = 1e-8;
        CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
        support_start(&lattice, NULL, v);
        support_open(&run, &lattice, obstacles, 2, &options);
        const motion state = support_at(&run, 1.0);
        assert_close(state.x[0] * c + state.x[1] * s, 0.5,
                     1e-6); /* 100 penetration tolerances: the lean makes ten of one */
    }
}
