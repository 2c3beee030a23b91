/* SPDX-License-Identifier: BSD-3-Clause */
/* lanes_avx512.h: quotients by multiplications have the bits of divisions. Elsewhere nothing is to be tested. */
#include "unit/close.h"

#include <math.h>
#include <string.h>

#include "base/random.h"
#include "dem/dem.h"
#include "elastic/layout_lanes.h"
#include "unit/elastic/quotients_avx512.h"

__extension__ typedef unsigned __int128 wide;

enum { TRIALS = 200000, BITS = 53 };

/* Fails unless all quotients are those of divisions. */
static void assert_divided(const double *a, const double *b)
{
    double quotients[LAYOUT_LANES];
    quotients_avx512(a, b, quotients);
    for (int q = 0; q < LAYOUT_LANES; q++) {
        const double expected = a[q] / b[q];
        if (memcmp(&expected, &quotients[q], sizeof expected) != 0)
            fail_msg("%a/%a is %a, not %a", a[q], b[q], expected, quotients[q]);
    }
}

static bool has_avx512(void)
{
    return dem_kernel_check(DEM_KERNEL_AVX512) == DEM_OK;
}

static uint64_t next_bits(uint64_t *state)
{
    return random_mix(*state += random_stride);
}

/* Of any size from 1e-100 to 1e100, divided by positive ones. */
TEST(quotients_of_any_numbers_are_those_of_a_division)
{
    uint64_t state = 1;
    for (int k = 0; k < TRIALS && has_avx512(); k++) {
        double a[LAYOUT_LANES], b[LAYOUT_LANES];
        for (int q = 0; q < LAYOUT_LANES; q++) {
            a[q] = ldexp(random_next(&state), (int)(300.0 * random_next(&state)));
            b[q] = ldexp(fabs(random_next(&state)), (int)(300.0 * random_next(&state)));
        }
        assert_divided(a, b);
    }
}

/* x with b x = 1 modulo 2^64, of an odd b: each round doubles the bits that are right, of which the first has three. */
static uint64_t inverse_of(uint64_t b)
{
    uint64_t x = b;
    for (int k = 0; k < 5; k++) x *= 2 - b * x;
    return x;
}

/* A quotient next to the middle between two numbers. With significands B of 53 bits and an odd M of 54, which is such a
 * middle, and a small odd N let A = (B M + N)/2^54 be whole; then A/B is M/2^54 but for N/(2^54 B), and no quotient by
 * this B is nearer to a middle than that with N = 1 or -1.  \return whether there is one */
static bool find_hard(uint64_t B, int64_t N, double *a, double *b)
{
    const uint64_t below = (UINT64_C(1) << (BITS + 1)) - 1, M = (0 - (uint64_t)N) * inverse_of(B) & below;
    if (M >> BITS == 0) return false;
    *a = (double)(uint64_t)(((wide)B * M + (wide)N) >> (BITS + 1));
    *b = (double)B;
    return true;
}

TEST(quotients_next_to_the_middle_of_two_numbers_are_those_of_a_division)
{
    uint64_t state = 2;
    int found = 0;
    for (int k = 0; k < TRIALS && has_avx512(); k++) {
        const uint64_t B = next_bits(&state) >> (64 - BITS) | UINT64_C(1) << (BITS - 1) | 1;
        double a[LAYOUT_LANES], b[LAYOUT_LANES];
        for (int q = 0; q < LAYOUT_LANES; q++) {
            a[q] = b[q] = 1.0;
            found += find_hard(B, 2 * q - 7, &a[q], &b[q]);
        }
        assert_divided(a, b);
    }
    assert_true(found > TRIALS || !has_avx512());
}

/* Divisors just below and above a power of 2, where an inverse is hardest to round: all bits of the significand of one
 * are set. */
TEST(quotients_by_divisors_next_to_a_power_of_two_are_those_of_a_division)
{
    uint64_t state = 3;
    for (int k = 0; k < TRIALS && has_avx512(); k++) {
        double a[LAYOUT_LANES], b[LAYOUT_LANES];
        for (int q = 0; q < LAYOUT_LANES; q++) {
            const int from_power = q - 4; /* in halves of an ulp */
            a[q] = k % 4 == 0 ? ldexp(1.0, k % 50) : 1.5 + 0.5 * random_next(&state);
            b[q] = ldexp(1.0 + ldexp(from_power, -BITS), k % 100 - 50);
        }
        assert_divided(a, b);
    }
}

TEST(a_division_by_nothing_is_no_number)
{
    const double a[LAYOUT_LANES] = {1.0, -1.0}, b[LAYOUT_LANES] = {0.0};
    double quotients[LAYOUT_LANES] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    if (has_avx512()) quotients_avx512(a, b, quotients);
    for (int q = 0; q < LAYOUT_LANES; q++) assert_true(isnan(quotients[q]));
}

TEST(zeros_divided_are_zeros_of_their_sign)
{
    const double a[LAYOUT_LANES] = {0.0, -0.0, 0.0, -0.0},
                 b[LAYOUT_LANES] = {1.0, 3.0, 1e-20, 1e20, 0.1, 7.0, 0.3, 1.0};
    if (has_avx512()) assert_divided(a, b);
}
