/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction of rigid bodies with obstacles: rest, sliding, rolling, belts, ledger and impulses, and what no bit depends
 * on. */
#include "support.h"

#include <gsl/gsl_math.h>
#include <string.h>

#include "ask.h"
#include "base/checkpoint_entries.h"
#include "elastic_bodies.h"
#include "harness/cleanup.h"
#include "harness/message.h"
#include "simulation/private.h"

static const dem_material rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 1.0);
static const double spacing = 5e-3, thickness = 1e-3, mu = 0.5, g = 9.81, width = 0.05;
static const double floor_points[4] = {-1.0, 0.0, 3.0, 0.0};
static const dem_method methods[2] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET};
static const dem_contact_method contacts[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};

/* ---- scenes ---- */

static dem_obstacle make_floor(void)
{
    return (dem_obstacle)SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .friction = mu);
}

/* A flat block at the height where the floor carries its weight: with half of its lower side, L, and the modulus M of
 * E h at nu = 1/3, m g = M L (1 - u)^2/u. */
static dem_lattice make_block(double speed)
{
    dem_lattice l = support_rectangle(width, 0.015, spacing, &rubber);
    double low = INFINITY, mass = 0.0;
    for (dem_index i = 0; i < l.n_nodes; i++) {
        low = fmin(low, l.x[2 * i + 1]);
        mass += l.mass[i];
    }
    const double u = 1.0 - sqrt(mass * g / (rubber.youngs_modulus * 0.5 * width));
    assert_ok(dem_lattice_stiffen(&l, DEM_GUIDE_NONE));
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, u * thickness - low});
    assert_ok(dem_lattice_launch(&l, (const double[2]){speed, 0.0}));
    return l;
}

/* On a slope of this angle, which falls along x. */
static dem_options options_of(int method, double slope)
{
    dem_options o = support_options();
    o.gravity[0] = g * sin(slope);
    o.gravity[1] = -g * cos(slope);
    o.bodies = DEM_BODIES_OTHERS;
    o.contact = contacts[method];
    o.method = methods[method];
    o.max_step = method == 0 ? 1e-4 : 1e-5;
    return o;
}

/* ---- sliding and rest ---- */

/* After v0^2/(2 mu g) = 102 mm; it sways on the springs of friction then. */
TEST(a_block_slides_as_far_as_coulomb_says)
{
    const double v0 = 1.0, way = v0 * v0 / (2.0 * mu * g), time = v0 / (mu * g);
    for (int m = 0; m < 2; m++) {
        CLEANUP(support_close) support_run run;
        CLEANUP(dem_lattice_free) dem_lattice l = make_block(v0);
        const dem_obstacle ground = make_floor();
        const dem_options o = options_of(m, 0.0);
        support_open(&run, &l, &ground, 1, &o);
        const double begin = ask_body(run.simulation, 0).centre[0];
        const dem_energy start = ask_energy(run.simulation);
        (void)support_at(&run, 2.0 * time);
        const dem_body_motion end = ask_body(run.simulation, 0);
        const dem_energy now = ask_energy(run.simulation);
        const dem_obstacle_load load = ask_obstacle(run.simulation, 0);
        const double closure = fabs(now.ledger - start.ledger) / start.kinetic;
        print_message("# slides %.5f of %.5f m, friction %.5f of %.5f J, closure %.1e, impulse off by %.1e\n",
                      end.centre[0] - begin, way, now.friction, start.kinetic, closure,
                      load.impulse[0] / (end.mass * (end.velocity[0] - v0)) - 1.0);
        assert_close(end.centre[0] - begin, way, 0.02 * way);
        assert_close(load.impulse[0], end.mass * (end.velocity[0] - v0), 1e-11 * end.mass);
        assert_close(load.friction_impulse[0], load.impulse[0], 1e-11 * end.mass);
        assert_true(closure < 1e-3);
    }
}

