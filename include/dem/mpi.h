/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/mpi.h -- one model on several processes: the ranks of an MPI communicator share its nodes, and integrate them to
 *  the bits of one process, whatever their number. Of the library libdem_mpi, which `pkg-config dem_mpi` knows; libdem
 *  itself has no MPI.
 *
 *  Each rank has a model and a simulation of its part: its own nodes; those near what may touch obstacles, or break, on
 *  surfaces of bodies that may touch each other, and of rigid bodies, whoever owns them; and as ghosts those of other
 *  ranks that a spring or a triangle joins to one of these, in large parts further rings of them (dem_model_part()).
 *  What goes on is *collective*: all ranks make the same calls in the same order, with the same
 *  arguments, and wait for each other in them. These are
 *
 *      dem_model_create_mpi(), dem_model_create_mpi_for(), dem_model_create_mpi_slab(); dem_model_omega() and
 *      dem_model_destroy() of such models
 *      dem_simulation_create(), dem_simulation_resume(), dem_simulation_observe(), dem_simulation_advance()
 *      all that is asked of a motion: dem_simulation_state(), dem_simulation_gather(), and what follows them in
 *      dem/simulation.h, up to dem_simulation_residual()
 *
 *  What is measured is of all bodies, has the bits of one process, and is the same on all ranks: energies, strains,
 *  bodies, boundaries, counts, residual. Springs and nodes are named by their numbers in the whole lattice there, and
 *  in dem_simulation_stress_at() and dem_simulation_force_at(). Arrays are of the part, as dem_model_lattice() is:
 *  stresses of own nodes, strains and forces of springs that have an own node; what they say of others counts for
 *  nothing. So do dem_peaks.
 *
 *  Rank 0 has the checkpoints, with the bytes of one process: dem_simulation_checkpoint() is NULL elsewhere, and of
 *  what observers add to one elsewhere nothing is kept. Any number of ranks, or one process, goes on from it:
 *  dem_simulation_resume() takes that of rank 0.
 *
 *  A status of a collective function is that of all ranks, with the same dem_status_message(): what fails on one rank,
 *  or is returned by an observer there, ends the call on all. Not so DEM_ERROR_MEMORY, and what is said of `out`,
 *  `model` or `simulation` that is NULL: a rank that gets one of these alone should call MPI_Abort(), as the others may
 *  wait for it. Boundaries name nodes of the whole lattice.
 *
 *  All ranks have all contacts, whose nodes have their numbers in the whole lattice: events, counts of them, contacts,
 *  loads of obstacles, dem_simulation_surfaces() and dem_simulation_pair() are the same on each, and a rank may ask for
 *  these, for contact forces and pressures of its part, and watch events, by itself. So it is with breaks, whose
 *  elements have their numbers in the whole lattice, with what is broken in its part, and with what the last look has
 *  found, dem_simulation_overlap().
 *
 *  Functions of the program, external forces and motions of obstacles, are called on each rank, by that rank alone, and
 *  answer alike on all: dem_force and dem_motion say what they are asked. A failure of one is that of all ranks. Where
 *  there is such a function all ranks watch the same events and breaks, as each look asks it.
 *
 *  Of a body alone without obstacles, which may not break, dem_model_create_mpi() shares no surfaces: that it touches
 *  itself is refused (DEM_ERROR_ARGUMENT by dem_simulation_create()), unless dem_model_create_mpi_for() knows of it.
 *
 *  Ranks cannot share yet, and refuse: what a program breaks, and a motion that it sets; trajectories, fragments of
 *  bodies, elastic constants and the energy of cracks, which are of the whole lattice at once, that no rank keeps.
 *  `mpirun dem_batch` has all but what a program breaks: there rank 0 has the whole besides its part, but of a single
 *  large body that ranks make in slabs.
 *
 *  MPI is initialised and finalised by the program: models are created after the one and destroyed before the other.
 *  All calls come from one thread, that of MPI_Init() or MPI_Init_thread() unless MPI has MPI_THREAD_SERIALIZED. A
 *  failure inside MPI ends the program, as MPI does by itself. */
