/* SPDX-License-Identifier: BSD-3-Clause */
/* Speed of a crack that runs: a strip is stretched between sides that are held, and cut from one end at the start. What
 * is ahead of the crack has the energy G = E e^2 H/(2 (1 - nu^2)) per area of it, e the strain across the strip (plane
 * stress), and the crack runs at a constant speed that grows with G, below that of Rayleigh's waves: at nu = 1/3 this
 * is c_R = 0.9194 of shear waves, which are sqrt(3/8) of sqrt(E/rho). */
#include "verification/support.h"

#include <stdlib.h>

#include "ask.h"

static const double modulus = 1e9, density = 1000.0, spacing = 0.01; /* Pa, kg/m^3, m: c = 1000 m/s */
static const double nu = 1.0 / 3.0, stretch = 1e-3;                  /* stretch: the critical one */
enum { WIDE = 120, HIGH = 50, CUT = 40, MOST = 400 };                /* spacings; places of the crack's tip */

typedef struct strip {
    support_run run;
    const dem_lattice *lattice;
    double begin, end, middle; /* m, of the strip along x; height of the crack */
    unsigned char *broken;
    dem_index n;
    double t[MOST], tip[MOST]; /* s, m: when the crack has come how far */
} strip;

static double centre(const dem_lattice *l, dem_index triangle, int axis)
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += l->x[2 * l->triangles[3 * triangle + c] + axis] / 3.0;
    return sum;
}

static double cut_end(const strip *p)
{
    return p->begin + CUT * spacing;
}

/* Until 70 % of the way from the cut to the end. */
static dem_status note(void *context, const dem_simulation *s)
{
    strip *p = context;
    double tip = p->n > 0 ? p->tip[p->n - 1] : cut_end(p);
    const double before = tip;
    assert_ok(dem_simulation_broken(s, p->broken, NULL));
    for (dem_index t = 0; t < p->lattice->n_triangles; t++)
        if (p->broken[t]) tip = fmax(tip, centre(p->lattice, t, 0));
    if (tip == before) return DEM_OK;
    assert_true(p->n < MOST);
    p->t[p->n] = ask_state(s).t;
    p->tip[p->n++] = tip;
    return tip - cut_end(p) >= 0.7 * (p->end - cut_end(p)) ? DEM_STOPPED : DEM_OK;
}

/* The slope of the tip over time from 20 % of its way on, least squares. */
static double slope(const strip *p)
{
    double n = 0.0, t = 0.0, x = 0.0, tt = 0.0, tx = 0.0;
    for (dem_index k = 0; k < p->n; k++) {
        if (p->tip[k] - cut_end(p) < 0.2 * (p->end - cut_end(p))) continue;
        n += 1.0;
        t += p->t[k];
        x += p->tip[k];
        tt += p->t[k] * p->t[k];
        tx += p->t[k] * p->tip[k];
    }
    return (n * tx - t * x) / (n * tt - t * t);
}

/* Stretches the strip, and lists the nodes of its sides.  \return how many there are */
static dem_index put(strip *p, dem_lattice *l, double g, dem_index *sides)
{
    const double bottom = support_bottom(l), height = support_top(l) - bottom, row = 0.5 * sqrt(3.0) * spacing;
    const double strain = stretch * sqrt(2.0 * (1.0 - nu * nu) * g * spacing / height);
    double *position = calloc((size_t)(2 * l->n_nodes), sizeof *position);
    dem_index n = 0;
    assert_non_null(position);
    p->middle = bottom + (floor(0.5 * round(height / row)) + 0.5) * row;
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double *x = &l->x[2 * i];
        position[2 * i] = x[0];
        position[2 * i + 1] = x[1] + strain * (x[1] - bottom);
        p->begin = fmin(p->begin, x[0]);
        p->end = fmax(p->end, x[0]);
        if (fmin(x[1] - bottom, bottom + height - x[1]) < 0.1 * spacing) sides[n++] = i;
    }
    support_start(l, position, NULL);
    free(position);
    return n;
}

static void cut(strip *p)
{
    const dem_lattice *l = p->lattice;
    dem_index *list = calloc((size_t)l->n_triangles, sizeof *list), n = 0;
    assert_non_null(list);
    for (dem_index t = 0; t < l->n_triangles; t++)
        if (fabs(centre(l, t, 1) - p->middle) < 0.3 * spacing && centre(l, t, 0) < cut_end(p)) list[n++] = t;
    assert_ok(dem_simulation_break(p->run.simulation, list, n, NULL, 0));
    free(list);
}

/* Of a crack driven by G = g E stretch^2 a, over c_R. */
static double speed(double g)
{
    const dem_material solid = {.struct_size = sizeof(dem_material),
                                .youngs_modulus = modulus,
                                .poissons_ratio = nu,
                                .density = density,
                                .thickness = 1.0,
                                .critical_stretch = stretch};
    CLEANUP(dem_lattice_free) dem_lattice l = support_rectangle(WIDE * spacing, HIGH * spacing, spacing, &solid);
    strip *p = calloc(1, sizeof *p);
    dem_index *sides = calloc((size_t)l.n_nodes, sizeof *sides);
    assert_non_null(p);
    assert_non_null(sides);
    const dem_boundary hold =
        SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY, .components = DEM_COMPONENT_X | DEM_COMPONENT_Y,
              .nodes = sides, .n_nodes = put(p, &l, g, sides));
    dem_options options = dem_options_default();
    options.gravity[1] = 0.0;
    options.rtol = 1e-7;
    options.v_scale = 1.0;
    options.n_boundaries = 1;
    options.boundaries = &hold;
    support_open(&p->run, &l, NULL, 0, &options);
    p->lattice = dem_model_lattice(p->run.model);
    p->broken = calloc((size_t)l.n_triangles, 1);
    assert_non_null(p->broken);
    const dem_observer observer = {.struct_size = sizeof observer, .step = note, .context = p};
    assert_ok(dem_simulation_observe(p->run.simulation, &observer));
    cut(p);
    assert_int_equal(dem_simulation_advance(p->run.simulation, 4e-3), DEM_STOPPED);
    const double found = slope(p);
    support_close(&p->run);
    free(p->broken);
    free(sides);
    free(p);
    return found / (0.9194 * sqrt(3.0 / 8.0 * modulus / density));
}

/* The speeds are those of another code, which measured them otherwise: slopes by least squares and between the ends of
 * the way differ by 0.01. */
TEST(cracks_run_below_the_speed_of_rayleigh_waves)
{
    const double g[] = {1.5, 2.0, 3.0}, expected[] = {0.837, 0.865, 0.899};
    for (int k = 0; k < 3; k++) {
        const double found = speed(g[k]);
        assert_close(found, expected[k], 0.01);
        assert_true(found < 1.0);
    }
}
