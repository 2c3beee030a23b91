/* SPDX-License-Identifier: BSD-3-Clause */
/* utilisation.c: what drives triangles of irregular meshes in uniform tension; when one breaks by its own stress, and
 * when by those of its corners. More of that is in test_fracture_source.c and, under pressure, in
 * tests/verification/test_pressed.c. */
#include "verification/support.h"

#include <stdlib.h>
#include <string.h>

#include "fracture/utilisation.h"

/* The largest and the mean utilisation of a block with `jitter`, which is stretched by 1e-5 along y and as much less
 * wide as tension along y makes it: half of the strength, up to strains squared. Every so many triangles are driven by
 * their own stress, none for 0. */
static void stretch(dem_springs rule, dem_index own_every, double *largest, double *mean)
{
    const dem_material solid = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = 1e9,
                                .poissons_ratio = 0.2,
                                .density = 1e3,
                                .thickness = 0.5,
                                .springs = rule,
                                .strength = 2e4};
    CLEANUP(dem_lattice_free) dem_lattice block = dem_lattice_empty();
    CLEANUP(element_state_destroy) element_state state;
    assert_ok(dem_lattice_rectangle(&block, 0.1, 0.12, 0.01));
    assert_ok(dem_lattice_jitter(&block, 0.0025, 3));
    assert_ok(dem_lattice_assemble(&block, &solid));
    const dem_index n = block.n_triangles;
    double *x = malloc(2 * (size_t)block.n_nodes * sizeof *x);
    block.own_stress = calloc((size_t)n, 1);
    assert_true(block.own_stress != NULL && x != NULL);
    for (dem_index t = 0; own_every > 0 && t < n; t += own_every) block.own_stress[t] = 1;
    for (dem_index k = 0; k < 2 * block.n_nodes; k++) x[k] = block.x[k] * (k % 2 ? 1.0 + 1e-5 : 1.0 - 0.2e-5);
    dem_model *model = support_model(&block, NULL, 0);
    assert_ok(stress_prepare(&model->stress));
    assert_ok(element_state_create(&state, &model->lattice, &model->springs));
    *largest = *mean = 0.0;
    for (dem_index t = 0; t < n; t++) {
        const double found = utilisation_of(model, &state, t, x);
        *largest = fmax(*largest, found);
        *mean += found / (double)n;
    }
    free(x);
    dem_model_destroy(model);
}

/* Coupled springs make every triangle exactly of its material, so that an irregular mesh is as strong as a regular one,
 * by either stress. 1e-4: strains squared are 1e-5 of strains. */
TEST(coupled_springs_drive_all_triangles_alike_in_uniform_tension)
{
    double largest, mean;
    stretch(DEM_SPRINGS_COUPLED, 2, &largest, &mean);
    assert_close(mean, 0.5, 1e-4);
    assert_close(largest, mean, 1e-4);
}

/* docs/fracture.md has 1.25, which depends on the seed. */
TEST(independent_springs_scatter_in_uniform_tension)
{
    double largest, mean;
    stretch(DEM_SPRINGS_INDEPENDENT, 0, &largest, &mean);
    assert_close(largest / mean, 1.25, 0.1);
}

/* Two triangles of springs of 1 N and 1 m that share a side, along x. All nodes are held but the outer corner of the
 * second, which is led away at 0.1 m/s: both of its springs get longer alike, and with l their length, h its height the
 * stress is xx = 2 (l - 1) (1/4)/l over its volume A, yy = 2 (l - 1) h h/l. */
static const double rate = 0.1, area = 0.4330127018922193;

static double rhomb_stress(double t)
{
    const double height = 0.5 * sqrt(3.0) + rate * t, length = sqrt(0.25 + height * height);
    return 2.0 * (length - 1.0) * height * height / length / area;
}

/* When `share` of its stress reaches a strength. */
static double due(double share, double strength)
{
    double before = 0.0, after = 2.0;
    for (int k = 0; k < 60; k++) {
        const double t = 0.5 * (before + after);
        *(share * rhomb_stress(t) < strength ? &before : &after) = t;
    }
    return after;
}

typedef struct heard {
    double t[2]; /* s, at which each broke; 0: it did not */
    double stress[2];
} heard;

static dem_status on_break(void *context, const dem_simulation *simulation, const dem_break *what)
{
    heard *h = context;
    (void)simulation;
    h->t[what->triangle] = what->t;
    h->stress[what->triangle] = what->stress[1];
    return DEM_OK;
}

static void pull_rhomb(bool own, double strength, dem_contact_method contact, heard *h)
{
    const double x[8] = {0.0, 0.0, 1.0, 0.0, 0.5, -0.5 * sqrt(3.0), 0.5, 0.5 * sqrt(3.0)};
    const double masses[4] = {1.0, 1.0, 1.0, 1.0};
    const dem_index ends[10] = {0, 1, 1, 2, 2, 0, 0, 3, 3, 1}, corners[6] = {0, 2, 1, 0, 1, 3},
                    numbers[4] = {0, 1, 2, 3};
    CLEANUP(dem_lattice_free) dem_lattice rhomb = support_lattice(4, x, masses, 5, ends, 1.0, 1.0, NULL);
    rhomb.n_triangles = 2;
    rhomb.triangles = malloc(sizeof corners);
    rhomb.strength = malloc(2 * sizeof *rhomb.strength);
    rhomb.own_stress = malloc(2);
    assert_true(rhomb.triangles && rhomb.strength && rhomb.own_stress);
    memcpy(rhomb.triangles, corners, sizeof corners);
    memset(rhomb.own_stress, own, 2);
    rhomb.strength[0] = rhomb.strength[1] = strength;
    const dem_boundary led[2] = {
        SIZED(dem_boundary, .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = 3, .nodes = numbers),
        SIZED(dem_boundary, .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = 1, .nodes = &numbers[3],
              .value = {0.0, rate})};
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = 1e-12;
    options.contact = contact;
    options.n_boundaries = 2;
    options.boundaries = led;
    const dem_observer observer = SIZED(dem_observer, .broken = on_break, .context = h);
    CLEANUP(support_close) support_run run;
    support_open(&run, &rhomb, NULL, 0, &options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    (void)support_at(&run, 1.0);
}

/* The side that both share is not strained: by its own stress the first does not break, and the second does at once
 * when its stress is its strength. Its corners have half of it where both triangles are, so that their mean is 2/3. The
 * times to what rtol 1e-12 leaves. */
TEST(a_triangle_breaks_by_the_stress_that_it_is_to_break_by)
{
    const dem_contact_method ways[2] = {DEM_CONTACT_LOCAL, DEM_CONTACT_EXACT};
    const double strength = 0.1;
    for (int k = 0; k < 2; k++) {
        heard own = {{0.0, 0.0}, {0.0, 0.0}}, mean = own;
        pull_rhomb(true, strength, ways[k], &own);
        pull_rhomb(false, strength, ways[k], &mean);
        assert_close(own.t[0], 0.0, 0.0);
        assert_close(own.t[1], due(1.0, strength), 1e-10);
        assert_close(own.stress[1], strength, 1e-10);
        assert_close(mean.t[1], due(2.0 / 3.0, strength), 1e-10);
        assert_close(mean.stress[1], strength, 1e-10);
    }
}
