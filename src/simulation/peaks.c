/* SPDX-License-Identifier: BSD-3-Clause */
/* Largest stresses and strains of a run (docs/method.md, Stress): one entry for each node and spring, replaced by a
 * larger one with its time. How a stress is computed is in src/model/stress.c, when they are looked for in
 * peak_observer.c. */
#include "simulation/peaks.h"

#include "base/checkpoint_entries.h"
#include "base/status.h"
#include "model/stress.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The size of a node's stress is its von Mises stress; the components are kept with it. Most are below the peak by more
 * than squares are rounded, and take no root. */
static dem_status look_at_nodes(dem_peaks *p, const dem_simulation *simulation, double t)
{
    const double surely = 1.0 - 8.0 * DBL_EPSILON;
    TRY(dem_simulation_stress(simulation, p->stress));
    for (dem_index i = 0; i < p->n_nodes; i++) {
        const double *s = p->stress + 3 * i, square = stress_square(s), most = p->nodes[i].von_mises;
        if (square < surely * most * most) continue;
        const double size = sqrt(square);
        if (size > most) p->nodes[i] = (dem_node_peak){size, t, {s[0], s[1], s[2]}};
    }
    return DEM_OK;
}

/* The size of a strain is its magnitude; the sign is kept: stretched or squeezed. */
static dem_status look_at_springs(dem_peaks *p, const dem_simulation *simulation, double t)
{
    TRY(dem_simulation_strains(simulation, p->strain));
    for (dem_index k = 0; k < p->n_springs; k++)
        if (fabs(p->strain[k]) > fabs(p->springs[k].strain)) p->springs[k] = (dem_spring_peak){p->strain[k], t};
    return DEM_OK;
}

/* Room for stresses and strains, which a rank that leads a run does without. */
static dem_status make_scratch(dem_peaks *p)
{
    if (p->stress == NULL) p->stress = calloc((size_t)p->n_nodes, 3 * sizeof *p->stress);
    if (p->strain == NULL) p->strain = calloc((size_t)p->n_springs + 1, sizeof *p->strain);
    CHECK(p->stress != NULL && p->strain != NULL, DEM_ERROR_MEMORY, "out of memory for the peaks of %lld nodes",
          (long long)p->n_nodes);
    return DEM_OK;
}

dem_status peaks_look(dem_peaks *p, const dem_simulation *simulation)
{
    dem_progress now = {.struct_size = sizeof now};
    TRY(peaks_load(p));
    TRY(make_scratch(p));
    TRY(dem_simulation_progress(simulation, &now));
    TRY(look_at_nodes(p, simulation, now.t));
    return look_at_springs(p, simulation, now.t);
}

/* ---- entries ---- */

dem_status peaks_make_node_room(dem_peaks *p)
{
    if (p->nodes == NULL) p->nodes = calloc((size_t)p->n_nodes, sizeof *p->nodes);
    CHECK(p->nodes != NULL, DEM_ERROR_MEMORY, "out of memory for the peaks of %lld nodes", (long long)p->n_nodes);
    return DEM_OK;
}

dem_status peaks_make_spring_room(dem_peaks *p)
{
    if (p->springs == NULL) p->springs = calloc((size_t)p->n_springs + 1, sizeof *p->springs);
    CHECK(p->springs != NULL, DEM_ERROR_MEMORY, "out of memory for the peaks of %lld springs", (long long)p->n_springs);
    return DEM_OK;
}

static void drop_entries(dem_peaks *p)
{
    free(p->nodes);
    free(p->springs);
    p->nodes = NULL;
    p->springs = NULL;
}

void peaks_give_up(dem_peaks *p)
{
    drop_entries(p);
    dem_checkpoint_destroy(p->from);
    p->from = NULL;
}

/* ---- in checkpoints ---- */

const char peaks_entry_nodes[] = "peaks.nodes", peaks_entry_springs[] = "peaks.springs";

static size_t bytes_of_nodes(const dem_peaks *p)
{
    return (size_t)p->n_nodes * sizeof *p->nodes;
}

static size_t bytes_of_springs(const dem_peaks *p)
{
    return (size_t)p->n_springs * sizeof *p->springs;
}

static bool is_entry(const char *name)
{
    return strcmp(name, peaks_entry_nodes) == 0 || strcmp(name, peaks_entry_springs) == 0;
}

dem_status peaks_go_on(dem_peaks *p, const dem_checkpoint *from)
{
    TRY(checkpoint_entries_check(from, peaks_entry_nodes, bytes_of_nodes(p)));
    TRY(checkpoint_entries_check(from, peaks_entry_springs, bytes_of_springs(p)));
    TRY(dem_checkpoint_create(&p->from));
    return checkpoint_entries_choose(p->from, from, is_entry);
}

dem_status peaks_put(const dem_peaks *p, dem_checkpoint *into)
{
    if (p->from != NULL) return checkpoint_entries_copy(into, p->from);
    TRY(dem_checkpoint_put(into, peaks_entry_nodes, p->nodes, bytes_of_nodes(p)));
    return dem_checkpoint_put(into, peaks_entry_springs, p->springs, bytes_of_springs(p));
}

static dem_status load(dem_peaks *p)
{
    TRY(peaks_make_node_room(p));
    TRY(peaks_make_spring_room(p));
    TRY(dem_checkpoint_get(p->from, peaks_entry_nodes, p->nodes, bytes_of_nodes(p)));
    return dem_checkpoint_get(p->from, peaks_entry_springs, p->springs, bytes_of_springs(p));
}

dem_status peaks_load(dem_peaks *p)
{
    if (p->from == NULL) return DEM_OK;
    const dem_status status = load(p);
    if (status != DEM_OK) {
        drop_entries(p);
        return status;
    }
    dem_checkpoint_destroy(p->from);
    p->from = NULL;
    return DEM_OK;
}

static dem_status read_rows(const dem_peaks *p, const char *name, rows_here here, dem_index first, dem_index n,
                            void *rows)
{
    checkpoint_row_source there = {p->from, name, 0, here.size};
    return p->from != NULL ? checkpoint_entries_row_reader(&there, first, n, rows)
                           : rows_reader_copy(&here, first, n, rows);
}

dem_status peaks_read_nodes(void *peaks, dem_index first, dem_index n, void *rows)
{
    const dem_peaks *p = peaks;
    return read_rows(p, peaks_entry_nodes, (rows_here){sizeof *p->nodes, p->nodes}, first, n, rows);
}

dem_status peaks_read_springs(void *peaks, dem_index first, dem_index n, void *rows)
{
    const dem_peaks *p = peaks;
    return read_rows(p, peaks_entry_springs, (rows_here){sizeof *p->springs, p->springs}, first, n, rows);
}
