/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction of bodies with each other: rest, creep, sliding, momentum and ledger, local corrections beside it, what no
 * bit depends on. The force of one anchor is in unit/surface_contact/test_anchor.c. With 'long' times are as long as
 * they are said to be; without, a tenth. */
#include "support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "harness/cleanup.h"
#include "harness/message.h"
#include "last_record.h"
#include "simulation/private.h"

static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                         .density = 1050.0, .thickness = 1.0, .guard = 0.02);
static const double spacing = 5e-3, thickness = 1e-3, mu = 0.5, g = 9.81;
static double second = 0.1; /* s; with 'long' 1 */
static const dem_method methods[3] = {DEM_METHOD_FEHLBERG45, DEM_METHOD_VERLET, DEM_METHOD_HEUN12};

/* ---- scenes ---- */

/* A block with its lower edge at a height. */
static dem_lattice make_block(double width, double height, double middle, double bottom)
{
    dem_lattice l = support_rectangle(width, height, spacing, &rubber);
    dem_lattice_move(&l, 0.0, (const double[2]){middle, bottom - support_bottom(&l)});
    return l;
}

static void add(dem_lattice *to, dem_lattice body)
{
    assert_ok(dem_lattice_append(to, &body));
    dem_lattice_free(&body);
}

/* A fixed plate, and blocks on it, 40 mm wide and 20 mm high, which just touch. */
static dem_lattice make_stack(int n_blocks)
{
    dem_lattice l = make_block(0.14, 2.0 * spacing, 0.0, 0.0);
    l.flags = malloc((size_t)l.n_nodes);
    memset(l.flags, DEM_NODE_FIXED | DEM_NODE_CONTACT, (size_t)l.n_nodes);
    for (int k = 0; k < n_blocks; k++)
        add(&l, make_block(0.04, 0.02, -0.02 + 1e-3 * k, support_top(&l) + 0.99 * thickness));
    return l;
}

/* On a slope of this angle. */
static dem_options with_friction(double slope, double gravity)
{
    dem_options o = support_options();
    o.gravity[0] = gravity * sin(slope);
    o.gravity[1] = -gravity * cos(slope);
    o.bodies = DEM_BODIES_ALL;
    o.contact_friction = mu;
    return o;
}

static const double settled = 0.1; /* s, when bodies are at rest with damping */

/* The state in which damping has brought the bodies to rest. */
static dem_checkpoint *settle(const dem_lattice *l, const dem_options *options)
{
    CLEANUP(support_close) support_run run;
    dem_options o = *options;
    o.mass_damping = 500.0;
    o.checkpoint_steps = 1;
    support_open(&run, l, NULL, 0, &o);
    const motion end = support_at(&run, settled);
    assert_true(end.energy.kinetic < 1e-15 * end.energy.contact);
    return last_record(run.simulation);
}

/* A run that goes on from there. */
static void open_at_rest(support_run *run, const dem_lattice *l, const dem_options *options, const dem_checkpoint *from)
{
    support_open(run, l, NULL, 0, options);
    dem_simulation_destroy(run->simulation);
    assert_ok(dem_simulation_resume(&run->simulation, run->model, options, from));
}

static void launch(dem_lattice *l, dem_index body, double x, double y)
{
    if (l->velocity == NULL) l->velocity = calloc(2 * (size_t)l->n_nodes, sizeof *l->velocity);
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->body[i] == body) memcpy(&l->velocity[2 * i], (const double[2]){x, y}, 2 * sizeof x);
}

/* The force of other bodies on one, N. */
static vec2 force_on_body(const dem_simulation *s, dem_index body)
{
    vec2 sum = {0.0, 0.0}, force;
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++)
        if (s->model->lattice.body[i] == body && surface_contact_has(s->surfaces, i) &&
            surface_contact_force(s->surfaces, i, s->seen, &force))
            sum = vec2_add(sum, force);
    return sum;
}

static double largest_difference(const double *a, const double *b, dem_index n)
{
    double most = 0.0;
    for (dem_index k = 0; k < n; k++) most = fmax(most, fabs(a[k] - b[k]));
    return most;
}

/* ---- rest ---- */

