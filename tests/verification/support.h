/* SPDX-License-Identifier: BSD-3-Clause */
/* Small bodies from literal arrays, and a run that checkpoints its impacts. */
#ifndef DEM_TEST_SUPPORT_H
#define DEM_TEST_SUPPORT_H

#include <gsl/gsl_math.h> /* M_PI */

#include <dem/dem.h>

#include "harness/motion.h"
#include "../unit/close.h"

/** Fails the test with the library's message unless the expression is DEM_OK. */
#define assert_ok(expression)                                                                                          \
    do {                                                                                                               \
        if ((expression) != DEM_OK) fail_msg("%s: %s", #expression, dem_status_message());                             \
    } while (0)

/** A body of n nodes at x [n][2] with masses, joined by n_springs springs of one rest length and stiffness; every
 *  node may touch. `fixed` [n] or NULL. Arrays are copied; free with dem_lattice_free. */
dem_lattice support_lattice(dem_index n, const double *x, const double *mass, dem_index n_springs,
                            const dem_index *ends, double rest_length, double stiffness, const unsigned char *fixed);

/** A rectangle of triangles with the springs and masses of a material; free with dem_lattice_free. */
dem_lattice support_rectangle(double width, double height, double spacing, const dem_material *material);

/** Two squares with the side and the spacing, the second one moved by `way`: bodies 0 and 1, with as many nodes each.
 *  Free with dem_lattice_free. */
dem_lattice support_squares(double side, double spacing, const dem_material *material, const double way[2]);

/** Heights of the highest and of the lowest node, m. */
double support_top(const dem_lattice *l);
double support_bottom(const dem_lattice *l);

/** What dem_model_create() and dem_simulation_create() make, which must succeed. */
dem_model *support_model(const dem_lattice *lattice, const dem_obstacle *obstacles, dem_index n_obstacles);
dem_simulation *support_simulation(const dem_model *model, const dem_options *options);

/** Sets where the nodes start and with which velocities [n][2]; NULL leaves it. */
void support_start(dem_lattice *lattice, const double *position, const double *velocity);

/** The default options, with the contact method that the environment names in CONTACT: 'local' or 'exact'. */
dem_options support_options(void);

enum { SUPPORT_IMPACTS = 4096 };

typedef struct support_run {
    dem_model *model;
    dem_simulation *simulation;
    dem_index n_impacts; /* all of them; the first SUPPORT_IMPACTS are kept */
    dem_event impacts[SUPPORT_IMPACTS];
} support_run;

/** A free block of rubber without guard, 50 x 52 mm, 137 nodes 5 mm apart, at rest and deformed: stretched along y by
 *  4 % and bent to a curvature of 1.4 1/m in its middle, both as (1 - s^2)^2 towards its ends s = -1, 1, where they
 *  vanish with their first derivatives; narrowed by a third of that. The largest strain of a spring is 5 %. */
void support_block(dem_lattice *out);

/** Model and simulation of a lattice, impacts recorded. */
void support_open(support_run *run, const dem_lattice *lattice, const dem_obstacle *obstacles, dem_index n_obstacles,
                  const dem_options *options);
void support_close(support_run *run);

/** The state at t, reached by advancing. */
motion support_at(support_run *run, double t);

/** One node of mass m at (x, y) with velocity (u, v), over one open or closed polyline. Tolerances fit a scale of 1
 *  m and the accuracy of the exact tests: rtol 1e-12, penetration tolerance 1e-13 m, steps of at most 0.01 s. */
void support_point(support_run *run, double m, const double x[2], const double v[2], const double *points,
                   dem_index n_points, double restitution);

#endif
