/* SPDX-License-Identifier: BSD-3-Clause */
/* kernel.c, band.c and the sweeps: every kernel with 1, 2 and 3 threads, and band by band, against
 * forces_acceleration(), which sums up row by row. They are to be equal, so that no tolerance is needed: 0 and -0 count
 * as equal. */
#include "verification/support.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#include "base/aligned.h"
#include "forces/band.h"
#include "harness/cleanup_gsl.h"
#include "unit/elastic/look.h"

typedef struct scene {
    dem_model *model;
    double *x, *v, *a, *u;
    gsl_rng *random;
    team *teams[4]; /* of up to so many threads */
} scene;

static const forces whole;

static double about_zero(gsl_rng *r, double size)
{
    return size * (2.0 * gsl_rng_uniform(r) - 1.0);
}

static double *copy_doubles(const double *from, dem_index n)
{
    double *to = malloc((size_t)n * sizeof *to);
    assert_non_null(to);
    return memcpy(to, from, (size_t)n * sizeof *to);
}

/* Positions at rest, moved at random by up to `share` of the spacing, and random velocities. */
static scene make_scene(const dem_lattice *lattice, double share)
{
    scene s = {.random = gsl_rng_alloc(gsl_rng_mt19937)};
    gsl_rng_set(s.random, 7);
    for (int n = 0; n < 4; n++) s.teams[n] = team_create(n, 1);
    assert_ok(dem_model_create(&s.model, lattice, NULL, 0));
    const dem_index n = 2 * lattice->n_nodes;
    s.x = copy_doubles(lattice->x, n);
    s.v = copy_doubles(lattice->x, n);
    s.a = copy_doubles(lattice->x, n);
    s.u = copy_doubles(lattice->x, n);
    for (dem_index k = 0; k < n; k++) {
        s.x[k] += about_zero(s.random, share * dem_model_spacing(s.model));
        s.v[k] = about_zero(s.random, 10.0);
    }
    return s;
}

static void free_scene(scene *s)
{
    dem_model_destroy(s->model);
    gsl_rng_free(s->random);
    free(s->x);
    free(s->v);
    free(s->a);
    free(s->u);
    for (int n = 0; n < 4; n++) team_destroy(s->teams[n]);
}

/* A kernel and its number of threads, and whether what is broken is trimmed from its layout. */
typedef struct trial {
    dem_kernel kind;
    int n_threads;
    bool trims;
} trial;

static kernel open_kernel(const scene *s, const forces *load, const trial *of)
{
    kernel k;
    assert_ok(kernel_create(&k, s->model, of->kind, s->teams[of->n_threads]));
    if (of->trims) kernel_follow(&k, load->elements, NULL, 0);
    return k;
}

/* The sum bounds all accelerations: 1e-14 is for the rounding of the root. */
static void check_bound(const scene *s, const forces *load, double sum)
{
    const dem_index n = s->model->lattice.n_nodes;
    double largest = 0.0;
    for (dem_index i = 0; i < n; i++) largest = fmax(largest, vec2_norm(vec2_at(s->a, i)));
    assert_true(isfinite(sum));
    if (load->rigid != NULL || s->model->rigid.n > 0) return;
    assert_true(sweep_largest(sum) >= (1.0 - 1e-14) * largest);
}

static void check_evaluations(scene *s, const forces *load, kernel *k)
{
    for (int round = 0; round < 2; round++) { /* what the first has left in the ring does not matter */
        const dem_index n = s->model->lattice.n_nodes;
        const kernel_state y = {.x = s->x, .v = s->v, .u = round ? s->u : NULL, .a = s->a};
        for (dem_index c = 0; c < 2 * n; c++) s->a[c] = s->u[c] = NAN;
        check_bound(s, load, kernel_accelerate(k, load, &y));
        if (round) assert_memory_equal(s->u, s->v, 2 * (size_t)n * sizeof *s->v);
        for (dem_index i = 0; i < n; i++) {
            const vec2 a = forces_acceleration(load, i, s->x, s->v);
            if (a.x != s->a[2 * i] || a.y != s->a[2 * i + 1])
                fail_msg("%s, %d threads, node %lld of %lld: (%.17g, %.17g) instead of (%.17g, %.17g)",
                         dem_kernel_name(k->kind), team_threads(k->team), (long long)i, (long long)n, s->a[2 * i],
                         s->a[2 * i + 1], a.x, a.y);
        }
    }
}

static void check_kernel(scene *s, const forces *load, const trial *of)
{
    CLEANUP(kernel_destroy) kernel k = open_kernel(s, load, of);
    check_evaluations(s, load, &k);
}

/* v' = v0 + h/2 a0, x1 = x0 + h v', v1 = (v' + h/2 a0) + h/2 (a1 - a0), number by number. */
static void check_fused_step(scene *s, const forces *load, const trial *of)
{
    const dem_index n = 2 * s->model->lattice.n_nodes;
    const double h = 0.1 * dem_model_spacing(s->model) / 10.0;
    CLEANUP(free_memory) double *a0 = copy_doubles(s->v, n), *x1 = copy_doubles(s->x, n), *v1 = copy_doubles(s->v, n);
    CLEANUP(kernel_destroy) kernel k = open_kernel(s, load, of);
    for (dem_index c = 0; c < n; c++) {
        a0[c] = about_zero(s->random, 10.0 / h);
        x1[c] = v1[c] = s->a[c] = 1.0;
    }
    const sweep_fused_step fused = {h, s->x, s->v, a0, x1, v1};
    const kernel_state y = {.x = x1, .v = v1, .a = s->a, .fused_step = &fused};
    kernel_begin_step(&k, &fused);
    assert_true(isfinite(kernel_accelerate(&k, load, &y)));
    for (dem_index c = 0; c < n; c++) assert_close(x1[c], s->x[c] + h * (s->v[c] + 0.5 * h * a0[c]), 0.0);
    for (dem_index c = 0; c < n; c++) {
        const vec2 a = forces_acceleration(load, c / 2, x1, s->v);
        const double a1 = c % 2 ? a.y : a.x, half = s->v[c] + 0.5 * h * a0[c];
        assert_close(s->a[c], a1, 0.0);
        assert_close(v1[c], half + 0.5 * h * a0[c] + 0.5 * h * (a1 - a0[c]), 0.0);
    }
}

