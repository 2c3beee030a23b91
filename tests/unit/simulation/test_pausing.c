/* SPDX-License-Identifier: BSD-3-Clause */
/* pausing.c: ramps stand still from a break until the bodies are at rest. Chains of two springs, side by side, between
 * fixed nodes and nodes that are pulled at a constant speed; in each chain one spring breaks, at its own stretch. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "harness/message.h"

enum { CHAINS = 3, NODES = 3 * CHAINS, SPRINGS = 2 * CHAINS };

static const double speed = 1e-3, at_rest = 1e-3; /* m/s; the residual at which a pause ends */

/* What was seen at the ends of steps. */
typedef struct journal {
    dem_index n_broken, n_pauses;
    double load[CHAINS], start[CHAINS], length[CHAINS]; /* s, of the ramps at the breaks; of each pause */
    double t, ramp, v;                                  /* of the last step; v: of the pulled nodes */
    double ledger, worst;                               /* J */
} journal;

static double pulled(const dem_simulation *s)
{
    return ask_state(s).x[2 * 2] - 2.0;
}

static dem_index count_broken(const dem_simulation *s)
{
    unsigned char broken[SPRINGS];
    dem_index n = 0;
    assert_ok(dem_simulation_broken(s, NULL, broken));
    for (dem_index k = 0; k < SPRINGS; k++) n += broken[k];
    return n;
}

/* The pulled nodes move at `speed` or stand, exactly, and the time of the ramps goes on or stands with them. */
static dem_status note(void *context, const dem_simulation *s)
{
    journal *j = context;
    const double ramp = dem_simulation_ramp_time(s);
    const dem_state now = ask_state(s);
    const double v = now.v[2 * 2];
    j->worst = fmax(j->worst, fabs(ask_energy(s).ledger - j->ledger));
    assert_true(v == 0.0 || v == speed);
    assert_close(ramp - j->ramp, j->v == 0.0 ? 0.0 : now.t - j->t, 1e-13);
    assert_close(pulled(s), speed * ramp, 1e-12);
    if (count_broken(s) > j->n_broken) {
        j->load[j->n_pauses] = ramp;
        j->start[j->n_pauses++] = now.t;
        j->n_broken = count_broken(s);
    }
    if (j->v == 0.0 && v > 0.0) j->length[j->n_pauses - 1] = now.t - j->start[j->n_pauses - 1];
    j->t = now.t;
    j->ramp = ramp;
    j->v = v;
    return DEM_OK;
}

static void fill_lattice(dem_lattice *out)
{
    double x[2 * NODES], masses[NODES];
    dem_index ends[2 * SPRINGS];
    unsigned char fixed[NODES];
    for (dem_index i = 0; i < NODES; i++) {
        x[2 * i] = (double)(i % 3);
        x[2 * i + 1] = (double)(i / 3);
        masses[i] = 1.0;
        fixed[i] = i % 3 == 0;
    }
    for (dem_index k = 0; k < 2 * SPRINGS; k++) ends[k] = k / 4 * 3 + k % 4 / 2 + k % 2;
    *out = support_lattice(NODES, x, masses, SPRINGS, ends, 1.0, 1.0, fixed);
    out->critical_stretch = malloc(SPRINGS * sizeof *out->critical_stretch);
    assert_non_null(out->critical_stretch);
    for (dem_index k = 0; k < SPRINGS; k++)
        out->critical_stretch[k] = k % 2 == 0 ? 0.010 + 1e-3 * (double)(k / 2) : (double)INFINITY;
}

static dem_options pulling(double pause, dem_contact_method way)
{
    static const dem_index nodes[CHAINS] = {2, 5, 8};
    static dem_boundary pull;
    dem_options options = dem_options_default();
    pull = (dem_boundary){.struct_size = sizeof pull,
                          .kind = DEM_BOUNDARY_VELOCITY,
                          .components = DEM_COMPONENT_X | DEM_COMPONENT_Y,
                          .n_nodes = CHAINS,
                          .nodes = nodes,
                          .value = {speed, 0.0}};
    options.gravity[1] = 0.0;
    options.rtol = 1e-11;
    options.contact = way;
    options.mass_damping = 2.0; /* critical for a mass on one spring */
    options.pause = pause;
    options.n_boundaries = 1;
    options.boundaries = &pull;
    options.checkpoint_steps = 40;
    return options;
}

