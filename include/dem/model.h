/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/model.h -- a lattice and obstacles, validated and compiled into an immutable model that simulations share.
 *  What a body is made of is in dem/lattice.h, how it moves in dem/simulation.h. */
#ifndef DEM_MODEL_H
#define DEM_MODEL_H

#include <dem/lattice.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum dem_friction_law {
    DEM_FRICTION_COULOMB = 0, /**< dry friction: at an impact |p_t| <= mu p_n, in a lasting contact |T| <= mu N */
    DEM_FRICTION_PAPER /**< at an impact v_t' = mu v_t, a lasting contact slides freely: docs/method.md    (10) */
} dem_friction_law;

/** Place and angle of an obstacle at one time, and their derivatives. A point of it that is given at X (dem_obstacle's
 *  points) is at place + R(angle) X, where R turns counter-clockwise about the origin. The third component of every
 *  vector is 0. */
typedef struct dem_pose {
    size_t struct_size;            /**< set by the library */
    double place[3];               /**< m */
    double velocity[3];            /**< m/s, the derivative of the place */
    double acceleration[3];        /**< m/s^2, that of the velocity */
    double angle, spin, spin_rate; /**< rad, rad/s, rad/s^2: an angle and its derivatives */
} dem_pose;

/** A motion that a program gives, twice continuously differentiable. It depends on t alone: the same t has the same
 *  pose whenever it is asked for, which is not in the order of time, and may be beyond the time of the run.
 *  Called by what computes with the obstacle, such as an advance, in the thread of the call and never from several at
 *  once; what only looks at a model or a simulation does not call it. Of ranks (dem/mpi.h) each calls its own, which
 *  returns to the bit what those of the others do: they compare it when a simulation is created, and before each step
 *  at `max_step` from its start. A difference ends the call on all ranks with DEM_ERROR_ARGUMENT.
 *  \param[out] pose  all 0 at entry
 *  \return other than DEM_OK to end an advance, which returns it and goes back to the last good state */
typedef dem_status (*dem_motion)(void *context, double t, dem_pose *pose);

/** A rigid polyline, at rest or moving; bodies live on the left of each segment, the solid is on its right. Closed if
 *  the last point is the first. The ends of an open one are free: what has passed round an end may come back from
 *  behind, unhindered. Restitution and friction are those of velocities relative to it. Its motions add up; nothing
 *  pushes it off its way. */
typedef struct dem_obstacle {
    size_t struct_size;   /**< to be set to sizeof(dem_obstacle), in each of an array */
    dem_index n_points;   /**< >= 2 */
    const double *points; /**< [n_points][2], m; from one to the next a length that can be squared */
    double restitution;   /**< eta in [0, 1], of a single node: a body rebounds by its waves even with 0   (9) */
    double friction;      /**< mu >= 0; 0: none in Coulomb's law. In (10) at most 1, which is none there */
    dem_friction_law friction_law;
    double velocity[3];   /**< m/s, of a translation. All vectors have a third component of 0 */
    double amplitude[3];  /**< m, of an oscillation amplitude sin(2 pi frequency t + phase) about the points given */
    double frequency;     /**< Hz, of it; > 0 */
    double phase;         /**< degrees, of it */
    double pivot[3];      /**< m, about which it turns, as the points are given; goes with the other motions */
    double spin;          /**< rad/s, of a rotation, counter-clockwise */
    double ramp;          /**< s, >= 0: velocity, amplitude and spin grow from 0 in this time, as a boundary's value */
    dem_motion motion;    /**< NULL: it moves as said above; else as this says, and in no other way */
    void *motion_context; /**< handed to it */
    double most_speed;    /**< m/s, > 0 with `motion`: what no point of the obstacle exceeds at any time, */
    double most_acceleration; /**< m/s^2, and this; a motion that does is a failure */
    double longest_step;      /**< s, a step that still follows it; 0: any */
} dem_obstacle;

/** A field of dem_obstacle that says how it moves: of this name in decks and files too. */
typedef struct dem_motion_field {
    const char *name, *unit;
    dem_index n;   /**< 1 or 2 numbers of type double, 2 of a vector, whose third is 0 in the plane, */
    size_t offset; /**< this many bytes behind the begin of dem_obstacle */
} dem_motion_field;

