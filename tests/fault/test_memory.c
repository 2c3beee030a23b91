/* SPDX-License-Identifier: BSD-3-Clause */
/* Allocations of the library's own code in standard runs fail in turn, once and from then on: the status says so,
 * nothing crashes, nothing leaks (the sanitizers' run sees that), and what was built or published before is still good.
 * The linker wraps malloc, calloc and realloc of the library's objects; HDF5 and SUNDIALS keep theirs.
 * `test_memory [SHARE]`: the share of them that is tried, chosen by a seed; default 0.1. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <dem/trajectory.h>

#include "../unit/close.h"

#include "allocations.h"
#include "harness/motion.h"
#include "base/random.h"
#include "output/slab_file.h"

static bool left_half(void *context, const double *x)
{
    (void)context;
    return x[0] < 0.021;
}

static dem_status build(dem_lattice *lattice)
{
    const dem_material rubber = {.struct_size = sizeof(dem_material),
                                 .youngs_modulus = 1e7,
                                 .poissons_ratio = 0.4,
                                 .density = 1050.0,
                                 .thickness = 1.0,
                                 .guard = 0.02,
                                 .damping_time = 1e-6};
    const double down[2] = {0.0, -5.0}, lift[2] = {0.0, 1e-4};
    dem_lattice other = dem_lattice_empty();
    dem_index parts;
    dem_status status = dem_lattice_rectangle(lattice, 0.05, 0.03, 0.01);
    if (status == DEM_OK) status = dem_lattice_cut(lattice, left_half, NULL);
    dem_index pieces, rims[32];
    if (status == DEM_OK) status = dem_lattice_pieces(lattice, &pieces, NULL);
    if (status == DEM_OK && lattice->n_nodes <= 32) status = dem_lattice_rims(lattice, rims);
    if (status == DEM_OK) status = dem_lattice_assemble(lattice, &rubber);
    if (status == DEM_OK) status = dem_lattice_launch(lattice, down);
    if (status == DEM_OK) status = dem_lattice_parts(lattice, &parts, NULL);
    dem_lattice_move(lattice, 0.01, lift);
    if (status != DEM_OK) return status;
    other = dem_lattice_empty();
    status = dem_lattice_disc(&other, 0.02, 0.01);
    if (status == DEM_OK) status = dem_lattice_assemble(&other, &rubber);
    dem_lattice_move(&other, 0.0, (const double[2]){0.1, 0.021});
    if (status == DEM_OK) status = dem_lattice_append(lattice, &other);
    dem_lattice_free(&other);
    return status;
}

/* Reached after 0.1 ms. */
static const double ground[6] = {-0.3, -2e-4, 0.0, -6e-4, 0.3, -2e-4};

static dem_status build_squares(void)
{
    const dem_material raw = {.struct_size = sizeof(dem_material),
                              .bond_stiffness = 1e3,
                              .density = 1050.0,
                              .thickness = 1.0,
                              .damping_time = 1e-6};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    dem_status status = dem_lattice_squares(&lattice, 0.02, 0.02, 0.01);
    if (status == DEM_OK) status = dem_lattice_jitter(&lattice, 1e-3, 1);
    if (status == DEM_OK) status = dem_lattice_assemble_squares(&lattice, &raw, 0.5);
    return status;
}

static dem_status build_slab(void)
{
    const dem_outline disc = {.struct_size = sizeof disc, .kind = DEM_OUTLINE_DISC, .radius = 0.03},
                      hole = {.struct_size = sizeof hole, .kind = DEM_OUTLINE_DISC, .radius = 0.005};
    const dem_shape shape = {
        .struct_size = sizeof shape, .outline = &disc, .spacing = 0.01, .n_voids = 1, .voids = &hole};
    CLEANUP(dem_slab_free) dem_slab slab = dem_slab_empty();
    dem_status status = dem_slab_shape(&slab, &shape, 1, 3);
    assert_true(status == DEM_OK || (slab.lattice.x == NULL && slab.rim == NULL));
    if (status == DEM_OK) status = dem_slab_jitter(&slab, 1e-3, 1);
    return status;
}