/* The weight is carried, normal to the slope and along it: to what is left of the motion. */
TEST(a_block_at_rest_is_carried_with_its_weight)
{
    const double slope = atan(0.6 * mu);
    dem_options o = with_friction(slope, g);
    CLEANUP(dem_lattice_free) dem_lattice l = make_stack(1);
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = settle(&l, &o);
    for (int m = 0; m < 3; m++) {
        CLEANUP(support_close) support_run run;
        o.method = methods[m];
        open_at_rest(&run, &l, &o, checkpoint);
        (void)support_at(&run, settled + 1e-3);
        const double weight = ask_body(run.simulation, 1).mass * g;
        const vec2 force = force_on_body(run.simulation, 1);
        print_message("# carried: off by %.1e and %.1e\n", force.y / (weight * cos(slope)) - 1.0,
                      force.x / (-weight * sin(slope)) - 1.0);
        assert_close(force.y, weight * cos(slope), 1e-6 * weight);
        assert_close(force.x, -weight * sin(slope), 1e-6 * weight);
    }
}

/* No body creeps in the second half of the time, without any damping. */
TEST(a_stack_on_a_slope_does_not_creep)
{
    dem_options o = with_friction(atan(0.6 * mu), g);
    CLEANUP(dem_lattice_free) dem_lattice l = make_stack(3);
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = settle(&l, &o);
    for (int m = 0; m < 2; m++) {
        CLEANUP(support_close) support_run run;
        double x[4][3], most = 0.0;
        o.method = methods[m];
        open_at_rest(&run, &l, &o, checkpoint);
        (void)support_at(&run, settled + 0.5 * second);
        for (int b = 1; b <= 3; b++) memcpy(x[b], ask_body(run.simulation, b).centre, sizeof x[b]);
        (void)support_at(&run, settled + second);
        for (int b = 1; b <= 3; b++) {
            const dem_body_motion end = ask_body(run.simulation, b);
            most = fmax(most, hypot(end.centre[0] - x[b][0], end.centre[1] - x[b][1]));
        }
        print_message("# creep: %.1e spacings\n", most / spacing);
        assert_true(most < 1e-9 * spacing);
    }
}

/* Steps just below 2/omega of the bodies alone, under 1000 g: shortened by what contact and friction add, a block that
 * friction holds stays at rest for thousands of them. Without that it does not. */
TEST(fixed_steps_near_the_bound_are_stable_with_friction)
{
    dem_options o = with_friction(atan(0.6 * mu), 1000.0 * g);
    CLEANUP(dem_lattice_free) dem_lattice l = make_stack(1);
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = settle(&l, &o);
    CLEANUP(free_model) dem_model *model = support_model(&l, NULL, 0);
    CLEANUP(support_close) support_run run;
    o.method = DEM_METHOD_VERLET;
    o.fixed_step = 1.98 / dem_model_omega_max(model);
    open_at_rest(&run, &l, &o, checkpoint);
    const double start = ask_body(run.simulation, 1).centre[0];
    const motion end = support_at(&run, settled + 3000.0 * o.fixed_step);
    print_message("# at steps of 1.98/omega: kinetic %.1e of %.1e J, way %.1e spacings\n", end.energy.kinetic,
                  end.energy.contact, fabs(ask_body(run.simulation, 1).centre[0] - start) / spacing);
    assert_true(end.energy.kinetic < 1e-9 * end.energy.contact);
}

/* ---- sliding ---- */

/* Gives the block on the plate this velocity. */
static void push_along(support_run *run, double speed)
{
    const dem_lattice *l = &run->simulation->model->lattice;
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)l->n_nodes, sizeof *v);
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->body[i] == 1) v[2 * i] = speed;
    assert_ok(dem_simulation_set_motion(run->simulation, NULL, v));
}

/* A block stops after v^2/(2 mu g): 2 % are for the shear of the block, which rings, and for its bounces. */
TEST(a_block_slides_as_far_as_coulomb_says)
{
    const double v0 = 1.0, gravity = 10.0 * g, way = v0 * v0 / (2.0 * mu * gravity), time = v0 / (mu * gravity);
    dem_options o = with_friction(0.0, gravity);
    CLEANUP(dem_lattice_free) dem_lattice l = make_stack(1);
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = settle(&l, &o);
    for (int m = 0; m < 3; m++) {
        CLEANUP(support_close) support_run run;
        o.method = methods[m];
        open_at_rest(&run, &l, &o, checkpoint);
        push_along(&run, v0);
        const double start = ask_body(run.simulation, 1).centre[0];
        const dem_energy before = ask_energy(run.simulation);
        const dem_energy end = support_at(&run, settled + 1.2 * time).energy;
        const double found = ask_body(run.simulation, 1).centre[0] - start;
        print_message("# way %.6f of %.6f m, friction %.4f of %.4f J, closure %.1e\n", found, way, end.friction,
                      before.kinetic, fabs(end.ledger - before.ledger) / before.kinetic);
        assert_close(found, way, 0.02 * way);
        assert_close(end.friction, before.kinetic, 0.02 * before.kinetic);
        assert_close(end.ledger, before.ledger, 1e-4 * before.kinetic);
    }
}

