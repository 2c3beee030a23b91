/* SPDX-License-Identifier: BSD-3-Clause */
/* A free rectangle rings: the ten lowest peaks in the spectrum of a run are the ten lowest eigenfrequencies of the
 * model's own stiffness and masses, by GSL. The spectrum is that of the strains of springs, which know of no rigid
 * motion; a Gaussian window makes every peak a parabola in the logarithm, so that three samples find its place. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_fft_real.h>

#include "dense.h"
#include "harness/motion.h"
#include "harness/cleanup_gsl.h"

enum { n_samples = 4096, n_modes = 10 };

static const double spacing = 5e-3, amplitude = 1e-5; /* m; of strains */
static const double width = 0.1;                      /* standard deviation of the window over the time of the run */

/* Six spacings by five rows: no two of the ten frequencies are nearer than seven widths of a peak. */
static void make_rectangle(dem_lattice *l, bool squares)
{
    const dem_material solid =
        SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.2, .density = 1050.0, .thickness = 1.0);
    if (squares) {
        assert_ok(dem_lattice_squares(l, 6.0 * spacing, 5.0 * spacing, spacing));
        assert_ok(dem_lattice_assemble_squares(l, &solid, 0.5));
    } else {
        assert_ok(dem_lattice_rectangle(l, 6.0 * spacing, 2.5 * sqrt(3.0) * spacing, spacing));
        assert_ok(dem_lattice_assemble(l, &solid));
    }
}

/* Smooth, without symmetry, so that every low mode takes part. */
static void strain(dem_lattice *l)
{
    const double size = 6.0 * spacing;
    CLEANUP(free_memory) double *start = malloc(2 * (size_t)l->n_nodes * sizeof *start);
    assert_non_null(start);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double x = l->x[2 * i] / size, y = l->x[2 * i + 1] / size;
        start[2 * i] = l->x[2 * i] + amplitude * size * (x + 0.5 * y * x + y * y * y - 3.0 * x * x * y + x * x * x * x);
        start[2 * i + 1] = l->x[2 * i + 1] + amplitude * size * (y - x * y + x * x - 4.0 * x * x * x + 2.0 * y * y * x);
    }
    support_start(l, start, NULL);
}

/* ---- the spectrum ---- */

/* Adds |FT|^2 of a windowed series to the power. */
static void add_power(double *power, double *series)
{
    for (int k = 0; k < n_samples; k++) {
        const double s = ((double)k / n_samples - 0.5) / width;
        series[k] *= exp(-0.5 * s * s);
    }
    assert_int_equal(gsl_fft_real_radix2_transform(series, 1, n_samples), 0);
    for (int k = 1; k < n_samples / 2; k++)
        power[k] += series[k] * series[k] + series[n_samples - k] * series[n_samples - k];
}

/* Lengths of all springs at every sample, [n_springs][n_samples]. */
static double *checkpoint(const dem_lattice *l, double interval, double omega)
{
    CLEANUP(support_close) support_run run;
    dem_options options = support_options();
    double *series = calloc((size_t)l->n_springs * n_samples, sizeof *series);
    assert_non_null(series);
    options.gravity[1] = 0.0;
    options.rtol = 1e-6;
    options.spacing = amplitude * 6.0 * spacing;
    options.v_scale = options.spacing * omega;
    support_open(&run, l, NULL, 0, &options);
    for (int k = 0; k < n_samples; k++) {
        const motion state = support_at(&run, k * interval);
        for (dem_index s = 0; s < l->n_springs; s++) {
            const double *a = state.x + 2 * l->ends[2 * s], *b = state.x + 2 * l->ends[2 * s + 1];
            series[s * n_samples + k] = hypot(b[0] - a[0], b[1] - a[1]) / l->rest_length[s] - 1.0;
        }
    }
    return series;
}

/* The lowest peaks, rad/s, that stand out: 1e-6 of the highest. */
static void find_peaks(double *peak, const double *power, double interval)
{
    double highest = 0.0;
    int n = 0;
    for (int k = 1; k < n_samples / 2; k++) highest = fmax(highest, power[k]);
    for (int k = 2; k + 1 < n_samples / 2 && n < n_modes; k++) {
        if (power[k] < 1e-6 * highest || power[k] < power[k - 1] || power[k] <= power[k + 1]) continue;
        const double low = log(power[k - 1]), here = log(power[k]), high = log(power[k + 1]);
        const double place = k + 0.5 * (low - high) / (low - 2.0 * here + high);
        peak[n++] = 2.0 * M_PI * place / (n_samples * interval);
    }
    assert_int_equal(n, n_modes);
}

/* ---- the law ---- */

/* omega^2, ascending, the three rigid motions first. */
static gsl_vector *eigenvalues(const dem_lattice *l)
{
    CLEANUP(free_model) dem_model *model = support_model(l, NULL, 0);
    gsl_vector *values = dense_frequencies(model, dense_stiffness(model, l->x, 1e-4 * spacing));
    return values;
}

static void check_ringing(bool squares)
{
    CLEANUP(dem_lattice_free) dem_lattice l = dem_lattice_empty();
    double peak[n_modes];
    make_rectangle(&l, squares);
    CLEANUP(free_vector) gsl_vector *values = eigenvalues(&l);
    const double highest = sqrt(gsl_vector_get(values, values->size - 1)), interval = 0.9 * M_PI / highest;
    strain(&l);
    CLEANUP(free_memory) double *series = checkpoint(&l, interval, highest), *power = calloc(n_samples, sizeof *power);
    assert_non_null(power);
    for (dem_index s = 0; s < l.n_springs; s++) add_power(power, series + s * n_samples);
    find_peaks(peak, power, interval);
    for (int k = 0; k < n_modes; k++) {
        const double omega = sqrt(gsl_vector_get(values, (size_t)k + 3));
        print_message("# %d: omega %.5f of the highest, error %+.1e\n", k + 1, omega / highest, peak[k] / omega - 1.0);
    }
    for (int k = 0; k < n_modes; k++)
        assert_close(peak[k] / sqrt(gsl_vector_get(values, (size_t)k + 3)), 1.0, 1e-5); /* found: 4e-7 */
}

TEST(a_rectangle_of_triangles_rings_with_its_eigenfrequencies)
{
    check_ringing(false);
}

TEST(a_rectangle_of_squares_rings_with_its_eigenfrequencies)
{
    check_ringing(true);
}
