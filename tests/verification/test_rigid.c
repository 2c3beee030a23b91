/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigid bodies: free rotation, collisions with each other and with elastic bodies against closed forms, guides, and
 * what no bit depends on. */
#include "support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "harness/cleanup.h"
#include "harness/message.h"
#include "last_record.h"

static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                         .density = 1050.0, .thickness = 1.0, .guard = 0.02);

static dem_lattice make_rigid(double width, double height, double spacing, dem_guide guide)
{
    dem_lattice l = support_rectangle(width, height, spacing, &rubber);
    assert_ok(dem_lattice_stiffen(&l, guide));
    return l;
}

/* Appends a body and frees it. */
static void append(dem_lattice *to, dem_lattice *body)
{
    assert_ok(dem_lattice_append(to, body));
    dem_lattice_free(body);
}

static dem_options free_options(void)
{
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.bodies = DEM_BODIES_OTHERS;
    return options;
}

/* ---- what is seen at every step ---- */

typedef struct extremes {
    dem_body_motion start; /* of body 0 */
    double energy, kinetic;
    dem_index steps;
    double shape, momentum, spin, closure; /* largest changes, all but the shape over what there was */
} extremes;

static double largest_strain(const dem_simulation *simulation)
{
    const dem_strain strain = ask_strain(simulation);
    return fmax(-strain.min, strain.max);
}

static dem_status look(void *context, const dem_simulation *simulation)
{
    extremes *e = context;
    const dem_body_motion now = ask_body(simulation, 0);
    const dem_energy energy = ask_energy(simulation);
    const double speed = hypot(e->start.velocity[0], e->start.velocity[1]);
    const double change = hypot(now.velocity[0] - e->start.velocity[0], now.velocity[1] - e->start.velocity[1]);
    e->steps++;
    e->shape = fmax(e->shape, largest_strain(simulation));
    e->momentum = fmax(e->momentum, change / speed);
    e->spin = fmax(e->spin, fabs(now.angular_momentum[2] / e->start.angular_momentum[2] - 1.0));
    e->closure = fmax(e->closure, fabs(energy.ledger - e->energy) / e->kinetic);
    return DEM_OK;
}

/* ---- free rotation ---- */

static extremes fly(dem_method method, double step, double t)
{
    extremes e = {.steps = 0};
    const dem_observer observer = SIZED(dem_observer, .context = &e, .step = look);
    CLEANUP(dem_lattice_free) dem_lattice l = make_rigid(0.05, 0.025, 5e-3, DEM_GUIDE_NONE);
    dem_options o = free_options();
    o.method = method;
    o.max_step = step;
    assert_ok(dem_lattice_launch(&l, (const double[2]){1.3, -0.4}));
    assert_ok(dem_lattice_spin(&l, 100.0));
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    e.start = ask_body(simulation, 0);
    e.energy = ask_energy(simulation).ledger;
    e.kinetic = ask_energy(simulation).kinetic;
    assert_ok(dem_simulation_observe(simulation, &observer));
    assert_ok(dem_simulation_advance(simulation, t));
    return e;
}

/* Coordinates of up to 1.5 m are rounded by 1.1e-16 of that, and a spring of 5 mm has four of them: a strain of
 * 1.3e-13. Every step rounds spin and velocity anew, by up to 1.1e-16 each. */
TEST(a_spinning_rigid_body_keeps_its_shape_and_momenta_for_ten_thousand_steps)
{
    const dem_method methods[4] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_RK4, DEM_METHOD_BS23};
    for (int m = 0; m < 4; m++) {
        const extremes e = fly(methods[m], 1e-4, 1.0);
        print_message("# method %d: shape %.1e, momentum %.1e, spin %.1e, energy %.1e\n", (int)methods[m], e.shape,
                      e.momentum, e.spin, e.closure);
        assert_true(e.steps >= 10000);
        assert_true(e.shape < 1.3e-13);
        assert_true(e.momentum < 1e-12);
        assert_true(e.spin < 2e-12);
        assert_true(e.closure < 4e-12);
    }
}

/* A third of a radian in each step: what the method does to the shape, about 1e-6 of it, is taken back at every end,
 * and takes neither spin nor energy with it. Coordinates of 4 m are rounded to strains of 3.5e-13, and a thousand steps
 * round velocities by 1.1e-13: found are 1e-13 each. */
TEST(a_fast_spin_is_kept_by_long_steps)
{
    const dem_method methods[3] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_RK4};
    for (int m = 0; m < 3; m++) {
        const extremes e = fly(methods[m], 3e-3, 3.0);
        print_message("# long steps, method %d: shape %.1e, momentum %.1e, spin %.1e, energy %.1e\n", (int)methods[m],
                      e.shape, e.momentum, e.spin, e.closure);
        assert_true(e.shape < 4e-13);
        assert_true(e.momentum < 2e-13);
        assert_true(e.spin < 2e-13);
        assert_true(e.closure < 4e-13);
    }
}

/* Velocities at the end of whole steps are those of a rotation by omega t to the order of the method: the error of the
 * angle goes with the fourth power of the step or more for Fehlberg's pair, and with the second for Verlet's. */
