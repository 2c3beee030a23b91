/* SPDX-License-Identifier: BSD-3-Clause */
/* Order and times of breaks, which do not depend on where steps end: a stretched strip, cut from one end, breaks by
 * steps of some length, and by steps of a quarter of that. Found at the ends of steps they would come in another
 * order from the 32nd of 154 on, and later by about 1 a/c (an independent code). */
#include "clamped_strip.h"

#include <stdlib.h>

#include "ask.h"

static const double spacing = CLAMPED_STRIP_SPACING, nu = 1.0 / 3.0;
static const double unit_time = CLAMPED_STRIP_SPACING / CLAMPED_STRIP_SPEED; /* a/c */
enum { WIDE = 90, HIGH = 36, CUT = 10, MOST = 302, FIRST = 40 };             /* spacings; breaks */

typedef struct breaks {
    dem_index n, most;
    dem_index triangle[MOST];
    double t[MOST]; /* s */
    double closure; /* by how much the ledger has changed, over the elastic energy at the start */
} breaks;

/* A way to compute the strip. */
typedef struct way {
    dem_method method;
    dem_contact_method contact;
    double step; /* a/c */
} way;

/* What was cut at the start is reported, too, and all that breaks at the instant of the last. */
static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    breaks *b = context;
    (void)s;
    if (what->t == 0.0) return DEM_OK;
    if (b->n == b->most) return DEM_STOPPED;
    b->triangle[b->n] = what->triangle;
    b->t[b->n++] = what->t;
    return b->n == b->most ? DEM_STOPPED : DEM_OK;
}

/* Breaks of a strip that is stretched to G = g E limit^2 a. */
static void run(breaks *b, bool by_stretch, double g, const way *w)
{
    const dem_material solid = clamped_strip_material(by_stretch, nu);
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(WIDE * spacing, HIGH * spacing, spacing, &solid);
    CLEANUP(clamped_strip_free) clamped_strip strip = clamped_strip_of(&l);
    CLEANUP(support_close) support_run run;
    dem_boundary hold[2];
    clamped_strip_stretch(&strip, &l, strip.height * sqrt(g * clamped_strip_unit(&strip, nu)));
    clamped_strip_strengthen(&strip, &l);
    clamped_strip_hold(&strip, 0.0, hold);
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.method = w->method;
    options.contact = w->contact;
    options.fixed_step = w->step * unit_time;
    options.n_boundaries = 2;
    options.boundaries = hold;
    support_open(&run, &l, NULL, 0, &options);
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note, .context = b};
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    clamped_strip_cut(&strip, run.simulation, &l, strip.begin, strip.begin + CUT * spacing);
    const dem_energy start = ask_energy(run.simulation);
    assert_int_equal(dem_simulation_advance(run.simulation, 1000.0 * unit_time), DEM_STOPPED);
    b->closure = fabs(ask_energy(run.simulation).ledger - start.ledger) / start.elastic;
}

/* The same breaks in the same order.  \return rms difference of the times of the first ones, a/c */
static double compare(dem_index most, bool by_stretch, const way *one, const way *other)
{
    breaks *found = calloc(2, sizeof *found);
    const double g = by_stretch ? 2.0 : 5.5;
    double sum = 0.0;
    assert_non_null(found);
    found[0].most = found[1].most = most;
    run(&found[0], by_stretch, g, one);
    run(&found[1], by_stretch, g, other);
    for (dem_index k = 0; k < most; k++) assert_int_equal(found[0].triangle[k], found[1].triangle[k]);
    for (dem_index k = 0; k < FIRST; k++) sum += pow((found[0].t[k] - found[1].t[k]) / unit_time, 2);
    free(found);
    return sqrt(sum / FIRST);
}

static way of(dem_method method, double step)
{
    return (way){method, DEM_CONTACT_LOCAL, step};
}

/* The bounds are three times what an independent code found by steps of this length, omega_max h = 0.5. */
TEST(steps_of_a_quarter_find_the_same_breaks)
{
    const way coarse = of(DEM_METHOD_FEHLBERG45, 0.2), fine = of(DEM_METHOD_FEHLBERG45, 0.05);
    assert_true(compare(150, true, &coarse, &fine) < 3.0 * 2e-5);  /* found: 1.5e-5 */
    assert_true(compare(302, false, &coarse, &fine) < 3.0 * 2e-5); /* likewise */
}

/* Likewise by steps of half of that. Errors fall as the square of the step: those of 0.1 and of 0.05 less that of 0.025
 * are as 15 to 3, where breaks at the ends of steps would make it 3 to 1. */
TEST(steps_of_a_quarter_find_the_same_breaks_by_verlet)
{
    const way coarse = of(DEM_METHOD_VERLET, 0.1), half = of(DEM_METHOD_VERLET, 0.05),
              fine = of(DEM_METHOD_VERLET, 0.025);
    const double error = compare(150, true, &coarse, &fine);
    assert_true(error < 3.0 * 2e-3);                             /* found: 4.8e-3 */
    assert_true(error > 4.5 * compare(150, true, &half, &fine)); /* found: 5.5 */
}

/* A quarter of the energy goes into the breaks. Found: 1.8e-5; 1.6e-5 if the whole body stops at each break, so that
 * most of it is the method's by steps of omega_max h = 0.51. By a quarter of them it is 1.8e-8, of fifth order. */
TEST(the_ledger_closes_over_150_breaks)
{
    const way coarse = of(DEM_METHOD_FEHLBERG45, 0.2), fine = of(DEM_METHOD_FEHLBERG45, 0.05);
    breaks *b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->most = 150;
    run(b, true, 2.0, &coarse);
    assert_true(b->closure < 2e-5);
    b->n = 0;
    run(b, true, 2.0, &fine);
    assert_true(b->closure < 1e-7);
    free(b);
}

/* Where the whole body stops at each break, nothing is corrected; found: 2e-6 of a step. */
TEST(bodies_that_stop_at_breaks_have_the_same)
{
    const way local = of(DEM_METHOD_FEHLBERG45, 0.1), exact = {DEM_METHOD_FEHLBERG45, DEM_CONTACT_EXACT, 0.1};
    assert_true(compare(302, false, &local, &exact) < 1e-6);
}
