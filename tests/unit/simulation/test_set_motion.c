/* SPDX-License-Identifier: BSD-3-Clause */
/* set_motion.c: nodes put elsewhere between advances, and what is refused. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "harness/message.h"
#include "harness/motion.h"
#include "unit/scratch.h"

static const double g = 9.81, mass = 2.0;
static const double floor_points[4] = {-10.0, 0.0, 10.0, 0.0};

/* A point of 2 kg at 1 m over a floor, at rest; as exact as support_point() has it. */
static void open_point(support_run *run, double restitution)
{
    const double x[2] = {0.0, 1.0};
    support_point(run, mass, x, NULL, floor_points, 2, restitution);
}

static double ledger(const support_run *run)
{
    return ask_energy(run->simulation).ledger;
}

/* From any instant on it goes as from a start there, and what that takes is counted as work. */
TEST(a_node_goes_on_from_where_it_is_put)
{
    const double x[2] = {3.0, 0.5}, v[2] = {-1.0, 2.0}, lands = (2.0 + sqrt(4.0 + g)) / g;
    CLEANUP(support_close) support_run run;
    open_point(&run, 0.5);
    const double start = ledger(&run);
    const motion before = support_at(&run, 0.3);
    const double had = 0.5 * mass * before.v[1] * before.v[1] + mass * g * before.x[1];
    assert_ok(dem_simulation_set_motion(run.simulation, x, v));
    motion s;
    motion_see(run.simulation, &s);
    assert_memory_equal(s.x, x, sizeof x);
    assert_memory_equal(s.v, v, sizeof v);
    assert_close(s.t, 0.3, 0.0);
    assert_close(s.energy.boundary, 0.5 * mass * 5.0 + mass * g * 0.5 - had, 1e-13);
    s = support_at(&run, 0.3 + 0.2);
    assert_close(s.x[0], 3.0 - 0.2, 1e-12);
    assert_close(s.x[1], 0.5 + 0.4 - 0.5 * g * 0.04, 1e-12);
    s = support_at(&run, 0.3 + 1.2 * lands);
    assert_int_equal(run.n_impacts, 1);
    assert_close(run.impacts[0].t, 0.3 + lands, 1e-10);
    assert_close(ledger(&run), start, 1e-11);
}

/* Before the first advance as well. */
TEST(the_start_may_be_another)
{
    const double v[2] = {1.5, 0.0};
    CLEANUP(support_close) support_run run;
    open_point(&run, 0.5);
    const double start = ledger(&run);
    assert_ok(dem_simulation_set_motion(run.simulation, NULL, v));
    const motion s = support_at(&run, 0.2);
    assert_close(s.x[0], 0.3, 1e-13);
    assert_close(s.x[1], 1.0 - 0.5 * g * 0.04, 1e-12);
    assert_close(ledger(&run), start, 1e-12);
}

/* What lies on the floor is lifted, hangs in the air, is put back, and rests there again. */
TEST(contacts_are_found_anew)
{
    const double up[2] = {0.0, 0.5}, down[2] = {1.0, 0.0}, still[2] = {0.0, 0.0};
    CLEANUP(support_close) support_run run;
    open_point(&run, 0.0);
    motion s = support_at(&run, 1.0);
    assert_int_equal(s.n_contacts, 1);
    assert_ok(dem_simulation_set_motion(run.simulation, up, still));
    motion_see(run.simulation, &s);
    assert_int_equal(s.n_contacts, 0);
    s = support_at(&run, 1.1);
    assert_close(s.x[1], 0.5 - 0.5 * g * 0.01, 1e-12);
    assert_ok(dem_simulation_set_motion(run.simulation, down, still));
    s = support_at(&run, 1.1);
    assert_int_equal(s.n_contacts, 1);
    assert_close(s.contacts[0].force, mass * g, 1e-12);
    s = support_at(&run, 2.0);
    assert_close(s.x[1], 0.0, 0.0);
}

/* ---- refusals ---- */

static void refuse(dem_simulation *simulation, const double *x, const double *v, dem_status status, const char *message)
{
    assert_int_equal(dem_simulation_set_motion(simulation, x, v), status);
    assert_message_parts(message);
}

