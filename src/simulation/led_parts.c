/* SPDX-License-Identifier: BSD-3-Clause */
/* On rank 0 a slab's model is owned by that of the whole. */
#include "simulation/led_parts.h"

#include "base/checkpoint_entries.h"
#include "base/rank_order.h"
#include "base/reduce.h"
#include "base/status.h"
#include "model/shared_model.h"
#include "simulation/shared_checkpoint.h"
#include "simulation/shared_problem.h"
#include "simulation/shared_use.h"

/* ---- ending ---- */

static dem_model *whole_of(const led_run *l)
{
    return (dem_model *)(uintptr_t)l->whole->model; /* which a program has as it is for all others */
}

void led_parts_drop_model(led_run *l)
{
    if (l->whole == NULL || !l->is_of_slabs) dem_model_destroy(l->model);
    l->model = NULL;
    l->is_of_slabs = false;
}

static void drop_part(led_run *l)
{
    shared_peaks_drop(&l->peaks);
    rank_order_forget(&l->kept);
    dem_simulation_destroy(l->part);
    l->part = NULL;
    l->is_observed = false;
}

static void drop_migration(led_run *l)
{
    slab_migration_free(&l->migration);
    l->migrates = false;
}

void led_parts_drop(led_run *l)
{
    drop_part(l);
    drop_migration(l);
    if (!l->is_of_slabs) led_parts_drop_model(l);
}

/* ---- from the whole, or from a slab ---- */

/* Shares in stresses of the whole, which creating its simulation may have made, nobody reads: parts have their own. */
static dem_status distribute(led_run *l, const dem_private_whole *about)
{
    const dem_model *whole = l->whole != NULL ? l->whole->model : NULL;
    if (l->is_of_slabs) return DEM_OK;
    if (whole != NULL) stress_forget(&whole->stress);
    return shared_model_distribute(&l->model, whole, about, &l->ranks);
}

/* Of a run in which nodes have not been shared out anew the whole has the checkpoint. */
static dem_status begin(led_run *l, const dem_options *options, bool resumes, const dem_checkpoint *checkpoint)
{
    if (l->migrates) {
        TRY(slab_migration_resume(&l->part, l->model, options, checkpoint, &l->migration));
        return slab_migration_end_peaks(&l->migration, l->model, &l->peaks);
    }
    if (resumes)
        TRY(dem_simulation_resume(&l->part, l->model, options, checkpoint));
    else
        TRY(dem_simulation_create(&l->part, l->model, options));
    checkpoint_entries_free(l->part->checkpoint);
    return DEM_OK;
}

static dem_status create_part(led_run *l, const shared_problem *p, bool resumes, const dem_checkpoint *checkpoint)
{
    dem_private_whole about = {.obstacles = p->obstacles,
                               .n_obstacles = p->n_obstacles,
                               .weights = l->balance.weights,
                               .is_near = near_contact_nodes(&l->near)};
    TRY(dem_private_use_shared(&about, &p->options));
    TRY(distribute(l, &about));
    TRY(begin(l, &p->options, resumes, checkpoint));
    l->part->is_led = true;
    l->part->whole = l->whole;
    return DEM_OK;
}

dem_status led_parts_create(led_run *l, dem_checkpoint *entries, bool resumes, const dem_checkpoint *checkpoint)
{
    shared_problem p = {0};
    led_ranks_enter(l);
    dem_status status = checkpoint_entries_share(&l->ranks, entries);
    if (status == DEM_OK) status = reduce_status(&l->ranks, shared_problem_get(&p, entries), 0.0);
    if (status == DEM_OK) status = create_part(l, &p, resumes, checkpoint);
    led_ranks_leave(l);
    shared_problem_free(&p);
    drop_migration(l);
    if (status != DEM_OK) led_parts_drop(l);
    if (l->weighs_anew)
        balance_begin(&l->balance, l->busy);
    else
        balance_go_on(&l->balance, l->busy);
    l->weighs_anew = false;
    l->busy = 0.0;
    return status;
}

/* ---- slabs ---- */

void led_parts_make_slab(led_run *l, bool is_first)
{
    led_parts_drop_model(l);
    if (shared_slabs_create(&l->model, &l->ranks, l->maker, NULL) != DEM_OK) return;
    l->is_of_slabs = true;
    dem_index hash;
    dem_status status = whole_of_parts_hash(l->model, &hash);
    if (status == DEM_OK && is_first) status = whole_of_parts_create(NULL, l->model, NULL);
    if (status != DEM_OK) led_parts_drop_model(l);
}

/* Files may be others by now. */
static dem_status check_same(const dem_model *whole)
{
    dem_index hash;
    TRY(whole_of_parts_hash(whole->part, &hash));
    CHECK(hash == whole->slabs.hash, DEM_ERROR_IO,
          "bodies have become others since the run began, as their slabs show, which were made again");
    return DEM_OK;
}

dem_status led_parts_remake_slab(led_run *l, const dem_index *first)
{
    dem_model *whole = whole_of(l);
    const slab_recipe recipe = {.bytes = whole->slabs.recipe,
                                .size = whole->slabs.size,
                                .obstacles = whole->obstacles.list,
                                .n_obstacles = whole->obstacles.n,
                                .options = l->options,
                                .first = first};
    const dem_status status = shared_slabs_create(&whole->part, whole->slabs.ranks, &whole->slabs.maker, &recipe);
    l->model = whole->part;
    return status == DEM_OK ? check_same(whole) : status;
}

static dem_index count_own(const domain *d)
{
    dem_index n = 0;
    for (dem_index i = 0; i < d->n_nodes; i++) n += d->is_own[i];
    return n;
}

/* Without the part, which is of it. */
static void drop_slab(led_run *l)
{
    dem_model_destroy(l->model);
    l->model = NULL;
    if (l->whole != NULL) whole_of(l)->part = NULL;
}

dem_status led_parts_migrate(led_run *l)
{
    balance_count(&l->balance, &l->ranks, count_own(l->model->domain));
    const double *y = shared_checkpoint_state(l->part);
    const dem_status own = slab_migration_begin(&l->migration, l->part, y, &l->peaks);
    const dem_status status = reduce_status(&l->ranks, own, 0.0);
    l->migrates = true;
    if (status == DEM_OK) {
        drop_part(l);
        drop_slab(l);
    } else {
        drop_migration(l);
    }
    return status;
}
