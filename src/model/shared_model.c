/* SPDX-License-Identifier: BSD-3-Clause */
/* Every rank compiles the whole and cuts its part from it (model/domain_model.c), unless rank 0 has it and cuts the
 * parts of all. Where all have it they have to have the same lattice and obstacles: lists of what they send to each
 * other, and so all that follows, are made of these. Whether they do is seen from a hash of the arrays, as the model
 * holds them. */
#include "model/shared_model.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/reduce.h"
#include "base/status.h"
#include "domain/partition.h"
#include "lattice/lattice_arrays.h"
#include "model/breakable_nodes.h"
#include "model/domain_model.h"
#include "model/slab_lattice.h"
#include "obstacle/obstacle_input.h"

/* ---- whether all have the same ---- */

/* Places, laws of impacts and friction, and of the motion. A function has another address in each process: what it
 * returns is compared in a run (simulation/likeness.c). */
static uint64_t hash_of_obstacle(uint64_t hash, const dem_obstacle *o)
{
    const bool is_asked = o->motion != NULL;
    const double law[] = {o->restitution,
                          o->friction,
                          (double)o->friction_law,
                          o->ramp,
                          (double)is_asked,
                          is_asked ? o->most_speed : 0.0,
                          is_asked ? o->most_acceleration : 0.0,
                          is_asked ? o->longest_step : 0.0};
    dem_index k = 0;
    hash = random_hash(hash, o->points, 2 * (size_t)o->n_points * sizeof *o->points);
    hash = random_hash(hash, law, sizeof law);
    for (const dem_motion_field *f; (f = dem_motion_field_at(k)) != NULL; k++)
        hash = random_hash(hash, (const char *)o + f->offset, (size_t)f->n * sizeof(double));
    return hash;
}

static uint64_t hash_of_obstacles(uint64_t hash, const dem_obstacle *list, dem_index n)
{
    for (dem_index k = 0; k < n; k++) hash = hash_of_obstacle(hash, &list[k]);
    return hash;
}

static uint64_t hash_of(const dem_model *m)
{
    return hash_of_obstacles(lattice_arrays_hash(&m->lattice), m->obstacles.list, m->obstacles.n);
}

static dem_status check_same(const ranks *r, const dem_model *m)
{
    CHECK(reduce_alike(r, hash_of(m)), DEM_ERROR_ARGUMENT, "the lattices or obstacles of the %d ranks differ", r->size);
    return DEM_OK;
}

/* ---- of the whole that all ranks have ---- */

/* \param weights  [nodes] NULL: all the same */
static dem_status find_owners(int32_t **owner, const dem_lattice *whole, const double *weights, int n_ranks)
{
    *owner = malloc((size_t)whole->n_nodes * sizeof **owner);
    CHECK_MEMORY(*owner);
    return partition_bisect_weighted(whole, weights, n_ranks, *owner);
}

/* What a rank does by itself. */
static dem_status prepare(dem_model **whole, int32_t **owner, const dem_private_whole *of, int n_ranks)
{
    TRY(of->refused);
    TRY(dem_model_create(whole, of->lattice, of->obstacles, of->n_obstacles));
    return find_owners(owner, &(*whole)->lattice, of->weights, n_ranks);
}

static bool may_touch(const dem_model *whole, dem_private_touching touching)
{
    const dem_lattice *l = &whole->lattice;
    if (touching == DEM_PRIVATE_TOUCHING_UNKNOWN) /* what breaks may touch itself */
        return whole->n_bodies > 1 || whole->obstacles.n > 0 || breakable_lattice(l);
    return touching == DEM_PRIVATE_TOUCHING_SOME;
}

/* Whether all go by options that agree in what the model is made for. */
static dem_status check_use(const ranks *r, const domain_model_shares *s)
{
    const ring_use *u = &s->use;
    const double use[] = {
        u->most,       u->least,   (double)u->stiff.least_nodes, u->stiff.part, (double)u->slack.least_nodes,
        u->slack.part, s->touching};
    CHECK(reduce_alike(r, random_hash(1, use, sizeof use)), DEM_ERROR_ARGUMENT,
          "the %d ranks share a model for options that differ", r->size);
    return DEM_OK;
}

