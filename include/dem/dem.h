/* SPDX-License-Identifier: BSD-3-Clause */
/** dem -- elastic bodies as spring lattices, dropped on rigid obstacles. This header includes the others, but for those
 *  of files:
 *
 *      dem/lattice.h     dem_lattice: plain arrays that you may edit: nodes, springs, triangles; materials
 *      dem/shape.h       dem_shape: outlines, images, voids and pores, from which lattices are made
 *      dem/slab.h        dem_slab: lattices in slabs, for several processes none of which has the whole
 *      dem/model.h       dem_model: compiled from a lattice and obstacles; validated, immutable, shareable
 *      dem/simulation.h  dem_simulation: owns the moving state; dem_simulation_advance() is the time loop
 *      dem/observer.h    dem_observer: is shown the simulation at frames, accepted steps and contact events
 *      dem/method.h      methods of integration in time
 *      dem/checkpoint.h  dem_checkpoint: what a run has to know so as to go on, in memory and as a file
 *      dem/status.h      what a call returns, and messages
 *
 *      dem/trajectory.h  dem_trajectory: a run as an HDF5 file; lattices from files      (not included here)
 *      dem/reader.h      dem_reader: such a file read back                               (not included here)
 *
 *  Units are SI throughout. Node arrays are [n][2], row-major: x0 y0 x1 y1 ...
 *  Numbers in parentheses, (1) to (10), are the equations of docs/method.md.
 *
 *  A function that can fail returns a dem_status; what it writes through `out` is set only on DEM_OK, and after a
 *  failure nothing has changed. dem_status_message() then tells what happened, with names and numbers.
 *  The library never prints, exits or aborts, and has no global state but that message, which each thread has for
 *  itself, and the turns in which threads use HDF5: distinct objects may live in distinct threads, and simulations in
 *  several threads may share a model. */
#ifndef DEM_DEM_H
#define DEM_DEM_H

#include <dem/checkpoint.h>
#include <dem/lattice.h>
#include <dem/method.h>
#include <dem/model.h>
#include <dem/observer.h>
#include <dem/shape.h>
#include <dem/simulation.h>
#include <dem/slab.h>
#include <dem/status.h>

#endif