/* Positions in bands further away than the next, and velocities in others than this one, are no numbers. In the second
 * round no band goes on with the scratch of the one before. */
static void check_bands(scene *s, const forces *load, const trial *of)
{
    const dem_index n = s->model->lattice.n_nodes;
    CLEANUP(kernel_destroy) kernel k = open_kernel(s, load, of);
    const dem_index rows = band_nodes(&k);
    CLEANUP(free_memory) double *x = copy_doubles(s->x, 2 * n), *v = copy_doubles(s->v, 2 * n);
    CLEANUP(free_memory) double *scratch = aligned_zeros(band_scratch(&k));
    if (rows == 0 || !band_is_possible(&k, load, s->x, 2)) return;
    for (dem_index c = 0; c < 2 * n; c++) s->a[c] = NAN;
    for (int round = 0; round < 2; round++)
        for (dem_index first = 0; first < n; first += rows) {
            const dem_index end = first + rows < n ? first + rows : n;
            for (dem_index c = 0; c < 2 * n; c++) {
                x[c] = c / 2 < first - rows || c / 2 >= end + rows ? (double)NAN : s->x[c];
                v[c] = c / 2 < first || c / 2 >= end ? (double)NAN : s->v[c];
            }
            for (size_t c = 0; round > 0 && c < k.ring_size; c++) scratch[c] = NAN;
            const band b = {.first = first,
                            .end = end,
                            .goes_on = first > 0 && round == 0,
                            .stage = round,
                            .is_own = true,
                            .x = x,
                            .v = v,
                            .a = s->a,
                            .scratch = scratch};
            assert_true(isfinite(band_accelerate(&k, load, &b)));
            for (dem_index i = first; i < end; i++) {
                const vec2 a = forces_acceleration(load, i, s->x, s->v);
                assert_close(s->a[2 * i], a.x, 0.0);
                assert_close(s->a[2 * i + 1], a.y, 0.0);
            }
        }
    assert_true(band_was_possible(load, 2));
}

static bool can_fuse(const scene *s, const forces *load)
{
    forces acting = *load;
    acting.model = s->model;
    CLEANUP(kernel_destroy) kernel k;
    assert_ok(kernel_create(&k, s->model, DEM_KERNEL_AUTO, NULL));
    const bool may = kernel_can_fuse(&k, &acting);
    return may;
}

/* sqrt(1 + largest bound/omega_max^2), node by node. */
static double stiffening_of(const scene *s, triangles_integrity integrity)
{
    const dem_model *m = s->model;
    double added = 0.0;
    for (dem_index i = 0; i < m->lattice.n_nodes; i++)
        added = fmax(added, triangles_guard_bound(&m->triangles, integrity, i, s->x) * m->inverse_mass[i]);
    return sqrt(1.0 + added / (m->omega_max * m->omega_max));
}

static void check_stiffening(scene *s, const forces *load, const trial *of)
{
    CLEANUP(kernel_destroy) kernel k = open_kernel(s, load, of);
    assert_close(kernel_stiffening(&k, load, s->x), stiffening_of(s, element_state_triangles(load->elements)), 0.0);
}

static void check_load(scene *s, const forces *load)
{
    forces acting = *load;
    acting.model = s->model;
    for (dem_kernel kind = DEM_KERNEL_PORTABLE; kind <= DEM_KERNEL_AVX512; kind++)
        for (int k = 0; k < (load->elements != NULL ? 6 : 3); k++) {
            const trial of = {kind, k % 3 + 1, k >= 3};
            if (dem_kernel_check(kind) != DEM_OK) continue;
            check_kernel(s, &acting, &of);
            if (can_fuse(s, load)) check_fused_step(s, &acting, &of);
            if (of.n_threads == 1) check_bands(s, &acting, &of);
            check_stiffening(s, &acting, &of);
        }
}

static void check_lattice(const dem_lattice *lattice, double share)
{
    const forces plain = {.gravity = {0.5, -9.81}}, drag = {.gravity = {0.0, -9.81}, .mass_damping = 3.0};
    CLEANUP(free_scene) scene s = make_scene(lattice, share);
    check_load(&s, &plain);
    check_load(&s, &drag);
}

static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                         .density = 1050.0, .thickness = 0.5, .guard = 0.02);

static const dem_material coupled_rubber =
    SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0, .density = 1050.0, .thickness = 0.5,
          .guard = 0.02, .springs = DEM_SPRINGS_COUPLED);

static dem_lattice make_solid(double width, double height, const dem_material *material)
{
    dem_lattice lattice = support_rectangle(width, height, 1e-2, material);
    return lattice;
}

/* Nodes inside are moved where springs are coupled: otherwise there would be no couplings. */
static dem_lattice make_irregular(double width, double height, const dem_material *material)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_rectangle(&lattice, width, height, 1e-2));
    if (material->springs == DEM_SPRINGS_COUPLED) assert_ok(dem_lattice_jitter(&lattice, 2e-3, 1));
    assert_ok(dem_lattice_assemble(&lattice, material));
    return lattice;
}

/* From one cell to rows longer than several blocks, with every number of nodes left over. */
TEST(rectangles_of_all_sizes_agree)
{
    for (int rows = 1; rows <= 5; rows += 2)
        for (int columns = 1; columns <= 21; columns++) {
            CLEANUP(dem_lattice_free)
            dem_lattice lattice = make_solid(1e-2 * columns + 1e-4, 0.9e-2 * rows + 1e-2, &rubber);
            check_lattice(&lattice, 0.05);
            if (rows == 1) continue; /* no node inside */
            CLEANUP(dem_lattice_free)
            dem_lattice coupled = make_irregular(1e-2 * columns + 1e-4, 0.9e-2 * rows + 1e-2, &coupled_rubber);
            check_lattice(&coupled, 0.05);
        }
}