static dem_status read_mesh(void)
{
    static const char text[] = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n"
                               "0 1 0\n$EndNodes\n$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n";
    const dem_mesh mesh = {.struct_size = sizeof(dem_mesh), .path = "memory.msh", .scale = 1.0, .numbered = true};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    FILE *file = fopen(mesh.path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
    const dem_status status = dem_mesh_lattice(&lattice, &mesh);
    assert_int_equal(unlink(mesh.path), 0);
    return status;
}

static dem_status measure(const dem_model *model)
{
    dem_constants constants = {.struct_size = sizeof constants};
    double omega;
    const dem_status status = dem_model_constants(model, 1, &constants);
    return status == DEM_OK ? dem_model_omega(model, &omega) : status;
}

static dem_status write_and_run(dem_simulation *simulation)
{
    dem_trajectory *trajectory = NULL;
    dem_trajectory_options options = dem_trajectory_options_default();
    const dem_probe probes[3] = {{"gauge", DEM_PROBE_GAUGE, {0, 1}, 2},
                                 {"node", DEM_PROBE_NODE, {3, 0}, 1},
                                 {"spring", DEM_PROBE_SPRING, {2, 0}, 3}};
    dem_peaks *peaks = NULL;
    options.frame_interval = 2e-4;
    options.events = 1;
    options.n_probes = 3;
    options.probes = probes;
    dem_status status = dem_peaks_create(&peaks, dem_simulation_model(simulation), 3);
    options.peaks = peaks;
    if (status == DEM_OK) status = dem_trajectory_create(&trajectory, "fault.vtkhdf", simulation, &options);
    if (status != DEM_OK) {
        dem_peaks_destroy(peaks);
        return status;
    }
    const dem_observer observer = ask_trajectory_observer(trajectory);
    status = dem_trajectory_note(trajectory, "title", "memory runs out");
    if (status == DEM_OK) status = dem_simulation_observe(simulation, &observer);
    if (status == DEM_OK) status = dem_simulation_advance(simulation, 6e-4);
    if (status == DEM_OK) status = dem_trajectory_finish(trajectory);
    dem_trajectory_destroy(trajectory);
    dem_peaks_destroy(peaks);
    return status;
}

/* Of the file that has been written. */
static dem_status read_slab(void)
{
    CLEANUP(dem_slab_free) dem_slab slab = dem_slab_empty();
    CLEANUP(dem_slab_free) dem_slab range = dem_slab_empty();
    CLEANUP(free_memory) dem_index *node_ranges = NULL;
    dem_status status = dem_slab_read(&slab, "fault.vtkhdf", 1, 3);
    assert_true(status == DEM_OK || (slab.lattice.x == NULL && slab.rim == NULL));
    if (status == DEM_OK) status = dem_private_slab_of_file(&range, "fault.vtkhdf", &node_ranges, 2, 9);
    assert_true(status == DEM_OK || (range.lattice.x == NULL && range.rim_boundary == NULL));
    return status;
}

static dem_status run(void)
{
    const dem_obstacle obstacle = {
        .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = ground, .restitution = 0.5};
    const dem_index nodes[2] = {8, 9};
    const double share[2] = {0.3, 0.7};
    const dem_boundary push = {.struct_size = sizeof(dem_boundary),
                               .kind = DEM_BOUNDARY_FORCE,
                               .n_nodes = 2,
                               .nodes = nodes,
                               .share = share,
                               .value = {1.0, -2.0},
                               .ramp = 1e-4};
    dem_options options = dem_options_default();
    options.n_boundaries = 1;
    options.boundaries = &push;
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    CLEANUP(free_model) dem_model *model = NULL;
    CLEANUP(free_simulation) dem_simulation *simulation = NULL;
    lattice = dem_lattice_empty();
    dem_status status = build_squares();
    if (status == DEM_OK) status = build_slab();
    if (status == DEM_OK) status = read_mesh();
    if (status == DEM_OK) status = build(&lattice);
    if (status == DEM_OK) status = dem_model_create(&model, &lattice, &obstacle, 1);
    if (status == DEM_OK) status = measure(model);
    if (status == DEM_OK) status = dem_simulation_create(&simulation, model, &options);
    if (status == DEM_OK) status = write_and_run(simulation);
    if (status == DEM_OK) status = read_slab();
    return status;
}

/* ---- a run with friction that keeps checkpoints and segments, and goes on from one of them ---- */

static const char *const checkpoints[] = {"fault.checkpoint", "fault.checkpoint.prev"};
static bool kept; /* a checkpoint has been written */

static dem_status keep_checkpoint(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    if (ask_counts(simulation).steps == 0) return DEM_OK;
    dem_status status = dem_trajectory_segment(context, checkpoint);
    if (status == DEM_OK) status = dem_checkpoint_write(checkpoint, checkpoints[0]);
    if (status == DEM_OK) kept = true;
    return status;
}

static dem_status follow(dem_simulation *simulation, dem_peaks *peaks, const dem_checkpoint *checkpoint,
                         bool to_the_end)
{
    dem_trajectory *trajectory = NULL;
    dem_trajectory_options options = dem_trajectory_options_default();
    options.frame_interval = 1e-4;
    options.fields = DEM_FIELD_VELOCITY;
    options.events = 1;
    options.peaks = peaks;
    dem_status status = checkpoint == NULL
                            ? dem_trajectory_create(&trajectory, "fault.vtkhdf", simulation, &options)
                            : dem_trajectory_resume(&trajectory, "fault.vtkhdf", simulation, &options, checkpoint);
    if (status != DEM_OK) return status;
    const dem_observer observers[3] = {
        ask_peaks_observer(peaks),
        ask_trajectory_observer(trajectory),
        {.struct_size = sizeof(dem_observer), .checkpoint = keep_checkpoint, .context = trajectory}};
    for (int k = 0; k < 3 && status == DEM_OK; k++) status = dem_simulation_observe(simulation, &observers[k]);
    if (status == DEM_OK) status = dem_simulation_advance(simulation, to_the_end ? 3e-4 : 2e-4);
    if (status == DEM_OK && to_the_end) status = dem_trajectory_finish(trajectory);
    dem_trajectory_destroy(trajectory);
    return status;
}

static dem_status lean(void *context, const dem_force_query *query, double *force)
{
    (void)context;
    for (dem_index k = 0; k < query->n; k++) force[2 * k] = 1e-3;
    return DEM_OK;
}

/* From the beginning but not to the end, or to the end from a checkpoint. */
static dem_status run_from(const dem_checkpoint *checkpoint, const dem_model *model)
{
    dem_options options = dem_options_default();
    CLEANUP(free_simulation) dem_simulation *simulation = NULL;
    CLEANUP(free_peaks) dem_peaks *peaks = NULL;
    options.contact = DEM_CONTACT_EXACT;
    options.checkpoint_steps = 12;
    options.force = lean;
    dem_status status = checkpoint == NULL ? dem_simulation_create(&simulation, model, &options)
                                           : dem_simulation_resume(&simulation, model, &options, checkpoint);
    if (status == DEM_OK)
        status =
            checkpoint == NULL ? dem_peaks_create(&peaks, model, 2) : dem_peaks_resume(&peaks, model, 2, checkpoint);
    if (status == DEM_OK) status = follow(simulation, peaks, checkpoint, checkpoint != NULL);
    return status;
}

static dem_status build_model(dem_model **model)
{
    const dem_obstacle obstacle = {
        .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = ground, .restitution = 0.5, .friction = 0.3};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    dem_status status = build(&lattice);
    if (status == DEM_OK) status = dem_model_create(model, &lattice, &obstacle, 1);
    return status;
}

static dem_status run_with_checkpoints(void)
{
    CLEANUP(free_model) dem_model *model = NULL;
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = NULL;
    kept = false;
    dem_status status = build_model(&model);
    if (status == DEM_OK) status = run_from(NULL, model);
    if (status == DEM_OK) status = dem_checkpoint_read(&checkpoint, checkpoints[0]);
    if (status == DEM_OK) status = run_from(checkpoint, model);
    return status;
}

/* A checkpoint that was on disk still is, in one of its two files, and the run comes to its end from there. */
static dem_status go_on(void)
{
    dem_model *model = NULL;
    dem_checkpoint *checkpoint = NULL;
    if (!kept) return DEM_OK;
    for (int k = 0; k < 2 && checkpoint == NULL; k++) (void)dem_checkpoint_read(&checkpoint, checkpoints[k]);
    dem_status status = checkpoint == NULL ? DEM_ERROR_IO : build_model(&model);
    if (status == DEM_OK) status = run_from(checkpoint, model);
    dem_checkpoint_destroy(checkpoint);
    dem_model_destroy(model);
    return status;
}

/* ---- failures ---- */

typedef dem_status standard_run(void);

static double share = 0.1;
static const double segment_share = 0.1; /* of that: a trial takes a tenth of a second */

static int remove_outputs(void **unused)
{
    char segment[32];
    static const char *const names[] = {"vtkhdf",      "part.vtkhdf", "obstacle.vtkhdf",
                                        "body.vtkhdf", "checkpoint",  "checkpoint.prev"};
    (void)unused;
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        (void)snprintf(segment, sizeof segment, "fault.%s", names[k]);
        (void)remove(segment);
    }
    for (int k = 1; k < 100; k++) {
        (void)snprintf(segment, sizeof segment, "fault.%05d.vtkhdf", k);
        (void)remove(segment);
    }
    return 0;
}

