/* SPDX-License-Identifier: BSD-3-Clause */
#include "decimal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void decimal_print(char out[DECIMAL_SIZE], double x)
{
    if (x == 0 && signbit(x)) {
        (void)snprintf(out, DECIMAL_SIZE, "-0.0");
        return;
    }
    for (int digits = 15; digits <= 17; digits++) {
        (void)snprintf(out, DECIMAL_SIZE, "%.*g", digits, x);
        if (strtod(out, NULL) == x) return;
    }
}