/* ---- prescribed nodes ---- */

/* The nodes of the plate, all of which are given a velocity. */
static dem_boundary drive(dem_index nodes[], const dem_lattice *l, double speed)
{
    dem_boundary out = SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY,
                             .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .nodes = nodes, .value = {speed});
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->body[i] == 0) nodes[out.n_nodes++] = i;
    return out;
}

/* A lattice that starts where damping has brought it to rest. */
static dem_lattice make_settled(const dem_options *options)
{
    CLEANUP(support_close) support_run run;
    dem_lattice l = make_stack(1);
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = settle(&l, options);
    open_at_rest(&run, &l, options, checkpoint);
    support_start(&l, ask_state(run.simulation).x, NULL);
    return l;
}

/* A plate that moves with the speed V drags a block: this goes with mu g t until it has V, at t = V/(mu g). The drive
 * has then done the work mu N V t = m V^2, of which friction has taken half. 3 % are for the shear of the block, which
 * rings. */
TEST(a_driven_plate_drags_a_block_by_friction_alone)
{
    const double speed = 1.0, gravity = 10.0 * g, time = speed / (mu * gravity);
    enum { MOST = 512 };
    dem_index nodes[MOST];
    dem_options o = with_friction(0.0, gravity);
    CLEANUP(dem_lattice_free) dem_lattice l = make_settled(&o);
    const dem_boundary plate = drive(nodes, &l, speed);
    assert_true(l.n_nodes <= MOST);
    memset(l.flags, DEM_NODE_CONTACT, (size_t)l.n_nodes);
    o.boundaries = &plate;
    o.n_boundaries = 1;
    for (int m = 0; m < 3; m++) {
        CLEANUP(support_close) support_run run;
        o.method = methods[m];
        support_open(&run, &l, NULL, 0, &o);
        const double whole = ask_body(run.simulation, 1).mass * speed * speed;
        const dem_energy start = ask_energy(run.simulation), half = support_at(&run, 0.5 * time).energy;
        assert_close(ask_body(run.simulation, 1).velocity[0], 0.5 * speed, 0.03 * speed);
        assert_close(half.boundary, 0.5 * whole, 0.03 * whole);
        assert_close(half.friction, 0.375 * whole, 0.03 * whole);
        const dem_energy end = support_at(&run, 1.5 * time).energy;
        const double found = ask_body(run.simulation, 1).velocity[0];
        print_message("# speed %.4f of %.4f m/s, work %.5f of %.5f J, friction %.5f of %.5f J, closure %.1e\n", found,
                      speed, end.boundary, whole, end.friction, 0.5 * whole, fabs(end.ledger - start.ledger) / whole);
        assert_close(found, speed, 0.03 * speed);
        assert_close(end.boundary, whole, 0.03 * whole);
        assert_close(end.friction, 0.5 * whole, 0.03 * whole);
        assert_close(end.ledger, start.ledger, 1e-4 * whole);
    }
}

/* ---- collisions ---- */

/* Two free blocks, of which the upper one falls on the lower one obliquely. */
static dem_lattice make_collision(double along, double down)
{
    dem_lattice l = make_block(0.06, 0.03, 0.0, 0.0);
    add(&l, make_block(0.06, 0.03, 0.37 * spacing, support_top(&l) + 1.1 * thickness));
    launch(&l, 1, along, -down);
    return l;
}

static double angular_momentum(const dem_lattice *l, const double *x, const double *v)
{
    double sum = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++) sum += l->mass[i] * (x[2 * i] * v[2 * i + 1] - x[2 * i + 1] * v[2 * i]);
    return sum;
}

/* Momentum is kept to rounding, 2e-16 of the speed in each step; angular momentum, which is not linear in the unknowns,
 * and the ledger to the integrator's error. The upper block slides all the time; the impulses have the ratio mu but for
 * what the surfaces tilt. */
