/* SPDX-License-Identifier: BSD-3-Clause */
/* Toughness and path of a crack where triangles soften: a clamped strip with an edge crack is pulled slowly, with a
 * drag that takes the waves of softening away. It has to go on at the fracture energy that was asked for, along a
 * straight path whatever the direction of the rows, and whatever the spacing. `long` as argument: more softening, more
 * meshes, finer ones, and squares. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"
#include "strip_mesh.h"

static const double spacing = CLAMPED_STRIP_SPACING, c = CLAMPED_STRIP_SPEED, third = 1.0 / 3.0;
enum { WIDE = 70, HIGH = 44, CRACK = 22, BESIDE = 8 }; /* spacings */

/* Triangles that soften by the mean of their corners' stresses, or by their own, and squares, whose a is 1.075 of their
 * sides: the edge of the equilateral triangle that is half as large. Rows of squares are at 0 or at 45 degrees. */
typedef enum band_kind { CORNERS, OWN, SQUARES } band_kind;

/* A lattice knows no length but its spacing: a body at half the spacing is one of twice as many spacings, which takes
 * twice as many strength^2 a/E for the same fracture energy. */
typedef struct band_case {
    double size;      /* by which lengths and `toughness` are multiplied */
    double toughness; /* G E/(strength^2 a) that is asked for at size 1 */
    bool alone;       /* the fracture energy is given without a strength: triangles are brittle */
    strip_mesh mesh;
    double most_angle, tolerance; /* degrees, of the path; of the toughness */
    band_kind kind;
    double nu; /* Poisson's ratio */
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

static double of_squares(double q)
{
    return q < 2.0 ? 2.8 + 0.5 * q : q < 3.0 ? 1.8 + q : 1.2 + 1.2 * q;
}

static double asked(const band_case *k)
{
    return k->size * k->toughness;
}

/* a, m. */
static double edge(const band_case *k)
{
    return k->kind == SQUARES ? sqrt(2.0 / sqrt(3.0)) * spacing : spacing;
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

/* Degrees towards the upper side, of the straight line through what has broken, least squares. */
static double direction(const band *b)
{
    return atan((b->n * b->xy - b->x * b->y) / (b->n * b->xx - b->x * b->x)) / M_PI * 180.0;
}

static void pull(band *b, dem_lattice *l, double step, support_run *run)
{
    dem_options options = dem_options_default();
    dem_boundary sides[2];
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note, .context = b};
    clamped_strip_hold(&b->strip, b->speed, sides);
    clamped_strip_stretch(&b->strip, l, b->start);
    options.gravity[1] = 0.0;
    options.method = DEM_METHOD_VERLET;
    options.max_step = step;
    options.mass_damping = 2.0 * M_PI * c / b->strip.height;
    options.n_boundaries = 2;
    options.boundaries = sides;
    support_open(run, l, NULL, 0, &options);
    assert_ok(dem_simulation_observe(run->simulation, &observer));
}

static dem_lattice assemble(const band_case *k, bool breaks)
{
    const double wide = k->size * WIDE, high = k->size * HIGH;
    dem_material solid = clamped_strip_material(false, k->nu);
    if (breaks) solid.fracture_energy = asked(k) * solid.strength * solid.strength * edge(k) / solid.youngs_modulus;
    if (k->alone || !breaks) solid.strength = 0.0;
    if (k->kind == OWN) solid.stress_average = DEM_STRESS_AVERAGE_ELEMENT;
    if (k->kind != SQUARES) {
        dem_lattice l = strip_mesh_make(wide, high, &k->mesh);
        assert_ok(dem_lattice_assemble(&l, &solid));
        return l;
    }
    dem_lattice l = strip_mesh_squares(wide, high, k->mesh.angle > 0.0);
    solid.springs = DEM_SPRINGS_INDEPENDENT;
    assert_ok(dem_lattice_assemble_squares(&l, &solid, 0.5));
    return l;
}

/* Between two sides the crack is through one row of squares, or two of turned ones, which hang together at corners. */
static clamped_strip strip_of(const band_case *k, const dem_lattice *l)
{
    clamped_strip s = clamped_strip_of(l);
    const double row = k->mesh.angle > 0.0 ? sqrt(0.5) * spacing : spacing;
    if (k->kind == SQUARES) s.middle = s.bottom + (floor(0.5 * round(s.height / row)) + 0.5) * row;
    return s;
}

/* Breaks both halves of the squares in these rows, or what triangles the middle line crosses, up to there. */
static void cut(const band_case *k, const band *b, dem_simulation *simulation, const dem_lattice *l, double to)
{
    dem_index *list = calloc((size_t)l->n_triangles, sizeof *list), n = 0;
    assert_non_null(list);
    for (dem_index t = 0; k->kind == SQUARES && t < l->n_triangles; t++) {
        const double x = 0.5 * (clamped_strip_centre(l, t, 0) + clamped_strip_centre(l, t ^ 1, 0)),
                     y = 0.5 * (clamped_strip_centre(l, t, 1) + clamped_strip_centre(l, t ^ 1, 1));
        if (fabs(y - b->strip.middle) < 0.4 * spacing && x < to) list[n++] = t;
    }
    if (k->kind == SQUARES)
        assert_ok(dem_simulation_break(simulation, list, n, NULL, 0));
    else
        clamped_strip_cut(&b->strip, simulation, l, b->strip.begin, to);
    free(list);
}

/* J, of a strip at rest, with a crack to there. */
static double energy_at_rest(const band_case *k, double parted, double crack)
{
    CLEANUP(dem_lattice_free) dem_lattice l = assemble(k, false);
    CLEANUP(support_close) support_run run;
    band b = {.strip = strip_of(k, &l), .start = parted};
    pull(&b, &l, 0.0, &run);
    cut(k, &b, run.simulation, &l, b.strip.begin + crack);
    assert_ok(dem_simulation_advance(run.simulation, 12.0 * b.strip.height / (M_PI * c)));
    const dem_energy e = ask_energy(run.simulation);
    clamped_strip_free(&b.strip);
    return e.elastic + e.area;
}

/* (D/H)^2 in which G is 1 E limit^2 a. Teeth at the sides are soft, so that of squares G is what a strip at rest loses
 * while a crack goes on by eight squares, past the place where the load is read. */
static double unit_of(const band_case *k, const clamped_strip *s)
{
    if (k->kind != SQUARES) return clamped_strip_unit(s, k->nu);
    const double step = (k->mesh.angle > 0.0 ? sqrt(2.0) : 1.0) * spacing, at = (CRACK + 3) * spacing;
    const double parted = CLAMPED_STRIP_LIMIT * s->height;
    const double lost = energy_at_rest(k, parted, at - 4.0 * step) - energy_at_rest(k, parted, at + 4.0 * step);
    return CLAMPED_STRIP_MODULUS * pow(CLAMPED_STRIP_LIMIT, 4.0) * edge(k) * 8.0 * step / lost;
}

/* Spacings, by which a crack grows: in a mesh without rows it wanders, and beside rows at 15 degrees, which a brittle
 * crack follows, one spacing to a side over 12 of them would be 5 degrees. */
static double way(const band_case *k)
{
    const bool follows = k->kind == CORNERS && k->mesh.angle == 15.0 && k->mesh.jitter == 0.0;
    return !k->mesh.rows || follows ? fmax(24.0, 12.0 * k->size) : 12.0 * k->size;
}

/* In a mesh without rows what is far from a path stays whole, so that no time is lost with looking at it: within 15
 * degrees of straight the path ends 6.4 spacings beside the middle. */
static void strengthen(const band_case *k, const clamped_strip *s, dem_lattice *l)
{
    const double end = s->begin + (k->size * (CRACK + BESIDE) + way(k)) * spacing;
    if (k->kind == SQUARES) clamped_strip_strengthen(s, l); /* teeth would break, too */
    for (dem_index t = 0; !k->mesh.rows && t < l->n_triangles; t++)
        if (fabs(clamped_strip_centre(l, t, 1) - s->middle) > BESIDE * k->size * spacing ||
            clamped_strip_centre(l, t, 0) > end)
            l->strength[t] *= 1e3;
}

/* What a crack took, over what was asked for, and where it went. */
typedef struct grown {
    double toughness, angle; /* degrees */
} grown;

/* The load grows by the whole of itself in `slow` 10000 a/c of a strip of size 1. */
static grown grow(const band_case *k, double slow)
{
    CLEANUP(dem_lattice_free) dem_lattice l = assemble(k, true);
    CLEANUP(support_close) support_run run;
    band b = {.strip = strip_of(k, &l)};
    strengthen(k, &b.strip, &l);
    const double unit = unit_of(k, &b.strip), crack = b.strip.begin + k->size * CRACK * spacing;
    const double parted = b.strip.height * sqrt(asked(k) * unit),
                 last = slow * (k->alone ? 20000.0 : 10000.0) * k->size * spacing / c;
    b.tip = b.strip.begin;
    b.nearer = crack + 3.0 * k->size * spacing;
    b.further = crack + way(k) * spacing;
    b.start = (k->mesh.rows ? 0.9 : 0.96) * parted;
    b.speed = parted / last;
    pull(&b, &l, k->mesh.rows ? 0.0 : clamped_strip_long_step(&l), &run);
    cut(k, &b, run.simulation, &l, crack);
    assert_int_equal(dem_simulation_advance(run.simulation, last), DEM_STOPPED);
    const double found = b.gone * b.gone / (b.strip.height * b.strip.height) / unit;
    clamped_strip_free(&b.strip);
    print_message("# %.2f for %.2f: %.4f; %.1f degrees\n", found, asked(k), found / asked(k), direction(&b));
    return (grown){found / asked(k), direction(&b)};
}

static grown check_case(const band_case *k, double slow)
{
    const grown g = grow(k, slow);
    assert_close(g.toughness, 1.0, k->tolerance);
    assert_true(fabs(g.angle) < k->most_angle);
    return g;
}

static void check(const band_case *list, size_t n)
{
    for (size_t k = 0; k < n; k++) (void)check_case(&list[k], 1.0);
}

/* Found: 4.02 (4.14), 5.20 (5.21). Drag and inertia add in proportion to the load's speed: 0.9834, 0.9717, 0.9656,
 * 0.9628 of what was asked for in the first strip if it grows in 5000, 10000, 20000, 40000 a/c, so 0.9600 infinitely
 * slowly. The first two tell that to 0.2 %; a fracture energy that is off by 1 % makes it 1 %. The second strip has
 * 1.014 in 5000 a/c, and 0.999 in twice the time. */
TEST(a_crack_takes_the_fracture_energy)
{
    const band_case list[] = {{1.0, softened(2.0), false, {0.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {1.0, softened(3.0), false, {30.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third}};
    assert_close(2.0 * check_case(&list[0], 1.0).toughness - check_case(&list[0], 0.5).toughness, 0.960, 0.004);
    assert_close(check_case(&list[1], 0.5).toughness, 1.014, 0.005);
}

/* Found: 0.958, 0.917 of what was asked for: a crack of 11 spacings is short. */
TEST(a_crack_takes_the_fracture_energy_at_twice_the_spacing)
{
    const band_case list[] = {{0.5, 3.4, true, {0.0, 0.0, true, 1}, 1.5, 0.10, CORNERS, third},
                              {0.5, 8.4, false, {0.0, 0.0, true, 1}, 1.5, 0.10, CORNERS, third}};
    check(list, sizeof list / sizeof *list);
}

/* The same body at the spacing of the other tests, and at half of it. Found: 1.017, 1.044, 1.006, 1.022 of what was
 * asked for; at rest a brittle crack of twice as many spacings needs 3.51 instead of 3.40, too (test_strip.c). */
static void at_finer_spacings(void **state)
{
    const band_case list[] = {{1.0, 3.4, true, {0.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {2.0, 3.4, true, {0.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {1.0, 8.4, false, {0.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {2.0, 8.4, false, {0.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

/* Rows that are turned, at two spacings. A strip has to be high enough that what is ahead of the crack is far below its
 * strength: where the crack goes on it is under sqrt(2 beta a/(H (1 - nu^2))) of it, with beta = 4.2 of G E/(strength^2
 * a) 0.46 if it is 44 spacings high, and 0.65 if it is 22, where cracks take 0.84 to 0.98 of what is asked however long
 * they are. So the coarse strip is 44 spacings high here. Found: 1.030, 1.034; 1.032, 0.982. */
static void of_turned_rows_at_finer_spacings(void **state)
{
    const band_case list[] = {{1.0, 4.2, false, {15.0, 0.0, true, 1}, 1.5, 0.10, CORNERS, third},
                              {1.0, 4.2, false, {30.0, 0.0, true, 1}, 1.5, 0.10, CORNERS, third},
                              {2.0, 4.2, false, {15.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {2.0, 4.2, false, {30.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

/* Found: 4.28, 4.29 (4.14); 4.98 (5.21); 8.47, 8.77, 8.64 (8.42). The crack that would follow a row at 15 degrees if it
 * were brittle is off straight by 1.3 degrees at q = 6: by 1.9, 0.8, 1.3, 1.1, 0.9 over 12, 18, 24, 30, 36 spacings. */
static void of_regular_meshes(void **state)
{
    const band_case list[] = {{1.0, softened(2.0), false, {15.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {1.0, softened(2.0), false, {30.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {1.0, softened(3.0), false, {0.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {1.0, softened(6.0), false, {0.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {1.0, softened(6.0), false, {15.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third},
                              {1.0, softened(6.0), false, {30.0, 0.0, true, 1}, 1.5, 0.05, CORNERS, third}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

/* Meshes scatter: twelve seeds took 0.900 to 1.063 of what was asked for, 0.974 +- 0.017 in the mean, and went -5.0 to
 * 7.8 degrees off straight. Found: 1.063, 2.3 degrees. */
static void of_jitter(void **state)
{
    const band_case k = {1.0, softened(3.0), false, {15.0, 0.25, true, 1}, 10.0, 0.12, CORNERS, third};
    (void)state;
    (void)check_case(&k, 1.0);
}

/* Steps a quarter as long do the same to four digits for the first two seeds. Of 32 meshes one is 19 % tougher than was
 * asked for, the others are to 7 %. */
static grown check_without_rows(uint64_t seed)
{
    const band_case k = {1.0, softened(3.0), false, {0.0, 0.0, false, seed}, 15.0, 0.22, CORNERS, third};
    return check_case(&k, 0.5);
}

/* Found: 0.967 of what was asked for, 4.8 degrees. */
TEST(a_crack_in_a_mesh_without_rows_takes_about_the_fracture_energy)
{
    (void)check_without_rows(1);
}

/* Each wanders, by 4.1 degrees in the root of the mean square and by 9.5 at most, and to no side in the mean. Found:
 * 0.947 to 1.193 of what was asked for, 24 of 32 within 5 %, in the mean 0.998 +- 0.010; 0.4 +- 0.7 degrees to the
 * right. */
static void of_meshes_without_rows(void **state)
{
    enum { SEEDS = 32 };
    double toughness = 0.0, angle = 0.0, square = 0.0;
    (void)state;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        const grown g = check_without_rows(seed);
        toughness += g.toughness / SEEDS;
        angle += g.angle / SEEDS;
        square += g.angle * g.angle / SEEDS;
    }
    const double error = sqrt((square - angle * angle) / (SEEDS - 1));
    print_message("# mean %.4f, %.2f +- %.2f degrees\n", toughness, angle, error);
    assert_close(toughness, 1.0, 0.05);
    assert_true(fabs(angle) < 1.5 && error < 1.0);
}

/* Where their own stress lets triangles soften irregular meshes take less than what is asked, and cracks keep to what
 * is left of rows: 16 seeds took 0.831 to 0.957 of it, 0.878 +- 0.009 in the mean. Found: 2.63, 3.02, 3.06 (3.08), 5.77
 * (5.96); -0.5, 14.5, -3.5, 14.5 degrees off straight. */
static void of_own_stress(void **state)
{
    const band_case list[] = {{1.0, softened_by_own(6.0), false, {0.0, 0.25, true, 1}, 1.5, 0.20, OWN, third},
                              {1.0, softened_by_own(6.0), false, {15.0, 0.25, true, 1}, 17.0, 0.13, OWN, third},
                              {1.0, softened_by_own(6.0), false, {30.0, 0.25, true, 1}, 17.0, 0.13, OWN, third},
                              {1.0, softened_by_own(12.0), false, {15.0, 0.25, true, 1}, 17.0, 0.13, OWN, third}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

/* Of squares toughness depends on direction, on Poisson's ratio and, where sides are at 45 degrees, on the square at
 * which a crack begins: the lines in the middle of what was found are off by 12 % at most.
 * Found: 0.961 of what was asked for. */
TEST(a_crack_through_squares_takes_about_the_fracture_energy)
{
    const band_case list[] = {{1.0, of_squares(3.0), false, {0.0, 0.0, true, 1}, 1.5, 0.05, SQUARES, third}};
    check(list, sizeof list / sizeof *list);
}

/* Found: 0.945, 1.059, 0.970, 0.893, 0.885, 0.949, 0.898, 0.980, 0.905. */
static void of_squares_in_two_directions(void **state)
{
    const band_case list[] = {{1.0, of_squares(1.0), true, {0.0, 0.0, true, 1}, 1.5, 0.07, SQUARES, third},
                              {1.0, of_squares(1.0), true, {45.0, 0.0, true, 1}, 1.5, 0.07, SQUARES, third},
                              {1.0, of_squares(2.0), false, {0.0, 0.0, true, 1}, 1.5, 0.05, SQUARES, third},
                              {1.0, of_squares(2.0), false, {45.0, 0.0, true, 1}, 1.5, 0.12, SQUARES, third},
                              {1.0, of_squares(3.0), false, {45.0, 0.0, true, 1}, 1.5, 0.12, SQUARES, third},
                              {1.0, of_squares(3.0), false, {45.0, 0.0, true, 1}, 1.5, 0.07, SQUARES, 0.2},
                              {1.0, of_squares(3.0), false, {0.0, 0.0, true, 1}, 1.5, 0.12, SQUARES, 0.45},
                              {1.0, of_squares(6.0), false, {0.0, 0.0, true, 1}, 1.5, 0.05, SQUARES, third},
                              {1.0, of_squares(6.0), false, {45.0, 0.0, true, 1}, 1.5, 0.12, SQUARES, third}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) {
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_regular_meshes), 1000);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_jitter), 1001);
        test_add(&(struct CMUnitTest)cmocka_unit_test(at_finer_spacings), 1002);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_turned_rows_at_finer_spacings), 1003);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_own_stress), 1004);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_squares_in_two_directions), 1005);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_meshes_without_rows), 1006);
    }
    return test_run();
}