/* Above the angle of friction a block slides with g (sin - mu cos): 1 % is left of the bounces at its start. */
TEST(a_block_slides_down_a_steep_slope)
{
    const double slope = atan(2.0 * mu), expected = g * (sin(slope) - mu * cos(slope));
    for (int m = 0; m < 2; m++) {
        CLEANUP(support_close) support_run run;
        CLEANUP(dem_lattice_free) dem_lattice l = make_block(0.0);
        const dem_obstacle ground = make_floor();
        const dem_options o = options_of(m, slope);
        support_open(&run, &l, &ground, 1, &o);
        (void)support_at(&run, 0.1);
        const double begin = ask_body(run.simulation, 0).velocity[0];
        (void)support_at(&run, 0.3);
        const double found = (ask_body(run.simulation, 0).velocity[0] - begin) / 0.2;
        print_message("# acceleration %.5f, expected %.5f m/s^2\n", found, expected);
        assert_close(found, expected, 0.01 * expected);
    }
}

static const double settled = 0.2; /* s, when damping has brought a block to rest */

/* Opens a run that goes on from there. */
static void open_at_rest(support_run *run, const dem_lattice *l, const dem_obstacle *ground, const dem_options *options)
{
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint;
    dem_options o = *options;
    o.mass_damping = 500.0;
    o.checkpoint_steps = 1;
    support_open(run, l, ground, 1, &o);
    (void)support_at(run, settled);
    assert_ok(dem_checkpoint_create(&checkpoint));
    assert_ok(checkpoint_entries_copy(checkpoint, dem_simulation_checkpoint(run->simulation)));
    dem_simulation_destroy(run->simulation);
    assert_ok(dem_simulation_resume(&run->simulation, run->model, options, checkpoint));
}

/* Below it friction carries the weight along the slope, and the block stays where it is, without any damping. */
TEST(a_block_on_a_slope_does_not_creep)
{
    const double slope = atan(0.6 * mu);
    for (int m = 0; m < 2; m++) {
        CLEANUP(support_close) support_run run;
        CLEANUP(dem_lattice_free) dem_lattice l = make_block(0.0);
        const dem_obstacle ground = make_floor();
        const dem_options o = options_of(m, slope);
        open_at_rest(&run, &l, &ground, &o);
        (void)support_at(&run, settled + 0.5);
        const dem_body_motion begin = ask_body(run.simulation, 0);
        const dem_obstacle_load load = ask_obstacle(run.simulation, 0);
        (void)support_at(&run, settled + 1.0);
        const dem_body_motion end = ask_body(run.simulation, 0);
        const double weight = end.mass * g,
                     most = hypot(end.centre[0] - begin.centre[0], end.centre[1] - begin.centre[1]);
        print_message("# creep %.1e spacings, weight carried off by %.1e and %.1e\n", most / spacing,
                      load.reaction[0] / (-weight * sin(slope)) - 1.0, load.reaction[1] / (weight * cos(slope)) - 1.0);
        assert_true(most < 1e-9 * spacing);
        assert_close(load.reaction[0], -weight * sin(slope), 1e-6 * weight);
        assert_close(load.reaction[1], weight * cos(slope), 1e-6 * weight);
    }
}

/* ---- rolling ---- */

enum { RINGS = 16 };

static const double radius = 0.04, soft = 1.2e-3; /* m, m: a shell that is thick enough to roll softly */

/* A disc with 96 nodes on its rim, 2.6 mm apart, that touches the floor. */
static dem_lattice make_disc(double speed)
{
    dem_lattice l = dem_lattice_empty();
    elastic_bodies_rings(&l, RINGS);
    for (dem_index k = 0; k < 2 * l.n_nodes; k++) l.x[k] *= radius / RINGS;
    assert_ok(dem_lattice_assemble(&l, &rubber));
    assert_ok(dem_lattice_stiffen(&l, DEM_GUIDE_NONE));
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, radius + 0.94 * soft});
    assert_ok(dem_lattice_launch(&l, (const double[2]){speed, 0.0}));
    return l;
}