static bool outside_hole(void *context, const double *x)
{
    (void)context;
    return hypot(x[0] - 0.08, x[1] - 0.1) > 0.043;
}

static dem_lattice make_holed(const dem_material *material)
{
    dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&lattice, 0.15, 1e-2));
    dem_lattice_move(&lattice, 0.1, (const double[2]){0.15, 0.15});
    assert_ok(dem_lattice_cut(&lattice, outside_hole, NULL));
    if (material->springs == DEM_SPRINGS_COUPLED) assert_ok(dem_lattice_jitter(&lattice, 2e-3, 1));
    assert_ok(dem_lattice_assemble(&lattice, material));
    return lattice;
}

/* One of sixteen laws: with and without area term, guard, damping of the springs, and their couplings. */
static dem_material law_of(int laws)
{
    dem_material material = rubber;
    if (laws & 1) material.poissons_ratio = 0.45;
    if (laws & 2) material.guard = 0.0;
    if (laws & 4) material.damping_time = 1e-5;
    if (laws & 8) material.springs = DEM_SPRINGS_COUPLED;
    return material;
}

/* Discs with holes; every law there is. */
TEST(every_law_agrees_on_bodies_with_holes)
{
    for (int laws = 0; laws < 16; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        check_lattice(&lattice, 0.1);
    }
}

/* Moved by up to 0.6 of a spacing, many triangles are below the guard's onset, and some are inverted. */
TEST(squeezed_triangles_agree)
{
    for (int stiff = 0; stiff < 2; stiff++) {
        dem_material material = rubber;
        if (stiff) material.poissons_ratio = 0.2;
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        check_lattice(&lattice, 0.6);
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.6);
        assert_true(stiffening_of(&s, TRIANGLES_WHOLE) > 2.0);
    }
}

/* Two blocks side by side, a fifth of a spacing apart, whose nodes are shifted by up to a tenth. */
TEST(surfaces_in_contact_agree)
{
    const dem_material law = law_of(3);
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.11, 0.07, &law), other = make_solid(0.11, 0.09, &law);
    dem_lattice_move(&other, 0.0, (const double[2]){0.112, 0.0});
    assert_ok(dem_lattice_append(&lattice, &other));
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
    forces load = {.gravity = {0.5, -9.81}};
    assert_ok(surface_contact_create(&load.surfaces, &s.model->lattice,
                                     &(const surface_contact_rule){.within_bodies = true, .stiffness = 1.0}));
    check_load(&s, &load);
    assert_true(surface_contact_evaluate(load.surfaces, s.x) && load.surfaces->compact.n_nodes > 4);
    assert_false(surface_contact_begin_stages(load.surfaces, s.x, 1));
    surface_contact_destroy(load.surfaces);
}

/* Rows of 22 nodes reach into the third block behind, lanes one further. What reads more than neighbours' positions is
 * not done by bands, nor are nodes beside what is broken that are evaluated one by one. */
TEST(bands_are_as_long_as_neighbours_are_apart)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.2101, 0.2, &rubber);
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
    CLEANUP(element_state_destroy) element_state broken;
    CLEANUP(kernel_destroy) kernel k;
    forces load = {.model = s.model};
    assert_ok(kernel_create(&k, s.model, DEM_KERNEL_AUTO, NULL));
    assert_int_equal(band_nodes(&k), 8 * (3 + 1));
    assert_true(band_is_possible(&k, &load, s.x, 2));
    load.mass_damping = 3.0;
    assert_false(band_is_possible(&k, &load, s.x, 2));
    load.mass_damping = 0.0;
    assert_ok(element_state_create(&broken, &s.model->lattice, &s.model->springs));
    load.elements = &broken;
    assert_true(band_is_possible(&k, &load, s.x, 2));
    element_state_break(&broken, 3);
    assert_false(band_is_possible(&k, &load, s.x, 2));
    kernel_follow(&k, &broken, NULL, 0);
    assert_true(band_is_possible(&k, &load, s.x, 2));
}

/* Two blocks three spacings apart, of which one moves on as a whole, and then one node alone. */
TEST(surfaces_that_stay_apart_have_bands)
{
    const dem_material law = law_of(3);
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.11, 0.07, &law), other = make_solid(0.11, 0.09, &law);
    const dem_index n_first = lattice.n_nodes;
    dem_lattice_move(&other, 0.0, (const double[2]){0.14, 0.0});
    assert_ok(dem_lattice_append(&lattice, &other));
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.01);
    const dem_index all[2] = {0, lattice.n_nodes};
    forces load = {.model = s.model, .gravity = {0.5, -9.81}};
    assert_ok(surface_contact_create(&load.surfaces, &s.model->lattice,
                                     &(const surface_contact_rule){.within_bodies = true, .stiffness = 1.0}));
    assert_true(surface_contact_evaluate(load.surfaces, s.x));
    assert_int_equal(load.surfaces->close.n, 0);
    check_load(&s, &load);
    assert_true(surface_contact_begin_stages(load.surfaces, s.x, 2)); /* chosen anew if others have been looked at */
    surface_contact_take_stage(load.surfaces, 0, all, s.x);
    surface_contact_take_stage(load.surfaces, 1, all, s.x);
    assert_true(surface_contact_stayed_apart(load.surfaces, 2));
    for (dem_index i = 0; i < 2 * n_first; i++) s.x[i] -= i % 2 == 0 ? 1e-4 : 0.0;
    surface_contact_take_stage(load.surfaces, 1, all, s.x);
    assert_true(surface_contact_stayed_apart(load.surfaces, 2));
    s.x[2 * load.surfaces->surface.nodes[0]] += 3e-2;
    surface_contact_take_stage(load.surfaces, 1, all, s.x);
    assert_true(surface_contact_stayed_apart(load.surfaces, 1));
    assert_false(surface_contact_stayed_apart(load.surfaces, 2));
    surface_contact_destroy(load.surfaces);
}

