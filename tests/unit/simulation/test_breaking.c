/* SPDX-License-Identifier: BSD-3-Clause */
/* breaking.c: what a program breaks between two advances, what that does to the motion, to the ledger and to surfaces,
 * and what is refused. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "harness/message.h"

static const dem_material rubber = {.struct_size = sizeof(dem_material),
                                    .youngs_modulus = 1e7,
                                    .poissons_ratio = 0.2,
                                    .density = 1050.0,
                                    .thickness = 1.0,
                                    .guard = 0.02};

static dem_options free_fall(double rtol)
{
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = rtol;
    return options;
}

/* A list of numbers. */
typedef struct numbers {
    dem_index n, list[512];
} numbers;

/* The triangles that lie across the height y. */
static numbers across(const dem_lattice *l, double y)
{
    numbers out = {0};
    for (dem_index t = 0; t < l->n_triangles; t++) {
        int above = 0;
        for (int c = 0; c < 3; c++) above += l->x[2 * l->triangles[3 * t + c] + 1] > y;
        if (above == 1 || above == 2) out.list[out.n++] = t;
    }
    assert_true(out.n > 0);
    return out;
}

static void break_triangles(dem_simulation *s, const numbers *which)
{
    assert_ok(dem_simulation_break(s, which->list, which->n, NULL, 0));
}

/* ---- one spring ---- */

/* Two masses of 1 kg at 1.5 times the rest length, 1 m, of a spring of 8 N: E (d - d0)^2/(2 d0) = 1 J. Broken, they
 * stay where they are. */
TEST(a_broken_spring_pulls_no_more)
{
    const double x[4] = {0.0, 0.0, 1.5, 0.0}, masses[2] = {1.0, 1.0};
    const dem_index ends[2] = {0, 1}, which[1] = {0};
    CLEANUP(dem_lattice_free) dem_lattice pair = support_lattice(2, x, masses, 1, ends, 1.0, 8.0, NULL);
    const dem_options options = free_fall(1e-10);
    CLEANUP(support_close) support_run run;
    unsigned char broken;
    double force;
    support_open(&run, &pair, NULL, 0, &options);
    assert_ok(dem_simulation_broken(run.simulation, NULL, &broken));
    assert_int_equal(broken, 0);
    assert_ok(dem_simulation_break(run.simulation, NULL, 0, which, 1));
    assert_ok(dem_simulation_broken(run.simulation, NULL, &broken));
    assert_int_equal(broken, 1);
    assert_ok(dem_simulation_force_at(run.simulation, 0, &force));
    assert_close(force, 0.0, 0.0);
    const motion s = support_at(&run, 1.0);
    assert_memory_equal(s.x, x, sizeof x);
    assert_close(s.energy.fracture, 1.0, 0.0);
    assert_close(s.energy.elastic, 0.0, 0.0);
    assert_close(s.energy.ledger, 1.0, 0.0);
}

/* ---- a body ---- */

/* A block that is stretched and bent swings; the row of triangles in its middle breaks, at a time within a step. */
enum { MOST_NODES = 256 };
static const double t_break = 1.3e-3, t_pressed = 4e-4, t_end = 4e-3, middle = 0.026;

static void moments(const dem_lattice *l, const motion *s, double out[3])
{
    out[0] = out[1] = out[2] = 0.0;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double *x = &s->x[2 * i], *v = &s->v[2 * i];
        out[0] += l->mass[i] * v[0];
        out[1] += l->mass[i] * v[1];
        out[2] += l->mass[i] * (x[0] * v[1] - x[1] * v[0]);
    }
}

/* Energy is taken by the break at its instant, and the ledger closes: 1e-12 of some J in 1e3 springs by rounding there,
 * the integrator's error at rtol 1e-9 before and after. Nothing pulls from outside: momenta stay 0 but for rounding,
 * with 1e-3 kg m/s of single nodes. */