static dem_status share(dem_model **out, const ranks *r, const dem_model *whole, const domain_model_shares *shares)
{
    TRY(check_same(r, whole));
    TRY(check_use(r, shares));
    TRY(domain_model_create(out, r, whole, shares));
    (*out)->ends_ranks = r->end != NULL;
    return DEM_OK;
}

static dem_status share_whole(dem_model **out, const dem_private_whole *whole, const ranks *r)
{
    dem_model *compiled = NULL;
    int32_t *owner = NULL;
    dem_status status = reduce_status(r, prepare(&compiled, &owner, whole, r->size), 0.0);
    if (status == DEM_OK)
        status = share(out, r, compiled,
                       &(domain_model_shares){
                           .owner = owner, .touching = may_touch(compiled, whole->touching), .use = whole->use});
    dem_model_destroy(compiled);
    free(owner);
    return status;
}

/* ---- in slabs ---- */

/* What a rank does by itself. */
static dem_status prepare_slab(dem_slab *slab, void **obstacles, const dem_private_whole *of)
{
    TRY(of->refused);
    CHECK(of->n_obstacles >= 0 && (of->n_obstacles == 0 || of->obstacles != NULL), DEM_ERROR_ARGUMENT,
          "%lld obstacles, obstacles is %s", (long long)of->n_obstacles, of->obstacles ? "given" : "NULL");
    TRY(obstacle_input_read_all(obstacles, of->obstacles, of->n_obstacles));
    return slab_lattice_take(slab, of->slab);
}

static dem_status gather(dem_model **out, const ranks *r, dem_slab *slab, const dem_private_whole *of,
                         const dem_obstacle *obstacles)
{
    const domain_model_shares shares = {.touching = of->touching == DEM_PRIVATE_TOUCHING_SOME, .use = of->use};
    slab_rows rows;
    CHECK(reduce_alike(r, hash_of_obstacles(1, obstacles, of->n_obstacles)), DEM_ERROR_ARGUMENT,
          "the obstacles of the %d ranks differ", r->size);
    TRY(check_use(r, &shares));
    dem_status status = slab_rows_create(&rows, r, slab);
    if (status == DEM_OK) status = slab_lattice_check_bodies(slab, &rows);
    if (status == DEM_OK) status = domain_model_gather(out, &rows, &shares, obstacles, of->n_obstacles);
    slab_rows_free(&rows);
    return status;
}

static dem_status share_slab(dem_model **out, const dem_private_whole *of, const ranks *r)
{
    void *obstacles = NULL;
    dem_slab slab = dem_slab_empty();
    dem_status status = reduce_status(r, prepare_slab(&slab, &obstacles, of), 0.0);
    if (status == DEM_OK) status = gather(out, r, &slab, of, obstacles);
    dem_slab_free(&slab);
    free(obstacles);
    if (status == DEM_OK) (*out)->ends_ranks = r->end != NULL;
    return status;
}

/* ---- public ---- */

dem_status dem_private_share_model(dem_model **out, const dem_private_whole *whole, const ranks *r)
{
    return whole->slab != NULL ? share_slab(out, whole, r) : share_whole(out, whole, r);
}

dem_status shared_model_distribute(dem_model **out, const dem_model *whole, const dem_private_whole *about,
                                   const ranks *r)
{
    int32_t *owner = NULL;
    dem_status status = r->rank == 0 ? find_owners(&owner, &whole->lattice, about->weights, r->size) : DEM_OK;
    const domain_model_shares shares = {.owner = owner,
                                        .is_near = about->is_near,
                                        .touching = about->touching == DEM_PRIVATE_TOUCHING_SOME,
                                        .use = about->use};
    status = reduce_status(r, status, 0.0);
    if (status == DEM_OK)
        status = domain_model_distribute(out, r, whole, &shares, about->obstacles, about->n_obstacles);
    free(owner);
    if (status == DEM_OK) (*out)->ends_ranks = r->end != NULL;
    return status;
}