static void open_chains(support_run *run, journal *j, const dem_options *options)
{
    CLEANUP(dem_lattice_free) dem_lattice chains = dem_lattice_empty();
    fill_lattice(&chains);
    *j = (journal){.v = speed};
    support_open(run, &chains, NULL, 0, options);
    j->ledger = ask_energy(run->simulation).ledger;
    const dem_observer observer = {.struct_size = sizeof observer, .step = note, .context = j};
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

/* The pulled nodes move by `speed` times the time of the ramps, which note() asserts at every step, and the ledger
 * closes over the jumps of their velocity. Springs break one by one at a load near the static one, twice the stretch:
 * the middle node lags by v/2 of its drag, and swings by less from the start. A pause lasts until the middle node, on
 * one spring, has come to rest: (1 + t) exp(-t) is 1e-3 at 9.2 s, and a look comes every 16 steps, of 0.35 s. When all
 * have broken there is no force left that anything could be small against: the last pause has no end. */
TEST(ramps_stand_still_after_each_break)
{
    const dem_contact_method ways[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};
    for (int way = 0; way < 2; way++) {
        const dem_options options = pulling(at_rest, ways[way]);
        CLEANUP(support_close) support_run run;
        journal j;
        open_chains(&run, &j, &options);
        assert_ok(dem_simulation_advance(run.simulation, 160.0));
        assert_int_equal(j.n_pauses, CHAINS);
        assert_int_equal(j.n_broken, CHAINS);
        assert_close(j.worst, 0.0, 1e-9 * 1e-4); /* of about E e^2 = 1e-4 J */
        for (int k = 0; k < CHAINS; k++) {
            assert_close(speed * j.load[k], 2.0 * (0.010 + 1e-3 * k), 2.0 * speed);
            if (k < CHAINS - 1) assert_true(j.length[k] > 9.0 && j.length[k] < 16.0);
        }
    }
}

/* Without the option, loads are as far apart in time as in stretch. */
TEST(without_the_option_ramps_go_on)
{
    const dem_options options = pulling(0.0, DEM_CONTACT_LOCAL);
    CLEANUP(support_close) support_run run;
    journal j;
    open_chains(&run, &j, &options);
    assert_ok(dem_simulation_advance(run.simulation, 30.0));
    assert_int_equal(j.n_broken, CHAINS);
    assert_close(dem_simulation_ramp_time(run.simulation), 30.0, 0.0);
}

TEST(what_the_program_breaks_begins_a_pause)
{
    const dem_index first = 0;
    const dem_options options = pulling(at_rest, DEM_CONTACT_LOCAL);
    CLEANUP(support_close) support_run run;
    journal j;
    open_chains(&run, &j, &options);
    assert_ok(dem_simulation_advance(run.simulation, 5.0));
    assert_ok(dem_simulation_break(run.simulation, NULL, 0, &first, 1));
    assert_ok(dem_simulation_advance(run.simulation, 8.0));
    assert_close(dem_simulation_ramp_time(run.simulation), 5.0, 0.0);
}

/* A run that is stopped in a pause goes on to the same bits. */
TEST(a_pause_is_part_of_a_checkpoint)
{
    const dem_options options = pulling(at_rest, DEM_CONTACT_LOCAL), without = pulling(0.0, DEM_CONTACT_LOCAL);
    CLEANUP(support_close) support_run run;
    journal j;
    dem_simulation *again = NULL;
    open_chains(&run, &j, &options);
    assert_ok(dem_simulation_advance(run.simulation, 35.0));
    assert_true(dem_simulation_ramp_time(run.simulation) < 34.0);
    assert_ok(dem_simulation_resume(&again, run.model, &options, dem_simulation_checkpoint(run.simulation)));
    assert_true(dem_simulation_ramp_time(again) < ask_state(again).t); /* in the pause or behind it */
    assert_ok(dem_simulation_advance(again, 160.0));
    assert_ok(dem_simulation_advance(run.simulation, 160.0));
    assert_close(dem_simulation_ramp_time(again), dem_simulation_ramp_time(run.simulation), 0.0);
    assert_memory_equal(ask_state(again).x, ask_state(run.simulation).x, 2 * NODES * sizeof(double));
    assert_memory_equal(ask_state(again).v, ask_state(run.simulation).v, 2 * NODES * sizeof(double));
    dem_simulation_destroy(again);
    again = NULL;
    assert_int_equal(dem_simulation_resume(&again, run.model, &without, dem_simulation_checkpoint(run.simulation)),
                     DEM_ERROR_IO);
    assert_message_parts("the option pause");
}
