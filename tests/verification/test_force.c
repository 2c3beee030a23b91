/* SPDX-License-Identifier: BSD-3-Clause */
/* A force from outside against closed forms, against what the library has of its own -- weight, drag, forces of
 * boundaries -- and in contacts, which it presses, slides and holds. */
#include <stdlib.h>
#include <string.h>

#include "harness/motion.h"
#include "support.h"

/* What a force of these tests is made of: F = push - k (x - centre) - c v, times a mass where there are masses. */
typedef struct field {
    double push[2], centre[2], stiffness, drag;
    double rise;        /* N/s along x */
    const double *mass; /* [n_nodes], or NULL */
    long asked, few;    /* how often, and of these not about all */
    dem_index n_nodes;
} field;

static dem_status act(void *context, const dem_force_query *q, double *force)
{
    field *f = context;
    f->asked++;
    f->few += q->n < f->n_nodes;
    for (dem_index k = 0; k < q->n; k++)
        for (int d = 0; d < 2; d++) {
            const double m = f->mass != NULL ? f->mass[q->nodes[k]] : 1.0;
            assert_true(force[2 * k + d] == 0.0);
            force[2 * k + d] = m * (f->push[d] - f->stiffness * (q->x[2 * k + d] - f->centre[d]) -
                                    f->drag * q->v[2 * k + d] + (d == 0 ? f->rise * q->t : 0.0));
        }
    return DEM_OK;
}

static void apply(dem_options *options, field *f)
{
    options->force = act;
    options->force_context = f;
}

/* ---- one node ---- */

static const double mass = 2.0;

/* Without weight, over a floor far below unless `ground` is given; rtol and penetration tolerance as support_point()
 * has them. */
static void open_node(support_run *run, const double v[2], const dem_obstacle *ground, dem_method method, field *f)
{
    const double x[2] = {0.0, 0.0};
    dem_options options = support_options();
    f->n_nodes = 1;
    options.method = method;
    options.gravity[1] = 0.0;
    options.spacing = options.v_scale = 1.0;
    options.max_step = 0.01;
    options.rtol = 1e-12;
    options.penetration_tolerance = 1e-13;
    apply(&options, f);
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(1, x, &mass, 0, NULL, 0.0, 0.0, NULL);
    support_start(&lattice, NULL, v);
    support_open(run, &lattice, ground, ground != NULL, &options);
}

/* Work of a force with the potential k (x - c)^2/2 is the potential's fall. */
static void check_work(const motion *s, const field *f, double tolerance)
{
    double fall = 0.0;
    for (int d = 0; d < 2; d++) {
        const double now = s->x[d] - f->centre[d];
        fall += 0.5 * f->stiffness * (f->centre[d] * f->centre[d] - now * now);
    }
    assert_close(s->energy.boundary, fall, tolerance);
}

/* x - c = -c cos(w t) + v0/w sin(w t), w^2 = k/m. With w h = 0.05 Fehlberg's pair has an error of 1e-12 a step or less,
 * of 400 steps; Verlet's method one of (w h)^2/24 of the phase. */
TEST(a_trap_swings_a_node)
{
    const struct {
        dem_method method;
        double tolerance;
    } cases[] = {{DEM_METHOD_FEHLBERG45, 1e-9},
                 {DEM_METHOD_RK4, 1e-6},
                 {DEM_METHOD_VERLET, 25.0 * 4.0 * 0.05 * 0.05 / 24.0},
                 {DEM_METHOD_DOPRI45, 1e-9}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        field f = {.centre = {0.3, -0.2}, .stiffness = 50.0};
        const double v[2] = {1.0, 0.5}, w = sqrt(f.stiffness / mass), tolerance = cases[k].tolerance;
        CLEANUP(support_close) support_run run;
        open_node(&run, v, NULL, cases[k].method, &f);
        const double ledger = ask_energy(run.simulation).ledger;
        for (double t = 0.1; t <= 4.0; t += 0.39) {
            const motion s = support_at(&run, t);
            for (int d = 0; d < 2; d++)
                assert_close(s.x[d], f.centre[d] * (1.0 - cos(w * t)) + v[d] / w * sin(w * t), tolerance);
            check_work(&s, &f, 20.0 * tolerance);
            assert_close(s.energy.ledger, ledger, 20.0 * tolerance);
        }
    }
}