static dem_status set_from_within(void *context, const dem_simulation *simulation)
{
    assert_int_equal(dem_simulation_set_motion(*(dem_simulation **)context, NULL, NULL), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_simulation_set_motion: an advance is under way");
    (void)simulation;
    return DEM_OK;
}

/* Three masses in a row, springs between them: the first fixed, the second prescribed along x, the last free. */
static void open_row(support_run *run)
{
    static const double x[6] = {0.0, 1.0, 0.5, 1.0, 1.0, 1.0}, masses[3] = {1.0, 1.0, 1.0};
    static const unsigned char fixed[3] = {1, 0, 0};
    static const dem_index ends[4] = {0, 1, 1, 2}, driven[1] = {1};
    const dem_boundary drive =
        SIZED(dem_boundary, .components = DEM_COMPONENT_X, .n_nodes = 1, .nodes = driven, .value = {0.1, 0.0});
    const dem_obstacle ground = SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.5);
    dem_options options = support_options();
    CLEANUP(dem_lattice_free) dem_lattice row = support_lattice(3, x, masses, 2, ends, 0.5, 50.0, fixed);
    row.flags[1] = 0;
    options.gravity[1] = 0.0;
    options.n_boundaries = 1;
    options.boundaries = &drive;
    support_open(run, &row, &ground, 1, &options);
}

TEST(what_cannot_be_is_refused_and_changes_nothing)
{
    CLEANUP(support_close) support_run run, untouched;
    open_row(&run);
    open_row(&untouched);
    const dem_observer observer = SIZED(dem_observer, .step = set_from_within, .context = &run.simulation);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    refuse(NULL, NULL, NULL, DEM_ERROR_ARGUMENT, "dem_simulation_set_motion: simulation is NULL");
    const motion now = support_at(&run, 0.1);
    double x[6], v[6];
    memcpy(x, now.x, sizeof x);
    memcpy(v, now.v, sizeof v);
    x[4] = NAN;
    refuse(run.simulation, x, v, DEM_ERROR_ARGUMENT, "(nan, 1) * node 2 * not finite");
    x[4] = now.x[4];
    v[5] = INFINITY;
    assert_int_equal(dem_simulation_set_motion(run.simulation, x, v), DEM_ERROR_ARGUMENT);
    assert_non_null(strstr(dem_status_message(), "the velocity ("));
    v[5] = 0.0;
    x[0] = 0.125;
    refuse(run.simulation, x, v, DEM_ERROR_ARGUMENT, "place (0.125, 1) * node 0 * fixed * prescribed * (0, 1)");
    x[0] = 0.0;
    v[0] = 1.0;
    refuse(run.simulation, x, v, DEM_ERROR_ARGUMENT, "velocity (1, 0) * node 0 * fixed * prescribed * (0, 0)");
    v[0] = 0.0;
    v[2] = 0.5;
    assert_int_equal(dem_simulation_set_motion(run.simulation, x, v), DEM_ERROR_ARGUMENT);
    assert_non_null(strstr(dem_status_message(), "of node 1, which is fixed or prescribed, is not ("));
    v[2] = now.v[2];
    x[5] = -0.01;
    assert_int_equal(dem_simulation_set_motion(run.simulation, x, v), DEM_ERROR_MODEL);
    assert_non_null(
        strstr(dem_status_message(), "starts 0.01 m inside obstacle 0, deeper than the penetration tolerance"));
    const motion a = support_at(&run, 0.5), b = support_at(&untouched, 0.5);
    assert_memory_equal(a.x, b.x, sizeof x);
    assert_memory_equal(a.v, b.v, sizeof v);
    assert_memory_equal(&a.energy, &b.energy, sizeof a.energy);
    memcpy(x, a.x, sizeof x);
    x[3] = 1.25; /* not prescribed */
    assert_ok(dem_simulation_set_motion(run.simulation, x, a.v));
}

/* ---- checkpoints ---- */

static dem_simulation *resumed(const support_run *run, const dem_checkpoint *checkpoint)
{
    const dem_options options = ask_options(run->simulation);
    dem_simulation *simulation;
    assert_ok(dem_simulation_resume(&simulation, run->model, &options, checkpoint));
    return simulation;
}