TEST(the_ledger_closes_over_a_break)
{
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    support_block(&block);
    const dem_options options = free_fall(1e-9);
    const numbers row = across(&block, middle);
    CLEANUP(support_close) support_run run;
    support_open(&run, &block, NULL, 0, &options);
    double momenta[3];
    motion s = support_at(&run, t_break);
    const dem_energy before = s.energy;
    break_triangles(run.simulation, &row);
    motion_see(run.simulation, &s);
    assert_close(s.t, t_break, 0.0);
    assert_true(s.energy.fracture > 1e-3 * before.motion && s.energy.motion < before.motion);
    assert_close(s.energy.kinetic, before.kinetic, 0.0);
    assert_close(s.energy.ledger, before.ledger, 1e-12 * before.motion);
    const double taken = s.energy.fracture;
    s = support_at(&run, t_end);
    assert_close(s.energy.fracture, taken, 0.0);
    assert_close(s.energy.ledger, before.ledger, 1e-7 * before.motion);
    moments(&block, &s, momenta);
    for (int k = 0; k < 3; k++) assert_close(momenta[k], 0.0, 1e-12);
}

/* The same block cut before it was assembled, with the masses of the whole one, from the state of the break on. Both
 * are run at rtol 1e-11, where errors of positions of 5 mm spacing are 5e-14 m a step. */
TEST(what_is_left_moves_like_the_body_cut_there)
{
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
    CLEANUP(dem_lattice_free) dem_lattice cut = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&cut, 0.05, 0.052, 0.005));
    const numbers row = across(&block, middle);
    CLEANUP(free_memory) bool *keep = calloc((size_t)cut.n_triangles, sizeof *keep);
    assert_non_null(keep);
    for (dem_index k = 0; k < cut.n_triangles; k++) keep[k] = true;
    for (dem_index k = 0; k < row.n; k++) keep[row.list[k]] = false;
    assert_ok(dem_lattice_trim(&cut, keep));
    assert_ok(dem_lattice_assemble(&cut, &rubber));
    assert_int_equal(cut.n_nodes, block.n_nodes);
    memcpy(cut.mass, block.mass, (size_t)cut.n_nodes * sizeof *cut.mass);
    double v[2 * MOST_NODES];
    assert_true(block.n_nodes <= MOST_NODES);
    for (dem_index c = 0; c < 2 * block.n_nodes; c++) v[c] = 0.5 * sin(3.0 * (double)(c * c));
    support_start(&block, NULL, v);
    const dem_options options = free_fall(1e-11);
    CLEANUP(support_close) support_run whole, pieces;
    support_open(&whole, &block, NULL, 0, &options);
    motion s = support_at(&whole, t_break);
    support_start(&cut, s.x, s.v);
    break_triangles(whole.simulation, &row);
    support_open(&pieces, &cut, NULL, 0, &options);
    s = support_at(&whole, t_break + 1e-3);
    const motion expected = support_at(&pieces, 1e-3);
    for (dem_index c = 0; c < 2 * block.n_nodes; c++) {
        assert_close(s.x[c], expected.x[c], 1e-10);
        assert_close(s.v[c], expected.v[c], 1e-6);
    }
}

/* Two runs of the same, one of which is cut after the break and goes on from its checkpoint. The row breaks as the wave
 * of the impact presses it, so that what fills it has less than its height. */
TEST(a_run_goes_on_from_a_checkpoint_to_the_same_bits)
{
    static const double ground[4] = {-1.0, -1e-4, 1.0, -1e-4};
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = ground, .restitution = 0.5);
    for (int bodies = 0; bodies < 2; bodies++) {
        CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
        assert_ok(dem_lattice_launch(&block, (const double[2]){0.0, -3.0}));
        const numbers row = across(&block, middle);
        dem_options options = free_fall(1e-6);
        options.bodies = bodies ? DEM_BODIES_ALL : DEM_BODIES_NONE;
        options.checkpoint_steps = 7;
        CLEANUP(support_close) support_run run;
        support_open(&run, &block, &floor, 1, &options);
        CLEANUP(free_model) dem_model *model = support_model(&block, &floor, 1);
        (void)support_at(&run, t_pressed);
        break_triangles(run.simulation, &row);
        (void)support_at(&run, 1.5 * t_pressed);
        const dem_checkpoint *last = dem_simulation_checkpoint(run.simulation);
        assert_non_null(last);
        CLEANUP(free_simulation) dem_simulation *resumed = NULL;
        assert_ok(dem_simulation_resume(&resumed, model, &options, last));
        assert_ok(dem_simulation_advance(resumed, 2.0 * t_end));
        motion s = support_at(&run, 2.0 * t_end), same;
        motion_see(resumed, &same);
        assert_true(run.n_impacts > 0);
        assert_memory_equal(s.x, same.x, 2 * (size_t)block.n_nodes * sizeof *s.x);
        assert_memory_equal(s.v, same.v, 2 * (size_t)block.n_nodes * sizeof *s.v);
        assert_memory_equal(&s.energy, &same.energy, sizeof s.energy);
        CLEANUP(free_memory) unsigned char *broken = calloc((size_t)block.n_triangles, 1);
        assert_non_null(broken);
        assert_ok(dem_simulation_broken(resumed, broken, NULL));
        for (dem_index k = 0; k < row.n; k++) broken[row.list[k]] ^= 1;
        for (dem_index k = 0; k < block.n_triangles; k++) assert_int_equal(broken[k], 0);
    }
}