/* m v' = -c v: v = v0 exp(-c t/m), and the work is the kinetic energy that is gone. */
TEST(a_drag_slows_a_node)
{
    field f = {.drag = 3.0};
    const double v[2] = {4.0, -1.0}, rate = f.drag / mass;
    CLEANUP(support_close) support_run run;
    open_node(&run, v, NULL, DEM_METHOD_FEHLBERG45, &f);
    for (double t = 0.0; t < 3.0; t += 0.31) {
        const motion s = support_at(&run, t);
        for (int d = 0; d < 2; d++) {
            assert_close(s.x[d], v[d] / rate * (1.0 - exp(-rate * t)), 1e-10);
            assert_close(s.v[d], v[d] * exp(-rate * t), 1e-10);
        }
        assert_close(s.energy.boundary, -0.5 * mass * 17.0 * (1.0 - exp(-2.0 * rate * t)), 1e-9);
    }
}

/* ---- one node on a floor ---- */

static const double floor_points[4] = {-10.0, 0.0, 100.0, 0.0};

/* At rest, pressed by P and pulled along by R t: N = P, and friction holds until R t = mu P; then m a = R t - mu P. The
 * root of the grip is found to rounding of the time. */
TEST(friction_holds_until_the_force_exceeds_it)
{
    const double mu = 0.4;
    const dem_obstacle ground = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .friction = mu);
    field f = {.push = {0.0, -25.0}, .rise = 8.0};
    const double slips = mu * 25.0 / f.rise;
    CLEANUP(support_close) support_run run;
    open_node(&run, NULL, &ground, DEM_METHOD_FEHLBERG45, &f);
    const motion before = support_at(&run, slips * (1.0 - 1e-12));
    assert_close(before.v[0], 0.0, 0.0);
    assert_int_equal(before.n_contacts, 1);
    assert_int_equal(before.contacts[0].state, DEM_CONTACT_STICK);
    assert_close(before.contacts[0].force, 25.0, 1e-13);
    for (double t = 0.1; t < 2.0; t += 0.17) {
        const motion s = support_at(&run, slips + t);
        assert_close(s.v[0], 0.5 * f.rise * t * t / mass, 1e-10);
        assert_close(s.x[0], f.rise * t * t * t / (6.0 * mass), 1e-10);
        assert_close(s.contacts[0].force, 25.0, 1e-13);
        assert_close(fabs(s.contacts[0].friction[0]), mu * 25.0, 1e-12);
        assert_close(s.energy.friction, mu * 25.0 * s.x[0], 1e-9);
        assert_close(s.energy.ledger, 0.0, 1e-9);
    }
}

/* A lift that grows with time takes it off when it has become the weight. */
TEST(a_contact_opens_when_the_force_lifts_it)
{
    const double wall[4] = {0.0, 10.0, 0.0, -10.0}; /* bodies on the right: the force along x lifts */
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = wall};
    field f = {.push = {-6.0, 0.0}, .rise = 4.0};
    CLEANUP(support_close) support_run run;
    open_node(&run, NULL, &ground, DEM_METHOD_FEHLBERG45, &f);
    const double opens = 6.0 / f.rise;
    assert_int_equal(support_at(&run, opens - 1e-9).n_contacts, 1);
    for (double t = 0.1; t < 1.0; t += 0.2) {
        const motion s = support_at(&run, opens + t);
        assert_int_equal(s.n_contacts, 0);
        assert_close(s.x[0], f.rise * t * t * t / (6.0 * mass), 1e-10);
    }
}

/* Under a push P down from height h with restitution eta the node is back on the floor after t1 = sqrt(2 h m/P), then
 * after 2 eta t1, 2 eta^2 t1 ... as under a weight. */
TEST(a_pushed_node_bounces)
{
    const double eta = 0.5, h = 0.7, points[4] = {-10.0, -0.7, 10.0, -0.7};
    const dem_obstacle ground = SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = eta);
    field f = {.push = {0.0, -5.0}};
    const double a = 5.0 / mass, t1 = sqrt(2.0 * h / a);
    CLEANUP(support_close) support_run run;
    open_node(&run, NULL, &ground, DEM_METHOD_FEHLBERG45, &f);
    const motion s = support_at(&run, 2.9 * t1);
    assert_true(run.n_impacts >= 3);
    double t = t1, speed = a * t1;
    for (int k = 0; k < 3; k++, t += 2.0 * speed / a) {
        assert_close(run.impacts[k].t, t, 1e-9);
        assert_close(run.impacts[k].before[1], -speed, 1e-9);
        speed *= eta;
    }
    assert_close(s.energy.ledger, 0.0, 1e-10);
}

/* ---- bodies ---- */

/* A block of rubber, deformed, over a floor or none; `how` puts on it what acts. */
typedef struct load {
    double gravity, mass_damping;
    const dem_boundary *boundary;
    field *field;
} load;

