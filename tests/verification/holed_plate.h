/* SPDX-License-Identifier: BSD-3-Clause */
/* The exact plane stress of a rectangular plate with a round hole in its middle, under tension along x. Lengths are in
 * radii of the hole, stresses in the tension. */
#ifndef DEM_TEST_HOLED_PLATE_H
#define DEM_TEST_HOLED_PLATE_H

/* Muskhelishvili, with lengths in R, tension 1 and z = x + iy: sxx + syy = 4 Re f, syy - sxx + 2 i sxy = 2 (conj(z)
 * f' + g). The plate is symmetric about both axes, so f = sum a_n z^2n, g = sum b_n z^2n with real a_n, b_n, n =
 * -terms .. terms, and there is no force on |z| = 1 if b_(n-1) = (1 - 2n) a_n + a_(-n). The a_n are those that
 * leave least traction on the outer edges, beside the tension, at points of the quarter x, y > 0. */
enum { HOLED_PLATE_TERMS = 24, HOLED_PLATE_UNKNOWNS = 2 * HOLED_PLATE_TERMS + 1 };

typedef struct holed_plate {
    double length, height; /* halves of them, in R */
    double a[HOLED_PLATE_UNKNOWNS];
    double error; /* largest traction left on the outer edges */
} holed_plate;

holed_plate holed_plate_solve(double length, double height);

/* Along the load, on the ligament at height y, in R. */
double holed_plate_stress(const holed_plate *p, double y);

#endif