/* Checkpoints of versions without fracture have no entry of it, as those of a body that cannot break. */
TEST(a_checkpoint_without_fracture_is_of_a_whole_body)
{
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
    dem_options options = free_fall(1e-6);
    options.checkpoint_steps = 7;
    CLEANUP(support_close) support_run run;
    support_open(&run, &block, NULL, 0, &options);
    (void)support_at(&run, t_end);
    const dem_checkpoint *last = dem_simulation_checkpoint(run.simulation);
    size_t size;
    assert_non_null(last);
    assert_null(dem_checkpoint_find(last, "fracture", &size));

    CLEANUP(dem_lattice_free) dem_lattice brittle = support_rectangle(0.05, 0.052, 0.005, &rubber);
    brittle.strength = malloc((size_t)brittle.n_triangles * sizeof *brittle.strength);
    assert_non_null(brittle.strength);
    for (dem_index k = 0; k < brittle.n_triangles; k++) brittle.strength[k] = 1e9; /* Pa, 100 E: nothing breaks */
    CLEANUP(free_model) dem_model *model = support_model(&brittle, NULL, 0);
    CLEANUP(free_simulation) dem_simulation *resumed = NULL;
    assert_ok(dem_simulation_resume(&resumed, model, &options, last));
    assert_ok(dem_simulation_advance(resumed, 2.0 * t_end));
    motion s = support_at(&run, 2.0 * t_end), same;
    motion_see(resumed, &same);
    assert_memory_equal(s.x, same.x, 2 * (size_t)block.n_nodes * sizeof *s.x);
    assert_int_equal(ask_fracture(resumed).triangles, 0);
    assert_int_equal(ask_fracture(resumed).fragments, 1);
}

/* ---- surfaces ---- */

/* The lowest row of triangles breaks off a block: its upper nodes, which were inside, come to lie on the floor. */
TEST(what_was_inside_touches_the_floor)
{
    static const double ground[4] = {-1.0, -1e-3, 1.0, -1e-3};
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = ground);
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
    const numbers row = across(&block, 0.002);
    dem_options options = dem_options_default();
    options.mass_damping = 200.0;
    CLEANUP(support_close) support_run run;
    support_open(&run, &block, &floor, 1, &options);
    break_triangles(run.simulation, &row);
    const motion s = support_at(&run, 0.3);
    dem_index n_inside = 0, n_lying = 0;
    for (dem_index i = 0; i < block.n_nodes; i++) {
        const bool second_row = block.x[2 * i + 1] > 0.002 && block.x[2 * i + 1] < 0.006;
        n_inside += second_row && fabs(block.x[2 * i]) < 0.021;
        n_lying += second_row && fabs(s.x[2 * i + 1] + 1e-3) < 1e-6;
        assert_true(s.x[2 * i + 1] > -1e-3 - 1e-7);
    }
    assert_true(n_inside > 5 && n_lying > n_inside);
}

