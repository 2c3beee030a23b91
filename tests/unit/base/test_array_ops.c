/* SPDX-License-Identifier: BSD-3-Clause */
/* array_ops.c, of every instruction set that the machine has: against sums written out, and each other. */
#include "unit/close.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>

#include "base/array_ops.h"
#include "base/exact_sum.h"
#include "harness/cleanup_gsl.h"

enum { most = 10000, n_inputs = 20 };

static const array_ops *const tables[] = {&array_ops_portable,
#ifdef DEM_X86_KERNELS
                                          &array_ops_avx2, &array_ops_avx512
#endif
};
static const dem_kernel kinds[] = {DEM_KERNEL_PORTABLE, DEM_KERNEL_AVX2, DEM_KERNEL_AVX512};
static const int n_tables = sizeof tables / sizeof tables[0];

static const dem_index sizes[] = {0, 1, 7, 8, 9, 63, 4096, 4097, most};
static const int n_sizes = sizeof sizes / sizeof sizes[0];

static double in[n_inputs][most], out[most + 1], other[most + 1];

static int fill(void **state)
{
    CLEANUP(free_rng) gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
    (void)state;
    for (int p = 0; p < n_inputs; p++)
        for (dem_index k = 0; k < most; k++) in[p][k] = 2.0 * gsl_rng_uniform(r) - 1.0;
    return 0;
}

/* Equal to the bit: from the first term on. What lies behind the end is not touched. */
TEST(combinations_are_sums_from_the_first_term_on)
{
    double c[n_inputs];
    const double *from[n_inputs];
    for (int p = 0; p < n_inputs; p++) {
        c[p] = 1.0 / (1.0 + p);
        from[p] = in[p];
    }
    for (int t = 0; t < n_tables; t++)
        for (int n = 1; n <= n_inputs && dem_kernel_check(kinds[t]) == DEM_OK; n++)
            for (int s = 0; s < n_sizes; s++) {
                out[sizes[s]] = 77.0;
                tables[t]->combine(out, n, c, from, sizes[s]);
                for (dem_index k = 0; k < sizes[s]; k++) {
                    double sum = c[0] * in[0][k];
                    for (int p = 1; p < n; p++) sum += c[p] * in[p][k];
                    assert_close(out[k], sum, 0.0);
                }
                assert_close(out[sizes[s]], 77.0, 0.0);
            }
}

static double value(const array_ops *b, const double *x, const double *w, double scale, dem_index size)
{
    array_ops_sum sum = {0};
    b->square(&sum, x, w, scale, size);
    return array_ops_value(&sum);
}

/* Each square is off by 2^-61, and a sum in long double by less. */
TEST(relative_changes_of_lengths_are_those_of_each_one)
{
    for (int t = 0; t < n_tables; t++)
        for (int n = 0; n < 40 && dem_kernel_check(kinds[t]) == DEM_OK; n++) {
            double lengths[40], reference[40];
            for (int k = 0; k < n; k++) {
                lengths[k] = 0.3 + k * k;
                reference[k] = 0.7 + 0.9 * k;
            }
            tables[t]->stretch(lengths, reference, n);
            for (int k = 0; k < n; k++) /* to the bit */
                assert_close(lengths[k], (sqrt(0.3 + k * k) - reference[k]) / reference[k], 0.0);
        }
}

TEST(squares_add_up)
{
    for (int t = 0; t < n_tables; t++)
        for (int s = 0; s < n_sizes && dem_kernel_check(kinds[t]) == DEM_OK; s++) {
            long double sum = 0.0L;
            for (dem_index k = 0; k < sizes[s]; k++) {
                const double e = 8.0 * in[0][k] * in[1][k];
                sum += (long double)(e * e);
            }
            const double tolerance = (double)(sizes[s] + 1) * 0x1p-61 + (double)sum * 0x1p-52;
            assert_close(value(tables[t], in[0], in[1], 8.0, sizes[s]), (double)sum, tolerance);
        }
}