/* Moment of inertia over the mass and the square of the radius. */
static double roundness(const dem_lattice *l)
{
    double mass = 0.0, sum = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        mass += l->mass[i];
        sum += l->mass[i] * (gsl_pow_2(l->x[2 * i]) + gsl_pow_2(l->x[2 * i + 1] - radius - 0.94 * soft));
    }
    return sum / (mass * gsl_pow_2(radius));
}

/* With k = I/(m R^2) a disc that slides at first rolls with v0/(1 + k), and on a slope with g sin/(1 + k). */
TEST(a_disc_slides_rolls_and_rolls_down)
{
    for (int m = 0; m < 2; m++) {
        CLEANUP(support_close) support_run run, down;
        CLEANUP(dem_lattice_free) dem_lattice l = make_disc(1.0), still = make_disc(0.0);
        const dem_obstacle ground = make_floor();
        const double k = roundness(&l), slope = 0.2, fall = g * sin(slope) / (1.0 + k);
        dem_options o = options_of(m, 0.0);
        o.contact_thickness = soft;
        support_open(&run, &l, &ground, 1, &o);
        (void)support_at(&run, 0.3);
        const dem_body_motion end = ask_body(run.simulation, 0);
        const double spin = end.angular_momentum[2] / (k * end.mass * gsl_pow_2(radius));
        o.gravity[0] = g * sin(slope);
        o.gravity[1] = -g * cos(slope);
        support_open(&down, &still, &ground, 1, &o);
        (void)support_at(&down, 0.3);
        const double speed = ask_body(down.simulation, 0).velocity[0];
        print_message("# k %.4f: rolls at %.5f of %.5f m/s, rim at %.5f; down %.5f of %.5f m/s\n", k, end.velocity[0],
                      1.0 / (1.0 + k), -spin * radius, speed, 0.3 * fall);
        assert_close(end.velocity[0], 1.0 / (1.0 + k), 0.01);
        assert_close(-spin * radius, end.velocity[0], 0.01);
        assert_close(speed, 0.3 * fall, 0.02 * 0.3 * fall);
    }
}

/* ---- belts ---- */

/* A block that is put on a belt is one that comes with the opposite speed, seen by somebody who moves along. */
TEST(a_belt_is_a_floor_at_rest_seen_in_motion)
{
    const double u = 0.7, t = 0.25;
    double x[2][2 * 256], off = 0.0;
    dem_index n = 0;
    for (int k = 0; k < 2; k++) {
        CLEANUP(support_close) support_run run;
        CLEANUP(dem_lattice_free) dem_lattice l = make_block(k == 0 ? -u : 0.0);
        dem_obstacle ground = make_floor();
        ground.velocity[0] = k == 0 ? 0.0 : u;
        dem_options o = options_of(0, 0.0);
        o.max_step = 0.0;
        o.fixed_step = 2e-5;
        support_open(&run, &l, &ground, 1, &o);
        (void)support_at(&run, t);
        n = l.n_nodes;
        memcpy(x[k], ask_state(run.simulation).x, 2 * (size_t)n * sizeof(double));
    }
    for (dem_index i = 0; i < 2 * n; i++) off = fmax(off, fabs(x[1][i] - x[0][i] - (i % 2 == 0 ? u * t : 0.0)));
    print_message("# belt: off by %.1e spacings\n", off / spacing);
    assert_true(off < 1e-9 * spacing);
}

/* As long as a block slides on a belt this does the work mu m g u t, half of which becomes motion until the block moves
 * along, and half is lost. */