/** Field k of those of all ways to move; NULL beyond the last. What an obstacle does in several ways adds up. */
DEM_API const dem_motion_field *dem_motion_field_at(dem_index k);

/** Whether an obstacle moves in the way that a field is of, or in any (NULL). */
DEM_API bool dem_obstacle_moves(const dem_obstacle *obstacle, const dem_motion_field *by);

/** Where the points of an obstacle are at t.
 *  \param[out] points  [n_points][2], m; may be those of the obstacle */
DEM_API dem_status dem_obstacle_points(const dem_obstacle *obstacle, double t, double *points);

/** Velocity of the point of an obstacle that is at x at t.
 *  \param[out] velocity  [2] m/s */
DEM_API dem_status dem_obstacle_velocity(const dem_obstacle *obstacle, double t, const double *x, double *velocity);

/** Whether dem_model_create() takes the obstacle: its message otherwise, in which the obstacle has the number 0.
 *  \param[out] segments  two of it that meet, the second following the first if it goes back over it; else -1 */
DEM_API dem_status dem_obstacle_check(const dem_obstacle *obstacle, dem_index segments[2]);

/** Springs in CSR: row i holds the neighbours of node i in ascending order. Those of rigid bodies carry nothing and are
 *  left out: row[n_nodes] is twice the number of the others. Views into the model, valid as long as it is. */
typedef struct dem_csr {
    size_t struct_size; /**< to be set to sizeof(dem_csr) */
    dem_index n_nodes;
    const dem_index *row;       /**< [n_nodes + 1]   slots row[i] .. row[i+1]-1 belong to node i */
    const dem_index *neighbour; /**< [row[n_nodes]]  node j */
    const dem_index *spring;    /**< [row[n_nodes]]  index of the spring in the lattice */
    const double *stiffness;    /**< [row[n_nodes]]  E_ij, N                                         (1) */
    const double *rest_length;  /**< [row[n_nodes]]  d0_ij, m                                        (1) */
    const double *viscosity;    /**< [row[n_nodes]]  N s; NULL: undamped */
} dem_csr;

typedef struct dem_model dem_model;

/** Validates, copies and compiles. Lattice and obstacles may be freed afterwards. Node order is kept.
 *  \return DEM_ERROR_MODEL with the first offending node, spring, triangle or segment named */
DEM_API dem_status dem_model_create(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                    dem_index n_obstacles);

/** The same without a copy of the lattice, whose arrays have to outlive the model and to stay as they are, but for its
 *  velocities, which are copied. Before there is a simulation of the model its nodes may be moved all together: what
 *  the model says of obstacles does not depend on them.
 *  \return as dem_model_create() */
DEM_API dem_status dem_model_create_borrowing(dem_model **out, const dem_lattice *lattice,
                                              const dem_obstacle *obstacles, dem_index n_obstacles);

/** Accepts NULL. Destroy its simulations first. */
DEM_API void dem_model_destroy(dem_model *model);

/** The arrays are made at the first call, for all later ones, too, and take some 200 bytes a node of a lattice of
 *  triangles. Several threads may ask at once.
 *  \return DEM_ERROR_MEMORY */
DEM_API dem_status dem_model_csr(const dem_model *model, dem_csr *out);

/** The lattice as the model holds it; a view, not to be freed or changed. `position` is x itself where the model was
 *  given none. */
DEM_API const dem_lattice *dem_model_lattice(const dem_model *model);

/** An obstacle as the model holds it; a view.
 *  \param obstacle  0 <= obstacle < n_obstacles; NULL, and a dem_status_message(), for any other */
DEM_API const dem_obstacle *dem_model_obstacle(const dem_model *model, dem_index obstacle);

/** Which nodes are here: node i of dem_model_lattice() and of dem_state. Views into the model.
 *  \param[out] n_nodes  here, of a model that ranks share (dem/mpi.h) with some nodes of other ranks
 *  \param[out] number   [n_nodes] in the whole lattice, ascending; NULL: all nodes are here
 *  \param[out] is_own   [n_nodes] 1: a node of this rank, 0: of another one; each is that of one rank. NULL: all are
 *  \return DEM_ERROR_ARGUMENT for a NULL */
