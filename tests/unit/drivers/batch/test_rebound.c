/* SPDX-License-Identifier: BSD-3-Clause */
/* rebound.c: nodes on floors, whose motion is known. Steps and impacts are located to some 1e-12 (rtol 1e-12). */
#include "rebound.h"

#include <stdlib.h>
#include <string.h>

#include "verification/support.h"

static const double g = 9.81, height = 0.5, eta = 0.5, near = 1e-9;
static const double extent = 1.0; /* m, of two nodes */
static char text[4096];

static dem_status step(void *context, const dem_simulation *simulation)
{
    dem_progress now = {.struct_size = sizeof now};
    assert_ok(dem_simulation_progress(simulation, &now));
    rebound_follow(context, simulation, &now);
    return DEM_OK;
}

static initial_motion initial; /* of the nodes that run */

static dem_status event(void *context, const dem_simulation *simulation, const dem_event *e)
{
    rebound_note(context, &initial, simulation, e);
    return DEM_OK;
}

/* An observer that sees steps in which something touches, and hardly another one, has to come to the same. */
static void assert_alike(const rebound *all, const rebound *few)
{
    assert_memory_equal(all, few, offsetof(rebound, started));
    assert_int_equal(all->n_contacts, few->n_contacts);
}

/* Runs nodes of 2 kg without springs. */
static rebound run_over(support_run *run, dem_index n, const double *x, const double *v, const dem_obstacle *floors,
                        dem_index n_floors, double t_end)
{
    const double mass[2] = {2.0, 2.0};
    dem_options options = dem_options_default();
    rebound r, few;
    memset(&r, 0, sizeof r);
    memset(&few, 0, sizeof few);
    dem_observer observer = {.struct_size = sizeof(dem_observer), .step = step, .event = event, .context = &r};
    options.spacing = 1.0, options.max_step = 0.01, options.rtol = 1e-12, options.v_scale = 1.0;
    options.penetration_tolerance = 1e-13;
    dem_lattice lattice = support_lattice(n, x, mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v);
    lattice.body = calloc((size_t)n, sizeof *lattice.body);
    assert_non_null(lattice.body);
    for (dem_index i = 0; i < n; i++) lattice.body[i] = (int32_t)i; /* without springs each is a body of its own */
    initial = (initial_motion){0};
    for (dem_index i = 0; i < n; i++) initial_motion_add(&initial, &lattice, i);
    support_open(run, &lattice, floors, n_floors, &options);
    dem_lattice_free(&lattice);
    assert_ok(dem_simulation_observe(run->simulation, &observer));
    observer.step_every = 1000;
    observer.step_touching = true;
    observer.context = &few;
    assert_ok(dem_simulation_observe(run->simulation, &observer));
    assert_ok(dem_simulation_advance(run->simulation, t_end));
    assert_alike(&r, &few);
    return r;
}

static rebound run_nodes(support_run *run, dem_index n, const double *x, const double *v, const dem_obstacle *floor,
                         double t_end)
{
    return run_over(run, n, x, v, floor, 1, t_end);
}

static void print_run(const rebound *r, const dem_simulation *simulation, bool rests)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    rebound_print(file, r, simulation, extent, rests);
    rebound_print_details(file, r, simulation);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    assert_int_equal(fclose(file), 0);
}

static void print(const rebound *r, const dem_simulation *simulation)
{
    print_run(r, simulation, false);
}

static const double flat[4] = {-9.0, 0.0, 9.0, 0.0};

