/* SPDX-License-Identifier: BSD-3-Clause */
/* break_list.c through the doors of a simulation: what observers are heard of breaks, against closed forms and against
 * what is broken in the end. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"

enum { MOST_BREAKS = 2048, MOST_TRIANGLES = 1024 };

/* What an observer has been heard, and of what else it heard meanwhile. */
typedef struct heard {
    dem_index n, n_events;
    dem_break list[MOST_BREAKS];
    double last; /* s, of the last event or break */
    unsigned char triangle[MOST_TRIANGLES];
} heard;

/* The state that is shown is that of the instant, in which the element is broken. */
static dem_status on_break(void *context, const dem_simulation *simulation, const dem_break *what)
{
    heard *t = context;
    unsigned char spring[4];
    dem_state seen = {.struct_size = sizeof seen};
    assert_ok(dem_simulation_state(simulation, &seen));
    assert_close(seen.t, what->t, 0.0);
    assert_int_equal(what->struct_size, sizeof *what);
    assert_true(what->t >= t->last && t->n < MOST_BREAKS);
    assert_ok(dem_simulation_broken(simulation, t->triangle, what->triangle < 0 ? spring : NULL));
    assert_true(what->triangle < 0 ? spring[what->spring] : t->triangle[what->triangle]);
    t->last = what->t;
    t->list[t->n++] = *what;
    return DEM_OK;
}

static dem_status on_event(void *context, const dem_simulation *simulation, const dem_event *event)
{
    heard *t = context;
    (void)simulation;
    assert_true(event->t >= t->last);
    t->last = event->t;
    t->n_events++;
    return DEM_OK;
}

static void listen(support_run *run, heard *t)
{
    const dem_observer observer = SIZED(dem_observer, .broken = on_break, .event = on_event, .context = t);
    *t = (heard){.last = -1.0};
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

static dem_options no_weight(double rtol, dem_contact_method contact)
{
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = rtol;
    options.contact = contact;
    return options;
}

static const dem_contact_method ways[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};

/* ---- a pair ---- */

/* Two masses of 1 kg, a spring of 8 N and 1 m that flies apart as (0.6/4) sin 4 t: test_fracture_source.c. It breaks
 * at a strain of 0.1, with 8 N 1 m 0.1^2/2 = 0.04 J. */
TEST(a_spring_is_reported_when_and_where_it_breaks)
{
    const double x[4] = {0.0, 0.0, 1.0, 0.0}, v[4] = {-0.3, 0.0, 0.3, 0.0}, masses[2] = {1.0, 1.0};
    const dem_index ends[2] = {0, 1};
    for (int k = 0; k < 2; k++) {
        static heard t;
        const dem_options options = no_weight(1e-12, ways[k]);
        CLEANUP(dem_lattice_free) dem_lattice pair = support_lattice(2, x, masses, 1, ends, 1.0, 8.0, NULL);
        CLEANUP(support_close) support_run run;
        support_start(&pair, NULL, v);
        pair.critical_stretch = malloc(sizeof *pair.critical_stretch);
        assert_non_null(pair.critical_stretch);
        pair.critical_stretch[0] = 0.1;
        support_open(&run, &pair, NULL, 0, &options);
        listen(&run, &t);
        (void)support_at(&run, 1.0);
        assert_int_equal(t.n, 1);
        /* What rtol 1e-12 leaves of positions, and of their energy. */
        assert_close(t.list[0].t, asin(0.1 * 4.0 / 0.6) / 4.0, 1e-10);
        assert_close(t.list[0].x[0], 0.5, 1e-13);
        assert_close(t.list[0].x[1], 0.0, 0.0);
        assert_close(t.list[0].energy, 0.04, 1e-11);
        assert_int_equal(t.list[0].triangle, -1);
        assert_int_equal(t.list[0].spring, 0);
        assert_int_equal(t.list[0].body, 0);
    }
}

/* ---- a block that is torn apart ---- */

static const double t_end = 1.5e-3;

/* It is stretched with `rate`, 1/s, above a floor that its lower end reaches, and its strengths differ by a half. */
static void open_block(support_run *run, dem_lattice *block, const dem_options *options, double rate)
{
    static const double floor[4] = {-0.06, -2.5e-3, 0.06, -2.5e-3};
    const dem_obstacle ground = {
        .struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor, .restitution = 0.5};
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 0.2,
                                 .density = 1050.0,
                                 .thickness = 1.0,
                                 .guard = 0.02};
    assert_ok(dem_lattice_rectangle(block, 0.04, 0.08, 0.005));
    assert_ok(dem_lattice_assemble(block, &rubber));
    assert_ok(dem_lattice_launch(block, (const double[2]){0.0, 0.0}));
    for (dem_index i = 0; i < block->n_nodes; i++) block->velocity[2 * i + 1] = rate * (block->x[2 * i + 1] - 0.04);
    block->strength = malloc((size_t)block->n_triangles * sizeof *block->strength);
    assert_non_null(block->strength);
    assert_true(block->n_triangles <= MOST_TRIANGLES);
    for (dem_index t = 0; t < block->n_triangles; t++)
        block->strength[t] = 8e5 * (1.0 + 0.5 * fmod((double)t * 0.6180339887498949, 1.0));
    support_open(run, block, &ground, 1, options);
}

