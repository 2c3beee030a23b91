/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DEM_UNIT_ELASTIC_QUOTIENTS_AVX512_H
#define DEM_UNIT_ELASTIC_QUOTIENTS_AVX512_H

/** a/b of eight numbers each. */
void quotients_avx512(const double *a, const double *b, double *quotients);

#endif
