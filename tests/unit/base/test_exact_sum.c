/* SPDX-License-Identifier: BSD-3-Clause */
/* exact_sum.c: against sums of fractions worked out by Python, sums known by hand, and itself in
 * other orders. Every comparison is to the bit: the nearest double is one number. */
#include "unit/close.h"

#include <float.h>
#include <string.h>

#include "base/exact_sum.h"

enum { most = 20000 };

static double terms[most];

static double sum_of(const double *x, int n)
{
    exact_sum s = {0};
    for (int k = 0; k < n; k++) exact_sum_add(&s, x[k]);
    return exact_sum_value(&s);
}

/* The same bits, so that +0 is not -0. */
static void assert_same(double actual, double expected)
{
    if (memcmp(&actual, &expected, sizeof actual) != 0) fail_msg("%a, expected %a", actual, expected);
}

/* ---- pseudo-random terms ---- */

/* Knuth's generator of period 2^64, 53 bits of it. */
static int64_t draw(uint64_t *state)
{
    *state = *state * 6364136223846793005 + 1442695040888963407;
    return (int64_t)(*state >> 11);
}

/* A mantissa of 53 bits, an exponent in [low, high), a sign. */
static void fill(uint64_t state, int n, int low, int high)
{
    for (int k = 0; k < n; k++) {
        const double mantissa = (double)draw(&state);
        const int exponent = low + (int)(draw(&state) % (high - low));
        const double size = ldexp(mantissa, exponent);
        terms[k] = draw(&state) >> 40 & 1 ? -size : size;
    }
}

static void shuffle(uint64_t state, int n)
{
    for (int k = n - 1; k > 0; k--) {
        const int j = (int)(draw(&state) % (k + 1));
        const double kept = terms[k];
        terms[k] = terms[j];
        terms[j] = kept;
    }
}

/* ---- tests ---- */

/* Expected is float(sum(map(Fraction, terms))): over all exponents, near each other, subnormal, near overflow. */
TEST(a_sum_is_the_double_nearest_to_the_sum_of_fractions)
{
    static const struct {
        uint64_t seed;
        int n, low, high;
        double expected;
    } cases[] = {
        {1, 3000, -1126, 918, 0x1.10decb3ddda4cp+968},     {2, 3000, -60, -50, 0x1.30ab76d207678p+6},
        {3, 3000, -1126, -1074, -0x0.cc3e5bc22d3acp-1022}, {4, 3000, -20, 20, -0x1.6589952ab618fp+70},
        {5, 2, -1074, -1020, -0x1.9aef4881914a9p-998},     {6, 3000, 900, 908, 0x1.fa0bdb50ca191p+961},
        {7, 100, -1126, 918, 0x1.73db8aa16e501p+950},      {8, 100, -53, -52, 0x1.4cce64a4b6d13p+2},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        fill(cases[k].seed, cases[k].n, cases[k].low, cases[k].high);
        assert_same(sum_of(terms, cases[k].n), cases[k].expected);
    }
}

TEST(the_order_of_the_terms_does_not_matter)
{
    for (uint64_t seed = 10; seed < 30; seed++) {
        const int low = seed % 2 ? -1126 : -30, high = seed % 2 ? 900 : 30;
        fill(seed, most, low, high);
        const double first = sum_of(terms, most);
        for (uint64_t k = 1; k <= 5; k++) {
            shuffle(k, most);
            assert_same(sum_of(terms, most), first);
        }
    }
}

/* What is left of the sum without its rounded value is at most half a unit of its last place. With that taken away too,
 * and so on, nothing is left: the sum is known to its last bit. */
TEST(what_rounding_leaves_is_at_most_half_a_unit)
{
    for (uint64_t seed = 40; seed < 60; seed++) {
        exact_sum s = {0};
        int n_parts = 0;
        fill(seed, most, -1126, 900);
        for (int k = 0; k < most; k++) exact_sum_add(&s, terms[k]);
        for (double value = exact_sum_value(&s); value != 0.0; n_parts++) {
            exact_sum_add(&s, -value);
            const double rest = exact_sum_value(&s), unit = nextafter(fabs(value), INFINITY) - fabs(value);
            assert_true(fabs(rest) <= 0.5 * unit);
            value = rest;
        }
        assert_true(n_parts > 20); /* 2000 bits and more, 53 in each part */
    }
}