/* Every seventh spring and every fifth triangle; what is left of the guard stiffens less. */
TEST(broken_elements_agree)
{
    for (int laws = 0; laws < 16; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        CLEANUP(springs_free) springs all;
        CLEANUP(element_state_destroy) element_state broken;
        assert_ok(springs_compile(&all, &lattice));
        assert_ok(element_state_create(&broken, &lattice, &all));
        for (dem_index k = 0; k < lattice.n_springs; k += 7) element_state_break_spring(&broken, k);
        for (dem_index k = 0; k < lattice.n_triangles; k += 5) element_state_break_triangle(&broken, k);
        const forces plain = {.gravity = {0.5, -9.81}, .elements = &broken};
        const forces drag = {.gravity = {0.5, -9.81}, .mass_damping = 3.0, .elements = &broken};
        CLEANUP(free_scene) scene s = make_scene(&lattice, laws & 1 ? 0.1 : 0.6);
        check_load(&s, &plain);
        check_load(&s, &drag);
    }
}

/* Triangles that soften as different materials do, every fifth of them brittle. */
static void let_soften(dem_lattice *l)
{
    l->softening = malloc((size_t)l->n_triangles * sizeof *l->softening);
    assert_non_null(l->softening);
    for (dem_index t = 0; t < l->n_triangles; t++) l->softening[t] = t % 5 == 0 ? 1.0 : 1.5 + 0.37 * (double)(t % 7);
}

static bool may_soften(const element_state *e, dem_index t)
{
    return e->lattice->softening != NULL && e->level[t] < softening_levels(e->lattice->softening[t]);
}

/* A triangle is whole, has softened between one and 32 times, or is broken, and then may have softened before. */
TEST(softened_elements_agree)
{
    for (int laws = 0; laws < 16; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        CLEANUP(springs_free) springs all;
        CLEANUP(element_state_destroy) element_state soft;
        let_soften(&lattice);
        assert_ok(springs_compile(&all, &lattice));
        assert_ok(element_state_create(&soft, &lattice, &all));
        for (dem_index t = 0; t < lattice.n_triangles; t++) {
            for (dem_index n = 0; n < t * t % 41 && t % 4 != 0 && may_soften(&soft, t); n++)
                element_state_soften(&soft, t);
            if (t % 11 == 0) element_state_break_triangle(&soft, t);
        }
        const forces plain = {.gravity = {0.5, -9.81}, .elements = &soft};
        const forces drag = {.gravity = {0.5, -9.81}, .mass_damping = 3.0, .elements = &soft};
        CLEANUP(free_scene) scene s = make_scene(&lattice, laws & 1 ? 0.1 : 0.6);
        check_load(&s, &plain);
        check_load(&s, &drag);
    }
}

/* The sweep of the whole body evaluates what is broken too, and has no number for it; a spring that is whole has none
 * either. */
TEST(the_ends_of_a_broken_spring_may_meet)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.2, 0.1, &rubber);
    CLEANUP(springs_free) springs all;
    CLEANUP(element_state_destroy) element_state broken;
    assert_ok(springs_compile(&all, &lattice));
    assert_ok(element_state_create(&broken, &lattice, &all));
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
        CLEANUP(kernel_destroy) kernel sweeps;
        const forces f = {.model = s.model, .elements = &broken};
        const kernel_state y = {.x = s.x, .v = s.v, .a = s.a};
        vec2_put(s.x, lattice.ends[2 * k], vec2_at(s.x, lattice.ends[2 * k + 1]));
        assert_ok(kernel_create(&sweeps, s.model, DEM_KERNEL_AUTO, NULL));
        assert_true(!isfinite(kernel_accelerate(&sweeps, &f, &y)));
        element_state_break_spring(&broken, k);
        assert_true(isfinite(kernel_accelerate(&sweeps, &f, &y)));
        kernel_follow(&sweeps, &broken, NULL, 0);
        assert_true(isfinite(kernel_accelerate(&sweeps, &f, &y)));
    }
}

/* A triangle softens where it may, up to three times, or breaks.  \return how many times it has been listed */
static dem_index fail_one(element_state *e, dem_index t, dem_index *list)
{
    dem_index n = 0;
    for (; n < 3 && may_soften(e, t); list[n++] = t) element_state_soften(e, t);
    if (n > 0) return n;
    element_state_break(e, t);
    list[0] = t;
    return 1;
}

/* Elements that are not broken fail, and the kernel follows, a few at a time: until hardly anything is left. In between
 * one breaks of which it does not know, and is mended. */
static void check_breaking(const dem_lattice *lattice)
{
    CLEANUP(free_scene) scene s = make_scene(lattice, 0.1);
    CLEANUP(element_state_destroy) element_state broken;
    assert_ok(element_state_create(&broken, &s.model->lattice, &s.model->springs));
    CLEANUP(kernel_destroy) kernel k;
    const forces f = {.model = s.model, .gravity = {0.5, -9.81}, .elements = &broken};
    assert_ok(kernel_create(&k, s.model, DEM_KERNEL_AUTO, s.teams[2]));
    kernel_follow(&k, &broken, NULL, 0);
    for (int round = 0; round < 16; round++) {
        dem_index list[12], n = 0, other = -1;
        for (int turn = 0; turn < 4; turn++) {
            const dem_index t = (dem_index)gsl_rng_uniform_int(s.random, (unsigned long)lattice->n_triangles);
            if (broken.triangle[t]) continue;
            n += fail_one(&broken, t, list + n);
        }
        if (n == 0) continue;
        check_evaluations(&s, &f, &k);
        kernel_follow(&k, &broken, list, n);
        assert_int_equal(k.n_trimmed, element_state_n_failures(&broken));
        check_evaluations(&s, &f, &k);
        for (dem_index t = 0; t < lattice->n_triangles && other < 0; t++)
            if (!broken.triangle[t]) other = t;
        element_state_break(&broken, other);
        check_evaluations(&s, &f, &k);
        element_state_mend(&broken, other);
        check_evaluations(&s, &f, &k);
    }
}

