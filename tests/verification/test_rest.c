/* SPDX-License-Identifier: BSD-3-Clause */
/* A block at rest for a second: on a floor, in a groove, on an incline; and one that slides down an incline.
 *
 * The block has 4 cells across and 4 rows of 0.1 m, rho = 1000 kg/m^3 and E = 4.9 MPa, so that c = 70 m/s and
 * the highest frequency is 2100 rad/s: a second is a few thousand steps, and its weight strains it by 1e-3 only. */
#include <stdbool.h>
#include <stdlib.h>

#include "harness/motion.h"
#include "support.h"

static const double g = 9.81, spacing = 0.1;

typedef struct scene {
    double angle;  /* rad, by which the block turns about the origin */
    double offset; /* m, of the middle of its bottom from there, before it turns */
    double height; /* m, at which it starts */
    dem_obstacle obstacle;
    double mass_damping, damping_time; /* of a damped run */
    double hardness;                   /* E in units of 4.9 MPa, 0: 1; times and dampings of scenes are those of 1 */
} scene;

typedef struct block {
    dem_model *model;
    dem_simulation *simulation;
    double t, impulse[2]; /* at the last step */
    double ledger, drift; /* J: at the start, the worst of it less that at the end of a step */
} block;

static const double flat[4] = {-9.0, 0.0, 9.0, 0.0}, groove[6] = {-2.0, 2.0, 0.0, 0.0, 2.0, 2.0};

static dem_status note(void *context, const dem_simulation *simulation)
{
    block *b = context;
    motion state;
    motion_see(simulation, &state);
    const double ledger = state.energy.ledger;
    if (state.t == 0.0) b->ledger = ledger;
    b->drift = fmax(b->drift, fabs(ledger - b->ledger));
    return DEM_OK;
}

/* By so much a harder block is faster. */
static double pace(const scene *s)
{
    return s->hardness > 0.0 ? sqrt(s->hardness) : 1.0;
}

/* From an unstrained start, or from positions. */
static void open_block(block *b, const scene *s, const double *position, bool damped)
{
    const dem_material material =
        SIZED(dem_material, .youngs_modulus = 4.9e6 * pace(s) * pace(s), .poissons_ratio = 1.0 / 3.0, .density = 1000.0,
              .thickness = 0.1, .damping_time = damped ? s->damping_time / pace(s) : 0.0);
    const double offset[2] = {s->offset, 0.0}, start[2] = {0.0, s->height};
    dem_options options = support_options();
    options.rtol = 1e-10;
    options.v_scale = 0.1; /* more than the weight moves it */
    options.penetration_tolerance = 1e-10 * spacing;
    options.mass_damping = damped ? s->mass_damping * pace(s) : 0.0;
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_rectangle(4.0 * spacing, 3.5 * spacing, spacing, &material);
    dem_lattice_move(&lattice, 0.0, offset);
    dem_lattice_move(&lattice, s->angle, start);
    if (position != NULL) support_start(&lattice, position, NULL);
    *b = (block){0};
    assert_ok(dem_model_create(&b->model, &lattice, &s->obstacle, 1));
    assert_ok(dem_simulation_create(&b->simulation, b->model, &options));
    assert_ok(dem_simulation_observe(b->simulation,
                                     &(dem_observer){.struct_size = sizeof(dem_observer), .step = note, .context = b}));
}

static void close_block(block *b)
{
    dem_simulation_destroy(b->simulation);
    dem_model_destroy(b->model);
}

static motion advance(block *b, double t)
{
    motion state;
    assert_ok(dem_simulation_advance(b->simulation, t));
    motion_see(b->simulation, &state);
    return state;
}

/* Largest difference of a and b [n]. */
static double distance(const double *a, const double *b, dem_index n)
{
    double most = 0.0;
    for (dem_index k = 0; k < n; k++) most = fmax(most, fabs(a[k] - (b != NULL ? b[k] : 0.0)));
    return most;
}