TEST(a_node_leaves_as_restitution_has_it)
{
    const double x[2] = {0.0, height}, v[2] = {0.25, 0.0}, t = sqrt(2.0 * height / g), fall = g * t;
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = flat, .restitution = eta};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 1.5 * t);
    const rebound_normal along = rebound_along(&r, run.simulation);
    assert_true(r.touched);
    assert_close(r.first, t, near);
    assert_close(r.last, t, near);
    assert_close(r.touching, 0.0, 0.0);
    assert_int_equal(r.n_bounces, 1);
    assert_close(r.approach[0], 0.25, near);
    assert_close(r.approach[1], -fall, near);
    assert_close(r.velocity[0], 0.25, near);
    assert_close(r.velocity[1], eta * fall, near);
    assert_close(r.speed, eta * fall, near);
    assert_close(r.spin, 0.0, 0.0);
    assert_close(r.normal[0], 0.0, 0.0);
    assert_close(r.normal[1], 1.0, 0.0);
    assert_close(along.in, -fall, near);
    assert_close(along.out, eta * fall, near);
    assert_close(along.ratio, eta, near);
    assert_close(r.impulse[0], 0.0, near);
    assert_close(r.impulse[1], 2.0 * (1.0 + eta) * fall, near);
    assert_close(r.reaction[1], 0.0, 0.0);
    print(&r, run.simulation);
    assert_non_null(strstr(text, " s, touching 0.0000e+00 s\n"));
    assert_non_null(
        strstr(text, "\nrebound    (+0.25, +1.566) m/s of the centre of mass at the last contact, spin +0 "));
    assert_non_null(
        strstr(text, "\nnormal     of obstacle 1, (0, 1): -3.1321 m/s before, +1.566 m/s after, ratio 0.5"));
    assert_non_null(
        strstr(text, "\nforce      largest at 0.0000e+00 s, by lasting contacts; impacts gave (0, 9.39628) N s\n"));
}

/* The third bounce comes at t (1 + 2 eta + 2 eta^2) with eta^2 of the first speed. */
TEST(of_three_bounces_the_last_is_given)
{
    const double x[2] = {0.0, height}, v[2] = {0.0, 0.0}, t = sqrt(2.0 * height / g), fall = g * t;
    const double third = t * (1.0 + 2.0 * eta + 2.0 * eta * eta);
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = flat, .restitution = eta};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, third + 0.1 * t);
    const rebound_normal along = rebound_along(&r, run.simulation);
    assert_int_equal(r.n_bounces, 3);
    assert_close(r.first, t, near);
    assert_close(r.begin, third, near);
    assert_close(along.in, -eta * eta * fall, near);
    assert_close(along.out, eta * eta * eta * fall, near);
    assert_close(along.ratio, eta, near);
    assert_false(along.along_impulse);
    print(&r, run.simulation);
    assert_non_null(strstr(text, "\nnormal     of obstacle 1, (0, 1): 3 bounces; last: -0.78302 m/s before, +0.39151 "
                                 "m/s after, ratio 0.5"));
}

/* Two nodes hit the sides of a groove, whose slopes are -1 and 1/3, at once: they are given impulses like (5, 5) and
 * (-3, 9), together along (1, 7). With them their centre of mass leaves at (0.15, 0.05) of the speed of the fall. */
TEST(in_a_groove_the_normal_is_along_the_impulse)
{
    static const double groove[6] = {-9.0, 9.0, 0.0, 0.0, 9.0, 3.0};
    const double x[4] = {-1.0, 1.0 + height, 3.0, 1.0 + height}, v[4] = {0.0, 0.0, 0.0, 0.0};
    const double t = sqrt(2.0 * height / g), fall = g * t, size = sqrt(50.0);
    const dem_obstacle floor = {
        .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = groove, .restitution = eta};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 2, x, v, &floor, 1.04 * t);
    const rebound_normal along = rebound_along(&r, run.simulation);
    assert_int_equal(r.n_bounces, 1);
    assert_true(along.along_impulse);
    assert_close(along.normal[0], 1.0 / size, near);
    assert_close(along.normal[1], 7.0 / size, near);
    assert_close(along.in, -7.0 / size * fall, near);
    assert_close(along.out, 0.5 / size * fall, near);
    assert_close(along.ratio, 1.0 / 14.0, near);
    print(&r, run.simulation);
    assert_non_null(strstr(text, "\nnormal     of obstacle 1, (0.1414, 0.9899) along its impulse: -3.1"));
}

/* A point on the straight line does not make it a polyline. */
TEST(a_straight_line_of_several_points_keeps_its_normal)
{
    static const double points[6] = {-9.0, 0.0, 3.0, 0.0, 9.0, 0.0};
    const double x[2] = {0.0, height}, v[2] = {0.0, 0.0}, t = sqrt(2.0 * height / g);
    const dem_obstacle floor = {
        .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = points, .restitution = eta};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 1.5 * t);
    assert_false(rebound_along(&r, run.simulation).along_impulse);
}

