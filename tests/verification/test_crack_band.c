/* SPDX-License-Identifier: BSD-3-Clause */
/* Toughness and path of a crack where triangles soften: a clamped strip with an edge crack is pulled slowly, with a
 * drag that takes the waves of softening away. It has to go on at the fracture energy that was asked for, along a
 * straight path whatever the direction of the rows. `long` as argument: more softening, more meshes. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "strip_mesh.h"

static const double spacing = CLAMPED_STRIP_SPACING, c = CLAMPED_STRIP_SPEED;
enum { WIDE = 70, HIGH = 44, CRACK = 22, GONE = 12 }; /* spacings */

typedef struct band_case {
    double q;
    strip_mesh mesh;
    double most_angle; /* degrees, of the path */
} band_case;

typedef struct band {
    clamped_strip strip;
    double start, speed; /* m, m/s: of what parts the sides */
    double tip, gone;    /* m; m, by which they had parted when the tip had gone three spacings */
    double n, x, y, xx, xy;
} band;

/* G E/(strength^2 a). */
static double toughness_asked(double q)
{
    return 2.0 + 1.07 * q;
}

static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    band *b = context;
    (void)s;
    if (what->t == 0.0) return DEM_OK;
    b->n += 1.0;
    b->x += what->x[0];
    b->y += what->x[1];
    b->xx += what->x[0] * what->x[0];
    b->xy += what->x[0] * what->x[1];
    b->tip = fmax(b->tip, what->x[0]);
    if (b->gone == 0.0 && b->tip > b->strip.begin + (CRACK + 3) * spacing) b->gone = b->start + b->speed * what->t;
    return b->tip > b->strip.begin + (CRACK + GONE) * spacing ? DEM_STOPPED : DEM_OK;
}

static double direction(const band *b)
{
    return atan((b->n * b->xy - b->x * b->y) / (b->n * b->xx - b->x * b->x)) / M_PI * 180.0;
}

static void pull(band *b, dem_lattice *l, support_run *run)
{
    dem_options options = dem_options_default();
    dem_boundary sides[2];
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note, .context = b};
    clamped_strip_hold(&b->strip, b->speed, sides);
    clamped_strip_stretch(&b->strip, l, b->start);
    options.gravity[1] = 0.0;
    options.method = DEM_METHOD_VERLET;
    options.mass_damping = 2.0 * M_PI * c / b->strip.height;
    options.n_boundaries = 2;
    options.boundaries = sides;
    support_open(run, l, NULL, 0, &options);
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

static void check_case(const band_case *k)
{
    const double nu = 1.0 / 3.0;
    dem_material solid = clamped_strip_material(false, nu);
    CLEANUP(dem_lattice_free) dem_lattice l = strip_mesh_make(WIDE, HIGH, &k->mesh);
    CLEANUP(support_close) support_run run;
    solid.fracture_energy = toughness_asked(k->q) * solid.strength * solid.strength * spacing / solid.youngs_modulus;
    assert_ok(dem_lattice_assemble(&l, &solid));
    band b = {.strip = clamped_strip_of(&l)};
    const double unit = clamped_strip_unit(&b.strip, nu);
    const double parted = b.strip.height * sqrt(toughness_asked(k->q) * unit), last = 10000.0 * spacing / c;
    b.tip = b.strip.begin;
    b.start = 0.9 * parted;
    b.speed = parted / last;
    pull(&b, &l, &run);
    clamped_strip_cut(&b.strip, run.simulation, &l, b.strip.begin, b.strip.begin + CRACK * spacing);
    assert_int_equal(dem_simulation_advance(run.simulation, last), DEM_STOPPED);
    const double found = b.gone * b.gone / (b.strip.height * b.strip.height) / unit;
    assert_close(found, toughness_asked(k->q), 0.05 * found);
    assert_true(fabs(direction(&b)) < k->most_angle);
    clamped_strip_free(&b.strip);
}

static void check(const band_case *list, size_t n)
{
    for (size_t k = 0; k < n; k++) check_case(&list[k]);
}

/* Found: 4.02 (4.14), 5.20 (5.21). */
TEST(a_crack_takes_the_fracture_energy)
{
    const band_case list[] = {{2.0, {0.0, 0.0, true}, 1.5}, {3.0, {30.0, 0.0, true}, 1.5}};
    check(list, sizeof list / sizeof *list);
}

/* Found: 4.27, 4.29 (4.14); 4.98 (5.21); 8.47, 8.76, 8.64 (8.42). The crack that would follow a row at 15 degrees if it
 * were brittle is off straight by 1.9 degrees at q = 6, by 0.3 at 2. */
static void of_regular_meshes(void **state)
{
    const band_case list[] = {{2.0, {15.0, 0.0, true}, 1.5}, {2.0, {30.0, 0.0, true}, 1.5},
                              {3.0, {0.0, 0.0, true}, 1.5},  {6.0, {0.0, 0.0, true}, 1.5},
                              {6.0, {15.0, 0.0, true}, 2.5}, {6.0, {30.0, 0.0, true}, 1.5}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

/* Found: 5.26, 5.07 (5.21). */
static void of_irregular_meshes(void **state)
{
    const band_case list[] = {{3.0, {15.0, 0.25, true}, 1.5}, {3.0, {0.0, 0.0, false}, 6.0}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) {
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_regular_meshes), 1000);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_irregular_meshes), 1001);
    }
    return test_run();
}
