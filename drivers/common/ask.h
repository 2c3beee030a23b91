/* SPDX-License-Identifier: BSD-3-Clause */
/* What the library says of models and simulations, by value: the structs have the size that this program knows. Where
 * the library refuses, all members are 0, and dem_status_message() says why. */
#ifndef DEM_ASK_H
#define DEM_ASK_H

#include <stdbool.h>

#include <dem/trajectory.h>

#define ASK(type, call)                                                                                                \
    type out = {.struct_size = sizeof out};                                                                            \
    (void)(call);                                                                                                      \
    return out

static inline dem_model_size ask_sizes(const dem_model *model)
{
    ASK(dem_model_size, dem_model_sizes(model, &out));
}

static inline dem_csr ask_csr(const dem_model *model)
{
    ASK(dem_csr, dem_model_csr(model, &out));
}

static inline dem_options ask_options(const dem_simulation *simulation)
{
    ASK(dem_options, dem_simulation_options(simulation, &out));
}

static inline dem_state ask_state(const dem_simulation *simulation)
{
    ASK(dem_state, dem_simulation_state(simulation, &out));
}

static inline dem_progress ask_progress(const dem_simulation *simulation)
{
    ASK(dem_progress, dem_simulation_progress(simulation, &out));
}

static inline dem_energy ask_energy(const dem_simulation *simulation)
{
    ASK(dem_energy, dem_simulation_energy(simulation, &out));
}

static inline dem_strain ask_strain(const dem_simulation *simulation)
{
    ASK(dem_strain, dem_simulation_strain(simulation, &out));
}

static inline dem_counts ask_counts(const dem_simulation *simulation)
{
    ASK(dem_counts, dem_simulation_counts(simulation, &out));
}

static inline dem_overlap ask_overlap(const dem_simulation *simulation)
{
    ASK(dem_overlap, dem_simulation_overlap(simulation, &out));
}

static inline dem_surfaces ask_surfaces(const dem_simulation *simulation)
{
    ASK(dem_surfaces, dem_simulation_surfaces(simulation, &out));
}

static inline dem_fracture ask_fracture(const dem_simulation *simulation)
{
    ASK(dem_fracture, dem_simulation_fracture(simulation, &out));
}

/** 0, as where it is not known, when memory runs out. */
static inline double ask_crack_energy(const dem_simulation *simulation)
{
    double energy = 0.0;
    return dem_simulation_crack_energy(simulation, &energy) == DEM_OK ? energy : 0.0;
}

static inline dem_pair ask_pair(const dem_simulation *simulation, dem_index pair)
{
    ASK(dem_pair, dem_simulation_pair(simulation, pair, &out));
}

static inline dem_contact ask_contact(const dem_simulation *simulation, dem_index contact)
{
    ASK(dem_contact, dem_simulation_contact(simulation, contact, &out));
}

static inline dem_body_motion ask_body(const dem_simulation *simulation, dem_index body)
{
    ASK(dem_body_motion, dem_simulation_body(simulation, body, &out));
}

static inline double ask_inertia(const dem_simulation *simulation, dem_index body)
{
    double inertia = 0.0;
    (void)dem_simulation_inertia(simulation, body, &inertia);
    return inertia;
}

static inline dem_obstacle_load ask_obstacle(const dem_simulation *simulation, dem_index obstacle)
{
    ASK(dem_obstacle_load, dem_simulation_obstacle(simulation, obstacle, &out));
}

/* Refused only where a function gives the motion, which no deck has. */
static inline void ask_obstacle_velocity(const dem_obstacle *obstacle, double t, const double *x, double velocity[2])
{
    velocity[0] = velocity[1] = 0.0;
    (void)dem_obstacle_velocity(obstacle, t, x, velocity);
}

static inline dem_boundary_load ask_boundary(const dem_simulation *simulation, dem_index boundary)
{
    ASK(dem_boundary_load, dem_simulation_boundary(simulation, boundary, &out));
}

static inline dem_observer ask_peaks_observer(dem_peaks *peaks)
{
    ASK(dem_observer, dem_peaks_observer(peaks, &out));
}

static inline dem_observer ask_trajectory_observer(dem_trajectory *trajectory)
{
    ASK(dem_observer, dem_trajectory_observer(trajectory, &out));
}

#endif