static double angle_error(dem_method method, double step)
{
    const double omega = 100.0, t = 0.01;
    CLEANUP(dem_lattice_free) dem_lattice l = make_rigid(0.1, 0.05, 5e-3, DEM_GUIDE_NONE);
    dem_options o = free_options();
    o.method = method;
    o.fixed_step = step;
    assert_ok(dem_lattice_spin(&l, omega));
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    assert_ok(dem_simulation_advance(simulation, t));
    const dem_state end = ask_state(simulation);
    const double way[2] = {end.x[2] - end.x[0], end.x[3] - end.x[1]}; /* of two nodes side by side at first */
    return fabs(atan2(way[1], way[0]) - omega * t);
}

TEST(a_rotation_converges_with_the_order_of_the_method)
{
    const double fehlberg[2] = {angle_error(DEM_METHOD_FEHLBERG45, 1e-3), angle_error(DEM_METHOD_FEHLBERG45, 5e-4)};
    const double verlet[2] = {angle_error(DEM_METHOD_VERLET, 1e-3), angle_error(DEM_METHOD_VERLET, 5e-4)};
    print_message("# angle: %.1e, %.1e; %.1e, %.1e\n", fehlberg[0], fehlberg[1], verlet[0], verlet[1]);
    assert_true(fehlberg[0] < 1e-7 && fehlberg[1] < fehlberg[0] / 14.0);
    assert_true(verlet[0] < 2e-3 && verlet[1] < verlet[0] / 3.8);
}

/* ---- collisions of rigid bodies ---- */

/* A block, and another on its right that comes with 4 m/s, both 50 mm high, with `shift` between their middles. */
static dem_lattice make_colliding(double width, double shift)
{
    dem_lattice left = make_rigid(0.05, 0.05, 5e-3, DEM_GUIDE_NONE);
    dem_lattice right = make_rigid(width, 0.05, 5e-3, DEM_GUIDE_NONE);
    dem_lattice_move(&right, 0.0, (const double[2]){0.5 * width + 0.03, shift});
    assert_ok(dem_lattice_launch(&right, (const double[2]){-4.0, 0.0}));
    append(&left, &right);
    return left;
}

typedef struct outcome {
    dem_body_motion before[2], after[2];
    double closure;
} outcome;

static outcome collide(const dem_lattice *l, dem_method method, double step)
{
    outcome out;
    dem_options o = free_options();
    o.method = method;
    o.max_step = step;
    CLEANUP(free_model) dem_model *model = support_model(l, NULL, 0);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const dem_energy start = ask_energy(simulation);
    for (int b = 0; b < 2; b++) out.before[b] = ask_body(simulation, b);
    assert_ok(dem_simulation_advance(simulation, 0.02));
    for (int b = 0; b < 2; b++) out.after[b] = ask_body(simulation, b);
    const dem_energy end = ask_energy(simulation);
    assert_close(end.contact, 0.0, 0.0); /* they are apart again */
    out.closure = fabs(end.ledger - start.ledger) / start.kinetic;
    return out;
}

/* Head-on, bodies exchange momentum as two masses do that collide elastically; 1e-4 is what is lost or gained of the
 * energy at the default rtol. Adaptive steps are bounded by nothing but the contact: a few dozen are enough. Found are
 * 4e-5 of the energy and 1e-4 m/s, with Verlet's steps 7e-8 and 1e-6. */
TEST(rigid_bodies_exchange_momentum_as_elastic_masses_do)
{
    const double widths[2] = {0.05, 0.1}, steps[2] = {1e-3, 2e-6};
    const dem_method methods[2] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    for (int k = 0; k < 4; k++) {
        CLEANUP(dem_lattice_free) dem_lattice l = make_colliding(widths[k % 2], 0.0);
        const outcome o = collide(&l, methods[k / 2], steps[k / 2]);
        const double m[2] = {o.before[0].mass, o.before[1].mass}, v = -4.0, sum = m[0] + m[1];
        print_message("# masses %.3f, %.3f kg: %.6f, %.6f m/s, closure %.1e\n", m[0], m[1], o.after[0].velocity[0],
                      o.after[1].velocity[0], o.closure);
        assert_close(o.after[0].velocity[0], 2.0 * m[1] / sum * v, 3e-4);
        assert_close(o.after[1].velocity[0], (m[1] - m[0]) / sum * v, 3e-4);
        assert_close(m[0] * o.after[0].velocity[0] + m[1] * o.after[1].velocity[0], m[1] * v, 1e-13 * m[1] * 4.0);
        assert_true(o.closure < 1e-4);
    }
}

static double angular_momentum(const dem_body_motion b[2])
{
    double sum = 0.0;
    for (int k = 0; k < 2; k++)
        sum += b[k].angular_momentum[2] +
               b[k].mass * (b[k].centre[0] * b[k].velocity[1] - b[k].centre[1] * b[k].velocity[0]);
    return sum;
}

/* Off the middle both turn. Verlet's steps keep angular momentum to rounding, even though shapes are put back in each;
 * Runge-Kutta methods to their error, as in elastic bodies: found are 6e-9 and 2e-13, and closures of 3e-6. */