static dem_status run_afresh(standard_run *run_it, long failing_one)
{
    (void)remove_outputs(NULL);
    allocations = 0;
    failing = failing_one;
    const dem_status status = run_it();
    failing = 0;
    return status;
}

/* Stresses of all nodes are measured node by node where there is no room for those of springs, in three arrays, and
 * ARKODE's operations are not deferred where there is none to record them: a run does without four, and again after it
 * was resumed; one that is not resumed makes a slab, which does without two. */
static void allocations_may_fail(standard_run *run_it, double of_share, int stays_so)
{
    enum { DOES_WITHOUT = 8 };
    long harmless = 0;
    const double tried = share < 1.0 ? of_share * share : 1.0;
    uint64_t seed = 1;
    assert_int_equal(run_afresh(run_it, 0), DEM_OK);
    const long all = allocations;
    assert_true(all > 60);
    from_then_on = stays_so;
    for (long k = 1; k <= all; k++) {
        if (fabs(random_next(&seed)) > tried) continue;
        const dem_status status = run_afresh(run_it, k);
        harmless += status == DEM_OK;
        if (status != DEM_ERROR_MEMORY && (status != DEM_OK || harmless > DOES_WITHOUT))
            fail_msg("allocation %ld of %ld: status %d, %s", k, all, status, dem_status_message());
        if (go_on() != DEM_OK) fail_msg("allocation %ld of %ld, then: %s", k, all, dem_status_message());
    }
    assert_int_equal(run_afresh(run_it, 0), DEM_OK);
    print_message("# %g of %ld allocations\n", tried, all);
}

