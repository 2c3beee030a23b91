/* SPDX-License-Identifier: BSD-3-Clause */
/* Plates of equal nodes and springs in equilateral triangles, here and for LAMMPS. */
#ifndef PLATE_H
#define PLATE_H

#include "bench.h"

double plate_bond(void);             /* stiffness of a spring, N/m */
double plate_mass(double spacing);   /* of a node, kg */
double plate_period(double spacing); /* sqrt(mass/bond), s */

/** The nodes and springs of rows that begin in turns at 0 and at half a spacing; at rest, may not touch. */
dem_lattice plate_make(dem_index columns, dem_index rows, double spacing);

/** Adds the triangles, so that the nodes on their boundary may touch. */
void plate_triangulate(dem_lattice *l, dem_index columns);

/** A rectangle of rubber of about so many nodes at 1 mm, twice as wide as high, with guarded triangles, `height` m
 *  above 0, which comes down at 1 m/s. */
dem_lattice plate_make_rubber(double nodes, double height);

/** Two such plates with triangles, of about so many nodes each: one above the other, shifted by 0.37 spacings and with
 *  `gap` spacings between them, which run towards each other with this speed each, m/s. */
dem_lattice plate_make_two(dem_index nodes, double gap, double spacing, double speed);

/** The body of W2: a rectangle of 8 x 13 cm with triangles, tilted by 0.03, which falls at 10 m/s; its lowest node is a
 *  fifth of a spacing above 0. */
dem_lattice plate_make_falling(double spacing);

/** Gives every triangle a folding guard, of this strength over E h. */
void plate_guard(dem_lattice *l, double strength);

/** Gives every spring this damping time, s. */
void plate_damp(dem_lattice *l, double time);

/** A data file for LAMMPS, in a box wider by `pad` all round; prints what a run needs beside it: springs, constant,
 *  length and period. */
void plate_write_lammps(const dem_lattice *l, double spacing, double pad, const char *path);

/** x y vx vy of every node, a line each. */
void plate_write_state(const dem_simulation *simulation, const char *path);

#endif