TEST(rigid_bodies_keep_angular_momentum_in_contact)
{
    const double steps[2] = {1e-3, 2e-6}, tolerance[2] = {2e-8, 1e-12};
    const dem_method methods[2] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    for (int k = 0; k < 2; k++) {
        CLEANUP(dem_lattice_free) dem_lattice l = make_colliding(0.08, 0.021);
        const outcome o = collide(&l, methods[k], steps[k]);
        const double scale = o.before[1].mass * 4.0 * 0.05;
        const double off = fabs(angular_momentum(o.after) - angular_momentum(o.before)) / scale;
        print_message("# angular momentum %.1e, closure %.1e\n", off, o.closure);
        assert_true(fabs(o.after[0].angular_momentum[2]) > 0.02 * scale);
        assert_true(off < tolerance[k]);
        assert_true(o.closure < 1e-5);
    }
}

/* ---- rigid and elastic bodies ---- */

/* A bar of rubber with nu = 0, 40 x 400 mm, along y, and a guided hammer of twice its density and a fifth of its length
 * that touches its end with 1 m/s. Until the wave comes back from the other end, at t = 2 L/c, the bar resists with the
 * force rho c v A, so that the hammer slows down like exp(-rho c A t/m) (St Venant). The shell lets the hammer go on by
 * a part of its thickness first: it is late by that over its speed, 5.1 % of the speed at 5 mm and 2.5 % at 2.5 mm. */
static double hammer_error(double spacing, dem_method method, double *closure)
{
    const double length = 0.4, width = 0.04, speed = 1.0;
    dem_material straight = rubber;
    straight.poissons_ratio = 0.0;
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(width, length, spacing, &straight);
    straight.density = 2.0 * rubber.density;
    dem_lattice hammer = support_rectangle(width, 0.2 * length, spacing, &straight);
    assert_ok(dem_lattice_stiffen(&hammer, DEM_GUIDE_Y));
    dem_lattice_move(&hammer, 0.0, (const double[2]){0.0, support_top(&l) + 0.2 * spacing});
    assert_ok(dem_lattice_launch(&hammer, (const double[2]){0.0, -speed}));
    append(&l, &hammer);
    dem_options o = free_options();
    o.method = method;
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const dem_energy start = ask_energy(simulation);
    const double c = sqrt(rubber.youngs_modulus / rubber.density), m = ask_body(simulation, 1).mass;
    double off = 0.0;
    for (int k = 1; k <= 20; k++) {
        const double t = 0.98 * 2.0 * length / c * k / 20;
        assert_ok(dem_simulation_advance(simulation, t));
        const double expected = speed * exp(-rubber.density * c * width * t / m);
        off = fmax(off, fabs(-ask_body(simulation, 1).velocity[1] - expected) / speed);
    }
    *closure = fabs(ask_energy(simulation).ledger - start.ledger) / start.kinetic;
    return off;
}

TEST(a_rigid_hammer_on_a_bar_slows_down_as_st_venant_says)
{
    const dem_method methods[2] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    for (int m = 0; m < 2; m++) {
        double closure[2];
        const double coarse = hammer_error(5e-3, methods[m], &closure[0]);
        const double fine = hammer_error(2.5e-3, methods[m], &closure[1]);
        print_message("# hammer: off by %.4f, %.4f; closure %.1e, %.1e\n", coarse, fine, closure[0], closure[1]);
        assert_true(coarse < 0.055);
        assert_true(fine < 0.027 && fine < 0.55 * coarse);
        assert_true(closure[0] < 1e-5 && closure[1] < 1e-5);
    }
}

/* A guided block falls with 5 m/s on one corner of an elastic one, and both are in gravity. */
static dem_lattice make_dropped(dem_guide guide)
{
    dem_lattice l = support_rectangle(0.05, 0.05, 5e-3, &rubber);
    dem_lattice upper = make_rigid(0.05, 0.03, 5e-3, guide);
    dem_lattice_move(&upper, 0.0, (const double[2]){0.021, support_top(&l) + 1.2e-3});
    assert_ok(dem_lattice_launch(&upper, (const double[2]){0.0, -5.0}));
    append(&l, &upper);
    return l;
}

TEST(a_guided_block_goes_along_its_guide_and_gives_its_momentum_to_an_elastic_one)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_dropped(DEM_GUIDE_Y);
    dem_options o = free_options();
    o.gravity[1] = -9.81;
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const dem_energy start = ask_energy(simulation);
    const double mass = dem_model_mass(model), t = 4e-3;
    double momentum = 5.0 * ask_body(simulation, 1).mass + mass * 9.81 * t;
    assert_ok(dem_simulation_advance(simulation, t));
    const dem_state end = ask_state(simulation);
    for (int b = 0; b < 2; b++) momentum += ask_body(simulation, b).mass * ask_body(simulation, b).velocity[1];
    const double closure = fabs(ask_energy(simulation).ledger - start.ledger) / start.kinetic;
    print_message("# guided: momentum %.1e kg m/s of %.1f, closure %.1e\n", momentum, 5.0 * mass, closure);
    assert_true(ask_body(simulation, 0).angular_momentum[2] < -1e-3); /* the elastic one turns */
    assert_close(momentum, 0.0, 1e-12 * 5.0 * mass);
    assert_true(closure < 1e-4); /* at rtol 1e-6, found 3e-5 */
    for (dem_index i = 0; i < l.n_nodes; i++) {
        if (l.body[i] == 0) continue;
        assert_close(end.x[2 * i], l.x[2 * i], 1e-15);
        assert_close(end.v[2 * i], 0.0, 0.0);
        assert_close(end.v[2 * i + 1], ask_body(simulation, 1).velocity[1], 1e-14);
    }
}

