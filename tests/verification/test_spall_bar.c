/* SPDX-License-Identifier: BSD-3-Clause */
/* Spall of a bar of triangles: its first part, the flyer, moves towards the rest with the speed v. By the diagram of
 * waves in a thin bar a compression E v/(2 c), c = sqrt(E/density), twice as long as the flyer goes towards the far
 * end, which sends it back as tension. Where its front meets what is still coming, as far from the end as the flyer is
 * long, is the first tension in the bar, after the time length/c. There the bar has to break, if it is not stronger
 * than that tension. With Poisson's ratio 0 the sides of the bar do not move; with 1/3 they do, and fronts are as wide
 * as the bar. */
#include "verification/support.h"

#include <stdlib.h>

enum { LONG = 160, HIGH = 8, FLYER = 40 }; /* spacings */

static const double modulus = 1e9, density = 1000.0, spacing = 0.01, c = 1000.0; /* Pa, kg/m^3, m, m/s */
static const double limit = 1e-3;                                                /* strain of the strength */

typedef struct spall_case {
    double nu, share; /* share of the tension that the bar stands */
    double toughness; /* G E/(strength^2 a); 0: triangles are brittle */
} spall_case;

typedef struct spall {
    double begin, t, place; /* m; s, m: of the first break */
} spall;

static dem_status note(void *context, const dem_simulation *s, const dem_break *what)
{
    spall *found = context;
    (void)s;
    found->t = what->t;
    found->place = what->x[0] - found->begin;
    return DEM_STOPPED;
}

static dem_lattice make_bar(const spall_case *k)
{
    const dem_material solid = {.struct_size = sizeof solid,
                                .youngs_modulus = modulus,
                                .poissons_ratio = k->nu,
                                .density = density,
                                .thickness = 1.0,
                                .springs = DEM_SPRINGS_COUPLED,
                                .strength = modulus * limit,
                                .fracture_energy = k->toughness * modulus * limit * limit * spacing};
    return support_rectangle(LONG * spacing, HIGH * spacing, spacing, &solid);
}

/* \return the left end of the bar, m */
static double throw_flyer(dem_lattice *l, double speed)
{
    double *v = calloc((size_t)(2 * l->n_nodes), sizeof *v), begin = l->x[0];
    assert_non_null(v);
    for (dem_index i = 0; i < l->n_nodes; i++) begin = fmin(begin, l->x[2 * i]);
    for (dem_index i = 0; i < l->n_nodes; i++) v[2 * i] = l->x[2 * i] - begin < FLYER * spacing ? speed : 0.0;
    support_start(l, NULL, v);
    free(v);
    return begin;
}

static void check(const spall_case *k)
{
    const double by_diagram = LONG * spacing / c;
    CLEANUP(dem_lattice_free) dem_lattice l = make_bar(k);
    CLEANUP(support_close) support_run run;
    spall found = {.begin = throw_flyer(&l, 2.0 * c * limit / k->share)};
    const dem_observer observer = {.struct_size = sizeof observer, .broken = note, .context = &found};
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    support_open(&run, &l, NULL, 0, &options);
    assert_ok(dem_simulation_observe(run.simulation, &observer));
    assert_int_equal(dem_simulation_advance(run.simulation, 2.0 * by_diagram), DEM_STOPPED);
    assert_close(found.t, by_diagram, 0.1 * by_diagram);
    assert_close(found.place, (LONG - FLYER) * spacing, 2.0 * spacing);
}

/* Found, over the time of the diagram: 1.015, 1.030, 1.039; 120.6, 120.1, 121.6 spacings from the flyer's end for 120.
 * A bar that stands 0.6 of the tension or less breaks at its ends before that where sides move: the wave, which
 * begins as a step, overshoots. */
TEST(a_brittle_bar_spalls_where_and_when_the_diagram_of_waves_says)
{
    const spall_case list[] = {{0.0, 0.7, 0.0}, {1.0 / 3.0, 0.7, 0.0}, {1.0 / 3.0, 0.9, 0.0}};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) check(&list[k]);
}

/* A triangle breaks when it has nothing left, at twice the strain. Found: 1.036, 1.066; 120.7, 121.1. */
TEST(a_bar_that_softens_spalls_there_too)
{
    const spall_case list[] = {{1.0 / 3.0, 0.5, 4.14}, {1.0 / 3.0, 0.9, 4.14}};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) check(&list[k]);
}
