/* SPDX-License-Identifier: BSD-3-Clause */
/* Quasi-static runs: bodies are damped until what acts on every node is in balance. */
#ifndef DEM_RELAXATION_H
#define DEM_RELAXATION_H

#include <stdbool.h>

#include <dem/dem.h>

#include "lattice_facts.h"

typedef struct relaxation {
    double residual;   /* at which the bodies are at rest; see dem_simulation_residual() */
    double settled;    /* s, when the last ramp has ended */
    long steps;        /* since the last look */
    double reached, t; /* residual at the last look, and when that was */
    bool done;
} relaxation;

/* Damping of the masses, 1/s, that is critical for the slowest stretch of a body held at one end: twice
 * pi c/(2 L), L the extent of all nodes; c = omega_max spacing/2, the speed of sound of a chain, in the fastest spring,
 * slower in all as their mean slowness is. */
double relaxation_damping(const dem_model *model, const lattice_facts *facts);

/* When the last ramp ends, s. */
double relaxation_settled(const dem_options *options);

/* When a run will be at rest, s, about: after the last ramp the slowest motion, of relaxation_damping(), decays from 1
 * to the residual at the rate that the damping in force gives it. Infinite without damping of the masses. */
double relaxation_expected(const dem_simulation *simulation, const lattice_facts *facts, const dem_options *options,
                           double residual);

/* A run that is to end at this residual. */
relaxation relaxation_start(double residual, const dem_options *options);

/* Goes on from a checkpoint of such a run.  DEM_ERROR_IO if it is not of one. */
dem_status relaxation_resume(relaxation *r, const dem_checkpoint *checkpoint);

/* To be handed to the simulation, behind all others: stops it when all ramps are over and the residual is small. */
dem_observer relaxation_observer(relaxation *r);

#endif