/* Its last point is its first, so that no line joins the two. */
TEST(a_closed_obstacle_is_not_straight)
{
    static const double box[10] = {-9.0, 0.0, 9.0, 0.0, 9.0, -5.0, -9.0, -5.0, -9.0, 0.0};
    const double x[2] = {0.0, height}, v[2] = {0.0, 0.0}, t = sqrt(2.0 * height / g);
    const dem_obstacle block = SIZED(dem_obstacle, .n_points = 5, .points = box, .restitution = eta);
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &block, 1.5 * t);
    assert_true(rebound_along(&r, run.simulation).along_impulse);
}

/* A slope of 45 degrees turns the fall into a flight along x; of that the normal has 1/sqrt(2). */
TEST(the_normal_is_that_of_the_slope)
{
    static const double slope[4] = {-9.0, 9.0, 9.0, -9.0};
    const double x[2] = {0.0, height}, v[2] = {0.0, 0.0}, t = sqrt(2.0 * height / g), fall = g * t;
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = slope, .restitution = 1.0);
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 1.2 * t);
    const rebound_normal along = rebound_along(&r, run.simulation);
    assert_close(r.normal[0], sqrt(0.5), near);
    assert_close(r.normal[1], sqrt(0.5), near);
    assert_close(r.velocity[0], fall, near);
    assert_close(r.velocity[1], 0.0, near);
    assert_close(along.in, -fall * sqrt(0.5), near);
    assert_close(along.ratio, 1.0, near);
}

/* Seen from a floor that rises at 1 m/s. */
TEST(the_ratio_is_against_a_moving_obstacle)
{
    const double x[2] = {0.0, height}, v[2] = {0.0, -2.0};
    const dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = 2, .points = flat, .restitution = eta, .velocity = {0.0, 1.0});
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 0.2);
    assert_true(r.touched);
    assert_close(rebound_along(&r, run.simulation).ratio, eta, near);
    assert_true(fabs(r.velocity[1] + eta * r.approach[1]) > 1.0); /* at rest it would be 0 */
}

/* Of a floor that swings and turns the velocity counts at the place and the time of the impact. */
TEST(the_ratio_is_against_the_point_that_was_hit)
{
    const double x[2] = {0.5, height}, v[2] = {0.0, -2.0};
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = flat, .restitution = eta,
                                     .amplitude = {0.0, 0.05}, .frequency = 1.0, .phase = -40.0, .spin = 0.3);
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 0.3);
    double w[2];
    assert_true(rebound_is_over(&r));
    assert_ok(dem_obstacle_velocity(&floor, r.last, (const double[2]){0.5, 0.0}, w));
    assert_true(hypot(w[0], w[1]) > 0.1);
    assert_close(rebound_along(&r, run.simulation).ratio, eta, near);
}

/* Of two nodes the left one meets a floor that rises at 1 m/s, at h - 2 t - g t^2/2 = t, the right one a moment later a
 * floor at rest: the velocity before the bounce is against where it began. */
TEST(the_velocity_before_is_against_the_ground_that_was_met_first)
{
    const double x[4] = {-1.0, height, 1.0, height + 0.1}, v[4] = {0.0, -2.0, 0.0, -2.0};
    const double left[4] = {-2.0, 0.0, -0.5, 0.0}, right[4] = {0.5, 0.0, 2.0, 0.0};
    const dem_obstacle floors[2] = {
        SIZED(dem_obstacle, .n_points = 2, .points = left, .restitution = eta, .velocity = {0.0, 1.0}),
        SIZED(dem_obstacle, .n_points = 2, .points = right, .restitution = eta)};
    const double t = (sqrt(9.0 + 2.0 * g * height) - 3.0) / g;
    CLEANUP(support_close) support_run run;
    const rebound r = run_over(&run, 2, x, v, floors, 2, 0.3);
    assert_true(rebound_is_over(&r) && r.several);
    assert_int_equal(r.n_bounces, 1);
    assert_int_equal(r.obstacle, 1);
    assert_close(rebound_along(&r, run.simulation).in, -2.0 - g * t - 1.0, near);
}