static void open_block(support_run *run, double height, const dem_obstacle *ground, load how)
{
    const double lift[2] = {0.0, height};
    dem_options options = support_options();
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    support_block(&block);
    for (dem_index i = 0; i < block.n_nodes; i++) block.position[2 * i + 1] += lift[1];
    options.gravity[1] = how.gravity;
    options.mass_damping = how.mass_damping;
    options.rtol = 1e-8;
    options.v_scale = 1.0;
    options.n_boundaries = how.boundary != NULL;
    options.boundaries = how.boundary;
    if (how.field != NULL) {
        apply(&options, how.field);
        how.field->n_nodes = block.n_nodes;
    }
    support_open(run, &block, ground, ground != NULL, &options);
    if (how.field != NULL && how.field->mass != NULL) how.field->mass = dem_model_lattice(run->model)->mass;
}

static double furthest(const motion *a, const motion *b, dem_index n)
{
    double most = 0.0;
    for (dem_index k = 0; k < 2 * n; k++) most = fmax(most, fabs(a->x[k] - b->x[k]));
    return most;
}

static const double low[4] = {-1.0, -0.028, 1.0, -0.028};

/* Both fall 1 mm at 200 m/s^2, hit and lie for a while. Roundings apart it is the same motion: 1e-9 of the spacing,
 * and what a change in the last digits grows to in the impacts. */
TEST(a_force_in_proportion_to_mass_is_a_weight)
{
    static const double any = 1.0;
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = low, .friction = 0.3};
    field f = {.push = {0.0, -200.0}, .mass = &any};
    CLEANUP(support_close) support_run heavy, pushed;
    open_block(&heavy, 0.0, &ground, (load){.gravity = -200.0});
    open_block(&pushed, 0.0, &ground, (load){.field = &f});
    const double ledger = ask_energy(pushed.simulation).ledger;
    const double weight = ask_energy(heavy.simulation).gravity;
    for (double t = 1e-3; t < 6e-3; t += 1e-3) {
        const motion a = support_at(&heavy, t), b = support_at(&pushed, t);
        assert_close(furthest(&a, &b, ask_sizes(heavy.model).n_nodes), 0.0, 1e-9);
        assert_int_equal(a.n_contacts, b.n_contacts);
        assert_close(b.energy.boundary, weight - a.energy.gravity, 1e-6 * a.energy.elastic);
        assert_close(b.energy.ledger, ledger, 1e-6 * a.energy.elastic);
    }
    assert_true(heavy.n_impacts > 20 && heavy.n_impacts == pushed.n_impacts);
    assert_true(f.few > 0);
}

/* The library's own drag, with its work under another name. */
TEST(a_drag_in_proportion_to_mass_is_mass_damping)
{
    static const double any = 1.0;
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = low};
    field f = {.drag = 300.0, .mass = &any};
    CLEANUP(support_close) support_run damped, dragged;
    open_block(&damped, 0.0, &ground, (load){.gravity = -200.0, .mass_damping = 300.0});
    open_block(&dragged, 0.0, &ground, (load){.gravity = -200.0, .field = &f});
    for (double t = 1e-3; t < 9e-3; t += 1e-3) {
        const motion a = support_at(&damped, t), b = support_at(&dragged, t);
        assert_close(furthest(&a, &b, ask_sizes(damped.model).n_nodes), 0.0, 1e-9);
        assert_close(-b.energy.boundary, a.energy.damping, 1e-6 * a.energy.elastic);
    }
    print_message("# %lld\n", (long long)damped.n_impacts);
    assert_true(damped.n_impacts > 20);
}

/* On two nodes only, by their numbers. */
typedef struct pair {
    dem_index nodes[2];
    double force[2][2];
} pair;

static dem_status act_on_pair(void *context, const dem_force_query *q, double *force)
{
    const pair *p = context;
    for (dem_index k = 0; k < q->n; k++)
        for (int e = 0; e < 2; e++)
            if (q->nodes[k] == p->nodes[e]) memcpy(force + 2 * k, p->force[e], sizeof p->force[e]);
    return DEM_OK;
}

/* The same forces by boundaries and from outside, with the numbers as `order` has them: far apart ones are not those
 * in which forces are evaluated. */
