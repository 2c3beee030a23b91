/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/shared_slabs.h"

#include "base/checkpoint_entries.h"
#include "base/reduce.h"
#include "base/status.h"
#include "model/shared_model.h"
#include "simulation/shared_problem.h"
#include "simulation/shared_use.h"

static const char entry[] = "recipe", shares[] = "shares";

static dem_status put(dem_checkpoint *into, const slab_recipe *recipe, int n_ranks)
{
    if (recipe == NULL) return DEM_OK;
    TRY(dem_checkpoint_put(into, entry, recipe->bytes, recipe->size));
    if (recipe->first != NULL)
        TRY(dem_checkpoint_put(into, shares, recipe->first, ((size_t)n_ranks + 1) * sizeof *recipe->first));
    return shared_problem_put(into, recipe->obstacles, recipe->n_obstacles, recipe->options);
}

dem_status dem_private_slab_refuse(const char *message)
{
    return status_fail(DEM_ERROR_IO, "%s", message);
}

static dem_status make(dem_slab *out, const slab_maker *maker, const dem_checkpoint *entries, const ranks *r)
{
    size_t size, size_of_first;
    const void *recipe = dem_checkpoint_find(entries, entry, &size);
    const slab_share which = {r->rank, r->size, dem_checkpoint_find(entries, shares, &size_of_first)};
    CHECK(maker->make != NULL, DEM_ERROR_ARGUMENT, "rank %d makes no slabs", r->rank);
    return maker->make(maker->program, recipe, size, &which, out);
}

/* dem_private_share_model() reports what fails on one rank. */
static dem_status share(dem_model **part, const ranks *r, const slab_maker *maker, const dem_checkpoint *entries)
{
    dem_slab slab = dem_slab_empty();
    shared_problem p;
    TRY(reduce_status(r, shared_problem_get(&p, entries), 0.0));
    dem_private_whole about = {.slab = &slab, .obstacles = p.obstacles, .n_obstacles = p.n_obstacles};
    about.refused = make(&slab, maker, entries, r);
    if (about.refused == DEM_OK) about.refused = dem_private_use_shared(&about, &p.options);
    const dem_status status = dem_private_share_model(part, &about, r);
    dem_slab_free(&slab);
    shared_problem_free(&p);
    if (status == DEM_OK) (*part)->ends_ranks = false; /* they are for further models */
    return status;
}

dem_status shared_slabs_create(dem_model **part, const ranks *r, const slab_maker *maker, const slab_recipe *recipe)
{
    dem_checkpoint *entries = NULL;
    dem_status status = dem_checkpoint_create(&entries);
    if (status == DEM_OK) status = put(entries, recipe, r->size);
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK) status = checkpoint_entries_share(r, entries);
    if (status == DEM_OK) status = share(part, r, maker, entries);
    dem_checkpoint_destroy(entries);
    return status;
}