/* The stiffness of a rigid body bounds no step: a thousand times the modulus is a run of as many steps. Its contact has
 * the modulus of the elastic body, which is the smaller one. */
TEST(the_stiffness_of_a_rigid_body_bounds_no_step)
{
    dem_index steps[2];
    for (int k = 0; k < 2; k++) {
        CLEANUP(dem_lattice_free) dem_lattice l = make_dropped(DEM_GUIDE_NONE);
        for (dem_index s = 0; s < l.n_springs && k == 1; s++)
            if (l.body[l.ends[2 * s]] == 1) l.stiffness[s] *= 1e3;
        const dem_options o = free_options();
        CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
        CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
        assert_ok(dem_simulation_advance(simulation, 2e-3));
        steps[k] = ask_counts(simulation).steps;
    }
    assert_int_equal(steps[0], steps[1]);
}

/* ---- rigid bodies and obstacles ---- */

static const double floor_points[4] = {-0.5, 0.0, 0.5, 0.0};

static dem_obstacle make_floor(void)
{
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 1.0);
    return obstacle;
}

/* A rigid block of 50 x 30 mm in gravity, its lower side at this height over y = 0. */
static dem_lattice make_falling(double height, dem_guide guide)
{
    dem_lattice l = make_rigid(0.05, 0.03, 5e-3, guide);
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, height});
    return l;
}

static dem_options weighed_options(double max_step)
{
    dem_options o = free_options();
    o.gravity[1] = -9.81;
    o.max_step = max_step;
    return o;
}

/* The shell takes no energy: after a fall of 20 mm from outside of it a block rises to the same height, which is the
 * highest of the second flight. Between two equal heights the ledger closes to what rtol lets: found is 2e-6, and
 * three times as much of the height. */
static double bounce(dem_contact_method contact, dem_method method, double step, double *closure)
{
    const double height = 0.02;
    CLEANUP(dem_lattice_free) dem_lattice l = make_falling(height, DEM_GUIDE_NONE);
    const dem_obstacle ground = make_floor();
    dem_options o = weighed_options(step);
    o.contact = contact;
    o.method = method;
    CLEANUP(free_model) dem_model *model = support_model(&l, &ground, 1);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const dem_energy start = ask_energy(simulation);
    const double t_floor = sqrt(2.0 * height / 9.81), rest = ask_body(simulation, 0).centre[1] - height;
    double highest = 0.0;
    assert_ok(dem_simulation_advance(simulation, t_floor));
    for (int k = 0; k <= 400; k++) {
        assert_ok(dem_simulation_advance(simulation, t_floor * (1.0 + 0.005 * k)));
        highest = fmax(highest, ask_body(simulation, 0).centre[1] - rest);
    }
    *closure = fabs(ask_energy(simulation).ledger - start.ledger) / (ask_body(simulation, 0).mass * 9.81 * height);
    return fabs(highest / height - 1.0);
}

TEST(a_rigid_block_bounces_as_high_as_it_has_fallen)
{
    const dem_contact_method contacts[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};
    const dem_method methods[2] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
    const double steps[2] = {1e-3, 2e-6};
    for (int k = 0; k < 4; k++) {
        double closure;
        const double off = bounce(contacts[k % 2], methods[k / 2], steps[k / 2], &closure);
        print_message("# bounce: height off by %.1e, closure %.1e\n", off, closure);
        assert_true(off < 2e-5);
        assert_true(closure < 1e-5);
    }
}

/* At rest with damping a block of weight m g has u with m g = M L (1 - u)^2/u, where L is half of the length of its
 * lower side: the floor has no nodes of its own there. The reaction is its weight, and acts in its middle. */
TEST(a_rigid_block_comes_to_rest_on_a_floor_that_carries_its_weight)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_falling(1.5e-3, DEM_GUIDE_NONE);
    const dem_obstacle ground = make_floor();
    dem_options o = weighed_options(1e-3);
    o.mass_damping = 200.0;
    CLEANUP(free_model) dem_model *model = support_model(&l, &ground, 1);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    assert_ok(dem_simulation_advance(simulation, 0.4));
    const dem_body_motion body = ask_body(simulation, 0);
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    const double weight = 9.81 * body.mass;
    print_message("# rest: reaction %.8f of %.8f N at (%g, %g), speed %.1e\n", load.reaction[1], weight, load.point[0],
                  load.point[1], fabs(body.velocity[1]));
    assert_close(load.reaction[1], weight, 1e-6 * weight);
    assert_close(load.reaction[0], 0.0, 1e-6 * weight);
    assert_close(load.point[0], body.centre[0], 1e-6);
    assert_close(body.velocity[1], 0.0, 1e-12); /* e^-40 of some cm/s, found 1e-15 */
}

