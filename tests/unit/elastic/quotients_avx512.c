/* SPDX-License-Identifier: BSD-3-Clause */
/* Quotients of the vectors of AVX-512, for test_quotients.c, which asks first whether the machine has them. */
#include "elastic/lanes_avx512.h"

#include "unit/elastic/quotients_avx512.h"

void quotients_avx512(const double *a, const double *b, double *quotients)
{
    lanes_store(quotients, lanes_div(lanes_load(a), lanes_load(b)));
}