/* The reaction is the weight, and its line of action passes through the centre of mass, up to the acceleration that is
 * left: 1e-10 m/s by the highest frequency, 2e-7 m/s^2. */
static void check_reaction(const block *b, double tolerance)
{
    const dem_obstacle_load load = ask_obstacle(b->simulation, 0);
    const dem_body_motion body = ask_body(b->simulation, 0);
    assert_close(load.reaction[0], 0.0, tolerance * body.mass);
    assert_close(load.reaction[1], body.mass * g, tolerance * body.mass);
    assert_close(load.point[0], body.centre[0], tolerance / g);
    assert_true(load.point[1] < body.centre[1]);
}

/* A damped run from the unstrained start ends at rest: velocities of rounding, of coordinates by the highest frequency
 * and by the number of steps. Returns the positions; free. */
static double *settle(const scene *s, double t_end, dem_index lasting)
{
    CLEANUP(close_block) block b;
    open_block(&b, s, NULL, true);
    const dem_index n = 2 * ask_sizes(b.model).n_nodes;
    const motion state = advance(&b, t_end / pace(s));
    assert_close(distance(state.v, NULL, n), 0.0, 1e-10 * pace(s));
    assert_true(state.n_contacts >= lasting);
    assert_close(b.drift, 0.0, 1e-6 * dem_model_mass(b.model) * g * 3.5 * spacing);
    check_reaction(&b, 2e-7 * pace(s) * pace(s));
    double *position = malloc((size_t)n * sizeof *position);
    assert_non_null(position);
    for (dem_index k = 0; k < n; k++) position[k] = state.x[k];
    return position;
}

/* From its equilibrium, undamped, the block stays where it is for a second. */
static void check_rest(const scene *s, dem_index lasting)
{
    CLEANUP(free_memory) double *position = settle(s, 0.7, lasting);
    CLEANUP(close_block) block b;
    open_block(&b, s, position, false);
    const dem_index n = 2 * ask_sizes(b.model).n_nodes;
    const double weight = dem_model_mass(b.model) * g;
    for (int k = 1; k <= 4; k++) {
        const double t = 0.25 * k / pace(s);
        const motion state = advance(&b, t);
        const dem_obstacle_load load = ask_obstacle(b.simulation, 0);
        assert_close(distance(state.x, position, n), 0.0, 1e-9 * spacing);
        assert_int_equal(state.n_contacts, lasting);
        assert_close(state.energy.impact + state.energy.friction, 0.0, 1e-6 * weight * 3.5 * spacing);
        assert_close(load.impulse[0], 0.0, 1e-9 * weight); /* momentum of velocities below 1e-9 m/s */
        assert_close(load.impulse[1], weight * t, 1e-9 * weight);
        check_reaction(&b, 2e-7 * pace(s) * pace(s));
    }
    const dem_counts counts = ask_counts(b.simulation);
    assert_int_equal(counts.impacts, 0);
    assert_int_equal(counts.releases, 0);
    assert_int_equal(counts.events, 0); /* no chatter between stick and slip either */
    assert_close(b.drift, 0.0, 1e-6 * weight * 3.5 * spacing);
}

static dem_obstacle straight(const double *points, double friction)
{
    return (dem_obstacle){.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = points, .friction = friction};
}

TEST(a_block_on_a_floor_rests)
{
    static const double mu[3] = {0.0, 0.05, 0.3};
    for (int k = 0; k < 3; k++) check_rest(&(scene){.obstacle = straight(flat, mu[k]), .mass_damping = 400.0}, 5);
}

/* Its corner is held, two sides of it lie on the flanks. */
TEST(a_block_in_a_groove_rests)
{
    scene s = {.angle = 0.25 * M_PI, .offset = 2.0 * spacing, .mass_damping = 400.0};
    s.obstacle = (dem_obstacle){.struct_size = sizeof(dem_obstacle), .n_points = 3, .points = groove};
    check_rest(&s, 8);
    s.obstacle.friction = 0.3;
    check_rest(&s, 8);
}

