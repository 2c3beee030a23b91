/* SPDX-License-Identifier: BSD-3-Clause */
/* Gauss's rule of integration: n points of the interval from -1 to 1, the zeros of Legendre's polynomial P_n, and their
 * weights. It is exact for polynomials up to the degree 2 n - 1. */
#ifndef DEM_BASE_GAUSS_RULE_H
#define DEM_BASE_GAUSS_RULE_H

enum { GAUSS_RULE_MOST = 64 };

typedef struct gauss_rule {
    int n;
    double x[GAUSS_RULE_MOST], weight[GAUSS_RULE_MOST]; /* ascending; antisymmetric and symmetric to the bit */
} gauss_rule;

/** \param n  of points, 1 to GAUSS_RULE_MOST */
gauss_rule gauss_rule_of(int n);

#endif
