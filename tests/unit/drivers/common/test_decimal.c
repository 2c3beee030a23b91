/* SPDX-License-Identifier: BSD-3-Clause */
/* decimal.c: numbers as texts. */
#include "unit/close.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "decimal.h"

static void expect(double x, const char *expected)
{
    char text[DECIMAL_SIZE];
    decimal_print(text, x);
    assert_string_equal(text, expected);
}

TEST(few_digits_where_few_do)
{
    expect(0.1, "0.1");
    expect(1e22, "1e+22");
    expect(-3.0, "-3");
    expect(0.0, "0");
    expect(-0.0, "-0.0");
    expect(0.1 + 0.2, "0.30000000000000004");
}

/* Random bits, so that all exponents come up. */
TEST(every_number_reads_back)
{
    uint64_t bits = UINT64_C(88172645463325252);
    for (int k = 0; k < 20000; k++) {
        char text[DECIMAL_SIZE];
        double x;
        bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
        memcpy(&x, &bits, sizeof x);
        if (!isfinite(x)) continue;
        decimal_print(text, x);
        const double again = strtod(text, NULL);
        assert_memory_equal(&again, &x, sizeof x);
    }
    expect(DBL_MAX, "1.7976931348623157e+308");
    expect(5e-324, "4.94065645841247e-324");
}
