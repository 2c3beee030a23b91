/* SPDX-License-Identifier: BSD-3-Clause */
/* Random small bodies near random obstacles, the same for the same seed. */
#ifndef DEM_TEST_SCENE_H
#define DEM_TEST_SCENE_H

#include <gsl/gsl_rng.h>

#include "../verification/support.h"

enum { SCENE_POINTS = 64, SCENE_SOLIDS = 4 };

/** A polygon with the solid inside, or of a room outside. The library is given the first n_exposed points; the rest
 *  only closes the solid. */
typedef struct solid {
    dem_index n;
    double points[2 * SCENE_POINTS];
    dem_index n_exposed;
    int is_room;
} solid;

typedef struct scene {
    solid solids[SCENE_SOLIDS];
    dem_obstacle obstacles[SCENE_SOLIDS];
    int n;
    dem_lattice body;
    dem_options options;
    double spacing, t_end, interval; /* m; s; s between looks */
} scene;

/** Free with scene_free. */
void scene_random(scene *out, unsigned long seed);
void scene_free(scene *sc);

/** The same with nodes and obstacles listed in another order. \param[out] old  [n_nodes] old number of each node */
void scene_shuffle(scene *out, const scene *sc, unsigned long seed, dem_index *old);

#endif
