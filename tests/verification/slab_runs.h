/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs by ranks, as threads, that have slabs of a lattice which no rank has, beside those of a process alone. */
#ifndef DEM_TEST_SLAB_RUNS_H
#define DEM_TEST_SLAB_RUNS_H

#include "rank_runs.h"

/** What is run. */
typedef struct slab_runs_scene {
    rank_runs_scene run;
    const dem_obstacle *obstacles;
    dem_index n_obstacles;
    ring_use use;
    dem_slab (*make)(const void *of, int part, int n_parts);
    const void *of; /* that is handed to `make` */
} slab_runs_scene;

/** Ranks with their slabs, and what they see. */
typedef struct slab_runs {
    const slab_runs_scene *scene;
    dem_slab slabs[RANK_RUNS_MOST];      /* are taken over */
    dem_index first[RANK_RUNS_MOST + 1]; /* own nodes, and behind the last */
    rank_runs_outcome outcomes[RANK_RUNS_MOST];
    bool has_no_options;         /* whether models are made for simulations of which nothing is known */
    bool is_cut[RANK_RUNS_MOST]; /* whether the model is as one that is cut from the whole */
} slab_runs;

/** Makes n slabs. */
slab_runs slab_runs_make(const slab_runs_scene *scene, int n);

/** Runs them. Outcomes are of rank_runs_make_outcomes(), unless no model comes of the slabs. */
void slab_runs_go(slab_runs *runs, int n);

/** n ranks have the models of ranks that cut them from the whole, and see what a process alone has seen. */
void slab_runs_assert_same(const slab_runs_scene *scene, int n, const rank_runs_outcome *whole);

#endif