/* A diamond of 2 mm within a body, about one of its nodes: edges do not see vertices. It turns clockwise. */
static dem_index put_diamond(const dem_lattice *l, double points[10])
{
    static const double turn[10] = {1e-3, 0.0, 0.0, -1e-3, -1e-3, 0.0, 0.0, 1e-3, 1e-3, 0.0};
    dem_index inner = -1;
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (fabs(l->x[2 * i]) < 2.6e-3 && fabs(l->x[2 * i + 1] - 0.026) < 2.2e-3) inner = i;
    assert_true(inner >= 0);
    for (int c = 0; c < 10; c++) points[c] = l->x[2 * inner + c % 2] + turn[c];
    return inner;
}

static dem_index nodes_behind(const dem_simulation *s)
{
    dem_counts counts = {.struct_size = sizeof counts};
    assert_ok(dem_simulation_counts(s, &counts));
    return counts.behind;
}

/* A node that is inside an obstacle when it comes to the surface, as a program breaks a triangle, or as it breaks by
 * itself, is behind the obstacle, and goes on with the body until it has come out. Nothing pulls: a way of 3 m/s t. */
TEST(a_node_that_comes_to_the_surface_in_an_obstacle_is_behind_it)
{
    for (int itself = 0; itself < 2; itself++) {
        CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
        double points[10], v[2 * MOST_NODES];
        const dem_index inner = put_diamond(&block, points);
        const dem_obstacle diamond = SIZED(dem_obstacle, .n_points = 5, .points = points);
        dem_options options = free_fall(1e-8);
        options.vertices = false;
        options.checkpoint_steps = 7;
        dem_index triangle = 0;
        while (block.triangles[3 * triangle] != inner && block.triangles[3 * triangle + 1] != inner) triangle++;
        for (dem_index c = 0; c < 2 * block.n_nodes; c++) v[c] = c % 2 ? (itself ? 100.0 * block.x[c] : -3.0) : 0.0;
        support_start(&block, NULL, v);
        block.strength = itself ? malloc((size_t)block.n_triangles * sizeof *block.strength) : NULL;
        for (dem_index t = 0; t < block.n_triangles && itself; t++)
            block.strength[t] = t == triangle ? 1e4 : (double)INFINITY;
        CLEANUP(support_close) support_run run;
        support_open(&run, &block, &diamond, 1, &options);
        const double had = support_at(&run, 0.0).energy.ledger;
        if (!itself) break_triangles(run.simulation, &(numbers){1, {triangle}});
        assert_int_equal(ask_fracture(run.simulation).buried, 0);
        motion s = support_at(&run, 1e-4);
        assert_int_equal(nodes_behind(run.simulation), 1);
        const dem_fracture then = ask_fracture(run.simulation);
        assert_int_equal(then.buried, 1);
        assert_int_equal(then.buried_node, inner);
        assert_true(itself ? then.buried_t > 0.0 && then.buried_t < 1e-4 : then.buried_t == 0.0);
        for (int c = 0; c < 2; c++) assert_close(then.buried_x[c], block.x[2 * inner + c], itself ? 3e-4 : 0.0);
        assert_close(s.energy.ledger, had, 1e-7 * had);
        s = support_at(&run, 2e-3);
        assert_int_equal(nodes_behind(run.simulation), 0);
        CLEANUP(free_simulation) dem_simulation *resumed = NULL;
        assert_ok(dem_simulation_resume(&resumed, run.model, &options, dem_simulation_checkpoint(run.simulation)));
        const dem_fracture later = ask_fracture(run.simulation), again = ask_fracture(resumed);
        assert_memory_equal(&later, &then, sizeof then);
        assert_memory_equal(&again, &then, sizeof then);
        if (!itself) assert_close(s.x[2 * inner + 1], block.x[2 * inner + 1] - 6e-3, 1e-12);
    }
}

/* What an observer sees of a break, and of the contacts that open from then on. */
typedef struct parting {
    dem_index n_breaks, n_releases;
    double broke; /* s */
    dem_event release;
} parting;

static dem_status note_break(void *context, const dem_simulation *s, const dem_break *what)
{
    parting *story = context;
    (void)s;
    story->broke = what->t;
    story->n_breaks++;
    return DEM_OK;
}

