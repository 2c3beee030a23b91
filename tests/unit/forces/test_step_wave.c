/* SPDX-License-Identifier: BSD-3-Clause */
/* step_wave.c: several steps at once beside as many fused steps in turn, by every kernel with 1, 2 and 3 threads. They
 * are to have the same bits. */
#include "base/aligned.h"
#include "forces/kernel_functions.h"
#include "forces/step_wave.h"
#include "unit/forces/scenes.h"
#include "unit/free_team.h"

static const double h = 1e-5; /* s, a tenth of the period of the fastest motion or less */

/* States at the ends of the steps, of which every other one has the same arrays in a wave. */
typedef struct states {
    dem_index n; /* numbers of an array */
    double *x[STEP_WAVE_MOST + 1], *v[STEP_WAVE_MOST + 1], *a[STEP_WAVE_MOST + 1];
    double *block;
} states;

static void free_states(states *s)
{
    free(s->block);
}

/* Arrays for a start and `rooms` ends. */
static states make_states(dem_index n_nodes, int rooms)
{
    const dem_index n = (2 * n_nodes + 7) / 8 * 8;
    states s = {.n = 2 * n_nodes, .block = aligned_zeros((size_t)(3 * (rooms + 1) * n))};
    assert_non_null(s.block);
    for (int k = 0; k <= STEP_WAVE_MOST; k++) {
        double *at = s.block + 3 * n * (k == 0 ? 0 : 1 + (k - 1) % rooms);
        s.x[k] = at;
        s.v[k] = at + n;
        s.a[k] = at + 2 * n;
    }
    return s;
}

static void start(const scene *from, const kernel *k, const forces *f, states *s)
{
    memcpy(s->x[0], from->x, (size_t)s->n * sizeof *from->x);
    memcpy(s->v[0], from->v, (size_t)s->n * sizeof *from->v);
    const kernel_state y = {.x = s->x[0], .v = s->v[0], .a = s->a[0]};
    kernel own = *k;
    (void)kernel_accelerate(&own, f, &y);
}

static sweep_fused_step step_from(const states *s, int k)
{
    return (sweep_fused_step){
        .h = h, .x0 = s->x[k], .v0 = s->v[k], .a0 = s->a[k], .x1 = s->x[k + 1], .v1 = s->v[k + 1]};
}

static void take_singly(kernel *k, const forces *f, states *s)
{
    for (int step = 0; step < STEP_WAVE_MOST; step++) {
        const sweep_fused_step fused = step_from(s, step);
        const kernel_state y = {.x = fused.x1, .v = fused.v1, .a = s->a[step + 1], .fused_step = &fused};
        kernel_begin_step(k, &fused);
        assert_true(isfinite(kernel_accelerate(k, f, &y)));
    }
}

/* Every third node, and the last. */
static dem_index *watch_some(dem_index n_nodes, dem_index *n)
{
    dem_index *list = malloc((size_t)n_nodes * sizeof *list);
    assert_non_null(list);
    *n = 0;
    for (dem_index i = 0; i < n_nodes; i++)
        if (i % 3 == 1 || i == n_nodes - 1) list[(*n)++] = i;
    return list;
}

static step_wave_steps steps_of(const states *s, int n)
{
    step_wave_steps steps = {.n = n};
    for (int k = 0; k < n; k++) {
        steps.step[k] = step_from(s, k);
        steps.a[k] = s->a[k + 1];
    }
    return steps;
}

static void check_squares(const step_wave_steps *steps, const states *single)
{
    for (int k = 0; k < steps->n; k++) {
        double most = 0.0;
        for (dem_index j = 0; j < steps->n_watched; j++) {
            const vec2 v = vec2_at(single->v[k + 1], steps->watched[j]);
            most = fmax(most, vec2_dot(v, v));
        }
        assert_close(steps->square[k], most, 0.0);
    }
}

/* The wave's arrays are no numbers before. */
static void check_wave(step_wave *w, const forces *f, const states *single, states *together, int n)
{
    const size_t size = (size_t)single->n * sizeof(double);
    CLEANUP(free_memory) dem_index *watched = NULL;
    step_wave_steps steps = steps_of(together, n);
    steps.watched = watched = watch_some(single->n / 2, &steps.n_watched);
    for (int k = 1; k < 3; k++)
        for (dem_index c = 0; c < single->n; c++) together->x[k][c] = together->v[k][c] = together->a[k][c] = NAN;
    assert_true(step_wave_run(w, f, &steps));
    assert_memory_equal(together->x[n], single->x[n], size);
    assert_memory_equal(together->v[n], single->v[n], size);
    assert_memory_equal(together->a[n], single->a[n], size);
    check_squares(&steps, single);
}

