/* SPDX-License-Identifier: BSD-3-Clause */
/* Peaks as a program has them: an observer that looks for larger ones at every so-many-th accepted step, and puts them
 * into checkpoints. In a run that ranks make they look (shared_peaks.c), and the entries are here while a checkpoint or
 * the program has a use for them; it gets some of them, and the largest, by peak_source.c. Files of peaks are in
 * src/output/peaks_file.c. */
#include "simulation/peaks.h"

#include <stdlib.h>

#include "base/checkpoint_entries.h"
#include "base/status.h"
#include "base/struct_size.h"
#include "simulation/leader_peaks.h"

typedef dem_status bring(dem_peaks *peaks);

/* Copies from the ranks that have them, as the program asks for them, which knows nothing of ranks: of nodes, in the
 * place of those of springs, or the other way round. */
static const dem_peaks *brought(const dem_peaks *peaks, bool is_there, bring *of_one_kind)
{
    dem_peaks *p = (dem_peaks *)(uintptr_t)peaks;
    if (peaks_load(p) != DEM_OK || !p->are_away || is_there) return p;
    peaks_give_up(p);
    if (of_one_kind(p) != DEM_OK) peaks_give_up(p);
    return p;
}

static const dem_peaks *with_nodes(const dem_peaks *peaks)
{
    return brought(peaks, peaks->nodes != NULL, leader_peaks_bring_nodes);
}

static const dem_peaks *with_springs(const dem_peaks *peaks)
{
    return brought(peaks, peaks->springs != NULL, leader_peaks_bring_springs);
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
    if (steps_since_look(p, simulation) > 0) return DEM_OK;
    const dem_status status = simulation->leads != NULL ? leader_peaks_look(simulation, p) : peaks_look(p, simulation);
    p->is_new = false;
    return status;
}

static const char entry_every[] = "peaks.every";

/* Checkpoints of older versions do not say it. */
static dem_status check_every(const dem_peaks *p, const dem_checkpoint *from)
{
    size_t size;
    dem_index every;
    const void *kept = dem_checkpoint_find(from, entry_every, &size);
    if (kept == NULL) return DEM_OK;
    TRY(dem_checkpoint_get(from, entry_every, &every, sizeof every));
    CHECK(every == p->every, DEM_ERROR_ARGUMENT,
          "the checkpoint is of a run that looked for peaks every %lld steps, not every %lld", (long long)every,
          (long long)p->every);
    return DEM_OK;
}

/* The ranks that have them keep them as they are now. */
static dem_status refer(dem_peaks *p, dem_checkpoint *checkpoint)
{
    const checkpoint_rows of_nodes = {leader_peaks_visit_kept_nodes, p, sizeof *p->nodes, p->n_nodes};
    const checkpoint_rows of_springs = {leader_peaks_visit_kept_springs, p, sizeof *p->springs, p->n_springs};
    TRY(leader_peaks_keep(p->away, p));
    TRY(checkpoint_entries_refer(checkpoint, peaks_entry_nodes, &of_nodes));
    return checkpoint_entries_refer(checkpoint, peaks_entry_springs, &of_springs);
}

/* The observer's checkpoint. */
static dem_status remember(void *context, const dem_simulation *simulation, dem_checkpoint *checkpoint)
{
    dem_peaks *p = context;
    (void)simulation;
    TRY(dem_checkpoint_put(checkpoint, entry_every, &p->every, sizeof p->every));
    return p->are_away ? refer(p, checkpoint) : peaks_put(p, checkpoint);
}

/* ---- public ---- */

/* Without entries. */
static dem_status create(dem_peaks **out, const dem_model *model, dem_index every)
{
    CHECK(model != NULL, DEM_ERROR_ARGUMENT, "dem_peaks_create: model is NULL");
    CHECK(every >= 1, DEM_ERROR_ARGUMENT, "peaks are looked for every %lld steps; it must be 1 or more",
          (long long)every);
    dem_model_size size = {.struct_size = sizeof size};
    TRY(dem_model_sizes(model, &size));
    dem_peaks *p = calloc(1, sizeof *p);
    CHECK_MEMORY(p);
    *p = (dem_peaks){.n_nodes = size.n_nodes, .n_springs = size.n_springs, .every = every, .is_new = true};
    *out = p;
    return DEM_OK;
}

static dem_status give(dem_peaks **out, dem_peaks *p, dem_status status)
{
    if (status == DEM_OK)
        *out = p;
    else
        dem_peaks_destroy(p);
    return status;
}

dem_status dem_peaks_create(dem_peaks **out, const dem_model *model, dem_index every)
{
    dem_peaks *p = NULL;
    CHECK(out != NULL, DEM_ERROR_ARGUMENT, "dem_peaks_create: out is NULL");
    TRY(create(&p, model, every));
    dem_status status = peaks_make_node_room(p);
    if (status == DEM_OK) status = peaks_make_spring_room(p);
    return give(out, p, status);
}

dem_status dem_peaks_resume(dem_peaks **out, const dem_model *model, dem_index every, const dem_checkpoint *checkpoint)
{
    dem_peaks *p = NULL;
    CHECK(out != NULL && checkpoint != NULL, DEM_ERROR_ARGUMENT, "dem_peaks_resume: %s is NULL",
          out != NULL ? "checkpoint" : "out");
    TRY(create(&p, model, every));
    p->is_new = false;
    dem_status status = check_every(p, checkpoint);
    if (status == DEM_OK) status = peaks_go_on(p, checkpoint);
    return give(out, p, status);
}

void dem_peaks_destroy(dem_peaks *peaks)
{
    if (peaks == NULL) return;
    if (peaks->away != NULL) leader_peaks_forget(peaks->away, peaks);
    peaks_give_up(peaks);
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
    return with_nodes(peaks)->nodes;
}

const dem_spring_peak *dem_peaks_springs(const dem_peaks *peaks)
{
    return with_springs(peaks)->springs;
}