static dem_status note_release(void *context, const dem_simulation *s, const dem_event *event)
{
    parting *story = context;
    assert_close(event->t, ask_state(s).t, 0.0);
    if (event->kind == DEM_EVENT_RELEASE && story->n_breaks > 0) story->release = *event;
    story->n_releases += event->kind == DEM_EVENT_RELEASE && story->n_breaks > 0;
    return DEM_OK;
}

/* The triangle at the middle edge of a block's lower side, and a ridge under the middle of that edge. */
static dem_index put_ridge(const dem_lattice *l, double points[6])
{
    for (dem_index t = 0; t < l->n_triangles; t++) {
        int n_low = 0;
        double x = 0.0;
        for (int c = 0; c < 3; c++) n_low += l->x[2 * l->triangles[3 * t + c] + 1] < 1e-9;
        for (int c = 0; c < 3; c++) x += l->x[2 * l->triangles[3 * t + c]] / 3.0;
        for (int c = 0; c < 6; c++) points[c] = c % 2 ? (c == 3 ? 0.0 : -0.5) : x + 0.25 * (c - 2);
        if (n_low == 2 && fabs(x) < 2.6e-3) return t;
    }
    fail_msg("no triangle at the lower side");
    return -1;
}

/* A block is pressed on a ridge and stretched, until the triangle at the ridge breaks: the contact ends where its edge
 * does, at the end of the step, which is shorter than 1/omega_max, or is that of the break. What has closed and not
 * opened is what is listed. */
TEST(a_contact_goes_with_its_edge_by_a_release)
{
    for (int exact = 0; exact < 2; exact++) {
        CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
        double points[6], v[2 * MOST_NODES];
        const dem_index triangle = put_ridge(&block, points);
        const dem_obstacle ridge = SIZED(dem_obstacle, .n_points = 3, .points = points);
        dem_options options = free_fall(1e-8);
        options.gravity[1] = -500.0;
        options.contact = exact ? DEM_CONTACT_EXACT : DEM_CONTACT_LOCAL;
        for (dem_index c = 0; c < 2 * block.n_nodes; c++) v[c] = c % 2 ? 0.0 : 20.0 * block.x[c];
        support_start(&block, NULL, v);
        block.strength = malloc((size_t)block.n_triangles * sizeof *block.strength);
        assert_non_null(block.strength);
        for (dem_index t = 0; t < block.n_triangles; t++) block.strength[t] = t == triangle ? 1e4 : (double)INFINITY;
        parting story = {.n_breaks = 0};
        const dem_observer observer =
            SIZED(dem_observer, .context = &story, .event = note_release, .broken = note_break);
        CLEANUP(support_close) support_run run;
        support_open(&run, &block, &ridge, 1, &options);
        assert_ok(dem_simulation_observe(run.simulation, &observer));
        const double had = support_at(&run, 0.0).energy.ledger;
        assert_int_equal(ask_state(run.simulation).n_contacts, 1);
        const motion s = support_at(&run, 1e-4);
        assert_int_equal(story.n_breaks, 1);
        assert_int_equal(story.n_releases, 1);
        assert_true(story.release.t >= story.broke && (!exact || story.release.t == story.broke));
        assert_true(story.release.t < story.broke + 1.0 / dem_model_omega_max(run.model));
        assert_int_equal(story.release.state, DEM_CONTACT_FREE);
        for (int c = 0; c < 2; c++) assert_close(story.release.x[c], points[2 + c], 0.0);
        assert_close(story.release.weight, 0.5, 1e-2);
        assert_int_equal(ask_state(run.simulation).n_contacts, 0);
        const dem_counts counts = ask_counts(run.simulation);
        assert_int_equal(counts.closings, 1);
        assert_int_equal(counts.releases, 1);
        assert_close(s.energy.ledger, had, 1e-7 * had);
    }
}