TEST(small_terms_outlive_large_ones_that_cancel)
{
    const double large[] = {1e300, 1.0, -1e300}, all[] = {DBL_MAX, 1e-300, DBL_MAX, -DBL_MAX, 0x1p-1074, -DBL_MAX};
    assert_same(sum_of(large, 3), 1.0);
    assert_same(sum_of(all, 6), 1e-300);
    terms[0] = 1.0;
    for (int k = 1; k < most; k++) terms[k] = k % 2 ? 0x1p-60 : -0x1p-60;
    assert_same(sum_of(terms, most - 1), 1.0);
}

TEST(ties_go_to_the_even_double)
{
    const double down[] = {1.0, 0x1p-53}, up[] = {1.0 + 0x1p-52, 0x1p-53}, above[] = {1.0, 0x1p-53, 0x1p-1074},
                 below[] = {-1.0, -0x1p-53, 0x1p-1074}, carry[] = {0x1.fffffffffffffp0, 0x1p-53};
    assert_same(sum_of(down, 2), 1.0);
    assert_same(sum_of(up, 2), 1.0 + 0x1p-51);
    assert_same(sum_of(above, 3), 1.0 + 0x1p-52);
    assert_same(sum_of(below, 3), -1.0);
    assert_same(sum_of(carry, 2), 2.0);
}

TEST(subnormal_numbers_are_terms_and_sums_like_others)
{
    const double least[] = {0x1p-1074, 0x1p-1074, -0x1p-1073}, gradual[] = {DBL_MIN, -0x1p-1074};
    for (int k = 0; k < most; k++) terms[k] = 0x1p-1074;
    assert_same(sum_of(terms, most), most * 0x1p-1074);
    assert_same(sum_of(least, 1), 0x1p-1074);
    assert_same(sum_of(least, 3), 0.0);
    assert_same(sum_of(gradual, 2), DBL_MIN - 0x1p-1074);
}

TEST(a_sum_that_is_zero_is_plus_zero)
{
    const double zeros[] = {-0.0, -0.0}, opposite[] = {-3.0, 3.0};
    assert_same(sum_of(zeros, 0), 0.0);
    assert_same(sum_of(zeros, 2), 0.0);
    assert_same(sum_of(opposite, 2), 0.0);
}

/* They would take the lowest limbs, and every carry all those from there on. */
TEST(zeros_take_no_limbs)
{
    exact_sum s = {0};
    exact_sum_add(&s, 0.0);
    exact_sum_add(&s, -0.0);
    assert_int_equal(s.high, 0);
    exact_sum_add(&s, 1.0);
    const int low = s.low;
    exact_sum_add(&s, 0.0);
    assert_true(s.low == low && low > 0);
    assert_same(exact_sum_value(&s), 1.0);
}

/* More of the largest mantissa than limbs have room for without carries, at every place in a limb: a power of two times
 * a term is a double. */
TEST(limbs_do_not_overflow)
{
    for (int exponent = 0; exponent < 32; exponent++) {
        exact_sum s = {0};
        const double term = ldexp(0x1.fffffffffffffp0, exponent);
        for (int k = 0; k < 16 * EXACT_SUM_MOST; k++) exact_sum_add(&s, term);
        assert_same(exact_sum_value(&s), 16.0 * EXACT_SUM_MOST * term);
    }
}

