/* SPDX-License-Identifier: BSD-3-Clause */
/* Peaks as simulations know them: in a run that ranks make each rank has those of its part. */
#ifndef DEM_SIMULATION_PEAKS_H
#define DEM_SIMULATION_PEAKS_H

#include <stdbool.h>

#include <dem/dem.h>

struct dem_peaks {
    dem_index n_nodes, n_springs;
    dem_index every;      /* accepted steps from look to look */
    bool is_new;          /* no node and no spring has a peak yet */
    bool are_away;        /* ranks have them; then there are copies here, of nodes or of springs, or NULL */
    dem_node_peak *nodes; /* [n_nodes] */
    dem_spring_peak *springs;
    dem_checkpoint *from;       /* owned: the entries as nobody has read them yet, which are not here then; or NULL */
    double *stress;             /* [n_nodes][3] scratch, made by the first look */
    double *strain;             /* [n_springs] likewise */
    const dem_simulation *away; /* the simulation that leads the run whose ranks have them; NULL: none do */
};

/** Make room for the entries, which are 0, unless they are there.  \return DEM_ERROR_MEMORY */
dem_status peaks_make_node_room(dem_peaks *p);
dem_status peaks_make_spring_room(dem_peaks *p);

/** Reads the entries from the checkpoint that has them, if one does.
 *  \return DEM_ERROR_IO, DEM_ERROR_MEMORY; then it has them still, and there are none here */
dem_status peaks_load(dem_peaks *p);

/** Read rows of those of nodes, or of springs, from there or from here: rows_reader.  \param peaks  dem_peaks */
dem_status peaks_read_nodes(void *peaks, dem_index first, dem_index n, void *rows);
dem_status peaks_read_springs(void *peaks, dem_index first, dem_index n, void *rows);

/** Goes on from the entries of a checkpoint, when they are wanted.  \return DEM_ERROR_IO, DEM_ERROR_MEMORY */
dem_status peaks_go_on(dem_peaks *p, const dem_checkpoint *from);

/** Puts the entries into a checkpoint.  \return DEM_ERROR_MEMORY */
dem_status peaks_put(const dem_peaks *p, dem_checkpoint *into);

/** Names of the entries in a checkpoint. */
extern const char peaks_entry_nodes[], peaks_entry_springs[];

/** Frees the entries, which others have: views of them end. */
void peaks_give_up(dem_peaks *p);

/** Looks at all nodes and springs of a simulation, at the time that is seen. */
dem_status peaks_look(dem_peaks *p, const dem_simulation *simulation);

#endif