/* Backwards, and in parts that are added in another order: the same bits. */
TEST(the_order_of_squares_does_not_matter)
{
    for (dem_index k = 0; k < most; k++) {
        out[k] = in[0][most - 1 - k];
        other[k] = in[1][most - 1 - k];
    }
    for (int t = 0; t < n_tables; t++) {
        array_ops_sum parts[3] = {{0}}, sum = {0};
        const dem_index ends[] = {0, 1234, 5555, most};
        if (dem_kernel_check(kinds[t]) != DEM_OK) continue;
        for (int p = 0; p < 3; p++)
            tables[t]->square(&parts[p], in[0] + ends[p], in[1] + ends[p], 1.0, ends[p + 1] - ends[p]);
        for (int p = 2; p >= 0; p--) array_ops_add(&sum, &parts[p]);
        assert_close(array_ops_value(&sum), value(&array_ops_portable, in[0], in[1], 1.0, most), 0.0);
        assert_close(array_ops_value(&sum), value(tables[t], out, other, 1.0, most), 0.0);
    }
}

/* 32^2 is the largest square that may be added; its sums are exact, and so are those of squares down to 2^-60. */
TEST(squares_of_all_sizes_are_exact)
{
    const double numbers[] = {32.0, 0x1p-10, 0x1p-30, 3.0 * 0x1p-29};
    for (int q = 0; q < 4; q++)
        for (dem_index k = 0; k < most; k++) {
            out[k] = numbers[q];
            other[k] = 1.0;
            if (k == most - 1)
                for (int t = 0; t < n_tables; t++)
                    if (dem_kernel_check(kinds[t]) == DEM_OK)
                        assert_close(value(tables[t], out, other, 1.0, most), most * numbers[q] * numbers[q], 0.0);
        }
}

TEST(the_largest_square_is_known_and_what_is_no_number_is_reported)
{
    for (int t = 0; t < n_tables; t++)
        for (dem_index at = 0; at < 5000; at += 501) {
            array_ops_sum sum = {0};
            if (dem_kernel_check(kinds[t]) != DEM_OK) continue;
            const double kept = in[0][at];
            in[0][at] = -40.0;
            tables[t]->square(&sum, in[0], in[2], 1.0, most);
            assert_close(sum.largest, fmax(1600.0 * in[2][at] * in[2][at], sum.largest), 0.0);
            in[0][at] = (double)NAN;
            sum = (array_ops_sum){0};
            tables[t]->square(&sum, in[0], in[2], 1.0, most);
            assert_true(isnan(sum.largest) != 0);
            in[0][at] = (double)INFINITY;
            sum = (array_ops_sum){0};
            tables[t]->square(&sum, in[0], in[2], 1.0, most);
            assert_false(sum.largest <= ARRAY_OPS_LARGEST);
            in[0][at] = kept;
        }
}

TEST(verlets_step_is_drift_and_kick)
{
    const double h = 0.3, *const start[3] = {in[0], in[1], in[2]};
    for (int t = 0; t < n_tables; t++)
        for (int s = 0; s < n_sizes && dem_kernel_check(kinds[t]) == DEM_OK; s++) {
            tables[t]->drift(out, other, start, h, sizes[s]);
            for (dem_index k = 0; k < sizes[s]; k++) {
                assert_close(out[k], in[0][k] + h * (in[1][k] + 0.5 * h * in[2][k]), 0.0);
                assert_close(other[k], in[1][k] + h * in[2][k], 1e-15);
            }
            tables[t]->kick(other, in[2], in[3], h, sizes[s]);
            for (dem_index k = 0; k < sizes[s]; k++)
                assert_close(other[k], in[1][k] + 0.5 * h * (in[2][k] + in[3][k]), 1e-15);
        }
}