TEST(what_breaks_by_and_by_agrees)
{
    for (int laws = 0; laws < 16; laws++) {
        const dem_material material = law_of(laws);
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_holed(&material);
        check_breaking(&lattice);
        let_soften(&lattice);
        check_breaking(&lattice);
    }
    const dem_material cell =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0, .thickness = 1.0);
    CLEANUP(dem_lattice_free) dem_lattice squares = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&squares, 0.2, 0.13, 0.01));
    assert_ok(dem_lattice_assemble_squares(&squares, &cell, 0.5));
    check_breaking(&squares);
}

TEST(squares_agree)
{
    const dem_material raw =
        SIZED(dem_material, .bond_stiffness = 1e3, .density = 1050.0, .thickness = 1.0, .damping_time = 1e-6);
    CLEANUP(dem_lattice_free) dem_lattice lattice = dem_lattice_empty();
    assert_ok(dem_lattice_squares(&lattice, 0.2, 0.13, 0.01));
    assert_ok(dem_lattice_assemble_squares(&lattice, &raw, 0.5));
    check_lattice(&lattice, 0.2);
}

/* ---- numberings ---- */

static void swap_nodes(dem_lattice *l, const dem_index *number)
{
    CLEANUP(free_memory) double *x = copy_doubles(l->x, 2 * l->n_nodes), *mass = copy_doubles(l->mass, l->n_nodes);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        memcpy(l->x + 2 * number[i], x + 2 * i, 2 * sizeof *x);
        l->mass[number[i]] = mass[i];
    }
    for (dem_index k = 0; k < 2 * l->n_springs; k++) l->ends[k] = number[l->ends[k]];
    for (dem_index k = 0; k < 3 * l->n_triangles; k++) l->triangles[k] = number[l->triangles[k]];
}

static dem_index *shuffled(dem_index n)
{
    dem_index *number = malloc((size_t)n * sizeof *number);
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    assert_non_null(number);
    for (dem_index k = 0; k < n; k++) number[k] = k;
    for (dem_index k = n - 1; k > 0; k--) {
        const dem_index j = (dem_index)gsl_rng_uniform_int(r, (unsigned long)k + 1), kept = number[k];
        number[k] = number[j];
        number[j] = kept;
    }
    return number;
}

/* One by one nodes behind the last block are moved onto the side of a triangle; all others are at rest. */
static void fold_rest(scene *s)
{
    const layout *l = &s->model->layout;
    const triangles *t = &s->model->triangles;
    for (dem_index q = LAYOUT_LANES * l->n_blocks; q < l->n_nodes; q++) {
        const dem_index i = layout_node(l, q), p = t->row[i];
        const vec2 kept = vec2_at(s->x, i);
        vec2_put(s->x, i, vec2_scale(0.5, vec2_add(vec2_at(s->x, t->next[p]), vec2_at(s->x, t->last[p]))));
        check_load(s, &(const forces){.gravity = {0.5, -9.81}});
        vec2_put(s->x, i, kept);
    }
}

/* Where no area term acts the nodes on which the guard does are found from the lowest corners of triangles, whose other
 * corners may have places anywhere about. */
TEST(the_guard_acts_on_the_same_nodes_in_any_numbering)
{
    for (int k = 0; k < 8; k++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.6 + 0.01 * k, 0.4, &rubber);
        CLEANUP(free_memory) dem_index *number = shuffled(lattice.n_nodes);
        swap_nodes(&lattice, number);
        check_lattice(&lattice, 0.25);
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.0);
        assert_true(s.model->layout.order != NULL && !s.model->layout.stiff);
        fold_rest(&s);
    }
}

/* All but the first body have so many nodes that the model finds a better numbering for itself. */
TEST(any_numbering_agrees)
{
    for (int k = 0; k < 4; k++) {
        const int large = k > 0;
        dem_material material = rubber;
        material.poissons_ratio = 0.4;
        material.damping_time = k < 2 ? 1e-5 : 0.0;
        if (k == 3) material.springs = DEM_SPRINGS_COUPLED;
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_irregular(large ? 0.6 : 0.2, large ? 0.4 : 0.1, &material);
        assert_int_equal(lattice.coupling != NULL, k == 3);
        CLEANUP(free_memory) dem_index *number = shuffled(lattice.n_nodes);
        swap_nodes(&lattice, number);
        check_lattice(&lattice, 0.1);
        if (k == 3) check_breaking(&lattice);
        if (k == 3) let_soften(&lattice);
        if (k == 3) check_breaking(&lattice);
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
        assert_int_equal(s.model->layout.order != NULL, large);
    }
}

/* As many rows as are worth it, and fewer. */
TEST(long_rows_keep_their_numbers)
{
    for (int few = 0; few < 2; few++) {
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(10.5, few ? 0.04 : 0.12, &rubber);
        check_lattice(&lattice, 0.05);
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
        assert_int_equal(s.model->layout.order != NULL, few);
    }
}