TEST_WITH(one_failed_allocation_ends_a_run_with_its_status, NULL, remove_outputs)
{
    allocations_may_fail(run, 1.0, 0);
}

TEST_WITH(memory_that_stays_away_ends_a_run_with_its_status, NULL, remove_outputs)
{
    allocations_may_fail(run, 1.0, 1);
}

TEST_WITH(one_failed_allocation_loses_no_checkpoint, NULL, remove_outputs)
{
    allocations_may_fail(run_with_checkpoints, segment_share, 0);
}

TEST_WITH(memory_that_stays_away_loses_no_checkpoint, NULL, remove_outputs)
{
    allocations_may_fail(run_with_checkpoints, segment_share, 1);
}

/* What is advanced, with or without obstacles. */
typedef struct advanced_run {
    dem_status (*build)(dem_lattice *lattice);
    dem_index n_obstacles;
    dem_options options;
    double t_end;      /* s */
    bool does_without; /* some allocations may fail without an end: those of layouts that are faster */
} advanced_run;

/* In `now` the state at the end, to be freed; an allocation may fail on the way, and the run goes on. */
static dem_status advance(const advanced_run *run, double **now, dem_index *n, long failing_one)
{
    const dem_obstacle obstacle = {
        .struct_size = sizeof(dem_obstacle), .n_points = 3, .points = ground, .restitution = 0.5, .friction = 0.3};
    dem_lattice lattice = dem_lattice_empty();
    dem_model *model;
    dem_simulation *simulation;
    motion state;
    assert_int_equal(run->build(&lattice), DEM_OK);
    assert_int_equal(dem_model_create(&model, &lattice, &obstacle, run->n_obstacles), DEM_OK);
    assert_int_equal(dem_simulation_create(&simulation, model, &run->options), DEM_OK);
    allocations = 0;
    failing = failing_one;
    const dem_status status = dem_simulation_advance(simulation, run->t_end);
    const long needed = allocations;
    failing = 0;
    assert_int_equal(dem_simulation_advance(simulation, run->t_end), DEM_OK);
    motion_see(simulation, &state);
    *n = 2 * lattice.n_nodes;
    *now = malloc(2 * (size_t)*n * sizeof **now);
    assert_non_null(*now);
    memcpy(*now, state.x, (size_t)*n * sizeof **now);
    memcpy(*now + *n, state.v, (size_t)*n * sizeof **now);
    dem_simulation_destroy(simulation);
    dem_model_destroy(model);
    dem_lattice_free(&lattice);
    allocations = needed;
    return status;
}