static void check_kernel(const scene *of, dem_kernel kind, int threads)
{
    const dem_index n = of->model->lattice.n_nodes;
    const forces f = {.model = of->model, .gravity = {0.5, -9.81}};
    CLEANUP(free_team) team *t = team_create(threads, 1);
    CLEANUP(kernel_destroy) kernel k;
    CLEANUP(free_states) states single = make_states(n, STEP_WAVE_MOST), together = make_states(n, 2);
    assert_ok(kernel_create(&k, of->model, kind, t));
    start(of, &k, &f, &single);
    start(of, &k, &f, &together);
    take_singly(&k, &f, &single);
    step_wave *w = step_wave_create(&k);
    assert_non_null(w);
    for (int steps = 1; steps <= STEP_WAVE_MOST; steps += steps < 4 ? 1 : 6)
        check_wave(w, &f, &single, &together, steps);
    step_wave_free(w);
}

static void check_lattice(const dem_lattice *lattice, double share, bool by_rows)
{
    CLEANUP(free_scene) scene s = make_scene(lattice, share);
    for (dem_kernel kind = DEM_KERNEL_PORTABLE; kind <= DEM_KERNEL_AVX512; kind++) {
        if (dem_kernel_check(kind) != DEM_OK) continue;
        if (by_rows && kernel_functions_of(kind)->lattice_step == NULL) continue;
        for (int threads = 1; threads <= 3; threads++) check_kernel(&s, kind, threads);
    }
}

TEST(steps_at_once_are_those_in_turn)
{
    for (int laws = 0; laws < 8; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice strip = make_solid(0.06, 10.0 + 0.05 * laws, &material);
        check_lattice(&strip, 0.05, false);
    }
}

/* Nothing acts but springs and guards, if any, and there are no lattice rows. */
static dem_lattice make_squares(double height, int laws)
{
    const dem_material material = law_of(laws);
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&lattice, 0.05, height, 1e-2));
    assert_ok(dem_lattice_assemble_squares(&lattice, &material, 0.5));
    return lattice;
}

TEST(blocks_of_bodies_without_lattice_rows_take_steps_of_the_same_bits)
{
    for (int laws = 0; laws < 3; laws += 2) {
        CLEANUP(dem_lattice_free) dem_lattice strip = make_squares(12.0, laws);
        check_lattice(&strip, 0.05, false);
    }
}

/* Widths at which all numbers of nodes behind the last block come up. */
TEST(nodes_behind_the_last_block_take_part)
{
    const dem_material material = law_of(1);
    for (int k = 0; k < 8; k++) {
        CLEANUP(dem_lattice_free) dem_lattice strip = make_solid(0.04, 3.0 + 0.0087 * k, &material);
        CLEANUP(free_scene) scene s = make_scene(&strip, 0.05);
        check_kernel(&s, DEM_KERNEL_AUTO, 1);
    }
}

/* Where the guard acts, or something is not finite, at some node of the strip, be it at the start or later. */
static bool holds_with(int kind, double x_by, double v_by, double place)
{
    const dem_material material = law_of(kind % 2);
    CLEANUP(dem_lattice_free)
    dem_lattice strip = kind < 2 ? make_solid(0.06, 10.0, &material) : make_squares(12.0, 0);
    CLEANUP(free_scene) scene s = make_scene(&strip, 0.01);
    CLEANUP(free_team) team *t = team_create(3, 1);
    CLEANUP(kernel_destroy) kernel k;
    const forces f = {.model = s.model};
    CLEANUP(free_states) states of = make_states(strip.n_nodes, 2);
    dem_index i = (dem_index)(place * (double)(strip.n_nodes - 1));
    /* There are triangles on all sides of a node in the middle. */
    while (fabs(strip.x[2 * i] - strip.x[0] - 0.03) > 0.006) i += place < 0.5 ? 1 : -1;
    assert_ok(kernel_create(&k, s.model, DEM_KERNEL_AUTO, t));
    const double inwards = place < 0.5 ? 1.0 : -1.0;
    s.x[2 * i + 1] += inwards * x_by;
    s.v[2 * i + 1] += inwards * v_by;
    start(&s, &k, &f, &of);
    step_wave *w = step_wave_create(&k);
    assert_non_null(w);
    step_wave_steps steps = steps_of(&of, 6);
    const bool holds = step_wave_run(w, &f, &steps);
    step_wave_free(w);
    return holds;
}

TEST(the_guard_and_overflows_are_found)
{
    for (int kind = 0; kind < 3; kind++) { /* by lattice rows, and by blocks with an area term and without */
        assert_true(holds_with(kind, 0.0, 0.0, 0.5));
        for (int k = 0; k <= 60; k++) {
            assert_false(holds_with(kind, 0.0085, 0.0, k / 60.0));
            assert_false(holds_with(kind, 0.0, 0.0085 / (4.0 * h), k / 60.0));
            assert_false(holds_with(kind, 0.0, (double)NAN, k / 60.0));
        }
    }
}