/* The pieces of a block that is broken in two run into each other: faces push, nothing crosses, momentum stays. */
TEST(new_faces_push_each_other)
{
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
    double v[2 * MOST_NODES] = {0.0};
    dem_index low = 0;
    assert_true(block.n_nodes <= MOST_NODES);
    for (dem_index i = 0; i < block.n_nodes; i++) {
        v[2 * i + 1] = block.x[2 * i + 1] > middle ? -2.0 : 0.0;
        if (block.x[2 * i + 1] == 0.0) low = i;
    }
    support_start(&block, NULL, v);
    const numbers row = across(&block, middle);
    dem_options options = free_fall(1e-8);
    options.bodies = DEM_BODIES_ALL;
    CLEANUP(support_close) support_run run;
    support_open(&run, &block, NULL, 0, &options);
    break_triangles(run.simulation, &row);
    motion s = support_at(&run, 0.0);
    double start[3], end[3], most = 0.0;
    const double had = s.energy.ledger;
    moments(&block, &s, start);
    for (int k = 1; k <= 40; k++) {
        s = support_at(&run, 1.5e-4 * k);
        most = fmax(most, s.energy.contact);
    }
    moments(&block, &s, end);
    assert_true(most > 1e-2);
    assert_int_equal(ask_overlap(run.simulation).most, 0);
    assert_true(s.x[2 * low + 1] < -1e-4); /* the lower piece has been pushed down */
    for (int k = 0; k < 3; k++) assert_close(end[k], start[k], 1e-12);
    assert_close(s.energy.ledger, had, 1e-5 * had);
}

/* A row that breaks while the block is pressed: its energy is taken as of a block that does not touch itself, to the
 * rounding of sums over all springs. What fills the crack begins without any, and pushes as the crack closes more. When
 * the rows on both sides break, too, no such crack is left, and the run goes on from checkpoints without any. */
TEST(what_is_broken_under_pressure_pushes_from_there_on)
{
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
    double x[2 * MOST_NODES], taken[2];
    assert_true(block.n_nodes <= MOST_NODES);
    for (dem_index k = 0; k < 2 * block.n_nodes; k++) x[k] = block.x[k] * (k % 2 == 1 ? 0.99 : 1.0);
    support_start(&block, x, NULL);
    const numbers row = across(&block, middle);
    for (int bodies = 0; bodies < 2; bodies++) {
        dem_options options = free_fall(1e-8);
        options.bodies = bodies ? DEM_BODIES_ALL : DEM_BODIES_NONE;
        options.checkpoint_steps = 3;
        CLEANUP(support_close) support_run run;
        support_open(&run, &block, NULL, 0, &options);
        break_triangles(run.simulation, &row);
        motion s = support_at(&run, 0.0);
        const double had = s.energy.ledger;
        taken[bodies] = s.energy.fracture;
        assert_close(s.energy.contact, 0.0, 1e-20);
        s = support_at(&run, 1.5e-4); /* half the time of a wave to the ends */
        assert_true(bodies ? s.energy.contact > 1e-2 * taken[0] : s.energy.contact == 0.0);
        assert_close(s.energy.ledger, had, 1e-6 * had);
        for (int side = -1; side < 2; side += 2) {
            const numbers next = across(&block, middle + side * 0.0043);
            break_triangles(run.simulation, &next);
        }
        (void)support_at(&run, t_pressed);
    }
    assert_true(taken[0] > 0.01);
    assert_close(taken[1], taken[0], 1e-12 * taken[0]);
}

/* Two halves of a body with a slot between them, narrower than surfaces are thick: on either side 11 nodes, each across
 * from one that two edges have as their end. The lowest row of triangles breaks off the upper half. */
TEST(pairs_that_never_push_are_counted_anew)
{
    const double spacing = 0.005, gap = 0.1 * spacing;
    CLEANUP(dem_lattice_free) dem_lattice halves = support_rectangle(0.05, 0.052, spacing, &rubber);
    const double floor = support_top(&halves) + gap;
    CLEANUP(dem_lattice_free) dem_lattice upper = support_rectangle(0.05, 0.052, spacing, &rubber);
    dem_lattice_move(&upper, 0.0, (const double[2]){0.0, floor});
    assert_ok(dem_lattice_append(&halves, &upper));
    memset(halves.body, 0, (size_t)halves.n_nodes * sizeof *halves.body);
    const numbers row = across(&halves, floor + 0.5 * spacing);
    dem_options options = free_fall(1e-8);
    options.bodies = DEM_BODIES_ALL;
    CLEANUP(support_close) support_run run;
    support_open(&run, &halves, NULL, 0, &options);
    assert_int_equal(ask_surfaces(run.simulation).left_out, 2 * 11 * 2);
    break_triangles(run.simulation, &row);
    assert_int_equal(ask_surfaces(run.simulation).left_out, 0);
}