typedef struct incline {
    double degrees, mu, hardness;
    dem_index lasting; /* the upper corner may be lifted */
} incline;

/* Nodes that have slid to where they rest stay at the limit of friction, where rounding decides whether they stick. */
TEST(a_block_below_the_friction_angle_rests_be_it_soft_or_hard)
{
    static const incline rows[9] = {{5.0, 0.5, 1.0, 5},  {15.0, 0.5, 1.0, 5}, {20.0, 0.5, 1.0, 4},
                                    {17.0, 0.8, 1.0, 5}, {25.0, 1.2, 1.0, 4}, {8.0, 0.3, 1e4, 5},
                                    {12.0, 0.4, 1e4, 5}, {17.0, 0.5, 1e4, 5}, {25.0, 0.5, 1e4, 4}};
    for (int k = 0; k < 9; k++) {
        const double a = rows[k].degrees * M_PI / 180.0;
        const double points[4] = {-9.0 * cos(a), 9.0 * sin(a), 9.0 * cos(a), -9.0 * sin(a)};
        scene s = {.angle = -a, .obstacle = straight(points, rows[k].mu), .mass_damping = 400.0};
        s.hardness = rows[k].hardness;
        check_rest(&s, rows[k].lasting);
    }
}

/* Vertices under its bottom edges carry it. */
TEST(a_block_on_two_pegs_rests)
{
    static const double pegs[10] = {-1.0, -0.1, -0.13, 0.0, 0.0, -0.1, 0.12, 0.0, 1.0, -0.1};
    check_rest(
        &(scene){.obstacle = {.struct_size = sizeof(dem_obstacle), .n_points = 5, .points = pegs, .friction = 0.3},
                 .mass_damping = 400.0},
        2);
}

/* The springs and friction alone take the energy. */
TEST(a_dropped_block_comes_to_rest_by_the_damping_of_its_springs)
{
    static const double eta[2] = {0.0, 0.5};
    for (int k = 0; k < 2; k++) {
        scene s = {.height = 0.2 * spacing, .damping_time = 2e-3, .obstacle = straight(flat, 0.3)};
        s.obstacle.restitution = eta[k];
        free(settle(&s, 1.0, 5));
    }
}

/* Once the springs' damping has taken its waves the block slides as a point would. */
TEST(a_block_above_the_friction_angle_slides_down_with_the_exact_acceleration)
{
    static const double mu[2] = {0.2, 0.3};
    const double a = M_PI / 6.0, tangent[2] = {cos(a), -sin(a)};
    const double points[4] = {-9.0 * cos(a), 9.0 * sin(a), 9.0 * cos(a), -9.0 * sin(a)};
    for (int k = 0; k < 2; k++) {
        const scene s = {.angle = -a, .obstacle = straight(points, mu[k]), .damping_time = 2e-3};
        CLEANUP(close_block) block b;
        double v[2], x[2];
        open_block(&b, &s, NULL, true);
        for (int i = 0; i < 2; i++) {
            (void)advance(&b, 0.5 + 0.5 * i);
            const dem_body_motion body = ask_body(b.simulation, 0);
            v[i] = body.velocity[0] * tangent[0] + body.velocity[1] * tangent[1];
            x[i] = body.centre[0] * tangent[0] + body.centre[1] * tangent[1];
            assert_close(body.velocity[0] * sin(a) + body.velocity[1] * cos(a), 0.0, 1e-9);
            assert_close(body.angular_momentum[2], 0.0, 1e-9);
        }
        const double exact = g * (sin(a) - mu[k] * cos(a));
        assert_close((v[1] - v[0]) / 0.5, exact, 1e-8);
        assert_close((x[1] - x[0] - 0.5 * v[0]) / 0.125, exact, 1e-8);
        assert_close(b.drift, 0.0, 1e-6 * dem_model_mass(b.model) * g * 3.5 * spacing);
    }
}