static void same(const dem_simulation *a, const dem_simulation *b)
{
    const size_t size = 2 * (size_t)ask_sizes(dem_simulation_model(a)).n_nodes * sizeof(double);
    motion one, other;
    motion_see(a, &one);
    motion_see(b, &other);
    assert_close(one.t, other.t, 0.0);
    assert_memory_equal(one.x, other.x, size);
    assert_memory_equal(one.v, other.v, size);
    assert_memory_equal(&one.energy, &other.energy, sizeof one.energy);
}

/* A checkpoint from before leads on to what was; the one that the next advance takes, to what is now. */
TEST(a_checkpoint_is_of_one_motion)
{
    const dem_obstacle ground =
        SIZED(dem_obstacle, .n_points = 2, .points = floor_points, .restitution = 0.5, .friction = 0.2);
    const double lift[2] = {0.0, 0.027};
    const char *path = scratch_file("a.checkpoint");
    dem_options options = support_options();
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    CLEANUP(free_checkpoint) dem_checkpoint *before, *after;
    CLEANUP(support_close) support_run run;
    motion s;
    (void)scratch_file("a.checkpoint.prev");
    support_block(&block);
    for (dem_index i = 0; i < block.n_nodes; i++) block.position[2 * i + 1] += lift[1] + 1e-3;
    options.gravity[1] = -200.0;
    options.checkpoint_steps = 32;
    support_open(&run, &block, &ground, 1, &options);
    assert_ok(dem_simulation_advance(run.simulation, 4e-3));
    dem_simulation *old = resumed(&run, dem_simulation_checkpoint(run.simulation));
    assert_ok(dem_simulation_advance(old, 6e-3)); /* what was to come */
    assert_ok(dem_checkpoint_write(dem_simulation_checkpoint(run.simulation), path));
    assert_ok(dem_checkpoint_read(&before, path));
    motion_see(run.simulation, &s);
    CLEANUP(free_memory) double *v = malloc(2 * (size_t)block.n_nodes * sizeof *v);
    assert_non_null(v);
    for (dem_index k = 0; k < 2 * block.n_nodes; k++) v[k] = s.v[k] + (k % 2 == 0 ? 0.5 : 0.3);
    assert_ok(dem_simulation_set_motion(run.simulation, NULL, v));
    assert_null(dem_simulation_checkpoint(run.simulation));
    assert_ok(dem_simulation_advance(run.simulation, 4e-3));
    assert_non_null(dem_simulation_checkpoint(run.simulation));
    assert_ok(dem_checkpoint_write(dem_simulation_checkpoint(run.simulation), path));
    assert_ok(dem_checkpoint_read(&after, path));
    assert_ok(dem_simulation_advance(run.simulation, 6e-3));
    assert_true(run.n_impacts > 10);
    dem_simulation *again = resumed(&run, before), *on = resumed(&run, after);
    assert_ok(dem_simulation_advance(again, 6e-3));
    assert_ok(dem_simulation_advance(on, 6e-3));
    same(again, old);
    same(on, run.simulation);
    dem_simulation_destroy(old);
    dem_simulation_destroy(again);
    dem_simulation_destroy(on);
}

/* The state of one simulation put into another, at another time: they go the same way, to the tolerance. */
TEST(a_state_is_taken_over)
{
    dem_options options = support_options();
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    CLEANUP(support_close) support_run from, to;
    support_block(&block);
    options.gravity[1] = 0.0;
    options.rtol = 1e-9;
    options.v_scale = 1.0;
    support_open(&from, &block, NULL, 0, &options);
    support_open(&to, &block, NULL, 0, &options);
    assert_ok(dem_simulation_advance(to.simulation, 3.3e-4));
    const double start = ledger(&to);
    motion s = support_at(&from, 1e-3);
    assert_ok(dem_simulation_set_motion(to.simulation, s.x, s.v));
    const motion a = support_at(&from, 2e-3), b = support_at(&to, 1.33e-3);
    for (dem_index k = 0; k < 2 * block.n_nodes; k++) {
        assert_close(b.x[k], a.x[k], 1e-9);
        assert_close(b.v[k], a.v[k], 1e-5);
    }
    assert_close(ledger(&to), start, 1e-7 * a.energy.motion);
}

TEST_GROUP(scratch_make, scratch_remove);
