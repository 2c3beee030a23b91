/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/observer.h -- functions of the caller that a simulation calls at frames, steps, contact events and checkpoints;
 *  and the observer that keeps the largest stresses and strains of a run. */
#ifndef DEM_OBSERVER_H
#define DEM_OBSERVER_H

#include <dem/simulation.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A triangle, or a spring that no triangle holds, has broken. Breaks are the library's: a program reads of them what
 *  its header knows, and struct_size tells what there is. */
typedef struct dem_break {
    size_t struct_size; /**< bytes that the library has filled */
    double t;           /**< s */
    dem_index triangle; /**< its number in the lattice; -1: a spring */
    dem_index spring;   /**< likewise; -1: a triangle, with what it gave to its springs */
    dem_index body;     /**< of its nodes */
    double x[3];        /**< m, mean place of its nodes then */
    double stress[3]; /**< Pa, of a triangle the mean of its corners' stresses just before: xx, yy, xy; 0 of a spring */
    double energy;    /**< J, that it had. Elements that break at one instant are taken in their order: what several
                             of them hold goes with the last */
    dem_index fragment_new; /**< the fragment that it has split off, by its lowest node then; of several the lowest; -1:
                                 none. Elements that break at one instant are taken in their order, here too */
} dem_break;

/** Called during dem_simulation_advance(), in the order of time; any callback may be NULL. A status other than DEM_OK
 *  ends the advance and is returned by it. */
typedef struct dem_observer {
    size_t struct_size; /**< to be set to sizeof(dem_observer) */
    double interval;    /**< s between frames, the first at t = 0; <= 0: no frames */
    dem_status (*frame)(void *context, const dem_simulation *simulation); /**< state interpolated to the frame */
    dem_status (*step)(void *context, const dem_simulation *simulation);  /**< after every accepted step and at t = 0 */
    dem_status (*event)(void *context, const dem_simulation *simulation, const dem_event *event);
    /**< after every contact event; the simulation shows the state of that instant */
    dem_status (*checkpoint)(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint);
    /**< at every checkpoint, which has the simulation's entries already: puts in what the observer has to remember */
    void *context;
    dem_status (*broken)(void *context, const dem_simulation *simulation, const dem_break *what);
    /**< after every break, in the order of time with contact events; the simulation shows the state of that instant.
     *   What dem_simulation_break() has broken is reported at the start of the next advance */
    dem_index step_every; /**< > 0: `step` is called after accepted steps whose number since the start of the run is a
                               multiple of this, and at t = 0 */
    double step_interval; /**< s, > 0: and after the first accepted step at or behind each multiple of this. Where both
                               are 0 it is called after every accepted step. Between calls the run may take steps that
                               nobody sees, which take less time; its results have the same bits */
    dem_index step_touching; /**< not 0: besides after every accepted step in which something touches: in which contacts
                               with obstacles change, or at whose end one is closed or surfaces of bodies push each
                               other. And before the contact events of a step with the state from which it goes, unless
                               that has been shown; a resumed run may show that of its checkpoint once more. After every
                               step where bodies are rigid, and if an MPI rank leads the run */
} dem_observer;

/** Copies `observer`. At most 8; to be called before the first advance. One of a resumed simulation is shown the frames
 *  later than its checkpoint. */
DEM_API dem_status dem_simulation_observe(dem_simulation *simulation, const dem_observer *observer);

/* ---- peaks: the most stressed places of a run ------------------------------------------------------------------- */

/** Where and when a node was stressed most. */
typedef struct dem_node_peak {
    double von_mises; /**< Pa, the largest so far; 0: none */
    double t;         /**< s, when */
    double stress[3]; /**< Pa, at that instant: xx, yy, xy */
} dem_node_peak;

typedef struct dem_spring_peak {
    double strain; /**< that of the largest size so far, with its sign */
    double t;      /**< s, when */
} dem_spring_peak;

/** The largest von Mises stress of every node and the largest |strain| of every spring, an observer: it looks at t = 0
 *  and at every `every`-th accepted step. */
typedef struct dem_peaks dem_peaks;

/** \param every  >= 1. A look costs about an eighth of a step; between looks every 4 steps of 0.5/omega_max the
 *                 fastest wave of a lattice passes a third of its period. */
DEM_API dem_status dem_peaks_create(dem_peaks **out, const dem_model *model, dem_index every);

/** Peaks as they were when the checkpoint was taken; `every` is the checkpoint's.
 *  \return DEM_ERROR_ARGUMENT for another `every`; DEM_ERROR_IO if the checkpoint has none of such a model */
DEM_API dem_status dem_peaks_resume(dem_peaks **out, const dem_model *model, dem_index every,
                                    const dem_checkpoint *checkpoint);

/** Accepts NULL. */
DEM_API void dem_peaks_destroy(dem_peaks *peaks);

/** The observer to hand to dem_simulation_observe(), of a simulation of the same model; borrows the peaks. */
DEM_API dem_status dem_peaks_observer(dem_peaks *peaks, dem_observer *out);

/** Peaks so far, [n_nodes] and [n_springs]: views. */
DEM_API const dem_node_peak *dem_peaks_nodes(const dem_peaks *peaks);
DEM_API const dem_spring_peak *dem_peaks_springs(const dem_peaks *peaks);

/** The n nodes of the largest stresses so far, the largest first, equal ones in the order of their numbers.
 *  \param[out] nodes  [n]
 *  \return how many there are: less than n where less have been stressed at all */
DEM_API dem_index dem_peaks_most_stressed_nodes(const dem_peaks *peaks, dem_index n, dem_index *nodes);

/** The same of the springs and their strains. */
DEM_API dem_index dem_peaks_most_strained_springs(const dem_peaks *peaks, dem_index n, dem_index *springs);

#ifdef __cplusplus
}
#endif

#endif