TEST(an_oblique_collision_keeps_momentum_and_the_ledger)
{
    const double down = 5.0;
    for (int m = 0; m < 3; m++) {
        CLEANUP(support_close) support_run run;
        CLEANUP(dem_lattice_free) dem_lattice l = make_collision(20.0, down);
        dem_options o = with_friction(0.0, 0.0);
        o.method = methods[m];
        o.contact_friction = 0.2;
        support_open(&run, &l, NULL, 0, &o);
        const dem_energy before = ask_energy(run.simulation);
        const double spin = angular_momentum(&l, l.x, l.velocity);
        const motion end = support_at(&run, 1.5e-3);
        const dem_body_motion lower = ask_body(run.simulation, 0), upper = ask_body(run.simulation, 1);
        const double momentum[2] = {lower.mass * lower.velocity[0], lower.mass * lower.velocity[1]};
        const double lost = fabs(momentum[0] / upper.mass + upper.velocity[0] - 20.0) +
                            fabs(momentum[1] / upper.mass + upper.velocity[1] + down);
        const double turned = (angular_momentum(&l, end.x, end.v) - spin) / (upper.mass * 0.06 * 20.0);
        const double closure = fabs(end.energy.ledger - before.ledger) / before.kinetic;
        const double rounding = 2e-16 * 20.0 * (double)ask_counts(run.simulation).steps;
        print_message("# ratio of impulses %.5f, momentum %.1e, angular %.1e, closure %.1e\n",
                      -momentum[0] / momentum[1], lost, turned, closure);
        assert_close(end.energy.contact, 0.0, 0.0); /* they are apart again */
        assert_close(-momentum[0] / momentum[1], 0.2, 0.02);
        assert_true(end.energy.friction > 0.0 && lost < rounding && fabs(turned) < 1e-7 && closure < 1e-4);
    }
}

/* ---- contact with an obstacle beside contact of bodies ---- */

/* Two squares side by side, the left one 0.4 mm higher, whose lower corners push each other. They fall with 5 m/s on a
 * floor, which stops each node: the right corner then slides along the left one. */
static void open_side_by_side(support_run *run, const dem_options *options)
{
    const double points[4] = {-1.0, 0.0, 1.0, 0.0};
    const dem_obstacle ground = SIZED(dem_obstacle, .n_points = 2, .points = points, .friction = 0.3);
    CLEANUP(dem_lattice_free)
    dem_lattice l = support_squares(0.03, spacing, &rubber, (const double[2]){0.0307, -4e-4});
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, 4.1e-4});
    assert_ok(dem_lattice_launch(&l, (const double[2]){0.5, -5.0}));
    support_open(run, &l, &ground, 1, options);
}

/* Anchors count as neighbours: a local correction beside them is as good as a step that ends at the event. What is left
 * is the error of both methods at this rtol, and that of friction, whose way is of second order in the steps: with
 * steps twice as long it is four times as large. */
TEST(events_beside_friction_of_bodies_are_corrected_locally)
{
    const double times[2] = {8e-6, 24e-6}; /* s */
    support_run runs[2];
    motion at[2];
    dem_options o = with_friction(0.0, 0.0);
    o.rtol = 1e-10;
    o.max_step = 1e-7;
    o.window = 0.0;
    for (int m = 0; m < 2; m++) {
        o.contact = m == 0 ? DEM_CONTACT_LOCAL : DEM_CONTACT_EXACT;
        open_side_by_side(&runs[m], &o);
    }
    for (int k = 0; k < 2; k++) {
        for (int m = 0; m < 2; m++) at[m] = support_at(&runs[m], times[k]);
        assert_true(runs[0].n_impacts >= 7 && at[0].energy.friction > 1e-4);
        const double off =
            largest_difference(at[0].x, at[1].x, 2 * runs[0].simulation->model->lattice.n_nodes) / spacing;
        print_message("# local against exact: off by %.1e spacings, friction %.3e J\n", off, at[0].energy.friction);
        assert_true(off < 1e-9);
    }
    for (int m = 0; m < 2; m++) support_close(&runs[m]);
}

/* ---- what no bit depends on ---- */

/* A plate of one row of triangles falls on a floor, which stops each node; a block slides on it with 2 m/s. */
static void open_on_floor(support_run *run, const dem_options *options)
{
    const double points[4] = {-1.0, 0.0, 1.0, 0.0};
    const dem_obstacle ground = SIZED(dem_obstacle, .n_points = 2, .points = points, .friction = 0.3);
    CLEANUP(dem_lattice_free) dem_lattice l = make_block(0.06, spacing, 0.0, 1e-5);
    add(&l, make_block(0.03, 0.02, 0.2 * spacing, support_top(&l) + 0.6 * thickness));
    launch(&l, 0, 0.5, -2.0);
    launch(&l, 1, 2.5, -2.0);
    support_open(run, &l, &ground, 1, options);
}

enum { MOST_NODES = 128 };

/* The state when the plate has hit the floor, and the block the plate. */
static const double late = 2.5e-4;

typedef struct bits {
    double x[2 * MOST_NODES], v[2 * MOST_NODES];
    dem_energy energy;
    dem_index n_made; /* how often the pair list was made */
} bits;

