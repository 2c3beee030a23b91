/* SPDX-License-Identifier: BSD-3-Clause */
/* Toughness and path of a crack where triangles soften: a clamped strip with an edge crack is pulled slowly, with a
 * drag that takes the waves of softening away. It has to go on at the fracture energy that was asked for, along a
 * straight path whatever the direction of the rows, and whatever the spacing. `long` as argument: more softening, more
 * meshes, finer ones. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "strip_mesh.h"

static const double spacing = CLAMPED_STRIP_SPACING, c = CLAMPED_STRIP_SPEED, nu = 1.0 / 3.0;
enum { WIDE = 70, HIGH = 44, CRACK = 22, GONE = 12 }; /* spacings */

/* A lattice knows no length but its spacing: a body at half the spacing is one of twice as many spacings, which takes
 * twice as many strength^2 a/E for the same fracture energy. */
typedef struct band_case {
    double size;      /* by which WIDE, HIGH, CRACK, GONE and `toughness` are multiplied */
    double toughness; /* G E/(strength^2 a) that is asked for at size 1 */
    bool alone;       /* the fracture energy is given without a strength: triangles are brittle */
    strip_mesh mesh;
    double most_angle, tolerance; /* degrees, of the path; of the toughness */
    bool own;                     /* triangles soften by their own stress */
} band_case;

typedef struct band {
    clamped_strip strip;
    double start, speed;    /* m, m/s: of what parts the sides */
    double nearer, further; /* m: places of the tip where the load is read, and where it ends */
    double tip, gone;       /* m; m, by which they had parted when the tip had gone three spacings */
    double n, x, y, xx, xy;
} band;

/* G E/(strength^2 a) by the softening. */
static double softened(double q)
{
    return q < 6.0 ? 2.0 + 1.07 * q : 8.42 + 1.29 * (q - 6.0);
}

static double softened_by_own(double q)
{
    return 0.2 + 0.48 * q;
}