DEM_API dem_status dem_model_part(const dem_model *model, dem_index *n_nodes, const dem_index **number,
                                  const unsigned char **is_own);

typedef struct dem_model_size {
    size_t struct_size; /**< to be set to sizeof(dem_model_size) */
    dem_index n_nodes, n_springs, n_triangles, n_bodies;
    dem_index n_contact_nodes; /**< nodes that may touch */
    dem_index n_contact_edges; /**< boundary edges of the triangulation between two such nodes */
    dem_index n_obstacles, n_segments;
    dem_index n_vertices; /**< convex vertices of obstacles, which may touch such an edge */
} dem_model_size;

DEM_API dem_status dem_model_sizes(const dem_model *model, dem_model_size *out);

/** Shortest rest length, m; 0 without springs. */
DEM_API double dem_model_spacing(const dem_model *model);

/** Rigorous upper bound of the highest angular frequency about the rest shape, rad/s; 0 without springs:
 *  omega^2 <= max over nodes of |B_i| / m_i, B_i = 2 sum over springs of (E_ij/d0_ij) n n^T
 *  + 3 sum over triangles of max(kappa, 0)/A0 g g^T + C_i, g = dA/dx_i, |.| the largest eigenvalue. C_i is what
 *  coupled triangles add: docs/algorithms.md (The lattice). */
DEM_API double dem_model_omega_max(const dem_model *model);

/** The highest angular frequency about the rest shape itself, rad/s, found by iteration from below, to 1e-6 of it or
 *  better; 0 without springs. It takes some hundred evaluations of the forces.
 *  \return DEM_ERROR_MEMORY; DEM_ERROR_MODEL if it is not found in 2000 iterations */
DEM_API dem_status dem_model_omega(const dem_model *model, double *omega);

/** Elastic constants of a body about its rest shape, read as a plate in plane stress: a solid in plane strain has
 *  E/(1 - nu^2) and nu/(1 - nu). */
typedef struct dem_constants {
    size_t struct_size;        /**< to be set to sizeof(dem_constants) */
    double stiffness[3][3];    /**< C in s = C e, Pa: s = (s_xx, s_yy, s_xy), e = (e_xx, e_yy, 2 e_xy) */
    double youngs_modulus;     /**< E, Pa, of the isotropic plate nearest to C: the average over all directions */
    double poissons_ratio;     /**< nu of the same */
    double anisotropy;         /**< largest over smallest Young's modulus along a direction; 1: isotropic */
    double longitudinal_speed; /**< m/s, of long waves, with E, nu and the density */
    double transverse_speed;   /**< m/s */
    double volume;             /**< m^3, of the triangles */
} dem_constants;

/** Measures them by loading: every node on the boundary of the body's triangles, round its holes too, is displaced by
 *  a uniform strain, the nodes inside find their equilibrium, and the stress is the derivative of the energy over the
 *  volume of the triangles; three strains give C. It is the material's, not the structure's: a porous body is held at
 *  the rims of its pores. Exact for regular lattices, where the inside has no cause to move. Fixed nodes count as free.
 *  \param body  0 <= body < n_bodies
 *  \return DEM_ERROR_MODEL for a body without triangles or whose inside is not stable; DEM_ERROR_ARGUMENT also for a
 *  model that several ranks share; DEM_ERROR_MEMORY */
DEM_API dem_status dem_model_constants(const dem_model *model, dem_index body, dem_constants *out);

/** Total mass, kg. */
DEM_API double dem_model_mass(const dem_model *model);

/** What each node has of the solid's rest volume, m^3: a third of its triangles' areas times their thickness; 0 where
 *  it is in no triangle. [n_nodes], a view, made at the first call; NULL without memory, and a dem_status_message(). */
DEM_API const double *dem_model_volumes(const dem_model *model);

/** Signed distance of a point to the nearest obstacle, m: > 0 in front, < 0 inside; infinity without obstacles. */
DEM_API double dem_model_gap(const dem_model *model, const double *x);

#ifdef __cplusplus
}
#endif

#endif
