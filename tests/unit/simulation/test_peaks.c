/* SPDX-License-Identifier: BSD-3-Clause */
/* peaks.c: against the largest values that a run shows step by step. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/peak_source.h"
#include "harness/cleanup.h"
#include "harness/message.h"
#include "harness/motion.h"
#include "simulation/peaks.h"
#include "unit/solids.h"

enum { most_nodes = 64, most_springs = 160 };

/* What an observer of its own sees at every `every`-th step. */
typedef struct witness {
    dem_index n_nodes, n_springs, every, calls;
    double von_mises[most_nodes], t[most_nodes], stress[3 * most_nodes], strain[most_springs], spring_t[most_springs];
} witness;

static dem_status watch(void *context, const dem_simulation *simulation)
{
    witness *w = context;
    motion state;
    double stress[3 * most_nodes], strain[most_springs];
    if (w->calls++ % w->every != 0) return DEM_OK;
    motion_see(simulation, &state);
    dem_simulation_stress(simulation, stress);
    dem_simulation_strains(simulation, strain);
    for (dem_index i = 0; i < w->n_nodes; i++) {
        const double *s = stress + 3 * i, size = sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3.0 * s[2] * s[2]);
        if (size <= w->von_mises[i]) continue;
        w->von_mises[i] = size;
        w->t[i] = state.t;
        memcpy(w->stress + 3 * i, s, 3 * sizeof *s);
    }
    for (dem_index k = 0; k < w->n_springs; k++) {
        if (fabs(strain[k]) <= fabs(w->strain[k])) continue;
        w->strain[k] = strain[k];
        w->spring_t[k] = state.t;
    }
    return DEM_OK;
}

/* A block that falls on a floor at 5 m/s. */
typedef struct fall {
    support_run run;
    dem_peaks *peaks;
    witness witness;
} fall;

static fall *make_fall(dem_index every)
{
    static const double points[4] = {-1.0, -1e-4, 1.0, -1e-4}, down[2] = {0.5, -5.0};
    const dem_obstacle floor =
        SIZED(dem_obstacle, .n_points = 2, .points = points, .restitution = 0.5, .friction = 0.3);
    const dem_options options = dem_options_default();
    fall *f = calloc(1, sizeof *f);
    assert_non_null(f);
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.04, 0.05, 0.01);
    assert_ok(dem_lattice_launch(&lattice, down));
    support_open(&f->run, &lattice, &floor, 1, &options);
    f->witness = (witness){.n_nodes = lattice.n_nodes, .n_springs = lattice.n_springs, .every = every};
    assert_true(lattice.n_nodes <= most_nodes && lattice.n_springs <= most_springs);
    assert_ok(dem_peaks_create(&f->peaks, f->run.model, every));
    const dem_observer own = {.struct_size = sizeof(dem_observer), .step = watch, .context = &f->witness},
                       observer = ask_peaks_observer(f->peaks);
    assert_ok(dem_simulation_observe(f->run.simulation, &observer));
    assert_ok(dem_simulation_observe(f->run.simulation, &own));
    return f;
}

static void free_fall(fall *f)
{
    dem_peaks_destroy(f->peaks);
    support_close(&f->run);
    free(f);
}

TEST(peaks_are_the_largest_values_of_the_steps_looked_at)
{
    for (dem_index every = 1; every <= 3; every += 2) {
        fall *f = make_fall(every);
        (void)support_at(&f->run, 2e-3);
        const dem_node_peak *nodes = dem_peaks_nodes(f->peaks);
        const dem_spring_peak *springs = dem_peaks_springs(f->peaks);
        assert_true(f->witness.calls > 100);
        for (dem_index i = 0; i < f->witness.n_nodes; i++) {
            assert_close(nodes[i].von_mises, f->witness.von_mises[i], 1e-15 * f->witness.von_mises[i]);
            assert_close(nodes[i].t, f->witness.t[i], 0.0);
            assert_memory_equal(nodes[i].stress, f->witness.stress + 3 * i, sizeof nodes[i].stress);
        }
        for (dem_index k = 0; k < f->witness.n_springs; k++) {
            assert_close(springs[k].strain, f->witness.strain[k], 0.0);
            assert_close(springs[k].t, f->witness.spring_t[k], 0.0);
        }
        free_fall(f);
    }
}