/* Springs of stiffness and length of their own between random nodes. */
TEST(random_springs_agree)
{
    enum { n = 203, most = 4 * n };
    static double x[2 * n], mass[n], rest_length[most], stiffness[most], viscosity[most];
    static dem_index ends[2 * most];
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    dem_lattice lattice = {.struct_size = sizeof(dem_lattice),
                           .dim = 2,
                           .n_nodes = n,
                           .x = x,
                           .mass = mass,
                           .ends = ends,
                           .rest_length = rest_length,
                           .stiffness = stiffness,
                           .viscosity = viscosity};
    for (dem_index i = 0; i < n; i++) {
        x[2 * i] = 20.0 * gsl_rng_uniform(r);
        x[2 * i + 1] = 20.0 * gsl_rng_uniform(r);
        mass[i] = 1.0 + gsl_rng_uniform(r);
    }
    for (dem_index i = 0; i < n; i++)
        for (dem_index step = 1; step <= 13 && i + step < n; step += 4) {
            const dem_index k = lattice.n_springs++;
            ends[2 * k + (i & 1)] = i;
            ends[2 * k + 1 - (i & 1)] = i + step;
            rest_length[k] = 1.0 + gsl_rng_uniform(r);
            stiffness[k] = 1e3 * (1.0 + gsl_rng_uniform(r));
            viscosity[k] = gsl_rng_uniform(r);
        }
    check_lattice(&lattice, 0.01);
}

/* A wheel: one node has a spring to each other. A layout of it would take n^2 of memory, and is not made. */
TEST(a_hub_of_many_springs_agrees)
{
    const dem_index sizes[] = {40, 3000};
    for (int k = 0; k < 2; k++) {
        const dem_index n = sizes[k];
        CLEANUP(free_memory) double *x = malloc(2 * (size_t)n * sizeof *x), *mass = malloc((size_t)n * sizeof *mass);
        CLEANUP(free_memory) double *ones = malloc((size_t)n * sizeof *ones);
        CLEANUP(free_memory) dem_index *ends = malloc(2 * (size_t)n * sizeof *ends);
        assert_true(x && mass && ones && ends);
        for (dem_index i = 0; i < n; i++) {
            x[2 * i] = i == 0 ? 0.0 : cos((double)i);
            x[2 * i + 1] = i == 0 ? 0.0 : sin((double)i);
            mass[i] = ones[i] = 1.0;
            ends[2 * i] = 0;
            ends[2 * i + 1] = i + 1;
        }
        const dem_lattice lattice = {.struct_size = sizeof(dem_lattice),
                                     .dim = 2,
                                     .n_nodes = n,
                                     .n_springs = n - 1,
                                     .x = x,
                                     .mass = mass,
                                     .ends = ends,
                                     .rest_length = ones,
                                     .stiffness = ones};
        check_lattice(&lattice, 0.1);
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
        assert_int_equal(s.model->layout.n_blocks, k == 0 ? n / LAYOUT_LANES : 0);
    }
}

/* ---- what is done from outside ---- */

/* Fixed nodes stay, pushed ones are pushed, some of them twice. */
TEST(fixed_and_pushed_nodes_agree)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.2, 0.1, &rubber);
    const dem_index pushed[] = {3, 17, 40}, others[] = {17, 5};
    const dem_boundary list[] = {
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 3, .nodes = pushed, .value = {1e3, -2e3}),
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE, .n_nodes = 2, .nodes = others, .value = {5.0, 1.0})};
    CLEANUP(boundary_conditions_free) boundary_conditions pushes;
    lattice.flags = calloc((size_t)lattice.n_nodes, sizeof *lattice.flags);
    assert_non_null(lattice.flags);
    for (dem_index i = 0; i < lattice.n_nodes; i += 7) lattice.flags[i] = DEM_NODE_FIXED;
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
    assert_ok(boundary_conditions_compile(&pushes, list, 2, &s.model->lattice, NULL, 0));
    const forces load = {
        .gravity = {0.0, -9.81}, .mass_damping = 1.0, .boundaries = &pushes, .clock = lattice.n_nodes - 1};
    check_load(&s, &load);
}

/* Springs along rows only, triangles between rows: these reach further. */
TEST(triangles_may_reach_further_than_springs)
{
    const forces load = {.gravity = {0.5, -9.81}};
    dem_material material = rubber;
    material.poissons_ratio = 0.2;
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.6, 0.6, &material);
    dem_index kept = 0;
    for (dem_index k = 0; k < lattice.n_springs; k++) {
        const dem_index *ends = lattice.ends + 2 * k;
        if (ends[1] - ends[0] != 1 && ends[0] - ends[1] != 1) continue;
        memmove(lattice.ends + 2 * kept, ends, 2 * sizeof *ends);
        lattice.rest_length[kept] = lattice.rest_length[k];
        lattice.stiffness[kept++] = lattice.stiffness[k];
    }
    lattice.n_springs = kept;
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
    assert_int_equal(look_reach(&s.model->layout), 1);
    assert_true(can_fuse(&s, &load));
    check_load(&s, &load);
}

/* Not where something asks for velocities, or pushes, or the nodes are renumbered, or a body is rigid. */
TEST(what_depends_on_more_than_positions_is_not_fused)
{
    dem_index none = -1;
    const boundary_conditions pushes = {.first = &none};
    const forces plain = {.gravity = {0.5, -9.81}}, drag = {.mass_damping = 1.0}, pushed = {.boundaries = &pushes};
    for (int k = 0; k < 4; k++) {
        dem_material material = rubber;
        if (k == 1) material.damping_time = 1e-5;
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(k == 2 ? 0.6 : 0.2, k == 2 ? 0.4 : 0.1, &material);
        CLEANUP(free_memory) dem_index *number = shuffled(lattice.n_nodes);
        if (k == 2) swap_nodes(&lattice, number);
        if (k == 3) assert_ok(dem_lattice_stiffen(&lattice, DEM_GUIDE_NONE));
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
        assert_int_equal(can_fuse(&s, &plain), k == 0);
        assert_false(can_fuse(&s, &drag));
        assert_false(can_fuse(&s, &pushed));
    }
}