/* By each table: no bit is lost, and what is left of a term is as small as it is to be. */
static void assert_splits_without_error(const double *terms, int n)
{
    for (int t = 0; t < n_tables; t++) {
        exact_sum lost[2] = {{.n_terms = 0}};
        double size[2], parts[4], largest = 0.0;
        if (dem_kernel_check(kinds[t]) != DEM_OK) continue;
        memcpy(other, terms, (size_t)n * sizeof *terms);
        tables[t]->magnitude(size, other, n);
        size[0] = size[1] = size[0] + size[1];
        const bool left = tables[t]->split(parts, other, n, size);
        for (int k = 0; k < n; k++) {
            const double rest = left ? other[k] : 0.0;
            exact_sum_add(&lost[k % 2], terms[k]);
            exact_sum_add(&lost[k % 2], -rest);
            largest = fmax(largest, fabs(rest));
        }
        for (int q = 0; q < 4; q++) exact_sum_add(&lost[q % 2], -parts[q]);
        for (int q = 0; q < 2; q++) assert_close(exact_sum_value(&lost[q]), 0.0, 0.0);
        for (int q = 0; q < 4; q += 2) assert_close((parts[q] + parts[q + 1] - parts[q]) - parts[q + 1], 0.0, 0.0);
        assert_true(largest <= 0x1p-94 * size[0]);
        assert_true(left == (largest > 0.0));
    }
}

/* Random terms alike, and 2^-120 to 1 of that, in blocks of all lengths. */
TEST(terms_are_split_without_an_error)
{
    for (int n = ARRAY_OPS_LANES; n <= ARRAY_OPS_TERMS; n += ARRAY_OPS_LANES) {
        assert_splits_without_error(in[n % n_inputs], n);
        for (int k = 0; k < n; k++) out[k] = ldexp(in[n % n_inputs][k], -(k * 7 % 121));
        assert_splits_without_error(out, n);
    }
}

/* A full block of the same term adds up to the most that its parts may: mantissas of ones, ties, subnormal numbers, the
 * largest ones; all of one sign, and one half against the other. */
TEST(full_blocks_of_equal_terms_are_split_without_an_error)
{
    static const double equal[] = {
        0x1.fffffffffffffp0,     1.0,       0x1.0000000000001p0,    0x1.00000004p-3,       0x1.000000000001p9,
        0x1.fffffffffffffp-1022, 0x1p-1074, 0x1.fffffffffffffp-970, 0x1.fffffffffffffp1008};
    for (size_t e = 0; e < sizeof equal / sizeof equal[0]; e++)
        for (int half = 0; half < 2; half++) {
            for (int k = 0; k < ARRAY_OPS_TERMS; k++) out[k] = half && k % 2 ? -equal[e] : equal[e];
            assert_splits_without_error(out, ARRAY_OPS_TERMS);
        }
}

/* Halves of the last places of both parts, on top of the largest term, decide which way each of them is rounded. */
/* Those at odd places are 2^-80 of the others, and nothing is left of either. */
TEST(terms_of_two_sizes_are_split_by_their_places)
{
    for (int t = 0; t < n_tables; t++) {
        double size[2], parts[4];
        if (dem_kernel_check(kinds[t]) != DEM_OK) continue;
        for (int k = 0; k < ARRAY_OPS_TERMS; k++) out[k] = ldexp(1.0 + in[0][k], k % 2 == 0 ? 0 : -80);
        tables[t]->magnitude(size, out, ARRAY_OPS_TERMS);
        assert_false(tables[t]->split(parts, out, ARRAY_OPS_TERMS, size));
        assert_true(parts[1] < 0x1p-60 * parts[0] && parts[1] > 0.0);
    }
}

TEST(what_lies_half_way_between_is_split_without_an_error)
{
    for (int low = -110; low < -40; low++) {
        for (int k = 0; k < ARRAY_OPS_TERMS; k++) out[k] = k % 3 ? ldexp(1.0, low) : -ldexp(3.0, low);
        out[17] = 1.0;
        assert_splits_without_error(out, ARRAY_OPS_TERMS);
    }
}

TEST_GROUP(fill, NULL);