static void compare_with_boundaries(const dem_index *order)
{
    const double far[4] = {-1.0, -0.028, 1.0, -0.028};
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = far, .restitution = 0.3};
    dem_options options = support_options();
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty(), again = dem_lattice_empty();
    CLEANUP(support_close) support_run by_boundary, by_force;
    motion a, b;
    support_block(&block);
    support_block(&again);
    for (dem_index i = 0; i < block.n_nodes; i++) {
        again.mass[order[i]] = block.mass[i];
        if (block.flags != NULL) again.flags[order[i]] = block.flags[i];
        memcpy(again.x + 2 * order[i], block.x + 2 * i, 2 * sizeof(double));
        memcpy(again.position + 2 * order[i], block.position + 2 * i, 2 * sizeof(double));
    }
    for (dem_index k = 0; k < 2 * block.n_springs; k++) again.ends[k] = order[block.ends[k]];
    for (dem_index k = 0; k < 3 * block.n_triangles; k++) again.triangles[k] = order[block.triangles[k]];
    pair p = {{order[5], order[100]}, {{30.0, -400.0}, {-50.0, -300.0}}};
    dem_boundary forces[2];
    for (int e = 0; e < 2; e++)
        forces[e] = (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 1, .nodes = &p.nodes[e],
                                        .value = {p.force[e][0], p.force[e][1]});
    options.rtol = 1e-8;
    options.v_scale = 1.0;
    options.n_boundaries = 2;
    options.boundaries = forces;
    support_open(&by_boundary, &again, &ground, 1, &options);
    options.n_boundaries = 0;
    options.force = act_on_pair;
    options.force_context = &p;
    support_open(&by_force, &again, &ground, 1, &options);
    for (double t = 5e-4; t < 4e-3; t += 5e-4) {
        a = support_at(&by_boundary, t);
        b = support_at(&by_force, t);
        assert_close(furthest(&a, &b, block.n_nodes), 0.0, 1e-9);
        assert_close(a.energy.boundary, b.energy.boundary, 1e-7 * a.energy.elastic);
    }
    assert_true(by_boundary.n_impacts > 10);
}

TEST(forces_of_boundaries_do_the_same)
{
    dem_index order[137];
    for (dem_index i = 0; i < 137; i++) order[i] = i;
    compare_with_boundaries(order);
    for (dem_index i = 0; i < 137; i++) order[i] = (i * 50) % 137;
    compare_with_boundaries(order);
}

/* What a floor has given is what momentum asks for at any time, M v = (W + F) t + impulse, in every frame; and at rest
 * its reaction is W + F. Sums of 1e4 steps of terms of order F t. */
TEST(a_floor_bears_weight_and_force)
{
    static const double any = 1.0;
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = low, .friction = 0.2};
    field f = {.push = {10.0, -100.0}, .mass = &any}; /* friction holds it */
    CLEANUP(support_close) support_run run;
    open_block(&run, 0.0, &ground, (load){.gravity = -150.0, .field = &f});
    const double m = dem_model_mass(run.model), scale = m * 250.0 * 0.02;
    for (double t = 1e-3; t < 0.02; t += 1.7e-3) {
        (void)support_at(&run, t);
        const dem_body_motion body = ask_body(run.simulation, 0);
        const dem_obstacle_load got = ask_obstacle(run.simulation, 0);
        assert_close(m * body.velocity[0], m * 10.0 * t + got.impulse[0], 1e-10 * scale);
        assert_close(m * body.velocity[1], -m * 250.0 * t + got.impulse[1], 1e-10 * scale);
    }
    support_close(&run);
    open_block(&run, 0.0, &ground, (load){.gravity = -150.0, .mass_damping = 2000.0, .field = &f});
    (void)support_at(&run, 0.08);
    const dem_obstacle_load rest = ask_obstacle(run.simulation, 0);
    assert_close(rest.reaction[0], -m * 10.0, 1e-4 * m * 250.0);
    assert_close(rest.reaction[1], m * 250.0, 1e-4 * m * 250.0);
}

/* ---- both methods of contact ---- */

/* A trap drives the block into the floor again and again, until the first impacts have parted the runs. */
TEST(the_ledger_of_a_trap_closes)
{
    static const double any = 1.0;
    const dem_obstacle ground = SIZED(dem_obstacle, .n_points = 2, .points = low, .restitution = 0.5, .friction = 0.3);
    field f = {.centre = {0.02, -0.01}, .stiffness = 4e4, .drag = 5.0, .mass = &any};
    CLEANUP(support_close) support_run run;
    open_block(&run, 0.0, &ground, (load){.gravity = -100.0, .field = &f});
    const double ledger = ask_energy(run.simulation).ledger;
    double scale = 0.0;
    for (double t = 1e-3; t < 0.02; t += 1e-3) {
        const motion s = support_at(&run, t);
        scale = fmax(scale, s.energy.motion);
        assert_close(s.energy.ledger, ledger, 1e-6 * scale);
    }
    print_message("# %lld\n", (long long)run.n_impacts);
    assert_true(run.n_impacts > 50);
}