TEST(a_number_that_is_not_finite_shows_in_the_sum)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.2, 0.1, &rubber);
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
    const forces load = {.model = s.model, .gravity = {0.0, -9.81}};
    for (dem_kernel kind = DEM_KERNEL_PORTABLE; kind <= DEM_KERNEL_AVX512; kind++) {
        CLEANUP(kernel_destroy) kernel k;
        if (dem_kernel_check(kind) != DEM_OK) continue;
        assert_ok(kernel_create(&k, s.model, kind, s.teams[2]));
        const kernel_state y = {.x = s.x, .v = s.v, .u = s.u, .a = s.a};
        for (dem_index i = 0; i < lattice.n_nodes; i++) {
            double *const number = i % 3 == 0 ? &s.v[2 * i] : &s.x[2 * i], kept = *number;
            *number = i & 1 ? (double)NAN : (double)INFINITY;
            assert_true(!isfinite(kernel_accelerate(&k, &load, &y)));
            *number = kept;
        }
    }
}

/* ---- strains ---- */

/* Which springs of a model are visited. */
typedef struct visited_springs {
    const springs *springs;
    unsigned char *visited; /* [n_springs] */
} visited_springs;

static void note_spring(void *context, dem_index node, dem_index slot)
{
    const visited_springs *to = context;
    assert_true(slot >= to->springs->row[node] && slot < to->springs->row[node + 1]);
    to->visited[to->springs->spring[slot]] = 1;
}

/* All springs that are strained by more than their thresholds must have been visited, but for broken ones, of which
 * none is.  \return how many have been that need not */
static dem_index count_others(const scene *s, const forces *load, const kernel_threshold *threshold,
                              const unsigned char *visited)
{
    const dem_lattice *l = &s->model->lattice;
    dem_index n_others = 0;
    for (dem_index j = 0; j < l->n_springs; j++) {
        const double strain = springs_strain_of(l, j, s->x);
        const bool is_over = strain > (double)threshold[j].stretch || -strain > (double)threshold[j].squeeze;
        const bool is_whole = load->elements->integrity[j] > 0.0;
        if (is_over && is_whole) assert_true(visited[j]);
        if (!is_whole) assert_false(visited[j]);
        n_others += visited[j] && !is_over;
    }
    return n_others;
}

/* Visits where a fused step of no length ends, which has found what is strained. A second look at the positions would
 * call a function that is not there. */
static void visit_after_step(kernel *k, const scene *s, const forces *load, kernel_visitor *visit, void *context)
{
    const dem_index n = 2 * s->model->lattice.n_nodes;
    CLEANUP(free_memory) double *none = calloc((size_t)n, sizeof *none), *x1 = copy_doubles(s->v, n);
    CLEANUP(free_memory) double *v1 = copy_doubles(s->v, n);
    const sweep_fused_step fused = {0.0, s->x, s->v, none, x1, v1};
    const kernel_state y = {.x = x1, .v = v1, .a = s->a, .fused_step = &fused};
    assert_non_null(none);
    kernel_begin_step(k, &fused);
    (void)kernel_accelerate(k, load, &y);
    k->sweep_strain = NULL;
    kernel_visit_strained(k, load->elements, x1, visit, context);
}

/* Visits, and again after a fused step if one is possible.
 * \return how many are visited that need not be */
static dem_index visit_strained(const scene *s, const forces *load, const trial *of, const kernel_threshold *threshold)
{
    const size_t n = (size_t)s->model->lattice.n_springs;
    CLEANUP(free_memory) unsigned char *visited = calloc(n, 1);
    CLEANUP(kernel_destroy) kernel k = open_kernel(s, load, of);
    visited_springs to = {&s->model->springs, visited};
    assert_non_null(visited);
    assert_ok(kernel_watch(&k, threshold));
    kernel_visit_strained(&k, load->elements, s->x, note_spring, &to);
    const dem_index n_others = count_others(s, load, threshold, visited);
    if (!kernel_can_fuse(&k, load)) return n_others;
    memset(visited, 0, n);
    visit_after_step(&k, s, load, note_spring, &to);
    assert_int_equal(count_others(s, load, threshold, visited), n_others);
    return n_others;
}

static float some_threshold(const gsl_rng *random, bool infinite)
{
    return infinite ? INFINITY : (float)(0.01 / (1.01 - gsl_rng_uniform(random)));
}

/* Thresholds of about half of the strains, from 1 % to beyond 1, and infinite ones, of which none is visited. */
static void check_strained(const dem_lattice *lattice)
{
    CLEANUP(free_scene) scene s = make_scene(lattice, 0.2);
    CLEANUP(element_state_destroy) element_state broken;
    CLEANUP(free_memory) kernel_threshold *threshold = malloc((size_t)lattice->n_springs * sizeof *threshold);
    const forces load = {.model = s.model, .elements = &broken};
    assert_non_null(threshold);
    assert_ok(element_state_create(&broken, &s.model->lattice, &s.model->springs));
    for (dem_index t = 0; t < lattice->n_triangles; t += 5) element_state_break(&broken, t);
    for (dem_kernel kind = DEM_KERNEL_PORTABLE; kind <= DEM_KERNEL_AVX512; kind++)
        for (int k = 0; k < 6; k++) {
            const trial of = {kind, k % 3 + 1, k >= 3};
            if (dem_kernel_check(kind) != DEM_OK) continue;
            for (dem_index j = 0; j < lattice->n_springs; j++)
                threshold[j] =
                    (kernel_threshold){some_threshold(s.random, j % 7 == 0), some_threshold(s.random, j % 5 == 0)};
            (void)visit_strained(&s, &load, &of, threshold);
            for (dem_index j = 0; j < lattice->n_springs; j++) threshold[j] = (kernel_threshold){INFINITY, INFINITY};
            assert_int_equal(visit_strained(&s, &load, &of, threshold), 0);
        }
}

