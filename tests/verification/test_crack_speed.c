/* SPDX-License-Identifier: BSD-3-Clause */
/* Speed of a crack that runs: a strip is stretched between sides that are held, and cut from one end at the start. What
 * is ahead of the crack has the energy G = E e^2 H/(2 (1 - nu^2)) per area of it, e the strain across the strip (plane
 * stress), and the crack runs at a constant speed that grows with G, below that of Rayleigh's waves: at nu = 1/3 this
 * is c_R = 0.9194 of shear waves, which are sqrt(3/8) of sqrt(E/rho). `long` as argument: a strip in which the crack
 * has come to a steady speed. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "reference_strip.h"

static const double spacing = CLAMPED_STRIP_SPACING, nu = 1.0 / 3.0;
static const double cut = 40.25; /* spacings: the last triangle that is cut has its centre a quarter before */
enum { MOST = 8192 };            /* breaks */

typedef struct speed_case {
    bool by_stretch;
    double g;          /* G over E limit^2 a */
    double wide, high; /* spacings, the second of whole rows */
    double expected, tolerance;
} speed_case;

typedef struct running {
    support_run run;
    double cut, end; /* m, where the crack starts, and the strip ends */
    dem_index n;
    double t[MOST], tip[MOST]; /* s, m: when the crack has come how far */
    dem_index n_breaks;
    double when[MOST]; /* s */
    dem_index triangle[MOST];
} running;

static void advance_tip(running *p, double t, double x)
{
    if (x <= (p->n > 0 ? p->tip[p->n - 1] : p->cut)) return;
    assert_true(p->n < MOST);
    p->t[p->n] = t;
    p->tip[p->n++] = x;
}

/* Until 70 % of the way from the cut to the end. What is cut is reported, too. */
static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    running *p = context;
    (void)s;
    if (what->t == 0.0) return DEM_OK;
    assert_true(p->n_breaks < MOST);
    p->when[p->n_breaks] = what->t;
    p->triangle[p->n_breaks++] = what->triangle;
    advance_tip(p, what->t, what->x[0]);
    return what->x[0] - p->cut >= 0.7 * (p->end - p->cut) ? DEM_STOPPED : DEM_OK;
}

/* Between the first places past 20 and 70 % of the way. */
static double between_ends(const running *p)
{
    dem_index first = 0;
    while (p->tip[first] - p->cut < 0.2 * (p->end - p->cut)) first++;
    return (p->tip[p->n - 1] - p->tip[first]) / (p->t[p->n - 1] - p->t[first]);
}

/* The slope of the tip over time from 20 % of its way on, least squares. */
static double slope(const running *p)
{
    double n = 0.0, t = 0.0, x = 0.0, tt = 0.0, tx = 0.0;
    for (dem_index k = 0; k < p->n; k++) {
        if (p->tip[k] - p->cut < 0.2 * (p->end - p->cut)) continue;
        n += 1.0;
        t += p->t[k];
        x += p->tip[k];
        tt += p->t[k] * p->t[k];
        tx += p->t[k] * p->tip[k];
    }
    return (n * tx - t * x) / (n * tt - t * t);
}

static void run(running *p, const speed_case *k, dem_lattice *l, const clamped_strip *strip)
{
    dem_boundary hold[2];
    clamped_strip_stretch(strip, l, strip->height * sqrt(k->g * clamped_strip_unit(strip, nu)));
    clamped_strip_strengthen(strip, l);
    clamped_strip_hold(strip, 0.0, hold);
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = 1e-7;
    options.v_scale = 1.0;
    options.n_boundaries = 2;
    options.boundaries = hold;
    support_open(&p->run, l, NULL, 0, &options);
    p->cut = strip->begin + cut * spacing;
    p->end = strip->end;
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note, .context = p};
    assert_ok(dem_simulation_observe(p->run.simulation, &observer));
    clamped_strip_cut(strip, p->run.simulation, l, strip->begin, p->cut);
    assert_int_equal(dem_simulation_advance(p->run.simulation, k->wide * spacing / (0.3 * CLAMPED_STRIP_SPEED)),
                     DEM_STOPPED);
    support_close(&p->run);
}