static double largest_principal(const double stress[3])
{
    double value[2], direction[2];
    dem_stress_principal(stress, value, direction);
    return value[0];
}

/* Each triangle that is broken in the end has been reported once, in the order of time with contacts, and their
 * energies are all that fracture took, to rounding of some hundred. A break is where the stress is the strength, or
 * beyond it at once where another break has brought it there: the first one has it to the width of a root. */
static void assert_complete(const support_run *run, const dem_lattice *block, const heard *t)
{
    unsigned char flags[MOST_TRIANGLES];
    dem_energy energy = {.struct_size = sizeof energy};
    double taken = 0.0;
    assert_ok(dem_simulation_broken(run->simulation, flags, NULL));
    assert_ok(dem_simulation_energy(run->simulation, &energy));
    for (dem_index k = 0; k < t->n; k++) {
        const dem_break *b = &t->list[k];
        assert_int_equal(b->spring, -1);
        assert_int_equal(flags[b->triangle], 1);
        flags[b->triangle] = 0;
        taken += b->energy;
        assert_true(largest_principal(b->stress) > (1.0 - 1e-6) * block->strength[b->triangle]);
    }
    for (dem_index k = 0; k < block->n_triangles; k++) assert_int_equal(flags[k], 0);
    assert_close(taken, energy.fracture, 1e-13 * energy.fracture * (double)t->n);
    assert_close(largest_principal(t->list[0].stress), block->strength[t->list[0].triangle],
                 1e-6 * block->strength[t->list[0].triangle]);
}

/* The numbers of fragments by a way of its own: the lowest number spreads along the sides of whole triangles until
 * nothing changes. */
static void spread(const dem_lattice *l, const unsigned char *broken, dem_index *fragment)
{
    bool changed = true;
    for (dem_index i = 0; i < l->n_nodes; i++) fragment[i] = i;
    while (changed) {
        changed = false;
        for (dem_index k = 0; k < 3 * l->n_triangles; k++) {
            const dem_index a = l->triangles[k], b = l->triangles[k - k % 3 + (k + 1) % 3];
            if (broken[k / 3] || fragment[a] == fragment[b]) continue;
            fragment[a] = fragment[b] = fragment[a] < fragment[b] ? fragment[a] : fragment[b];
            changed = true;
        }
    }
}

/* Breaks the triangles one after the other: numbers that were not there before, the lowest of them first.
 * \return how many fragments there are in the end */
static dem_index assert_split(const dem_lattice *l, const heard *t)
{
    static dem_index before[MOST_TRIANGLES], after[MOST_TRIANGLES];
    static unsigned char broken[MOST_TRIANGLES];
    dem_index n = 0;
    memset(broken, 0, sizeof broken);
    spread(l, broken, before);
    for (dem_index k = 0; k < t->n; k++) {
        dem_index expected = -1;
        broken[t->list[k].triangle] = 1;
        spread(l, broken, after);
        for (dem_index i = l->n_nodes; i-- > 0;)
            if (after[i] == i && before[i] != i) expected = i;
        assert_int_equal(t->list[k].fragment_new, expected);
        memcpy(before, after, sizeof before);
    }
    for (dem_index i = 0; i < l->n_nodes; i++) n += before[i] == i;
    return n;
}

TEST(every_break_is_reported_once_in_the_order_of_time)
{
    for (int k = 0; k < 2; k++) {
        static heard t;
        const dem_options options = no_weight(1e-6, ways[k]);
        CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
        CLEANUP(support_close) support_run run;
        open_block(&run, &block, &options, 250.0);
        listen(&run, &t);
        (void)support_at(&run, t_end);
        assert_true(t.n > 20 && t.n_events > 10);
        assert_complete(&run, &block, &t);
    }
}