TEST(the_work_of_a_belt_is_that_of_coulombs_friction)
{
    const double u = 0.7, t = u / (mu * g);
    for (int m = 0; m < 2; m++) {
        CLEANUP(support_close) support_run run;
        CLEANUP(dem_lattice_free) dem_lattice l = make_block(0.0);
        dem_obstacle ground = make_floor();
        ground.velocity[0] = u;
        const dem_options o = options_of(m, 0.0);
        support_open(&run, &l, &ground, 1, &o);
        const dem_energy start = ask_energy(run.simulation);
        (void)support_at(&run, 0.9 * t);
        const dem_body_motion body = ask_body(run.simulation, 0);
        const dem_energy sliding = ask_energy(run.simulation);
        const dem_obstacle_load load = ask_obstacle(run.simulation, 0);
        const double expected = mu * body.mass * g * u * 0.9 * t;
        (void)support_at(&run, 2.0 * t);
        const dem_energy end = ask_energy(run.simulation);
        const double scale = body.mass * u * u, closure = fabs(end.ledger - start.ledger) / scale;
        print_message("# belt: work %.5f of %.5f J, in the end %.5f, lost %.5f of %.5f J, closure %.1e\n",
                      sliding.obstacle, expected, end.obstacle, end.friction, 0.5 * scale, closure);
        assert_close(sliding.obstacle, expected, 0.02 * expected);
        assert_close(sliding.obstacle, load.impulse[0] * u, 1e-11 * expected);
        assert_close(end.friction, 0.5 * scale, 0.02 * scale);
        assert_true(closure < 1e-4);
    }
}

/* ---- what no bit depends on ---- */

enum { MOST_NODES = 64 };

typedef struct bits {
    double x[2 * MOST_NODES], v[2 * MOST_NODES];
    dem_energy energy;
    double impulse[2], friction_impulse[2];
} bits;

/* What a block meets: a peak that shakes and turns, which rubs on an edge of the block; or the floor, which shakes
 * along x. */
typedef enum met { PEAK, FLOOR, N_MET } met;

static const double peak[10] = {-0.1, -0.05, -0.02, 0.0, 0.0012, 0.03, 0.02, 0.0, 0.1, -0.05};
static const double late[N_MET] = {8.5e-3, 0.03}; /* s, when friction has been stuck and slides */

static void open_on(met what, support_run *run, const dem_options *options)
{
    CLEANUP(dem_lattice_free) dem_lattice l = make_block(0.4);
    dem_obstacle obstacle = make_floor();
    obstacle.amplitude[0] = 2e-3;
    obstacle.frequency = 40.0;
    if (what == PEAK) {
        obstacle.n_points = 5;
        obstacle.points = peak;
        obstacle.spin = 1.0;
        dem_lattice_move(&l, 0.0, (const double[2]){0.005, 0.03});
        assert_ok(dem_lattice_spin(&l, 10.0));
    }
    support_open(run, &l, &obstacle, 1, options);
}

static bits bits_of(const dem_simulation *simulation)
{
    const dem_state end = ask_state(simulation);
    const size_t n = (size_t)simulation->model->lattice.n_nodes;
    const dem_obstacle_load load = ask_obstacle(simulation, 0);
    bits out = {.energy = ask_energy(simulation)};
    assert_true(n <= MOST_NODES);
    assert_true(simulation->rigid->list[0].anchors.now.n > 0 && out.energy.friction > 1e-4);
    memcpy(out.x, end.x, 2 * n * sizeof *out.x);
    memcpy(out.v, end.v, 2 * n * sizeof *out.v);
    memcpy(out.impulse, load.impulse, sizeof out.impulse);
    memcpy(out.friction_impulse, load.friction_impulse, sizeof out.friction_impulse);
    return out;
}

/* The list's margin is a multiple of the usual one. */
static bits meet(met what, const dem_options *options, double margin)
{
    CLEANUP(support_close) support_run run;
    open_on(what, &run, options);
    run.simulation->rigid->list[0].margin *= margin;
    run.simulation->rigid->list[0].made = false;
    (void)support_at(&run, late[what]);
    return bits_of(run.simulation);
}