static dem_lattice lattice_of(const speed_case *k)
{
    const dem_material solid = clamped_strip_material(k->by_stretch, nu);
    return support_rectangle(k->wide * spacing, k->high * spacing, spacing, &solid);
}

/* Over c_R; `unit` is the speed of 1 in the run's own lengths and times. */
static double over_rayleigh(double found, double unit)
{
    return found / (0.9194 * sqrt(3.0 / 8.0) * unit);
}

static double speed(const speed_case *k, double (*measure)(const running *))
{
    CLEANUP(dem_lattice_free) dem_lattice l = lattice_of(k);
    CLEANUP(clamped_strip_free) clamped_strip strip = clamped_strip_of(&l);
    running *p = calloc(1, sizeof *p);
    assert_non_null(p);
    run(p, k, &l, &strip);
    const double found = measure(p);
    free(p);
    return over_rayleigh(found, CLAMPED_STRIP_SPEED);
}

static void check(const speed_case *list, size_t n, double (*measure)(const running *))
{
    for (size_t j = 0; j < n; j++) {
        const double found = speed(&list[j], measure);
        print_message("# %s, G = %.1f: %.4f\n", list[j].by_stretch ? "stretch" : "stress", list[j].g, found);
        assert_close(found, list[j].expected, list[j].tolerance);
        assert_true(found < 1.0);
    }
}

/* The speeds are those of another code. Cracks are not at a steady speed here: they have come 56 spacings, and run at
 * 0.77 over the first 25 of them and at 0.85 over the next, under the smallest load. So the strip is as high as that
 * code's, 57 rows, and the speed is read between the same two places, as the slope of a line by least squares differs
 * by up to 0.006, and that of a strip of 58 rows by up to 0.003. Found: 0.8401, 0.8621, 0.8958, 0.9414. */
TEST(cracks_run_below_the_speed_of_rayleigh_waves)
{
    const speed_case list[] = {{true, 1.5, 120.0, 49.0, 0.837, 0.005},
                               {true, 2.0, 120.0, 49.0, 0.865, 0.005},
                               {true, 3.0, 120.0, 49.0, 0.899, 0.005},
                               {true, 5.0, 120.0, 49.0, 0.946, 0.005}};
    check(list, sizeof list / sizeof *list, between_ends);
}

/* How long before or after the program the reference breaks a triangle, a/c; infinite if the program does not. */
static double apart(const running *p, const dem_lattice *l, const clamped_strip *strip, const reference_break *what)
{
    for (dem_index i = 0; i < p->n_breaks; i++) {
        const double x = (clamped_strip_centre(l, p->triangle[i], 0) - strip->begin) / spacing,
                     y = (clamped_strip_centre(l, p->triangle[i], 1) - strip->bottom) / spacing;
        if (hypot(x - what->x[0], y - what->x[1]) < 0.1)
            return fabs(p->when[i] * CLAMPED_STRIP_SPEED / spacing - what->t);
    }
    return (double)INFINITY;
}

/* The same triangles but for those at the last instant, where the program stops, each at the same time. */
static void compare_breaks(const running *p, const dem_lattice *l, const clamped_strip *strip,
                           const reference_break *list, int n)
{
    double worst = 0.0;
    int before = 0;
    dem_index found = 0;
    for (; list[before].t < list[n - 1].t; before++) worst = fmax(worst, apart(p, l, strip, &list[before]));
    while (p->when[found] < p->t[p->n - 1]) found++;
    print_message("# %d and %d breaks before the last, times differ by %.1e a/c at most\n", before, (int)found, worst);
    assert_int_equal(before, found);
    assert_true(worst < 1e-2);
}

