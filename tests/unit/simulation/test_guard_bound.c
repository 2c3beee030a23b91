/* SPDX-License-Identifier: BSD-3-Clause */
/* guard_bound.c, and what it asks of elastic/fold_pass.c by forces/kernel.c: by every kernel, against each triangle by
 * itself; and a run with the bound against one without. */
#include "simulation/guard_bound.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "harness/cleanup_gsl.h"
#include "verification/support.h"

static const double onset = 0.4;

static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                         .density = 1050.0, .thickness = 1.0, .guard = 0.02);

/* Of a width by which some nodes are behind the last block of eight. */
static dem_lattice make_block(void)
{
    const dem_lattice lattice = support_rectangle(0.05, 0.06, 5e-3, &rubber);
    assert_true(lattice.n_nodes % 8 != 0);
    return lattice;
}

/* How far the corners of a triangle may move relative to each other until twice its area has fallen to that at the
 * onset, at most, by the larger root of w^2 + w (|b| + |c|) = what may be lost; 0 where nothing may. */
static double way_of(const dem_lattice *l, dem_index k, const double *x)
{
    const dem_index *corner = &l->triangles[3 * k];
    const vec2 a = vec2_at(x, corner[0]), b = vec2_sub(vec2_at(x, corner[1]), a),
               c = vec2_sub(vec2_at(x, corner[2]), a);
    const double spare = vec2_cross(b, c) - 2.0 * onset * vec2_area_of(l->x, corner), sum = vec2_norm(b) + vec2_norm(c);
    return spare > 0.0 ? 0.5 * (sqrt(sum * sum + 4.0 * spare) - sum) : 0.0;
}

static double speed_of(const dem_lattice *l, dem_index k, const double *v)
{
    double speed = 0.0;
    for (int c = 0; c < 3; c++)
        speed = fmax(speed, vec2_norm(vec2_sub(vec2_at(v, l->triangles[3 * k + c]),
                                               vec2_at(v, l->triangles[3 * k + (c + 1) % 3]))));
    return speed;
}

/* The pass takes an onset that is larger by 0.1 % (TRIANGLES_ROUNDED), and for |b| + |c| what is larger by up to
 * a fifth where these differ as here. */
static void check_room(const dem_model *model, const kernel *k, const double *x, const double *v)
{
    const dem_lattice *l = &model->lattice;
    const triangles_room room = kernel_room_to_fold(k, x, v);
    double way = (double)INFINITY, speed = 0.0;
    for (dem_index t = 0; t < l->n_triangles; t++) {
        way = fmin(way, way_of(l, t, x));
        speed = fmax(speed, speed_of(l, t, v));
    }
    assert_true(room.way <= way);
    assert_true(room.way >= 0.7 * way - 1e-5);
    assert_close(room.speed, speed, 1e-12 * speed);
}

/* From a block at rest to one with triangles that are folded. */
TEST(every_kernel_finds_how_far_triangles_are_from_folding)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_block();
    CLEANUP(free_model) dem_model *model = support_model(&lattice, NULL, 0);
    CLEANUP(free_rng) gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    const dem_index n = 2 * lattice.n_nodes;
    CLEANUP(free_memory) double *x = malloc((size_t)n * sizeof *x), *v = malloc((size_t)n * sizeof *v);
    for (dem_kernel kind = DEM_KERNEL_PORTABLE; kind <= DEM_KERNEL_AVX512; kind++) {
        CLEANUP(kernel_destroy) kernel k = {0};
        if (dem_kernel_check(kind) != DEM_OK) continue;
        assert_ok(kernel_create(&k, model, kind, NULL));
        for (int round = 0; round < 40; round++) {
            for (dem_index c = 0; c < n; c++) {
                x[c] = lattice.x[c] + 5e-5 * round * (gsl_rng_uniform(rng) - 0.5);
                v[c] = gsl_rng_uniform(rng) - 0.5;
            }
            check_room(model, &k, x, v);
        }
    }
}

/* ---- runs ---- */

typedef struct watch {
    bool forgets;
    int n_known, n_folded; /* steps after which it is known that nothing folds, and those at whose end something has */
} watch;

static dem_status on_step(void *context, const dem_simulation *simulation)
{
    watch *w = context;
    dem_simulation *s = (dem_simulation *)simulation;
    const bool folded = ask_strain(simulation).area_min < onset,
               known = s->unfolded.is_known && s->unfolded.left >= 0.0;
    assert_false(folded && known);
    const double *x = s->y, *v = x + state_velocities(&s->layout);
    if (known) assert_true(kernel_room_to_fold(&s->kernel, x, v).speed <= s->unfolded.speed);
    w->n_known += known;
    w->n_folded += folded;
    if (w->forgets) guard_bound_forget(s);
    return DEM_OK;
}

/* A block hits a floor at 30 m/s, is squeezed until the guard acts, and flies off again. */
static void run(watch *w, double *y)
{
    static const double floor_points[4] = {-1.0, 0.0, 1.0, 0.0};
    const dem_obstacle ground = {.struct_size = sizeof(dem_obstacle), .n_points = 2, .points = floor_points};
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_block();
    dem_lattice_move(&lattice, 0.0, (const double[2]){0.0, 5e-3});
    assert_ok(dem_lattice_launch(&lattice, (const double[2]){3.0, -30.0}));
    CLEANUP(free_model) dem_model *model = support_model(&lattice, &ground, 1);
    dem_options options = dem_options_default();
    options.max_step = 1e-6;
    CLEANUP(free_simulation) dem_simulation *simulation = support_simulation(model, &options);
    const dem_observer observer = {.struct_size = sizeof observer, .step = on_step, .context = w};
    assert_ok(dem_simulation_observe(simulation, &observer));
    assert_ok(dem_simulation_advance(simulation, 4e-3));
    memcpy(y, ask_state(simulation).x, 2 * (size_t)lattice.n_nodes * sizeof *y);
}

TEST(a_run_with_the_bound_is_that_without_to_the_last_bit)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_block();
    const size_t size = 2 * (size_t)lattice.n_nodes * sizeof(double);
    CLEANUP(free_memory) double *with = malloc(size), *without = malloc(size);
    watch bound = {0}, none = {.forgets = true};
    run(&bound, with);
    run(&none, without);
    assert_memory_equal(with, without, size);
    assert_true(bound.n_known > 100);
    assert_true(bound.n_folded > 10);
    assert_int_equal(none.n_known, 0);
    assert_int_equal(none.n_folded, bound.n_folded);
}