/* The usual margin is half a spacing. */
TEST(no_bit_depends_on_the_list_of_pairs_threads_or_instructions)
{
    const double margins[3] = {1e-3, 0.1, 10.0};
    for (int m = 0; m < 2 * N_MET; m++) {
        dem_options o = options_of(m / N_MET, 0.0);
        const bits expected = meet((met)(m % N_MET), &o, 1.0);
        for (int k = 0; k < 3; k++) {
            const bits found = meet((met)(m % N_MET), &o, margins[k]);
            assert_memory_equal(&found, &expected, sizeof found);
        }
        o.kernel = DEM_KERNEL_PORTABLE;
        o.thread_nodes = 1;
        for (o.threads = 2; o.threads <= 3; o.threads++) {
            const bits found = meet((met)(m % N_MET), &o, 1.0);
            assert_memory_equal(&found, &expected, sizeof found);
        }
    }
}

/* Anchors are part of a checkpoint. */
TEST(a_run_goes_on_from_a_checkpoint_to_the_same_bits)
{
    const dem_index every[3] = {1, 7, 64};
    for (int m = 0; m < 2 * N_MET; m++)
        for (int k = 0; k < 3; k++) {
            CLEANUP(support_close) support_run run;
            CLEANUP(free_checkpoint) dem_checkpoint *checkpoint;
            CLEANUP(free_simulation) dem_simulation *resumed;
            const met what = (met)(m % N_MET);
            dem_options o = options_of(m / N_MET, 0.0);
            size_t size = 0;
            o.checkpoint_steps = every[k];
            const bits expected = meet(what, &o, 1.0);
            open_on(what, &run, &o);
            (void)support_at(&run, 0.95 * late[what]);
            assert_ok(dem_checkpoint_create(&checkpoint));
            assert_ok(checkpoint_entries_copy(checkpoint, dem_simulation_checkpoint(run.simulation)));
            assert_non_null(dem_checkpoint_find(checkpoint, "friction of rigid body 0", &size));
            assert_true(size > 0 || k == 2); /* long before it may have been apart */
            assert_ok(dem_simulation_resume(&resumed, run.model, &o, checkpoint));
            assert_ok(dem_simulation_advance(resumed, late[what]));
            const bits found = bits_of(resumed);
            assert_memory_equal(&found, &expected, sizeof found);
        }
}

/* ---- methods ---- */

/* Fehlberg's method with its error test and Verlet's with short steps. */
TEST(two_methods_agree)
{
    for (int what = 0; what < N_MET; what++) {
        dem_options o = options_of(0, 0.0);
        o.rtol = 1e-9;
        o.max_step = 1e-5;
        const bits fehlberg = meet((met)what, &o, 1.0);
        o = options_of(1, 0.0);
        o.max_step = 1e-6;
        const bits verlet = meet((met)what, &o, 1.0);
        double off = 0.0;
        for (int k = 0; k < 2 * MOST_NODES; k++) off = fmax(off, fabs(verlet.x[k] - fehlberg.x[k]));
        print_message("# methods: places off by %.1e spacings, friction %.8f and %.8f J\n", off / spacing,
                      fehlberg.energy.friction, verlet.energy.friction);
        assert_true(off < 1e-4 * spacing);
        assert_close(verlet.energy.friction, fehlberg.energy.friction, 1e-3 * fehlberg.energy.friction);
    }
}

/* Work, motion and what is lost close with anchors on a peak that shakes and turns, whose impulses are the block's. */
TEST(the_ledger_closes_on_an_obstacle_that_shakes_and_turns)
{
    for (int m = 0; m < 2 * N_MET; m++) {
        CLEANUP(support_close) support_run run;
        const dem_options o = options_of(m / N_MET, 0.0);
        open_on((met)(m % N_MET), &run, &o);
        const dem_energy start = ask_energy(run.simulation);
        const dem_body_motion before = ask_body(run.simulation, 0);
        (void)support_at(&run, 3.0 * late[m % N_MET]);
        const dem_body_motion after = ask_body(run.simulation, 0);
        const dem_energy end = ask_energy(run.simulation);
        const dem_obstacle_load load = ask_obstacle(run.simulation, 0);
        const double t = 3.0 * late[m % N_MET], closure = fabs(end.ledger - start.ledger) / end.friction;
        const double off = hypot(load.impulse[0] - after.mass * (after.velocity[0] - before.velocity[0]),
                                 load.impulse[1] - after.mass * (after.velocity[1] - before.velocity[1] + g * t));
        print_message("# work %.5f, friction %.5f J, closure %.1e, momentum off by %.1e\n", end.obstacle, end.friction,
                      closure, off);
        assert_true(closure < 1e-4);
        assert_true(off < 1e-11);
    }
}