#ifndef DEM_MPI_H
#define DEM_MPI_H

#include <dem/dem.h>
#include <mpi.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Validates and compiles as dem_model_create() does, and shares the nodes out among the ranks of a communicator, in
 *  compact domains of equal size. Each rank gets the model of its domain; lattice and communicator may be freed
 *  afterwards. Collective. While it works every rank has the whole lattice.
 *  \param lattice    the same on all ranks, as are obstacles and n_obstacles
 *  \param obstacles  [n_obstacles]
 *  \return as dem_model_create(); DEM_ERROR_ARGUMENT if lattices or obstacles differ, MPI is not initialised, or libdem
 *  has another version than libdem_mpi; DEM_ERROR_MODEL also for more ranks than nodes */
DEM_API dem_status dem_model_create_mpi(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                        dem_index n_obstacles, MPI_Comm communicator);

/** The same for simulations with certain options, of which are looked at method, contact, bodies, boundaries, and
 *  whether there is an external force: ranks get of each other what these have a use for. Without them a model has the
 *  ghosts for steps of Fehlberg's pair, and in large parts for fewer steps of Verlet's method at once. Simulations with
 *  other options may take longer, and bodies can touch in them only if they do so with these.
 *  \param options  the same on all ranks
 *  \return besides, DEM_ERROR_ARGUMENT if what is looked at differs between ranks */
DEM_API dem_status dem_model_create_mpi_for(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                            dem_index n_obstacles, const dem_options *options, MPI_Comm communicator);

/** The same of a lattice that no rank has: each has a slab of it (dem/slab.h), rank 0 the first one, and owns the nodes
 *  that are the slab's own. While it works a rank has besides what is near its slab, and what is near nodes that may
 *  touch obstacles, or surfaces of bodies that touch. Springs and triangles are numbered slab by slab, each in the one
 *  that owns the lowest of its nodes, in the order that they have there. That is the order of lattices which dem/slab.h
 *  makes slabs of, and of files that dem_slab_read() reads slabs of: runs have the bits of one process that has such a
 *  lattice.
 *  For elastic bodies of triangles, connected or not, which may touch each other and themselves; rigid ones, and those
 *  that may break, are refused. `body` has the numbers of the whole, of the rim too, and a slab may have parts of
 *  several bodies. A slab that was made, and jittered, of a body alone becomes one of the whole with n_nodes and
 *  n_triangles of the whole, and with the number of nodes before that body added to first_node and to each number of
 *  the rim. Numbers of nodes, springs and triangles in messages about a slab are its own.
 *  \param slab     of this rank. It is taken over, so that nobody has it beside the model: it is empty afterwards,
 *                  whatever is returned
 *  \param options  as dem_model_create_mpi_for() has them; NULL: any without contact of bodies
 *  \return as dem_model_create_mpi_for(); DEM_ERROR_ARGUMENT also if slabs do not follow each other or do not have the
 *  same arrays, but for those that assembling leaves out; DEM_ERROR_MODEL also for what is not supported, which the
 *  message names */
DEM_API dem_status dem_model_create_mpi_slab(dem_model **out, dem_slab *slab, const dem_obstacle *obstacles,
                                             dem_index n_obstacles, const dem_options *options, MPI_Comm communicator);

/** The same for Fortran, where a communicator is an integer: docs/fortran.md has the first one's interface. */
DEM_API dem_status dem_model_create_mpi_f(dem_model **out, const dem_lattice *lattice, const dem_obstacle *obstacles,
                                          dem_index n_obstacles, MPI_Fint communicator);
DEM_API dem_status dem_model_create_mpi_for_f(dem_model **out, const dem_lattice *lattice,
                                              const dem_obstacle *obstacles, dem_index n_obstacles,
                                              const dem_options *options, MPI_Fint communicator);
DEM_API dem_status dem_model_create_mpi_slab_f(dem_model **out, dem_slab *slab, const dem_obstacle *obstacles,
                                               dem_index n_obstacles, const dem_options *options,
                                               MPI_Fint communicator);

#ifdef __cplusplus
}
#endif

#endif