/* Strips with three nodes in the last row, of which up to seven are behind the last block: the guard acts on triangles
 * among these. */
TEST(the_guard_is_found_behind_the_last_block)
{
    for (int k = 0; k < 16; k++) {
        const dem_material material = law_of(k % 2);
        CLEANUP(dem_lattice_free) dem_lattice strip = make_solid(0.02, 8.0 + 0.01733 * (k / 2), &material);
        CLEANUP(free_scene) scene s = make_scene(&strip, 0.0);
        CLEANUP(kernel_destroy) kernel own;
        CLEANUP(free_states) states of = make_states(strip.n_nodes, 2);
        const forces f = {.model = s.model};
        assert_ok(kernel_create(&own, s.model, DEM_KERNEL_AUTO, NULL));
        s.x[2 * (strip.n_nodes - 2) + 1] -= 0.0085;
        start(&s, &own, &f, &of);
        step_wave *w = step_wave_create(&own);
        assert_non_null(w);
        step_wave_steps steps = steps_of(&of, 2);
        assert_false(step_wave_run(w, &f, &steps));
        step_wave_free(w);
    }
}

/* ---- lattice rows ---- */

static dem_lattice make_disc(void)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&lattice, 0.25, 1e-2));
    return lattice;
}

/* Outside of three holes, of which one is open below. */
static bool is_solid(void *context, const double *x)
{
    (void)context;
    return hypot(x[0] - 0.1, x[1]) > 0.06 && hypot(x[0] + 0.12, x[1] - 0.05) > 0.045 && hypot(x[0], x[1] + 0.25) > 0.1;
}

/* A disc with holes, whose lattice rows lie across, with nodes that stand elsewhere than in the lattice. */
static dem_lattice make_porous(void)
{
    const dem_material material = law_of(0);
    dem_lattice lattice = make_disc();
    assert_ok(dem_lattice_cut(&lattice, is_solid, NULL));
    assert_ok(dem_lattice_jitter(&lattice, 0.2 * 1e-2, 7));
    dem_lattice_move(&lattice, 2.5, (const double[2]){0.3, -0.1});
    assert_ok(dem_lattice_assemble(&lattice, &material));
    return lattice;
}

/* A body above another, one node wide at its lower end, and one as wide as ever. */
static dem_lattice make_pile(void)
{
    const dem_material material = law_of(0);
    dem_lattice lattice = make_disc();
    assert_ok(dem_lattice_assemble(&lattice, &material));
    CLEANUP(dem_lattice_free) dem_lattice second = make_solid(0.43, 0.2, &material);
    CLEANUP(dem_lattice_free) dem_lattice third = make_solid(0.03, 0.9, &material);
    dem_lattice_move(&second, 0.3, (const double[2]){0.6, 0.1});
    dem_lattice_move(&third, -1.0, (const double[2]){-0.9, 0.4});
    assert_ok(dem_lattice_append(&lattice, &second));
    assert_ok(dem_lattice_append(&lattice, &third));
    return lattice;
}

/* Some nodes are fixed, others are heavier, and springs have stiffnesses of their own. */
static void make_uneven(dem_lattice *lattice)
{
    for (dem_index i = 0; i < lattice->n_nodes; i++) lattice->mass[i] *= 1.0 + 0.25 * (double)(i % 3);
    if (lattice->flags == NULL) lattice->flags = calloc((size_t)lattice->n_nodes, sizeof *lattice->flags);
    assert_non_null(lattice->flags);
    for (dem_index i = 0; i < lattice->n_nodes; i += 17) lattice->flags[i] |= DEM_NODE_FIXED;
    for (dem_index k = 0; k < lattice->n_springs; k++) lattice->stiffness[k] *= 1.0 + 0.125 * (double)(k % 5);
}

/* The sizes of steps are so small that no triangle folds. */
TEST(lattice_rows_take_steps_of_the_same_bits)
{
    for (int k = 0; k < 4; k++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = k % 2 == 0 ? make_porous() : make_pile();
        if (k > 1) make_uneven(&lattice);
        check_lattice(&lattice, 0.02, true);
    }
}

/* Laws of triangles keep bodies to blocks, and numbers in any order keep them off lattice rows; few have no blocks. */
TEST(there_are_none_of_few_nodes_or_of_others_numbers)
{
    const dem_material material = law_of(1);
    for (int k = 0; k < 2; k++) {
        CLEANUP(dem_lattice_free)
        dem_lattice lattice = k == 0 ? make_solid(0.3, 0.3, &material) : make_shuffled(&material);
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.0);
        CLEANUP(kernel_destroy) kernel own;
        assert_ok(kernel_create(&own, s.model, DEM_KERNEL_AUTO, NULL));
        assert_null(step_wave_create(&own));
    }
    step_wave_free(NULL);
}
