/* SPDX-License-Identifier: BSD-3-Clause */
/* Heights are white noise under a Gaussian kernel. Only IEEE operations make them: no digit depends on a libm. */
#include "profile.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_interp.h>
#include <gsl/gsl_rng.h>

#include "gsl_errors.h"

static const double reach = 3.0; /* of the kernel in correlation lengths; it has fallen to exp(-18) there */

/* m along x. */
static double length_of_segment(const profile_recipe *r)
{
    return (r->points[2 * r->n_points - 2] - r->points[0]) / (double)r->n_segments;
}

static bool is_sound(const profile_recipe *r)
{
    if (r->n_points < 2 || r->n_segments < 1 || r->n_segments > PROFILE_MAX) return false;
    for (size_t k = 0; k < 2 * r->n_points; k++)
        if (!isfinite(r->points[k])) return false;
    for (size_t k = 1; k < r->n_points; k++)
        if (!(r->points[2 * k] > r->points[2 * k - 2])) return false;
    if (r->roughness == 0.0) return true;
    const double segments = r->correlation / length_of_segment(r), slack = 1e-9;
    return r->roughness > 0.0 && isfinite(r->roughness) && segments >= PROFILE_COARSEST * (1.0 - slack) &&
           segments <= PROFILE_FINEST * (1.0 + slack);
}

/* ---- mean line ---- */

static void evaluate(double *out, const profile_recipe *r, const gsl_interp *curve, const double *x, const double *y)
{
    gsl_interp_accel place = {0};
    const double first = x[0], last = x[r->n_points - 1];
    for (size_t k = 0; k <= r->n_segments; k++) {
        const double share = (double)k / (double)r->n_segments;
        out[2 * k] = k == r->n_segments ? last : fmin(last, first + (last - first) * share);
        out[2 * k + 1] = gsl_interp_eval(curve, x, y, out[2 * k], &place);
    }
}

static dem_status sample_mean(double *out, const profile_recipe *r)
{
    const size_t n = r->n_points;
    double *x = calloc(n, sizeof *x), *y = calloc(n, sizeof *y);
    gsl_interp *curve = gsl_interp_alloc(r->smooth && n > 2 ? gsl_interp_steffen : gsl_interp_linear, n);
    const bool good = x != NULL && y != NULL && curve != NULL;
    for (size_t k = 0; k < n && good; k++) x[k] = r->points[2 * k], y[k] = r->points[2 * k + 1];
    if (good) {
        (void)gsl_interp_init(curve, x, y, n);
        evaluate(out, r, curve, x, y);
    }
    gsl_interp_free(curve);
    free(x);
    free(y);
    return good ? DEM_OK : DEM_ERROR_MEMORY;
}

/* ---- heights ---- */

/* exp(-y), 0 <= y < 50: its series for y/64, squared six times. */
static double decay(double y)
{
    double sum = 1.0;
    for (int k = 18; k > 0; k--) sum = 1.0 - sum * (y / 64.0) / k;
    for (int k = 0; k < 6; k++) sum *= sum;
    return sum;
}

/* The kernel exp(-2 d^2/correlation^2), whose own autocorrelation is exp(-d^2/correlation^2), with a sum of squares of
 * roughness^2: under it, noise of variance 1 gets this variance. The weights at both sides are equal.
 * \param[out] weights  [n + 1] */
static void set_kernel(double *weights, size_t n, const profile_recipe *r)
{
    const double step = length_of_segment(r) / r->correlation;
    double squares = 0.0;
    for (size_t k = 0; k <= n; k++) {
        const double d = (double)k * step;
        weights[k] = decay(2.0 * d * d);
        squares += (k > 0 ? 2.0 : 1.0) * weights[k] * weights[k];
    }
    for (size_t k = 0; k <= n; k++) weights[k] *= r->roughness / sqrt(squares);
}

/* Numbers of mean 0 and variance 1. The sum of twelve uniform ones is nearly Gaussian, sums of such sums even more. */
static void set_noise(double *noise, size_t n, gsl_rng *rng)
{
    for (size_t k = 0; k < n; k++) {
        noise[k] = -6.0;
        for (int j = 0; j < 12; j++) noise[k] += gsl_rng_uniform(rng);
    }
}

static void add_heights(double *out, size_t n_samples, const double *weights, size_t n, const double *noise)
{
    for (size_t i = 0; i < n_samples; i++) {
        const double *middle = noise + i + n;
        double height = weights[0] * middle[0];
        for (size_t k = 1; k <= n; k++) height += weights[k] * (*(middle - k) + middle[k]);
        out[2 * i + 1] += height;
    }
}

static dem_status roughen(double *out, const profile_recipe *r)
{
    const double slack = 1e-9; /* where the profile lies must not, by rounding, make another of it */
    const size_t n = (size_t)ceil(reach * r->correlation / length_of_segment(r) - slack);
    const size_t n_samples = r->n_segments + 1;
    const size_t n_noise = n_samples + 2 * n; /* the ends have neighbours, too */
    double *weights = calloc(n + 1, sizeof *weights), *noise = calloc(n_noise, sizeof *noise);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    const bool good = weights != NULL && noise != NULL && rng != NULL;
    if (good) {
        gsl_rng_set(rng, r->seed);
        set_kernel(weights, n, r);
        set_noise(noise, n_noise, rng);
        add_heights(out, n_samples, weights, n, noise);
    }
    gsl_rng_free(rng);
    free(weights);
    free(noise);
    return good ? DEM_OK : DEM_ERROR_MEMORY;
}

dem_status profile_sample(double *out, const profile_recipe *recipe)
{
    if (!is_sound(recipe)) return DEM_ERROR_ARGUMENT;
    gsl_errors_return();
    dem_status status = sample_mean(out, recipe);
    if (status == DEM_OK && recipe->roughness > 0.0) status = roughen(out, recipe);
    gsl_errors_restore();
    return status;
}