TEST(ends_of_springs_that_are_strained_are_visited)
{
    for (int k = 0; k < 4; k++) {
        dem_material material = rubber;
        if (k & 1) material.springs = DEM_SPRINGS_COUPLED;
        CLEANUP(dem_lattice_free) dem_lattice lattice = make_irregular(k < 2 ? 0.2 : 0.6, k < 2 ? 0.1 : 0.4, &material);
        CLEANUP(free_memory) dem_index *number = shuffled(lattice.n_nodes);
        if (k >= 2) swap_nodes(&lattice, number);
        check_strained(&lattice);
    }
}

/* A uniform strain just above and just below the only thresholds, in tension and compression. */
TEST(a_threshold_parts_strains)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.2, 0.1, &rubber);
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.0);
    CLEANUP(element_state_destroy) element_state broken;
    CLEANUP(free_memory) kernel_threshold *threshold = malloc((size_t)lattice.n_springs * sizeof *threshold);
    const forces load = {.model = s.model, .elements = &broken};
    assert_non_null(threshold);
    assert_ok(element_state_create(&broken, &s.model->lattice, &s.model->springs));
    for (dem_index j = 0; j < lattice.n_springs; j++) threshold[j] = (kernel_threshold){1e-3f, 2e-3f};
    for (int k = 0; k < 4; k++) {
        const trial of = {DEM_KERNEL_AUTO, 1, false};
        const double strain = (k & 1 ? -2e-3 : 1e-3) * (k & 2 ? 1.0 + 1e-6 : 1.0 - 1e-6);
        for (dem_index c = 0; c < 2 * lattice.n_nodes; c++) s.x[c] = lattice.x[c] * (1.0 + strain);
        assert_int_equal(visit_strained(&s, &load, &of, threshold), 0);
    }
}

/* ---- what the guard stiffens ---- */

/* A triangle squeezed to a fifth along y: J = 0.2, ln(J/0.4) = -ln 2. Opposite to node 2 is the side of 1 m, to node 1
 * the diagonal, to node 0 the side of 0.2 m; each in turn is so light that it decides. What the guard adds stands
 * beside omega_max^2. */
TEST(the_guard_stiffens_what_it_squeezes)
{
    double rest[6] = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0}, mass[3] = {1.0, 2.0, 3.0}, length[2] = {1.0, 1.0};
    double stiffness[2] = {10.0, 10.0}, guard[1] = {10.0};
    dem_index ends[4] = {0, 1, 1, 2}, corners[3] = {0, 1, 2};
    const double x[6] = {0.0, 0.0, 1.0, 0.0, 1.0, 0.2}, L = log(2.0), J = 0.2, A0 = 0.5;
    const double w1 = 3.0 * L * L / J, w2 = (6.0 * L + 3.0 * L * L) / (J * J);
    const double side[3] = {0.2 * 0.2, 1.0 + 0.2 * 0.2, 1.0};
    const dem_lattice lattice = {.struct_size = sizeof(dem_lattice),
                                 .dim = 2,
                                 .n_nodes = 3,
                                 .n_springs = 2,
                                 .n_triangles = 1,
                                 .x = rest,
                                 .mass = mass,
                                 .ends = ends,
                                 .rest_length = length,
                                 .stiffness = stiffness,
                                 .triangles = corners,
                                 .guard = guard};
    for (int light = -1; light < 3; light++) {
        double added = 0.0;
        for (int i = 0; i < 3; i++) mass[i] = i == light ? 0.1 : 1.0 + i;
        for (int i = 0; i < 3 && light >= 0; i++)
            added = fmax(added, 10.0 * (3.0 * w2 * 0.25 * side[i] / A0 + 0.5 * sqrt(3.0) * w1) / mass[i]);
        guard[0] = light < 0 ? 0.0 : 10.0;
        CLEANUP(free_scene) scene s = make_scene(&lattice, 0.0);
        CLEANUP(kernel_destroy) kernel k;
        const double omega = dem_model_omega_max(s.model);
        assert_ok(kernel_create(&k, s.model, DEM_KERNEL_AUTO, NULL));
        assert_close(kernel_stiffening(&k, &whole, rest), 1.0, 0.0);
        assert_close(kernel_stiffening(&k, &whole, x), sqrt(1.0 + added / (omega * omega)), 1e-12);
    }
}

/* ---- names ---- */

TEST(kernels_have_names)
{
    dem_kernel kind;
    for (dem_kernel k = DEM_KERNEL_AUTO; k <= DEM_KERNEL_AVX512; k++) {
        assert_ok(dem_kernel_find(&kind, dem_kernel_name(k)));
        assert_int_equal(kind, k);
    }
    assert_null(dem_kernel_name((dem_kernel)99));
    assert_int_equal(dem_kernel_find(&kind, "abacus"), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_kernel_find(NULL, "auto"), DEM_ERROR_ARGUMENT);
    assert_int_equal(dem_kernel_check((dem_kernel)99), DEM_ERROR_ARGUMENT);
    assert_ok(dem_kernel_check(DEM_KERNEL_AUTO));
    assert_ok(dem_kernel_check(DEM_KERNEL_PORTABLE));
}

TEST(the_choice_left_open_is_the_last_that_runs)
{
    CLEANUP(dem_lattice_free) dem_lattice lattice = make_solid(0.05, 0.05, &rubber);
    CLEANUP(free_scene) scene s = make_scene(&lattice, 0.1);
    kernel k;
    assert_ok(kernel_create(&k, s.model, DEM_KERNEL_AUTO, NULL));
    assert_ok(dem_kernel_check(k.kind));
    assert_true(k.kind != DEM_KERNEL_AUTO);
    assert_true(k.kind == DEM_KERNEL_AVX512 || dem_kernel_check(k.kind + 1) == DEM_ERROR_ARGUMENT);
    kernel_destroy(&k);
    assert_int_equal(kernel_create(&k, s.model, (dem_kernel)99, NULL), DEM_ERROR_ARGUMENT);
}