/* Without contact of bodies the pieces pass through each other, which is counted: by nodes that were inside before, and
 * not while these are where broken triangles were. */
TEST(pieces_that_overlap_are_counted)
{
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
    double v[2 * MOST_NODES] = {0.0};
    assert_true(block.n_nodes <= MOST_NODES);
    for (dem_index i = 0; i < block.n_nodes; i++) v[2 * i + 1] = block.x[2 * i + 1] > middle ? -2.0 : 0.0;
    const numbers row = across(&block, middle);
    const dem_options options = free_fall(1e-6);
    CLEANUP(support_close) support_run run;
    support_open(&run, &block, NULL, 0, &options);
    assert_ok(dem_simulation_set_motion(run.simulation, NULL, v));
    break_triangles(run.simulation, &row);
    (void)support_at(&run, 1.5e-3); /* 3 mm of 4.3 */
    assert_int_equal(ask_overlap(run.simulation).most, 0);
    (void)support_at(&run, 3e-3);
    assert_true(ask_overlap(run.simulation).most > 5);
}

/* A body on the floor goes on to the same bits, with the contacts that it has, when nothing breaks, or nothing that is
 * not broken already. */
TEST(to_break_nothing_changes_nothing)
{
    static const double ground[4] = {-1.0, 0.0, 1.0, 0.0};
    const dem_obstacle floor = SIZED(dem_obstacle, .n_points = 2, .points = ground);
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
    const numbers row = across(&block, middle);
    motion end[2];
    dem_index releases[2];
    for (int again = 0; again < 2; again++) {
        const dem_options options = dem_options_default();
        CLEANUP(support_close) support_run run;
        support_open(&run, &block, &floor, 1, &options);
        break_triangles(run.simulation, &row);
        (void)support_at(&run, t_break);
        const dem_index n = ask_state(run.simulation).n_contacts;
        assert_true(n > 0);
        if (again) {
            break_triangles(run.simulation, &row);
            assert_ok(dem_simulation_break(run.simulation, NULL, 0, NULL, 0));
        }
        assert_int_equal(ask_state(run.simulation).n_contacts, n);
        end[again] = support_at(&run, t_end);
        releases[again] = ask_counts(run.simulation).releases;
        assert_memory_equal(&end[again].energy, &end[0].energy, sizeof end->energy);
        assert_int_equal(releases[again], releases[0]);
    }
}

/* ---- what is refused ---- */

TEST(what_cannot_break_is_refused_and_nothing_changes)
{
    CLEANUP(dem_lattice_free) dem_lattice block = support_rectangle(0.05, 0.052, 0.005, &rubber);
    const dem_options options = free_fall(1e-6);
    const dem_index beyond[2] = {3, block.n_triangles}, negative[1] = {-1}, held[1] = {4}, none[1] = {block.n_springs};
    CLEANUP(support_close) support_run run;
    support_open(&run, &block, NULL, 0, &options);
    dem_simulation *s = run.simulation;
    assert_int_equal(dem_simulation_break(NULL, beyond, 1, NULL, 0), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_break(s, NULL, 1, NULL, 0), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_break(s, NULL, 0, held, -1), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_break(s, beyond, 2, NULL, 0), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_break(s, negative, 1, NULL, 0), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_break(s, NULL, 0, none, 1), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_simulation_break(s, NULL, 0, held, 1), DEM_ERROR_ARGUMENT);
    assert_message_parts("spring 4 between nodes");
    assert_message_parts("is held by triangles");
    assert_int_equal(dem_simulation_broken(NULL, NULL, NULL), DEM_ERROR_ARGUMENT);
    CLEANUP(free_memory) unsigned char *broken = calloc((size_t)block.n_triangles, 1);
    assert_non_null(broken);
    assert_ok(dem_simulation_broken(s, broken, NULL));
    for (dem_index k = 0; k < block.n_triangles; k++) assert_int_equal(broken[k], 0);
    assert_ok(dem_simulation_break(s, NULL, 0, NULL, 0));
}