/* A block on a table that oscillates: the table's work is in the ledger, and its impulse is that of the block, to the
 * rounding of 2e4 steps. */
static void ride(dem_method method, double step, double tolerance)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_falling(2e-3, DEM_GUIDE_NONE);
    dem_obstacle table = make_floor();
    table.amplitude[1] = 1e-3;
    table.frequency = 50.0;
    dem_options o = weighed_options(step);
    o.method = method;
    CLEANUP(free_model) dem_model *model = support_model(&l, &table, 1);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const dem_energy start = ask_energy(simulation);
    assert_ok(dem_simulation_advance(simulation, 0.1));
    const dem_energy end = ask_energy(simulation);
    const dem_body_motion body = ask_body(simulation, 0);
    const double scale = fabs(end.obstacle), impulse = ask_obstacle(simulation, 0).impulse[1];
    const double closure = fabs(end.ledger - start.ledger) / scale;
    print_message("# table: work %.4f J, closure %.1e, impulse off by %.1e\n", end.obstacle, closure,
                  fabs(impulse - body.mass * (body.velocity[1] + 9.81 * 0.1)) / impulse);
    assert_true(scale > 1e-2);
    assert_true(closure < tolerance);
    assert_close(impulse, body.mass * (body.velocity[1] + 9.81 * 0.1), 1e-12 * impulse);
}

TEST(the_work_of_an_oscillating_table_on_a_rigid_block_is_in_the_ledger)
{
    ride(DEM_METHOD_FEHLBERG45, 1e-3, 1e-4); /* found 2e-5 at rtol 1e-6 */
    ride(DEM_METHOD_VERLET, 5e-6, 1e-6);     /* found 6e-8 */
}

static dem_status swing(void *calls, double t, dem_pose *pose)
{
    const double omega = 2.0 * M_PI * 50.0, a = 1e-3;
    pose->place[1] = a * sin(omega * t);
    pose->velocity[1] = a * omega * cos(omega * t);
    pose->acceleration[1] = -a * omega * omega * sin(omega * t);
    ++*(int *)calls;
    return DEM_OK;
}

/* The oscillation as a function of the program, which those who look do not call: the same bounces as by the keys. */
TEST(a_table_moved_by_a_function_is_not_asked_by_those_who_look)
{
    double velocity[2];
    for (int k = 0; k < 2; k++) {
        int calls = 0;
        CLEANUP(dem_lattice_free) dem_lattice l = make_falling(2e-3, DEM_GUIDE_NONE);
        dem_obstacle of_table = make_floor();
        dem_options o = weighed_options(1e-4);
        o.v_scale = 1.0;
        if (k == 0) {
            of_table.amplitude[1] = 1e-3;
            of_table.frequency = 50.0;
        } else {
            of_table.motion = swing;
            of_table.motion_context = &calls;
            of_table.most_speed = 0.32;
            of_table.most_acceleration = 99.0;
        }
        CLEANUP(free_model) dem_model *model = support_model(&l, &of_table, 1);
        CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
        const dem_energy start = ask_energy(simulation);
        assert_ok(dem_simulation_advance(simulation, 0.05));
        const int before = calls;
        const dem_energy end = ask_energy(simulation);
        assert_true(fabs(end.obstacle) > 1e-2 && isfinite(ask_obstacle(simulation, 0).power));
        assert_true(fabs(end.ledger - start.ledger) < 1e-3 * fabs(end.obstacle));
        assert_int_equal(calls, before);
        velocity[k] = ask_body(simulation, 0).velocity[1];
    }
    print_message("# by keys %.9f, by a function %.9f m/s\n", velocity[0], velocity[1]);
    assert_close(velocity[1], velocity[0], 1e-9);
}

/* A table at constant speed is the one at rest, seen by somebody who moves along. The block falls askew and turns. */
TEST(a_table_at_constant_speed_is_one_at_rest_seen_in_motion)
{
    const double u[2] = {0.3, -0.2}, t = 0.06;
    double x[2][2 * 256];
    dem_index n = 0;
    for (int k = 0; k < 2; k++) {
        CLEANUP(dem_lattice_free) dem_lattice l = make_rigid(0.05, 0.03, 5e-3, DEM_GUIDE_NONE);
        dem_lattice_move(&l, 0.2, (const double[2]){0.0, 8e-3});
        const double v[2] = {k * u[0], k * u[1] - 1.0};
        assert_ok(dem_lattice_launch(&l, v));
        dem_obstacle table = make_floor();
        if (k == 1) memcpy(table.velocity, u, sizeof u);
        dem_options o = weighed_options(0.0);
        o.fixed_step = 2e-5;
        CLEANUP(free_model) dem_model *model = support_model(&l, &table, 1);
        CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
        assert_ok(dem_simulation_advance(simulation, t));
        assert_true(fabs(ask_body(simulation, 0).angular_momentum[2]) > 1e-3);
        n = l.n_nodes;
        memcpy(x[k], ask_state(simulation).x, 2 * (size_t)n * sizeof(double));
    }
    double off = 0.0;
    for (dem_index i = 0; i < 2 * n; i++) off = fmax(off, fabs(x[1][i] - x[0][i] - u[i % 2] * t));
    print_message("# moving table: off by %.1e spacings\n", off / 5e-3);
    assert_true(off < 1e-9 * 5e-3);
}