TEST(many_large_terms_overflow_only_when_they_are_read)
{
    exact_sum s = {0};
    for (int k = 0; k < 3 * EXACT_SUM_MOST; k++) exact_sum_add(&s, DBL_MAX);
    assert_same(exact_sum_value(&s), INFINITY);
    for (int k = 0; k < 3 * EXACT_SUM_MOST - 1; k++) exact_sum_add(&s, -DBL_MAX);
    assert_same(exact_sum_value(&s), DBL_MAX);
    for (int k = 0; k < 3 * EXACT_SUM_MOST; k++) exact_sum_add(&s, -DBL_MAX);
    assert_same(exact_sum_value(&s), -INFINITY);
    const double half[] = {DBL_MAX, 0x1p970}, less[] = {DBL_MAX, 0x1.fffffffffffffp969};
    assert_same(sum_of(half, 2), INFINITY); /* a tie, and the even neighbour is 2^1024 */
    assert_same(sum_of(less, 2), DBL_MAX);
}

TEST(terms_that_are_not_finite_count_in_any_order)
{
    const double up[] = {1.0, INFINITY, -DBL_MAX}, down[] = {-INFINITY, -INFINITY, 5.0},
                 both[] = {-INFINITY, 1.0, INFINITY}, none[] = {INFINITY, NAN, 1.0};
    assert_same(sum_of(up, 3), INFINITY);
    assert_same(sum_of(down, 3), -INFINITY);
    assert_true(isnan(sum_of(both, 3)));
    assert_true(isnan(sum_of(none, 3)));
}

/* ---- many at a time ---- */

/* The same number, not only the same rounded one: nothing is left of one without the other. */
static void assert_same_sum(exact_sum actual, exact_sum expected)
{
    exact_sum rest = expected;
    exact_sum_carry(&rest);
    for (int k = 0; k < EXACT_SUM_LIMBS; k++) rest.limb[k] = -rest.limb[k];
    exact_sum_join(&rest, &actual);
    assert_same(exact_sum_value(&rest), 0.0);
    assert_same(exact_sum_value(&actual), exact_sum_value(&expected));
}

/* The first n terms, to what is there already. */
static void assert_many_are_like_one_by_one(int n)
{
    exact_sum one_by_one = {0}, array = {0};
    exact_sum_add(&one_by_one, 1.0 / 3.0);
    exact_sum_add(&array, 1.0 / 3.0);
    for (int k = 0; k < n; k++) exact_sum_add(&one_by_one, terms[k]);
    exact_sum_add_array(&array, terms, n);
    assert_same_sum(array, one_by_one);
}

/* All exponents, as far as 2^86 apart, alike, subnormal, near overflow; lengths at the ends of lanes and blocks. */
TEST(many_terms_add_up_like_one_by_one)
{
    static const int ranges[][2] = {{-1126, 918}, {-1050, 945}, {-40, 46}, {-53, -52}, {-1126, -1074}, {900, 970}};
    static const int lengths[] = {0, 1, 15, 16, 17, 255, 256, 257, 512, 1000, most};
    for (size_t r = 0; r < sizeof ranges / sizeof ranges[0]; r++)
        for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; k++) {
            fill(70 + r, lengths[k], ranges[r][0], ranges[r][1]);
            assert_many_are_like_one_by_one(lengths[k]);
        }
}

/* A full block of the same term, whose multiples add up to the most that they can; all bits of its mantissa are set,
 * or rounding to multiples is a tie. */
TEST(blocks_of_equal_terms_are_exact)
{
    static const double equal[] = {0x1.fffffffffffffp0, 1.0, 0x1.0000000000001p0, 0x1.00000004p-3,
                                   0x1.fffffffffffffp-1022};
    for (size_t e = 0; e < sizeof equal / sizeof equal[0]; e++)
        for (int n = EXACT_SUM_BLOCK - 1; n <= EXACT_SUM_BLOCK + 1; n++) {
            for (int k = 0; k < n; k++) terms[k] = equal[e];
            assert_many_are_like_one_by_one(n);
        }
}

TEST(many_terms_that_cancel_leave_what_is_left)
{
    for (uint64_t seed = 80; seed < 90; seed++) {
        exact_sum s = {0};
        fill(seed, most / 2, seed % 2 ? -1050 : -60, seed % 2 ? 945 : 60);
        for (int k = 0; k < most / 2; k++) terms[most / 2 + k] = -terms[k];
        shuffle(seed, most);
        exact_sum_add_array(&s, terms, most);
        assert_same(exact_sum_value(&s), 0.0);
        terms[7] = terms[most - 1] = 0x1p-1074;
        assert_many_are_like_one_by_one(most);
    }
}

