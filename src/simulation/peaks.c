/* SPDX-License-Identifier: BSD-3-Clause */
/* Largest stresses and strains of a run (docs/method.md, Stress): one entry for each node and spring, replaced by a
 * larger one with its time. It is an observer like any other, through the public interface: at every so-many-th
 * accepted step it looks at all nodes and springs, and it puts its entries into checkpoints. How a stress is computed
 * is in src/model/stress.c; files of peaks are in src/output/peaks_file.c. */
#include <dem/dem.h>

#include "base/checkpoint_entries.h"
#include "base/status.h"
#include "base/struct_size.h"
#include "model/stress.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

struct dem_peaks {
    dem_index n_nodes, n_springs;
    dem_index every; /* accepted steps between looks, */
    dem_index left;  /* so many are passed over before the next, as checkpoints have it */
    dem_node_peak *nodes;
    dem_spring_peak *springs;
    double *stress; /* [n_nodes][3] scratch */
    double *strain; /* [n_springs] scratch */
};

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

/* Those whose number is a multiple of `every` are looked at. */
static dem_index steps_since_look(const dem_peaks *p, const dem_simulation *simulation)
{
    dem_counts counts = {.struct_size = sizeof counts};
    (void)dem_simulation_counts(simulation, &counts);
    return counts.steps % p->every;
}

/* The observer's step. A program that was built with a header without `step_every` shows all of them. */
static dem_status look(void *context, const dem_simulation *simulation)
{
    dem_peaks *p = context;
    dem_progress now = {.struct_size = sizeof now};
    if (steps_since_look(p, simulation) > 0) return DEM_OK;
    TRY(dem_simulation_progress(simulation, &now));
    TRY(look_at_nodes(p, simulation, now.t));
    return look_at_springs(p, simulation, now.t);
}

/* Puts what a checkpoint contains of the peaks into it, or gets it from there. */
static dem_status pass(dem_peaks *p, const checkpoint_entries_way *way)
{
    TRY(checkpoint_entries_pass(way, "peaks.left", &p->left, sizeof p->left));
    TRY(checkpoint_entries_pass(way, "peaks.nodes", p->nodes, (size_t)p->n_nodes * sizeof *p->nodes));
    return checkpoint_entries_pass(way, "peaks.springs", p->springs, (size_t)p->n_springs * sizeof *p->springs);
}

/* The observer's checkpoint. */
static dem_status remember(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    const checkpoint_entries_way way = {.into = checkpoint};
    dem_peaks *p = context;
    p->left = p->every - 1 - steps_since_look(p, simulation);
    return pass(p, &way);
}

/* ---- ranks ---- */

/* Sizes of entries by their number. */
typedef double (*size_of)(const dem_peaks *p, dem_index k);

static double node_size(const dem_peaks *p, dem_index i)
{
    return p->nodes[i].von_mises;
}

static double spring_size(const dem_peaks *p, dem_index k)
{
    return fabs(p->springs[k].strain);
}

/* The n largest of `count`, those of equal size in the order of their numbers, by insertion into a list that descends.
 * Entries of size 0 have no peak. With n small this is one pass over all. */
static dem_index rank(const dem_peaks *p, size_of size, dem_index count, dem_index n, dem_index *list)
{
    dem_index filled = 0;
    for (dem_index k = 0; k < count; k++) {
        if (!(size(p, k) > 0.0) || n <= 0) continue;
        if (filled == n && size(p, k) <= size(p, list[n - 1])) continue;
        dem_index q = filled < n ? filled++ : n - 1;
        for (; q > 0 && size(p, list[q - 1]) < size(p, k); q--) list[q] = list[q - 1];
        list[q] = k;
    }
    return filled;
}

/* ---- public ---- */

dem_status dem_peaks_create(dem_peaks **out, const dem_model *model, dem_index every)
{
    CHECK(out != NULL && model != NULL, DEM_ERROR_ARGUMENT, "dem_peaks_create: %s is NULL", out ? "model" : "out");
    CHECK(every >= 1, DEM_ERROR_ARGUMENT, "peaks are looked for every %lld steps; it must be 1 or more",
          (long long)every);
    dem_model_size size = {.struct_size = sizeof size};
    TRY(dem_model_sizes(model, &size));
    const size_t n = (size_t)size.n_nodes, m = (size_t)size.n_springs;
    dem_peaks *p = calloc(1, sizeof *p);
    CHECK_MEMORY(p);
    *p = (dem_peaks){.n_nodes = size.n_nodes, .n_springs = size.n_springs, .every = every};
    p->nodes = calloc(n, sizeof *p->nodes);
    p->springs = calloc(m + 1, sizeof *p->springs);
    p->stress = calloc(n, 3 * sizeof *p->stress);
    p->strain = calloc(m + 1, sizeof *p->strain);
    if (p->nodes && p->springs && p->stress && p->strain) {
        *out = p;
        return DEM_OK;
    }
    dem_peaks_destroy(p);
    return status_fail(DEM_ERROR_MEMORY, "out of memory for the peaks of %lld nodes", (long long)size.n_nodes);
}

/* A checkpoint of a run with another `every` may count further down than this one: it is refused. */
dem_status dem_peaks_resume(dem_peaks **out, const dem_model *model, dem_index every, const dem_checkpoint *checkpoint)
{
    const checkpoint_entries_way way = {.from = checkpoint};
    dem_peaks *p;
    CHECK(checkpoint != NULL, DEM_ERROR_ARGUMENT, "dem_peaks_resume: checkpoint is NULL");
    TRY(dem_peaks_create(&p, model, every));
    dem_status status = pass(p, &way);
    if (status == DEM_OK && (p->left < 0 || p->left >= every))
        status = status_fail(DEM_ERROR_IO, "the checkpoint has %lld steps until the next look at peaks, of %lld",
                             (long long)p->left, (long long)every);
    if (status == DEM_OK)
        *out = p;
    else
        dem_peaks_destroy(p);
    return status;
}

void dem_peaks_destroy(dem_peaks *peaks)
{
    if (peaks == NULL) return;
    free(peaks->nodes);
    free(peaks->springs);
    free(peaks->stress);
    free(peaks->strain);
    free(peaks);
}

dem_status dem_peaks_observer(dem_peaks *peaks, dem_observer *out)
{
    CHECK(peaks != NULL && out != NULL, DEM_ERROR_ARGUMENT, "dem_peaks_observer: %s is NULL", peaks ? "out" : "peaks");
    const dem_observer own = {.step = look, .checkpoint = remember, .context = peaks, .step_every = peaks->every};
    return struct_size_write(&STRUCT_KIND(dem_observer), out, &own);
}

const dem_node_peak *dem_peaks_nodes(const dem_peaks *peaks)
{
    return peaks->nodes;
}

const dem_spring_peak *dem_peaks_springs(const dem_peaks *peaks)
{
    return peaks->springs;
}

dem_index dem_peaks_most_stressed_nodes(const dem_peaks *peaks, dem_index n, dem_index *nodes)
{
    return rank(peaks, node_size, peaks->n_nodes, n, nodes);
}

dem_index dem_peaks_most_strained_springs(const dem_peaks *peaks, dem_index n, dem_index *list)
{
    return rank(peaks, spring_size, peaks->n_springs, n, list);
}