/* A block that turns hits walls, corners, the point of a wedge in the middle of its sides, and the free end of a wall
 * without thickness, some dozens of times: the ledger closes, and the impulses of the obstacles are its momentum. A
 * corner of it, or of them, that the potential forgot would be a jump of energy. Found are closures of 6e-5 and less,
 * and momenta off by the rounding of a thousand steps, 3e-13 kg m/s. */
typedef struct scene {
    const char *name;
    dem_index n_points;
    const double *points;
    double height, spin, v[2];
} scene;

static const double box[10] = {-0.08, 0.0, 0.08, 0.0, 0.08, 0.12, -0.08, 0.12, -0.08, 0.0};
static const double wedge[10] = {-0.1, -0.05, -0.02, 0.0, 0.0012, 0.03, 0.02, 0.0, 0.1, -0.05};
static const double table[4] = {-0.1, 0.0, 0.0012, 0.0};

static void tumble(const scene *of, double g, double t)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_rigid(0.05, 0.03, 5e-3, DEM_GUIDE_NONE);
    const dem_obstacle obstacle = SIZED(dem_obstacle, .n_points = of->n_points, .points = of->points);
    dem_options o = free_options();
    o.gravity[1] = -g;
    o.max_step = 1e-3;
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, of->height});
    assert_ok(dem_lattice_launch(&l, of->v));
    assert_ok(dem_lattice_spin(&l, of->spin));
    CLEANUP(free_model) dem_model *model = support_model(&l, &obstacle, 1);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const dem_energy start = ask_energy(simulation);
    const dem_body_motion before = ask_body(simulation, 0);
    dem_index hits = 0;
    for (int k = 1; k <= 2000; k++) {
        assert_ok(dem_simulation_advance(simulation, t * k / 2000));
        hits += ask_energy(simulation).contact > 0.0;
        assert_true(hypot(ask_body(simulation, 0).centre[0], ask_body(simulation, 0).centre[1]) < 1.0);
    }
    const dem_body_motion after = ask_body(simulation, 0);
    const dem_energy end = ask_energy(simulation);
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    const double closure = fabs(end.ledger - start.ledger) / (start.kinetic + 1.0);
    const double off = hypot(load.impulse[0] - after.mass * (after.velocity[0] - before.velocity[0]),
                             load.impulse[1] - after.mass * (after.velocity[1] - before.velocity[1] + g * t));
    print_message("# %s: %d looks in contact, %d steps, %d rejected, closure %.1e, momentum off by %.1e\n", of->name,
                  (int)hits, (int)ask_counts(simulation).steps, (int)ask_counts(simulation).rejected, closure, off);
    assert_true(hits > 3);
    assert_true(closure < 2e-4);
    assert_true(off < 2e-12);
}

TEST(a_tumbling_block_keeps_its_energy_at_walls_corners_and_ends)
{
    const scene scenes[3] = {{"box", 5, box, 0.04, 30.0, {2.0, 1.3}},
                             {"wedge", 5, wedge, 0.045, 0.0, {0.0, 0.0}},
                             {"end of a table", 2, table, 0.01, 0.0, {0.0, -0.5}}};
    tumble(&scenes[0], 0.0, 0.5);
    tumble(&scenes[1], 9.81, 0.1);
    tumble(&scenes[2], 9.81, 0.1);
}

/* An elastic strip of two rows between the floor, which it meets by events, and a rigid block that falls on it: every
 * event is beside the block. Both methods of contact give the same motion. */
static dem_index squeeze(dem_contact_method contact, dem_method method, double *x, double *closure)
{
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(0.05, 5e-3, 5e-3, &rubber);
    dem_lattice upper = make_rigid(0.05, 0.02, 5e-3, DEM_GUIDE_NONE);
    const dem_obstacle ground = make_floor();
    dem_lattice_move(&upper, 0.0, (const double[2]){0.011, support_top(&l) + 1.2e-3});
    assert_ok(dem_lattice_launch(&upper, (const double[2]){0.0, -2.0}));
    append(&l, &upper);
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, 1e-4});
    dem_options o = weighed_options(0.0);
    o.contact = contact;
    o.method = method;
    o.rtol = 1e-9;
    o.window = 0.0;
    CLEANUP(free_model) dem_model *model = support_model(&l, &ground, 1);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const dem_energy start = ask_energy(simulation);
    assert_ok(dem_simulation_advance(simulation, 2.5e-3));
    assert_true(ask_counts(simulation).impacts > 20);
    memcpy(x, ask_state(simulation).x, 2 * (size_t)l.n_nodes * sizeof *x);
    *closure = fabs(ask_energy(simulation).ledger - start.ledger) / start.kinetic;
    return l.n_nodes;
}