/* Of two nodes one hits, the other falls on beside the floor: L = -m (1 + eta) v, J = 2 m. */
TEST(the_spin_is_angular_momentum_over_inertia)
{
    static const double left[4] = {-9.0, 0.0, 0.0, 0.0};
    const double x[4] = {-1.0, height, 1.0, height}, v[4] = {0.0, 0.0, 0.0, 0.0}, t = sqrt(2.0 * height / g);
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = left, .restitution = eta};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 2, x, v, &floor, 1.04 * t);
    /* Measured at the end of the step, at most 0.01 s later: by then the nodes are 0.05 m apart in height. */
    assert_close(r.spin, -0.5 * (1.0 + eta) * g * t, 5e-3);
}

TEST(what_rests_touches_all_the_time)
{
    const double x[2] = {0.0, 0.0}, v[2] = {0.0, 0.0};
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = flat};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 1.0);
    assert_close(r.first, 0.0, 0.0);
    assert_close(r.touching, r.last, 1e-12); /* a sum of a hundred steps */
    assert_true(r.last > 0.98);              /* the end of a step */
    assert_close(r.reaction[1], 2.0 * g, near);
    assert_true(isnan(rebound_along(&r, run.simulation).ratio)); /* it did not come */
    print(&r, run.simulation);
    assert_non_null(strstr(text, " s (still touching); largest force (0, 19.62) N\n"));
    assert_non_null(strstr(text, "\nrebound    not yet: 1 contact at t_end; give a later t_end\n"));
    assert_null(strstr(text, "ratio"));
    print_run(&r, run.simulation, true); /* a run that ends at rest has no rebound to come */
    assert_null(strstr(text, "rebound"));
}

/* A perfectly plastic impact at 1 m/s upon a floor that ends: it slides on the floor and leaves it at its end. */
TEST(what_slides_off_has_touched_from_impact_to_end)
{
    static const double table[4] = {-9.0, 0.0, 1.0, 0.0};
    const double x[2] = {0.0, 1e-3}, v[2] = {2.0, -1.0};
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = table};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 0.7);
    assert_close(r.last, 0.5, near); /* 1 m at 2 m/s */
    assert_close(r.touching, r.last - r.first, near);
    assert_true(r.first > 0.0 && r.touching > 0.49);
    assert_close(r.velocity[0], 2.0, near);
    assert_close(r.velocity[1], 0.0, near);
}

TEST(what_touches_from_the_beginning_comes_with_its_first_velocity)
{
    const double x[2] = {0.0, 0.0}, v[2] = {1.0, -3.0};
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = flat, .restitution = eta};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 0.1);
    assert_close(r.approach[0], 1.0, near);
    assert_close(r.approach[1], -3.0, near);
    assert_close(rebound_along(&r, run.simulation).ratio, eta, near);
}

TEST(without_a_touch_there_is_nothing)
{
    const double x[2] = {0.0, height}, v[2] = {0.0, 0.0};
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = flat};
    CLEANUP(support_close) support_run run;
    const rebound r = run_nodes(&run, 1, x, v, &floor, 0.1);
    assert_false(r.touched);
    assert_true(isnan(rebound_along(&r, run.simulation).in));
    print(&r, run.simulation);
    assert_string_equal(text, "contact    none\n");
}

/* A body that comes and leaves straight: what is left of sums that cancel must not look like a result. */
TEST(rounding_is_printed_as_zero)
{
    const double x[4] = {-0.5, height, 0.5, height}, v[4] = {0.0, 0.0, 0.0, 0.0};
    const dem_obstacle floor = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = flat, .restitution = eta};
    CLEANUP(support_close) support_run run;
    rebound r = run_nodes(&run, 2, x, v, &floor, 0.7);
    assert_true(r.touched);
    for (int small = 0; small < 2; small++) {
        const double size = small ? 1e-13 : 1e-11; /* of speeds of 1 to 4 m/s: on both sides of 1e-12 */
        r.velocity[0] = r.approach[0] = r.spin = size;
        print(&r, run.simulation);
        assert_int_equal(strstr(text, "\nrebound    (+0, +") != NULL, small);
        assert_int_equal(strstr(text, " last contact, spin +0 rad/s\n") != NULL, small);
    }
}
