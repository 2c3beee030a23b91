/* SPDX-License-Identifier: BSD-3-Clause */
/* Random scenes of 2 to 12 bodies that run into each other, in free space or in a box, which may move. */
#ifndef DEM_TEST_CROWD_H
#define DEM_TEST_CROWD_H

#include <dem/dem.h>

/** A scene, all of which follows from its seed. */
typedef struct crowd {
    uint64_t seed, state;
    dem_lattice lattice;
    dem_options options;
    bool boxed;
    double corners[10];
    dem_obstacle walls;
    double speed; /* m/s, of the bodies along x and y at most */
} crowd;

/** Its lattice is freed with dem_lattice_free(). It stays where it is, as its walls point to it. */
void crowd_draw(crowd *s, uint64_t seed);

#endif