TEST(local_and_exact_contact_agree_beside_a_rigid_body)
{
    double x[2][2 * 256], closure[2], off = 0.0;
    const dem_index n = squeeze(DEM_CONTACT_LOCAL, DEM_METHOD_FEHLBERG45, x[0], &closure[0]);
    assert_int_equal(squeeze(DEM_CONTACT_EXACT, DEM_METHOD_FEHLBERG45, x[1], &closure[1]), n);
    for (dem_index i = 0; i < 2 * n; i++) off = fmax(off, fabs(x[0][i] - x[1][i]));
    print_message("# squeezed: off by %.1e spacings, closure %.1e, %.1e\n", off / 5e-3, closure[0], closure[1]);
    assert_true(off < 1e-8 * 5e-3);                   /* found 2.4e-9; 2.4e-8 if the block were not moved as a whole */
    assert_true(fmax(closure[0], closure[1]) < 2e-7); /* found 5e-8 */
}

/* A guided block presses an elastic one on to the floor until all is at rest: the floor carries both weights, and the
 * block between them that of the upper one. */
TEST(a_guided_block_presses_an_elastic_one_with_its_weight)
{
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(0.04, 0.02, 5e-3, &rubber);
    dem_lattice upper = make_rigid(0.05, 0.02, 5e-3, DEM_GUIDE_Y);
    dem_obstacle ground = make_floor();
    ground.restitution = 0.0;
    dem_lattice_move(&upper, 0.0, (const double[2]){0.002, support_top(&l) + 8e-4});
    append(&l, &upper);
    dem_options o = weighed_options(0.0);
    o.gravity[1] = -981.0;
    o.mass_damping = 2e3;
    CLEANUP(free_model) dem_model *model = support_model(&l, &ground, 1);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    CLEANUP(free_memory) double *force = malloc(2 * (size_t)l.n_nodes * sizeof *force);
    assert_ok(dem_simulation_advance(simulation, 0.04));
    assert_ok(dem_simulation_contact_forces(simulation, force));
    const double weights = 981.0 * dem_model_mass(model), upper_weight = 981.0 * ask_body(simulation, 1).mass;
    double pressed = 0.0;
    for (dem_index i = 0; i < l.n_nodes; i++) pressed -= l.body[i] == 0 ? force[2 * i + 1] : 0.0;
    print_message("# pressed: floor %.9f, block %.9f of the weights\n",
                  ask_obstacle(simulation, 0).reaction[1] / weights, pressed / upper_weight);
    assert_close(ask_obstacle(simulation, 0).reaction[1], weights, 1e-6 * weights);
    assert_close(pressed, upper_weight, 1e-6 * upper_weight);
}

/* ---- what no bit depends on ---- */

enum { MOST_NODES = 256 };

typedef struct bits {
    double x[2 * MOST_NODES], v[2 * MOST_NODES];
    dem_energy energy;
} bits;

static bits see(const dem_simulation *simulation, dem_index n)
{
    bits out = {.energy = ask_energy(simulation)};
    const dem_state end = ask_state(simulation);
    assert_true(n <= MOST_NODES);
    memcpy(out.x, end.x, 2 * (size_t)n * sizeof *out.x);
    memcpy(out.v, end.v, 2 * (size_t)n * sizeof *out.v);
    return out;
}

/* Beside a wall that comes with 2 m/s and pushes the upper block. */
static dem_model *make_scene(dem_lattice *l)
{
    static const double points[4] = {0.0472, 0.0, 0.0472, 0.2};
    dem_obstacle wall = SIZED(dem_obstacle, .n_points = 2, .points = points);
    wall.velocity[0] = -2.0;
    *l = make_dropped(DEM_GUIDE_NONE);
    return support_model(l, &wall, 1);
}

static bits drop(const dem_options *options)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    CLEANUP(free_model) dem_model *model = make_scene(&l);
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, options);
    assert_ok(dem_simulation_advance(simulation, 2.5e-4));
    assert_true(ask_energy(simulation).contact > 0.0);
    assert_true(ask_energy(simulation).obstacle > 0.0);
    return see(simulation, l.n_nodes);
}

static const dem_method methods_of_bits[3] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_HEUN12};

TEST(no_bit_depends_on_threads_or_instructions)
{
    for (int m = 0; m < 3; m++) {
        dem_options o = free_options();
        o.method = methods_of_bits[m];
        const bits expected = drop(&o);
        o.kernel = DEM_KERNEL_PORTABLE;
        o.thread_nodes = 1;
        for (o.threads = 1; o.threads <= 3; o.threads++) {
            const bits found = drop(&o);
            assert_memory_equal(&found, &expected, sizeof found);
        }
    }
}