static bits bits_of(const dem_simulation *simulation)
{
    const dem_state end = ask_state(simulation);
    const size_t n = (size_t)simulation->model->lattice.n_nodes;
    bits out = {.energy = ask_energy(simulation), .n_made = simulation->surfaces->candidates.n_made};
    assert_true(n <= MOST_NODES);
    memcpy(out.x, end.x, 2 * n * sizeof *out.x);
    memcpy(out.v, end.v, 2 * n * sizeof *out.v);
    return out;
}

static bits run_on_floor(const dem_options *options, double margin)
{
    CLEANUP(support_close) support_run run;
    open_on_floor(&run, options);
    pair_list *list = &run.simulation->surfaces->candidates;
    list->margin = margin * run.simulation->surfaces->surface.mean_length;
    surface_contact_forget(run.simulation->surfaces);
    assert_ok(surface_contact_follow(run.simulation->surfaces, run.simulation->y));
    (void)support_at(&run, late);
    assert_true(run.n_impacts > 14 && run.simulation->surfaces->anchors.now.n > 0);
    return bits_of(run.simulation);
}

static void compare_bits(const bits *found, const bits *expected)
{
    assert_memory_equal(found->x, expected->x, sizeof found->x);
    assert_memory_equal(found->v, expected->v, sizeof found->v);
    assert_memory_equal(&found->energy, &expected->energy, sizeof found->energy);
}

/* Margins of 0.05 to 1 spacing; with the least one the list is made anew whenever something has moved. */
TEST(no_bit_depends_on_the_pair_list_threads_or_instructions)
{
    const double margins[4] = {0.05, 0.1, 0.5, 1.0};
    for (int m = 0; m < 3; m++) {
        dem_options o = with_friction(0.0, g);
        o.method = methods[m];
        const bits expected = run_on_floor(&o, 0.25);
        assert_true(expected.energy.friction > 1e-3);
        for (int k = 0; k < 4; k++) {
            const bits found = run_on_floor(&o, margins[k]);
            assert_true(k > 0 || found.n_made > 4 * expected.n_made);
            compare_bits(&found, &expected);
        }
        o.kernel = DEM_KERNEL_PORTABLE;
        o.thread_nodes = 1;
        for (o.threads = 1; o.threads <= 3; o.threads++) {
            const bits found = run_on_floor(&o, 0.25);
            compare_bits(&found, &expected);
        }
    }
}

/* An external force that pushes nothing, and may forget the lists at every evaluation. */
static dem_status forget_lists(void *context, const dem_force_query *query, double *force)
{
    surface_contact **surfaces = context;
    (void)query;
    (void)force;
    if (*surfaces != NULL) surface_contact_forget(*surfaces);
    return DEM_OK;
}

TEST(no_bit_depends_on_when_lists_are_made)
{
    for (int m = 0; m < 2; m++) {
        bits ends[2];
        for (int k = 0; k < 2; k++) {
            CLEANUP(support_close) support_run run;
            surface_contact *forgotten = NULL;
            dem_options o = with_friction(0.0, g);
            o.method = methods[m];
            o.force = forget_lists;
            o.force_context = &forgotten;
            open_on_floor(&run, &o);
            if (k == 1) forgotten = run.simulation->surfaces;
            (void)support_at(&run, late);
            ends[k] = bits_of(run.simulation);
        }
        assert_true(ends[1].n_made > 50 && ends[1].n_made > 4 * ends[0].n_made);
        compare_bits(&ends[1], &ends[0]);
    }
}

/* Anchors are part of a checkpoint: without them the block would have lost what it has stored. */
TEST(a_run_goes_on_from_a_checkpoint_to_the_same_bits)
{
    const dem_index every[3] = {1, 7, 256};
    for (int k = 0; k < 6; k++) {
        CLEANUP(support_close) support_run run;
        CLEANUP(free_simulation) dem_simulation *resumed;
        dem_options o = with_friction(0.0, g);
        size_t size = 0;
        o.method = methods[k / 3];
        o.checkpoint_steps = every[k % 3];
        if (k < 3)
            o.max_step = 8e-7; /* so that there are more than 256 steps */
        else
            o.fixed_step = 8e-7;
        const bits expected = run_on_floor(&o, 0.25);
        open_on_floor(&run, &o);
        (void)support_at(&run, 0.9 * late);
        CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = last_record(run.simulation);
        assert_non_null(dem_checkpoint_find(checkpoint, "friction", &size));
        assert_true(size > 0);
        assert_ok(dem_simulation_resume(&resumed, run.model, &o, checkpoint));
        assert_ok(dem_simulation_advance(resumed, late));
        const bits found = bits_of(resumed);
        compare_bits(&found, &expected);
    }
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) second = 1.0;
    return test_run();
}