TEST(ranks_begin_with_the_largest)
{
    dem_index nodes[most_nodes], springs[most_springs], first[3];
    fall *f = make_fall(1);
    (void)support_at(&f->run, 1e-3);
    const dem_index n = f->witness.n_nodes, m = f->witness.n_springs;
    assert_int_equal(dem_peaks_most_stressed_nodes(f->peaks, most_nodes, nodes), n);
    assert_int_equal(dem_peaks_most_strained_springs(f->peaks, most_springs, springs), m);
    unsigned char seen[most_nodes] = {0};
    for (dem_index k = 0; k < n; k++) {
        assert_int_equal(seen[nodes[k]]++, 0);
        if (k > 0)
            assert_true(dem_peaks_nodes(f->peaks)[nodes[k - 1]].von_mises >=
                        dem_peaks_nodes(f->peaks)[nodes[k]].von_mises);
    }
    for (dem_index k = 1; k < m; k++) {
        const double a = dem_peaks_springs(f->peaks)[springs[k - 1]].strain;
        assert_true(fabs(a) >= fabs(dem_peaks_springs(f->peaks)[springs[k]].strain));
    }
    assert_int_equal(dem_peaks_most_stressed_nodes(f->peaks, 3, first), 3);
    assert_memory_equal(first, nodes, sizeof first);
    assert_int_equal(dem_peaks_most_strained_springs(f->peaks, 3, first), 3);
    assert_memory_equal(first, springs, sizeof first);
    assert_int_equal(dem_peaks_most_stressed_nodes(f->peaks, 0, first), 0);
    free_fall(f);
}

/* Two springs of one stretch, to the bit, and one that is not stretched. */
TEST(equals_are_ranked_by_number_and_what_was_never_strained_not_at_all)
{
    static const double x[6] = {0.0, 0.0, 2.0, 0.0, 4.0, 0.0}, mass[3] = {1.0, 1.0, 1.0};
    static const dem_index ends[6] = {1, 2, 0, 1, 0, 2};
    dem_index springs[3] = {-1, -1, -1}, nodes[3];
    CLEANUP(support_close) support_run run;
    CLEANUP(free_peaks) dem_peaks *peaks;
    const dem_options options = dem_options_default();
    CLEANUP(dem_lattice_free) dem_lattice lattice = support_lattice(3, x, mass, 3, ends, 1.0, 10.0, NULL);
    lattice.rest_length[2] = 4.0;
    support_open(&run, &lattice, NULL, 0, &options);
    assert_ok(dem_peaks_create(&peaks, run.model, 1));
    assert_int_equal(dem_peaks_most_strained_springs(peaks, 3, springs), 0);
    const dem_observer observer = ask_peaks_observer(peaks);
    assert_ok(observer.step(observer.context, run.simulation)); /* the initial state alone */
    assert_int_equal(dem_peaks_most_strained_springs(peaks, 3, springs), 2);
    assert_int_equal(springs[0], 0);
    assert_int_equal(springs[1], 1);
    assert_close(dem_peaks_springs(peaks)[1].strain, 1.0, 0.0);
    assert_int_equal(dem_peaks_most_stressed_nodes(peaks, 3, nodes), 0); /* no triangles */
}

TEST(impossible_arguments_are_refused)
{
    dem_peaks *peaks = NULL;
    fall *f = make_fall(1);
    assert_int_equal(dem_peaks_create(NULL, f->run.model, 1), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_peaks_create: out is NULL");
    assert_int_equal(dem_peaks_create(&peaks, NULL, 1), DEM_ERROR_ARGUMENT);
    assert_message_parts("dem_peaks_create: model is NULL");
    assert_int_equal(dem_peaks_create(&peaks, f->run.model, 0), DEM_ERROR_ARGUMENT);
    assert_message_parts("0 steps * 1");
    assert_null(peaks);
    dem_peaks_destroy(NULL);
    free_fall(f);
}

/* Of so many nodes that their entries stay in the file, which somebody then cuts: nothing is made up, or lost. */
TEST(peaks_of_a_checkpoint_that_cannot_be_read_any_more_are_an_error)
{
    static const char path[] = "test_peaks.checkpoint";
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.5, 0.5, 0.01);
    dem_model *model = support_model(&lattice, NULL, 0);
    dem_peaks *fresh = NULL, *peaks = NULL;
    CLEANUP(free_checkpoint) dem_checkpoint *written = NULL;
    CLEANUP(free_checkpoint) dem_checkpoint *checkpoint = NULL;
    assert_ok(dem_peaks_create(&fresh, model, 2));
    assert_ok(dem_checkpoint_create(&written));
    const dem_observer observer = ask_peaks_observer(fresh);
    assert_ok(observer.checkpoint(observer.context, NULL, written));
    assert_ok(dem_checkpoint_write(written, path));
    assert_ok(dem_checkpoint_read(&checkpoint, path));
    assert_ok(dem_peaks_resume(&peaks, model, 2, checkpoint));
    assert_int_equal(truncate(path, 1000), 0);
    for (int k = 0; k < 2; k++) {
        dem_index n = 3, list[3];
        dem_node_peak largest[3];
        assert_null(dem_peaks_nodes(peaks));
        assert_null(dem_peaks_springs(peaks));
        assert_int_equal(peaks_look(peaks, NULL), DEM_ERROR_IO);
        assert_message_parts("test_peaks.checkpoint: cannot be read any more");
        assert_int_equal(dem_private_peaks_largest_nodes(peaks, &n, list, largest), DEM_ERROR_IO);
    }
    assert_int_equal(unlink(path), 0);
    dem_peaks_destroy(peaks);
    dem_peaks_destroy(fresh);
    dem_model_destroy(model);
}