TEST(a_run_goes_on_from_a_checkpoint_to_the_same_bits)
{
    const dem_index every[3] = {1, 7, 64};
    for (int k = 0; k < 9; k++) {
        CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
        CLEANUP(free_model) dem_model *model = make_scene(&l);
        dem_options o = free_options();
        o.checkpoint_steps = every[k % 3];
        o.method = methods_of_bits[k / 3];
        const bits expected = drop(&o);
        CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o), *resumed;
        assert_ok(dem_simulation_advance(simulation, 2e-4));
        CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = last_record(simulation);
        assert_ok(dem_simulation_resume(&resumed, model, &o, checkpoint));
        assert_ok(dem_simulation_advance(resumed, 2.5e-4));
        const bits found = see(resumed, l.n_nodes);
        assert_memory_equal(&found, &expected, sizeof found);
    }
}

/* ---- what is refused ---- */

static void refuse(const dem_model *model, const dem_options *options, dem_status status, const char *message)
{
    dem_simulation *simulation = NULL;
    assert_int_equal(dem_simulation_create(&simulation, model, options), status);
    assert_null(simulation);
    assert_message_parts(message);
}

TEST(rigid_bodies_need_contact_and_are_not_moved_by_boundaries)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_dropped(DEM_GUIDE_NONE);
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    dem_options o = free_options();
    o.bodies = DEM_BODIES_NONE;
    refuse(model, &o, DEM_ERROR_MODEL, "body 1 is rigid * option bodies");
    o = free_options();
    const dem_index node = l.n_nodes - 1;
    const dem_boundary moved =
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_X, .n_nodes = 1, .nodes = &node);
    o.n_boundaries = 1;
    o.boundaries = &moved;
    refuse(model, &o, DEM_ERROR_MODEL, "boundary 0: node * is of a rigid body * guide");
}

TEST(a_rigid_body_that_crosses_or_nearly_touches_an_obstacle_is_refused)
{
    const dem_obstacle ground = make_floor();
    const char *messages[2] = {"body 0, which is rigid, crosses obstacle 0 at the start * between nodes",
                               "body 0, which is rigid, is 1e-05 m from obstacle 0 * a twentieth"};
    const double heights[2] = {-0.01, 1e-5};
    for (int k = 0; k < 2; k++) {
        CLEANUP(dem_lattice_free) dem_lattice l = make_falling(heights[k], DEM_GUIDE_NONE);
        CLEANUP(free_model) dem_model *model = support_model(&l, &ground, 1);
        const dem_options o = weighed_options(1e-3);
        refuse(model, &o, DEM_ERROR_MODEL, messages[k]);
    }
}

/* 20 m in a step, through the floor and all of the shell. */
TEST(a_fixed_step_in_which_a_rigid_body_crosses_an_obstacle_is_an_error)
{
    const dem_obstacle ground = make_floor();
    CLEANUP(dem_lattice_free) dem_lattice l = make_falling(0.02, DEM_GUIDE_NONE);
    CLEANUP(free_model) dem_model *model = support_model(&l, &ground, 1);
    dem_options o = weighed_options(1e-3);
    o.method = DEM_METHOD_VERLET;
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)l.n_nodes, sizeof *v);
    for (dem_index i = 0; i < l.n_nodes; i++) v[2 * i + 1] = -20000.0;
    assert_ok(dem_simulation_set_motion(simulation, NULL, v));
    assert_int_equal(dem_simulation_advance(simulation, 0.01), DEM_ERROR_CONTACT);
    assert_message_parts("body 0, which is rigid, crosses obstacle 0 near * m, t = * s: shorten fixed_step");
}

TEST(rigid_bodies_alone_need_a_longest_step)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_colliding(0.05, 0.0);
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    const dem_options o = free_options();
    refuse(model, &o, DEM_ERROR_ARGUMENT, "a model of rigid bodies alone * max_step, in s");
}

/* A motion that is set between advances must be rigid, too; one that is goes on. */
TEST(a_motion_that_is_set_is_rigid)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_colliding(0.05, 0.0);
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    dem_options o = free_options();
    o.max_step = 1e-3;
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &o);
    const size_t size = 2 * (size_t)l.n_nodes * sizeof(double);
    CLEANUP(free_memory) double *x = malloc(size);
    CLEANUP(free_memory) double *v = malloc(size);
    assert_ok(dem_simulation_advance(simulation, 2.5e-3));
    memcpy(x, ask_state(simulation).x, size);
    memcpy(v, ask_state(simulation).v, size);
    x[6] += 1e-6;
    assert_int_equal(dem_simulation_set_motion(simulation, x, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("place * of node 3 deforms its body 0");
    v[7] += 1.0;
    assert_int_equal(dem_simulation_set_motion(simulation, NULL, v), DEM_ERROR_ARGUMENT);
    assert_message_parts("velocity * of node 3 * body 0");
    for (dem_index i = 0; i < l.n_nodes; i++) v[2 * i + 1] = l.body[i] == 0 ? 1.0 : 2.0;
    assert_ok(dem_simulation_set_motion(simulation, NULL, v));
    assert_ok(dem_simulation_advance(simulation, 3e-3));
    assert_close(ask_body(simulation, 1).velocity[1], 2.0, 1e-14);
}