static double asked(const band_case *k)
{
    return k->size * k->toughness;
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
    if (b->gone == 0.0 && b->tip > b->nearer) b->gone = b->start + b->speed * what->t;
    return b->tip > b->further ? DEM_STOPPED : DEM_OK;
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

static dem_lattice assemble(const band_case *k)
{
    dem_material solid = clamped_strip_material(false, nu);
    dem_lattice l = strip_mesh_make(k->size * WIDE, k->size * HIGH, &k->mesh);
    solid.fracture_energy = asked(k) * solid.strength * solid.strength * spacing / solid.youngs_modulus;
    if (k->alone) solid.strength = 0.0;
    if (k->own) solid.stress_average = DEM_STRESS_AVERAGE_ELEMENT;
    assert_ok(dem_lattice_assemble(&l, &solid));
    return l;
}

static void check_case(const band_case *k)
{
    CLEANUP(dem_lattice_free) dem_lattice l = assemble(k);
    CLEANUP(support_close) support_run run;
    band b = {.strip = clamped_strip_of(&l)};
    const double unit = clamped_strip_unit(&b.strip, nu), crack = b.strip.begin + k->size * CRACK * spacing;
    const double parted = b.strip.height * sqrt(asked(k) * unit),
                 last = (k->alone ? 20000.0 : 10000.0) * k->size * spacing / c;
    b.tip = b.strip.begin;
    b.nearer = crack + 3.0 * k->size * spacing;
    b.further = crack + GONE * k->size * spacing;
    b.start = 0.9 * parted;
    b.speed = parted / last;
    pull(&b, &l, &run);
    clamped_strip_cut(&b.strip, run.simulation, &l, b.strip.begin, crack);
    assert_int_equal(dem_simulation_advance(run.simulation, last), DEM_STOPPED);
    const double found = b.gone * b.gone / (b.strip.height * b.strip.height) / unit;
    assert_close(found, asked(k), k->tolerance * asked(k));
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
    const band_case list[] = {{1.0, softened(2.0), false, {0.0, 0.0, true}, 1.5, 0.05, false},
                              {1.0, softened(3.0), false, {30.0, 0.0, true}, 1.5, 0.05, false}};
    check(list, sizeof list / sizeof *list);
}

/* Found: 0.958, 0.917 of what was asked for: a crack of 11 spacings is short. */
TEST(a_crack_takes_the_fracture_energy_at_twice_the_spacing)
{
    const band_case list[] = {{0.5, 3.4, true, {0.0, 0.0, true}, 1.5, 0.10, false},
                              {0.5, 8.4, false, {0.0, 0.0, true}, 1.5, 0.10, false}};
    check(list, sizeof list / sizeof *list);
}

/* The same body at the spacing of the other tests, and at half of it. Found: 1.017, 1.044, 1.006, 1.022 of what was
 * asked for; at rest a brittle crack of twice as many spacings needs 3.51 instead of 3.40, too (test_strip.c). */
static void at_finer_spacings(void **state)
{
    const band_case list[] = {{1.0, 3.4, true, {0.0, 0.0, true}, 1.5, 0.05, false},
                              {2.0, 3.4, true, {0.0, 0.0, true}, 1.5, 0.05, false},
                              {1.0, 8.4, false, {0.0, 0.0, true}, 1.5, 0.05, false},
                              {2.0, 8.4, false, {0.0, 0.0, true}, 1.5, 0.05, false}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

/* Found: 4.27, 4.29 (4.14); 4.98 (5.21); 8.47, 8.76, 8.64 (8.42). The crack that would follow a row at 15 degrees if it
 * were brittle is off straight by 1.9 degrees at q = 6, by 0.3 at 2. */
static void of_regular_meshes(void **state)
{
    const band_case list[] = {{1.0, softened(2.0), false, {15.0, 0.0, true}, 1.5, 0.05, false},
                              {1.0, softened(2.0), false, {30.0, 0.0, true}, 1.5, 0.05, false},
                              {1.0, softened(3.0), false, {0.0, 0.0, true}, 1.5, 0.05, false},
                              {1.0, softened(6.0), false, {0.0, 0.0, true}, 1.5, 0.05, false},
                              {1.0, softened(6.0), false, {15.0, 0.0, true}, 2.5, 0.05, false},
                              {1.0, softened(6.0), false, {30.0, 0.0, true}, 1.5, 0.05, false}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

/* Found: 5.26, 5.07 (5.21). */
static void of_irregular_meshes(void **state)
{
    const band_case list[] = {{1.0, softened(3.0), false, {15.0, 0.25, true}, 1.5, 0.05, false},
                              {1.0, softened(3.0), false, {0.0, 0.0, false}, 6.0, 0.05, false}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

/* Where their own stress lets triangles soften irregular meshes take what is asked to 13 %, and cracks keep to what is
 * left of rows. Found: 2.73 (3.08). */
TEST(a_crack_takes_about_the_fracture_energy_by_the_stress_of_elements)
{
    const band_case list[] = {{1.0, softened_by_own(6.0), false, {0.0, 0.25, true}, 1.5, 0.13, true}};
    check(list, sizeof list / sizeof *list);
}

/* Found: 2.87, 3.32 (3.08), 5.57 (5.96); 15.5, 9.2, 15.5 degrees off straight. */
static void of_own_stress(void **state)
{
    const band_case list[] = {{1.0, softened_by_own(6.0), false, {15.0, 0.25, true}, 17.0, 0.13, true},
                              {1.0, softened_by_own(6.0), false, {30.0, 0.25, true}, 17.0, 0.13, true},
                              {1.0, softened_by_own(12.0), false, {15.0, 0.25, true}, 17.0, 0.13, true}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) {
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_regular_meshes), 1000);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_irregular_meshes), 1001);
        test_add(&(struct CMUnitTest)cmocka_unit_test(at_finer_spacings), 1002);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_own_stress), 1003);
    }
    return test_run();
}