/* A strip of two rows between the floor, which it meets by events, and a rigid block that rubs along a wall: both
 * methods of contact give the same motion. */
static dem_index squeeze(dem_contact_method contact, double *x, double *closure)
{
    static const double wall_points[4] = {0.0362, -0.1, 0.0362, 0.2};
    const dem_obstacle obstacles[2] = {SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 1.0),
                                       SIZED(dem_obstacle, .n_points = 2, .points = wall_points, .friction = mu)};
    CLEANUP(support_close) support_run run;
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(width, spacing, spacing, &rubber);
    dem_lattice upper = make_block(0.0);
    dem_lattice_move(&upper, 0.0, (const double[2]){0.0102, 4.6e-3});
    assert_ok(dem_lattice_launch(&upper, (const double[2]){0.2, -2.0}));
    assert_ok(dem_lattice_append(&l, &upper));
    dem_lattice_free(&upper);
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, 1e-4});
    dem_options o = options_of(0, 0.0);
    o.contact = contact;
    o.max_step = 0.0;
    o.rtol = 1e-9;
    o.window = 0.0;
    support_open(&run, &l, obstacles, 2, &o);
    const dem_energy start = ask_energy(run.simulation);
    const motion end = support_at(&run, 2.5e-3);
    print_message("# %d impacts, friction %.3e J\n", (int)run.n_impacts, end.energy.friction);
    assert_true(run.n_impacts > 10 && end.energy.friction > 1e-3);
    memcpy(x, ask_state(run.simulation).x, 2 * (size_t)l.n_nodes * sizeof *x);
    *closure = fabs(end.energy.ledger - start.ledger) / start.kinetic;
    return l.n_nodes;
}

TEST(local_and_exact_contact_agree_beside_friction)
{
    double x[2][2 * 256], closure[2], off = 0.0;
    const dem_index n = squeeze(DEM_CONTACT_LOCAL, x[0], &closure[0]);
    assert_int_equal(squeeze(DEM_CONTACT_EXACT, x[1], &closure[1]), n);
    for (dem_index i = 0; i < 2 * n; i++) off = fmax(off, fabs(x[0][i] - x[1][i]));
    print_message("# squeezed: off by %.1e spacings, closure %.1e, %.1e\n", off / spacing, closure[0], closure[1]);
    assert_true(off < 1e-5 * spacing); /* the shift of anchors is of second order in the steps, which differ */
    assert_true(fmax(closure[0], closure[1]) < 1e-5);
}

/* What springs had stored counts as lost then, and the ledger stays. */
TEST(a_motion_that_is_set_forgets_anchors)
{
    CLEANUP(support_close) support_run run;
    const dem_options o = options_of(0, 0.0);
    open_on(FLOOR, &run, &o);
    const motion before = support_at(&run, late[FLOOR]);
    assert_true(run.simulation->rigid->list[0].anchors.now.n > 0);
    assert_ok(dem_simulation_set_motion(run.simulation, NULL, NULL));
    assert_int_equal(run.simulation->rigid->list[0].anchors.now.n, 0);
    const dem_energy after = ask_energy(run.simulation);
    assert_true(after.friction > before.energy.friction && after.contact < before.energy.contact);
    assert_close(after.ledger, before.energy.ledger, 1e-12);
    assert_ok(dem_simulation_advance(run.simulation, 1.1 * late[FLOOR]));
}