/* \return the speed of the reference over c_R */
static double compare(const speed_case *k, running *p, running *reference, reference_break *list)
{
    CLEANUP(dem_lattice_free) dem_lattice l = lattice_of(k);
    CLEANUP(clamped_strip_free) clamped_strip strip = clamped_strip_of(&l);
    const int rows = 1 + (int)lround(strip.height / (0.5 * sqrt(3.0) * spacing)), wide = (int)k->wide;
    const reference_load load = {k->by_stretch, wide, rows, CLAMPED_STRIP_LIMIT, k->g, cut, 4.0};
    const int n = reference_strip(&load, cut + 0.7 * (wide - cut), 0.1, list, MOST);
    run(p, k, &l, &strip);
    compare_breaks(p, &l, &strip, list, n);
    reference->cut = cut;
    reference->end = wide;
    for (int j = 0; j < n; j++) advance_tip(reference, list[j].t, list[j].x[0]);
    return over_rayleigh(between_ends(reference), 1.0);
}

/* By steps of 0.1 a/c in the reference all breaks have the same places, and their times agree to 7e-4 and 3.4e-3 a/c
 * by stress, to 4.3e-3 by stretch; by half of them to 1e-4 and 3e-4 a/c. Three times that is allowed. */
static void compare_all(const speed_case *list, size_t n)
{
    for (size_t j = 0; j < n; j++) {
        running *both = calloc(2, sizeof *both);
        reference_break *breaks = calloc(MOST, sizeof *breaks);
        assert_true(both != NULL && breaks != NULL);
        const double reference = compare(&list[j], &both[0], &both[1], breaks),
                     found = over_rayleigh(between_ends(&both[0]), CLAMPED_STRIP_SPEED);
        print_message("# %s, G = %.1f: %.4f, reference %.4f\n", list[j].by_stretch ? "stretch" : "stress", list[j].g,
                      found, reference);
        assert_close(reference, list[j].expected, 1e-3);
        assert_close(found, reference, list[j].tolerance);
        assert_true(found < 1.0);
        free(both);
        free(breaks);
    }
}

/* That other code has 0.735 and 0.821 by stress, of a start and a way that are not known. In 16 cuts of 36 to 44
 * spacings these speeds differ by 0.09 and 0.08, 0.779 +- 0.028 and 0.806 +- 0.020, as cracks branch and hesitate:
 * 0.005 is a matter of one start, which the reference takes, too. */
TEST(a_crack_by_stress_runs_as_in_a_second_computation)
{
    const speed_case list[] = {{false, 4.0, 120.0, 49.0, 0.770, 0.005}};
    compare_all(list, sizeof list / sizeof *list);
}

static void so_do_cracks_under_other_loads_and_by_stretch(void **state)
{
    const speed_case list[] = {{false, 5.5, 120.0, 49.0, 0.817, 0.005},
                               {true, 1.5, 120.0, 49.0, 0.840, 0.005},
                               {true, 2.0, 120.0, 49.0, 0.862, 0.005},
                               {true, 3.0, 120.0, 49.0, 0.896, 0.005},
                               {true, 5.0, 120.0, 49.0, 0.941, 0.005}};
    (void)state;
    compare_all(list, sizeof list / sizeof *list);
}

/* Between 112 and 292 spacings. By stretch a tolerance of a hundredth, a way that begins elsewhere by 4
 * spacings, and a cut that is longer by 1.5 change this by 0.003 at most, means over 25 spacings have standard errors
 * of 0.001 to 0.003. Cracks by stress branch and stop, over 25 spacings they run at 0.65 to 0.81 and 0.78 to 0.85: the
 * tolerance is two standard errors. That other code has 0.735 and 0.821 in the shorter strip. */
static void at_a_steady_speed(void **state)
{
    const speed_case list[] = {{true, 1.5, 400.0, 50.0, 0.851, 0.005},  {true, 2.0, 400.0, 50.0, 0.880, 0.005},
                               {true, 3.0, 400.0, 50.0, 0.908, 0.005},  {true, 5.0, 400.0, 50.0, 0.958, 0.005},
                               {false, 4.0, 400.0, 50.0, 0.764, 0.030}, {false, 5.5, 400.0, 50.0, 0.825, 0.015}};
    (void)state;
    check(list, sizeof list / sizeof *list, slope);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) {
        test_add(&(struct CMUnitTest)cmocka_unit_test(so_do_cracks_under_other_loads_and_by_stretch), 1000);
        test_add(&(struct CMUnitTest)cmocka_unit_test(at_a_steady_speed), 1001);
    }
    return test_run();
}