/* Blocks whose magnitudes overflow when they are added up, and those with terms that are not finite. */
TEST(blocks_that_overflow_are_added_one_by_one)
{
    fill(90, most, 960, 971);
    assert_many_are_like_one_by_one(most);
    for (int k = 0; k < most; k++) terms[k] = k % 3 ? -DBL_MAX : DBL_MAX;
    assert_many_are_like_one_by_one(most);
    exact_sum s = {0}, none = {0};
    terms[300] = INFINITY;
    exact_sum_add_array(&s, terms, most);
    assert_same(exact_sum_value(&s), INFINITY);
    terms[0] = NAN;
    exact_sum_add_array(&none, terms, most);
    assert_true(isnan(exact_sum_value(&none)));
}

TEST(pairs_are_added_to_two_sums)
{
    for (int n = 2; n <= EXACT_SUM_BLOCK; n += 14) {
        exact_sum pairs[2] = {{.n_terms = 0}}, apart[2] = {{.n_terms = 0}};
        double block[EXACT_SUM_BLOCK];
        fill(140 + (uint64_t)n, n, -90, 20);
        for (int k = 0; k < n; k++) exact_sum_add(&apart[k % 2], terms[k]);
        memcpy(block, terms, (size_t)n * sizeof *block);
        exact_sum_take_pairs(pairs, block, n);
        for (int c = 0; c < 2; c++) assert_same_sum(pairs[c], apart[c]);
    }
}

/* ---- sums of sums ---- */

enum { PARTS = 7 };

/* Every term goes into one of some sums, as nodes are shared out among processes, and these are joined in any order. */
static void assert_shares_are_like_one_sum(uint64_t *state, int n)
{
    exact_sum parts[PARTS], joined = {0}, whole = {0};
    const int n_parts = 1 + (int)(draw(state) % PARTS), first = (int)(draw(state) % n_parts);
    memset(parts, 0, sizeof parts);
    for (int k = 0; k < n; k++) exact_sum_add(&whole, terms[k]);
    shuffle((uint64_t)draw(state), n);
    for (int k = 0; k < n; k++) exact_sum_add(&parts[draw(state) % n_parts], terms[k]);
    for (int q = 0; q < n_parts; q++) exact_sum_join(&joined, &parts[(first + q) % n_parts]);
    assert_same_sum(joined, whole);
}

TEST(a_sum_does_not_depend_on_how_its_terms_are_shared_out)
{
    static const int ranges[][2] = {{-1126, 918}, {-60, -50}, {-20, 20}, {-1126, -1074}};
    static const int lengths[] = {3, 20, most};
    uint64_t state = 100;
    for (size_t r = 0; r < sizeof ranges / sizeof ranges[0]; r++)
        for (int split = 0; split < 60; split++) {
            const int n = lengths[split % 3];
            fill(110 + r, n, ranges[r][0], ranges[r][1]);
            assert_shares_are_like_one_sum(&state, n);
        }
}

TEST(joined_sums_have_room_for_many_more)
{
    exact_sum s = {0}, part = {0}, none = {0};
    for (int k = 0; k < EXACT_SUM_MOST - 1; k++) exact_sum_add(&part, -DBL_MAX);
    for (int k = 0; k < 5 * EXACT_SUM_MOST; k++) exact_sum_join(&s, &part);
    for (int k = 0; k < 5 * EXACT_SUM_MOST * (EXACT_SUM_MOST - 1); k++) exact_sum_add(&s, DBL_MAX);
    exact_sum_join(&s, &none);
    assert_same(exact_sum_value(&s), 0.0);
    exact_sum_add(&part, INFINITY);
    exact_sum_join(&s, &part);
    assert_same(exact_sum_value(&s), INFINITY);
}