/* Each of the allocations, `least` or more, fails once. The state at the end is that of a run in which none fails, but
 * for as much as `apart`. */
static void goes_on(const advanced_run *run, long least, double apart)
{
    double *undisturbed, *now;
    dem_index n;
    from_then_on = 0;
    assert_int_equal(advance(run, &undisturbed, &n, 0), DEM_OK);
    const long all = allocations;
    assert_true(all >= least);
    for (long k = 1; k <= all; k++) {
        const dem_status status = advance(run, &now, &n, k);
        assert_true(status == DEM_ERROR_MEMORY || (run->does_without && status == DEM_OK));
        for (dem_index c = 0; c < 2 * n; c++) assert_true(fabs(now[c] - undisturbed[c]) <= apart);
        free(now);
    }
    free(undisturbed);
}

/* A body that falls on the ground, in steps of one length. */
TEST(a_run_goes_on_where_memory_ran_out_to_the_same_bits)
{
    advanced_run fall = {.build = build, .n_obstacles = 1, .options = dem_options_default(), .t_end = 6e-4};
    fall.options.fixed_step = 4e-6;
    goes_on(&fall, 7, 0.0); /* of what is near a contact */
}

/* Bodies that run into each other, disc on disc: lists of pairs grow in the evaluations of forces. */
static dem_status build_two_layers(dem_lattice *both)
{
    const double up[2] = {0.0, 5.0};
    CLEANUP(dem_lattice_free) dem_lattice lower = dem_lattice_empty();
    dem_status status = build(both);
    if (status == DEM_OK) status = build(&lower);
    dem_lattice_move(&lower, 0.0, (const double[2]){0.004, -0.0365});
    if (status == DEM_OK) status = dem_lattice_launch(&lower, up);
    return status == DEM_OK ? dem_lattice_append(both, &lower) : status;
}

