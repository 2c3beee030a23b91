/* SPDX-License-Identifier: BSD-3-Clause */
/* A second computation of a crack in a stretched strip, from the law's own words and without the library: nodes of its
 * own, forces and stresses triangle by triangle, the classical Runge-Kutta method with steps of one length, and the
 * whole strip stops at each break. Poisson's ratio is 1/3, that of springs alone in plane stress. Its units are the
 * spacing a, Young's modulus, density and thickness, so that times are in a/c, c = sqrt(E/density). */
#ifndef DEM_TEST_REFERENCE_STRIP_H
#define DEM_TEST_REFERENCE_STRIP_H

#include <stdbool.h>

typedef struct reference_break {
    double t, x[2]; /* where the centre of the triangle was at rest; the lower left corner of the strip is 0 */
} reference_break;

typedef struct reference_load {
    bool by_stretch;
    int wide, rows; /* springs along the lowest row; rows of nodes, both outermost ones held */
    double limit;   /* strength/E, or critical stretch */
    double g;       /* G over E limit^2 a */
    double cut;     /* triangles of the middle row up to here are broken at the start */
    double margin;  /* nothing breaks nearer than this to the sides and to the right end */
} reference_load;

/** All that breaks until the tip of the crack has come to x = `until`, in the order of time, by steps of `step`, a/c.
 *  \param[out] list  [most]; more than these fail the test, as does a tip that has not come there after 1000 a/c
 *  \return how many there are */
int reference_strip(const reference_load *load, double until, double step, reference_break *list, int most);

#endif
