/* SPDX-License-Identifier: BSD-3-Clause */
/* Speed of a crack that runs: a strip is stretched between sides that are held, and cut from one end at the start. What
 * is ahead of the crack has the energy G = E e^2 H/(2 (1 - nu^2)) per area of it, e the strain across the strip (plane
 * stress), and the crack runs at a constant speed that grows with G, below that of Rayleigh's waves: at nu = 1/3 this
 * is c_R = 0.9194 of shear waves, which are sqrt(3/8) of sqrt(E/rho). */
#include "clamped_strip.h"

#include <stdlib.h>

#include "ask.h"

static const double spacing = CLAMPED_STRIP_SPACING, nu = 1.0 / 3.0;
enum { WIDE = 120, HIGH = 50, CUT = 40, MOST = 400 }; /* spacings; places of the crack's tip */

typedef struct running {
    support_run run;
    const dem_lattice *lattice;
    double cut, end; /* m, where the crack starts, and the strip ends */
    unsigned char *broken;
    dem_index n;
    double t[MOST], tip[MOST]; /* s, m: when the crack has come how far */
} running;

/* Until 70 % of the way from the cut to the end. */
static dem_status note(void *context, const dem_simulation *s)
{
    running *p = context;
    double tip = p->n > 0 ? p->tip[p->n - 1] : p->cut;
    const double before = tip;
    assert_ok(dem_simulation_broken(s, p->broken, NULL));
    for (dem_index t = 0; t < p->lattice->n_triangles; t++)
        if (p->broken[t]) tip = fmax(tip, clamped_strip_centre(p->lattice, t, 0));
    if (tip == before) return DEM_OK;
    assert_true(p->n < MOST);
    p->t[p->n] = ask_state(s).t;
    p->tip[p->n++] = tip;
    return tip - p->cut >= 0.7 * (p->end - p->cut) ? DEM_STOPPED : DEM_OK;
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

/* Of a crack driven by G = g E stretch^2 a, over c_R. */
static double speed(double g)
{
    const dem_material solid = clamped_strip_material(true, nu);
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(WIDE * spacing, HIGH * spacing, spacing, &solid);
    CLEANUP(clamped_strip_free) clamped_strip strip = clamped_strip_of(&l);
    running *p = calloc(1, sizeof *p);
    dem_boundary hold[2];
    assert_non_null(p);
    clamped_strip_stretch(&strip, &l, strip.height * sqrt(g * clamped_strip_unit(&strip, nu)));
    clamped_strip_strengthen(&strip, &l);
    clamped_strip_hold(&strip, 0.0, hold);
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = 1e-7;
    options.v_scale = 1.0;
    options.n_boundaries = 2;
    options.boundaries = hold;
    support_open(&p->run, &l, NULL, 0, &options);
    p->lattice = dem_model_lattice(p->run.model);
    p->cut = strip.begin + CUT * spacing;
    p->end = strip.end;
    p->broken = calloc((size_t)l.n_triangles, 1);
    assert_non_null(p->broken);
    const dem_observer observer = {.struct_size = sizeof observer, .step = note, .context = p};
    assert_ok(dem_simulation_observe(p->run.simulation, &observer));
    clamped_strip_cut(&strip, p->run.simulation, p->lattice, strip.begin, p->cut);
    assert_int_equal(dem_simulation_advance(p->run.simulation, 4e-3), DEM_STOPPED);
    const double found = slope(p);
    support_close(&p->run);
    free(p->broken);
    free(p);
    return found / (0.9194 * sqrt(3.0 / 8.0) * CLAMPED_STRIP_SPEED);
}

/* The speeds are those of another code, which measured them otherwise: slopes by least squares and between the ends of
 * the way differ by 0.01. Found: 0.844, 0.868, 0.892, 0.940. */
TEST(cracks_run_below_the_speed_of_rayleigh_waves)
{
    const double g[] = {1.5, 2.0, 3.0, 5.0}, expected[] = {0.837, 0.865, 0.899, 0.946};
    for (int k = 0; k < 4; k++) {
        const double found = speed(g[k]);
        assert_close(found, expected[k], 0.01);
        assert_true(found < 1.0);
    }
}