/* So fast that more than 100 would break in a step, which is taken again. */
TEST(what_a_rejected_step_broke_is_not_reported)
{
    static heard t;
    dem_counts counts = {.struct_size = sizeof counts};
    const dem_options options = no_weight(1e-6, DEM_CONTACT_LOCAL);
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    CLEANUP(support_close) support_run run;
    open_block(&run, &block, &options, 4000.0);
    listen(&run, &t);
    (void)support_at(&run, t_end);
    assert_ok(dem_simulation_counts(run.simulation, &counts));
    assert_true(t.n > 100);
    assert_true(counts.rejected > 10);
    assert_complete(&run, &block, &t);
}

/* The same list, to the bit, with advances that end inside steps. */
TEST(reports_do_not_depend_on_cuts)
{
    static heard whole, cut;
    const dem_options options = no_weight(1e-6, DEM_CONTACT_LOCAL);
    for (int n_parts = 1; n_parts <= 53; n_parts += 52) {
        CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
        CLEANUP(support_close) support_run run;
        open_block(&run, &block, &options, 250.0);
        listen(&run, n_parts == 1 ? &whole : &cut);
        for (int k = 1; k <= n_parts; k++) (void)support_at(&run, t_end * k / n_parts);
    }
    assert_int_equal(whole.n, cut.n);
    assert_memory_equal(whole.list, cut.list, (size_t)whole.n * sizeof *whole.list);
}

/* ---- the fragments that breaks split off ---- */

/* With 4000 1/s some hundred break in a step, many of them at one instant. */
TEST(a_break_is_reported_with_the_fragment_that_it_splits_off)
{
    const double rates[2] = {250.0, 4000.0};
    for (int k = 0; k < 4; k++) {
        static heard t;
        const dem_options options = no_weight(1e-6, ways[k / 2]);
        CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
        CLEANUP(support_close) support_run run;
        dem_fracture all = {.struct_size = sizeof all};
        open_block(&run, &block, &options, rates[k % 2]);
        listen(&run, &t);
        (void)support_at(&run, t_end);
        assert_ok(dem_simulation_fracture(run.simulation, &all));
        assert_true(all.fragments > 5);
        assert_int_equal(assert_split(&block, &t), all.fragments);
    }
}

/* ---- by the program ---- */

/* Of a chain of two springs the first would break by itself at a time in the same step after the one at which the
 * program breaks the second: until then nothing but the second is broken or reported. */
TEST(what_a_program_breaks_is_reported_at_the_start_of_the_next_advance)
{
    static heard t;
    const double x[8] = {0.0, 0.0, 1.0, 0.0, 0.0, 5.0, 1.0, 5.0}, v[8] = {-0.3, 0.0, 0.3, 0.0};
    const double masses[4] = {1.0, 1.0, 1.0, 1.0}, broken_at = asin(0.1 * 4.0 / 0.6) / 4.0;
    const dem_index ends[4] = {0, 1, 2, 3}, which[2] = {1, 1};
    const dem_options options = no_weight(1e-10, DEM_CONTACT_LOCAL);
    CLEANUP(dem_lattice_free) dem_lattice pairs = support_lattice(4, x, masses, 2, ends, 1.0, 8.0, NULL);
    CLEANUP(support_close) support_run run;
    unsigned char spring[4];
    support_start(&pairs, NULL, v);
    pairs.critical_stretch = malloc(2 * sizeof *pairs.critical_stretch);
    assert_non_null(pairs.critical_stretch);
    pairs.critical_stretch[0] = pairs.critical_stretch[1] = 0.1;
    support_open(&run, &pairs, NULL, 0, &options);
    listen(&run, &t);
    assert_ok(dem_simulation_advance(run.simulation, broken_at - 1e-9));
    assert_ok(dem_simulation_broken(run.simulation, NULL, spring)); /* the first to look at this time */
    assert_int_equal(spring[0], 0);
    assert_ok(dem_simulation_break(run.simulation, NULL, 0, which, 2));
    assert_ok(dem_simulation_broken(run.simulation, NULL, spring));
    assert_int_equal(spring[0], 0);
    assert_int_equal(spring[1], 1);
    assert_int_equal(t.n, 0);
    (void)support_at(&run, 1.0);
    assert_int_equal(t.n, 2);
    assert_int_equal(t.list[0].spring, 1);
    assert_close(t.list[0].t, broken_at - 1e-9, 0.0);
    assert_close(t.list[0].x[1], 5.0, 0.0);
    assert_close(t.list[0].energy, 0.0, 0.0);
    assert_int_equal(t.list[0].fragment_new, 3);
    assert_int_equal(t.list[1].spring, 0);
    assert_close(t.list[1].t, broken_at, 1e-9);
    assert_int_equal(t.list[1].fragment_new, 1);
}
