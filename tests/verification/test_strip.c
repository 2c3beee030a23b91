/* SPDX-License-Identifier: BSD-3-Clause */
/* Toughness: a strip with clamped sides and an edge crack, pulled slowly. Whatever the length of the crack, the energy
 * released per area is that of the strip ahead, G = E (D/H)^2 H/(2 (1 - nu^2)) with D the way by which the sides have
 * parted and H their distance (plane stress; the sides hold the strip along itself). A brittle lattice needs G = beta
 * strength^2 a/E, with beta of the criterion and the lattice alone. `long` as argument: other Poisson's ratios, and a
 * strip of twice the size. Drag and inertia add to the load in proportion to its speed (found: halved with it, to 1 %
 * of them), so two speeds tell what a strip takes that is pulled infinitely slowly. */
#include "clamped_strip.h"

#include <stdlib.h>
#include <string.h>

#include "ask.h"

static const double spacing = CLAMPED_STRIP_SPACING, c = CLAMPED_STRIP_SPEED;

/* A case of the table below. */
typedef struct strip_case {
    bool by_stretch;
    double nu;
    int scale;            /* the strip is so many times as large */
    double beta, largest; /* expected: the mean over a crack whose loads may fall, and the largest; 0: not known */
} strip_case;
enum { WIDE = 70, HIGH = 44, CRACK = 22, MOST = 30 }; /* spacings; triangles that break */

typedef struct slow_strip {
    support_run run;
    double start; /* m, by which the sides have parted at the start */
    double speed; /* m/s, at which they part */
    double most;  /* m, by which they had parted at the last break under a growing load */
    dem_index n_broken, n_cut;
    double middle, off; /* m: of the crack; its largest distance from straight */
    const dem_lattice *lattice;
    unsigned char *broken;
} slow_strip;

/* Only the first break of those between two pauses is one by the load; others follow it by waves and by what it has
 * left over the limit. */
static dem_status note(void *context, const dem_simulation *s)
{
    slow_strip *p = context;
    dem_index n = 0;
    assert_ok(dem_simulation_broken(s, p->broken, NULL));
    for (dem_index t = 0; t < p->lattice->n_triangles; t++) {
        if (!p->broken[t]) continue;
        n++;
        p->off = fmax(p->off, fabs(clamped_strip_centre(p->lattice, t, 1) - p->middle));
    }
    if (n == p->n_broken) return DEM_OK;
    p->most = p->start + p->speed * dem_simulation_ramp_time(s);
    p->n_broken = n;
    return n - p->n_cut >= MOST ? DEM_STOPPED : DEM_OK;
}

/* The drag is critical for the slowest wave between the sides, pi c/H. */
static void open_strip(slow_strip *p, const dem_lattice *l, const clamped_strip *strip)
{
    dem_boundary pull[2];
    dem_options options = dem_options_default();
    clamped_strip_hold(strip, p->speed, pull);
    options.gravity[1] = 0.0;
    options.rtol = 1e-8;
    options.mass_damping = 2.0 * M_PI * c / strip->height;
    options.pause = 1e-3;
    options.n_boundaries = 2;
    options.boundaries = pull;
    support_open(&p->run, l, NULL, 0, &options);
    p->lattice = dem_model_lattice(p->run.model);
    const dem_observer observer = {.struct_size = sizeof observer, .step = note, .context = p};
    assert_ok(dem_simulation_observe(p->run.simulation, &observer));
}

/* G E/(strength^2 a) at the break under the largest load. The strip starts stretched by 0.85 of what it is expected to
 * stand, and is pulled by the whole of that in `slow` H/(44 a) of a/c. */
static double toughness(const strip_case *k, double slow)
{
    const dem_material solid = clamped_strip_material(k->by_stretch, k->nu);
    CLEANUP(dem_lattice_free)
    dem_lattice l = support_rectangle(k->scale * WIDE * spacing, k->scale * HIGH * spacing, spacing, &solid);
    CLEANUP(clamped_strip_free) clamped_strip strip = clamped_strip_of(&l);
    const double unit = strip.height * strip.height * clamped_strip_unit(&strip, k->nu);
    const double parted = sqrt(k->beta * unit), last = slow * k->scale * spacing / c;
    slow_strip p = {.start = 0.85 * parted, .speed = parted / last, .middle = strip.middle};
    p.broken = calloc((size_t)l.n_triangles, 1);
    assert_non_null(p.broken);
    clamped_strip_stretch(&strip, &l, p.start);
    open_strip(&p, &l, &strip);
    p.n_cut =
        clamped_strip_cut(&strip, p.run.simulation, p.lattice, strip.begin, strip.begin + k->scale * CRACK * spacing);
    p.n_broken = p.n_cut;
    assert_int_equal(dem_simulation_advance(p.run.simulation, 20.0 * last), DEM_STOPPED);
    assert_true(p.off < 0.5 * spacing); /* along its row */
    support_close(&p.run);
    free(p.broken);
    return p.most * p.most / unit;
}

/* Expected are means over a crack by an independent static code, in which loads may fall; the largest of the loads is
 * half a per cent of G above that. Where the largest is known, by test_crack_path.c from the stresses of strips at
 * rest, to which nothing breaks by itself, it is met to 0.5 %: a strength that is off by 1 % makes it 2 %. */
static void check(const strip_case *list, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        const double fast = toughness(&list[k], 2500.0), slow = toughness(&list[k], 5000.0), found = 2.0 * slow - fast;
        print_message("# %s, nu %.2f: %.4f, %.4f, so %.4f at rest\n", list[k].by_stretch ? "stretch" : "stress",
                      list[k].nu, fast, slow, found);
        assert_close(found, list[k].beta, 0.02 * list[k].beta);
        if (list[k].largest > 0.0) assert_close(found, list[k].largest, 0.005 * list[k].largest);
    }
}

TEST(toughness_is_that_of_the_criterion)
{
    const strip_case list[] = {{false, 1.0 / 3.0, 1, 3.40, 3.421}, {true, 1.0 / 3.0, 1, 1.325, 1.336}};
    check(list, sizeof list / sizeof *list);
}

static void of_other_ratios(void **state)
{
    const strip_case list[] = {
        {false, 0.0, 1, 3.48, 3.498}, {false, 0.2, 1, 3.41, 3.424}, {false, 0.45, 1, 3.45, 3.471}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

static void of_twice_the_size(void **state)
{
    const strip_case list[] = {{false, 1.0 / 3.0, 2, 3.51, 0.0}, {true, 1.0 / 3.0, 2, 1.345, 0.0}};
    (void)state;
    check(list, sizeof list / sizeof *list);
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) {
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_other_ratios), 1000);
        test_add(&(struct CMUnitTest)cmocka_unit_test(of_twice_the_size), 1001);
    }
    return test_run();
}