TEST(a_run_goes_on_where_bodies_had_no_memory_to_touch_each_other)
{
    advanced_run collide = {.build = build_two_layers, .options = dem_options_default(), .t_end = 6e-4};
    collide.options.bodies = DEM_BODIES_ALL;
    collide.options.fixed_step = 4e-6;
    goes_on(&collide, 10, 0.0);
    collide.options.method = DEM_METHOD_VERLET;
    goes_on(&collide, 10,
            1e-5); /* after a restart its damping is evaluated with v instead of an extrapolated velocity */
}

/* The same bodies, brittle: surfaces follow what breaks. */
static dem_status build_brittle(dem_lattice *lattice)
{
    const dem_status status = build_two_layers(lattice);
    if (status != DEM_OK) return status;
    lattice->strength = __real_malloc((size_t)lattice->n_triangles * sizeof *lattice->strength);
    if (lattice->strength == NULL) return DEM_ERROR_MEMORY;
    for (dem_index t = 0; t < lattice->n_triangles; t++) lattice->strength[t] = t % 2 == 0 ? 5e4 : (double)INFINITY;
    return DEM_OK;
}

TEST(a_run_goes_on_where_surfaces_had_no_memory_to_follow_a_break)
{
    advanced_run shatter = {.build = build_brittle, .options = dem_options_default(), .t_end = 6e-4};
    shatter.options.bodies = DEM_BODIES_ALL;
    shatter.options.fixed_step = 4e-6;
    shatter.does_without = true;
    goes_on(&shatter, 100, 0.0);
}

/* Breaks some triangles of bodies that fly, where an allocation fails, and again where none does. The state at the end
 * is in `now`.  \return what the first attempt returned */
static dem_status break_twice(long failing_one, int stays_so, motion *now)
{
    dem_options options = dem_options_default();
    const dem_index list[3] = {0, 3, 7};
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    CLEANUP(free_model) dem_model *model = NULL;
    CLEANUP(free_simulation) dem_simulation *simulation = NULL;
    options.bodies = DEM_BODIES_ALL;
    options.fixed_step = 4e-6;
    assert_int_equal(build_two_layers(&lattice), DEM_OK);
    assert_int_equal(dem_model_create(&model, &lattice, NULL, 0), DEM_OK);
    assert_int_equal(dem_simulation_create(&simulation, model, &options), DEM_OK);
    assert_int_equal(dem_simulation_advance(simulation, 1e-4), DEM_OK);
    allocations = 0;
    failing = failing_one;
    from_then_on = stays_so;
    const dem_status status = dem_simulation_break(simulation, list, 3, NULL, 0);
    const long needed = allocations;
    failing = from_then_on = 0;
    if (status != DEM_OK) assert_int_equal(dem_simulation_break(simulation, list, 3, NULL, 0), DEM_OK);
    assert_int_equal(dem_simulation_advance(simulation, 3e-4), DEM_OK);
    motion_see(simulation, now);
    allocations = needed;
    return status;
}

/* Also where there is no memory to go back: the flags of what did not break are gone then. */
TEST(what_could_not_break_for_want_of_memory_breaks_again_to_the_same_bits)
{
    static motion undisturbed, now;
    assert_int_equal(break_twice(0, 0, &undisturbed), DEM_OK);
    const long all = allocations;
    assert_true(all > 30);
    for (int stays_so = 0; stays_so < 2; stays_so++)
        for (long k = 1; k <= all; k++) {
            const dem_status status = break_twice(k, stays_so, &now);
            assert_true(status == DEM_ERROR_MEMORY || status == DEM_OK); /* without a layout that is faster */
            assert_memory_equal(&now.energy, &undisturbed.energy, sizeof now.energy);
        }
}

int main(int argc, char **argv)
{
    if (argc > 1) share = strtod(argv[1], NULL);
    return test_run();
}
