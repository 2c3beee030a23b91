/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions are compared ahead of each step, by hashes: events and rejected steps follow from them, of which ranks do not
 * tell each other. Forces are compared once, where two ranks have the same node; what is wrong most often, as numbers
 * of nodes or a context of another rank, shows then. */
#include "simulation/likeness.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"

/* ---- motions ---- */

/* A failure counts as a pose of its own, and is over. */
static uint64_t hash_of_pose(const dem_simulation *s, dem_index obstacle, double t)
{
    pose at = motion_law_pose(&s->model->obstacles.laws[obstacle], t);
    if (given_motion_failed()) {
        (void)given_motion_failure();
        return 0;
    }
    const double numbers[] = {at.centre.x,       at.centre.y, at.velocity.x, at.velocity.y, at.acceleration.x,
                              at.acceleration.y, at.angle,    at.spin,       at.spin_rate};
    return random_hash(1, numbers, sizeof numbers);
}

/* The lowest rank whose hash is not that of rank 0. */
static int other_rank(const ranks *r, uint64_t hash)
{
    double halves[] = {(double)(hash >> 32), (double)(uint32_t)hash}, own[2];
    memcpy(own, halves, sizeof own);
    reduce_report(r, r->rank == 0, halves, 2);
    const bool differs = own[0] != halves[0] || own[1] != halves[1];
    return (int)reduce_min(r, differs ? (double)r->rank : (double)r->size);
}

static dem_status name_obstacle(const dem_simulation *s, double t)
{
    const ranks *r = s->model->ranks;
    for (dem_index k = 0; k < s->model->obstacles.n; k++) {
        const uint64_t hash = hash_of_pose(s, k, t);
        if (reduce_alike(r, hash)) continue;
        return status_fail(DEM_ERROR_ARGUMENT,
                           "the function that moves obstacle %lld says otherwise on rank %d than "
                           "on rank 0 at t = %.9g s",
                           (long long)k, other_rank(r, hash), t);
    }
    return status_fail(DEM_ERROR_ARGUMENT, "a function that moves an obstacle does not repeat itself at t = %.9g s", t);
}

dem_status likeness_check_motions(const dem_simulation *s, double t)
{
    const obstacle_set *o = &s->model->obstacles;
    uint64_t hash = 0;
    if (!o->is_asked || !run_is_shared(s)) return DEM_OK;
    for (dem_index k = 0; k < o->n; k++) hash = random_mix(hash + hash_of_pose(s, k, t));
    return reduce_alike(s->model->ranks, hash) ? DEM_OK : name_obstacle(s, t);
}

/* ---- forces ---- */

/* \param own, theirs  [n_nodes][dim] N; they can differ on ghosts alone */
static dem_status compare(const dem_simulation *s, const double *own, const double *theirs)
{
    const domain *d = s->model->domain;
    const int dim = s->layout.dim;
    for (int k = 0; k < d->n_neighbours; k++) {
        const domain_neighbour *of = &d->neighbours[k];
        for (dem_index q = 0; q < of->n_received; q++) {
            const dem_index i = of->received[q];
            CHECK(memcmp(own + dim * i, theirs + dim * i, (size_t)dim * sizeof *own) == 0, DEM_ERROR_ARGUMENT,
                  "the external force on node %lld is another one on rank %d than on rank %d at t = %.9g s",
                  (long long)d->number[i], s->model->ranks->rank, of->rank, s->t);
        }
    }
    return DEM_OK;
}

/* \param own, theirs  [n_nodes][dim], to work with */
static dem_status ask_and_compare(dem_simulation *s, double *own, double *theirs)
{
    const state_layout *l = &s->layout;
    double *const state[] = {s->y, s->y + state_velocities(l)};
    const size_t size = (size_t)(l->dim * l->n_nodes) * sizeof *own;
    halo_exchange(&s->halo, state, 2);
    external_force_ask_here(s->external, state_time(l, s->y), s->y, state[1], own);
    memcpy(theirs, own, size);
    halo_exchange(&s->halo, &theirs, 1);
    const bool failed = external_force_failed(s->external);
    if (failed) (void)external_force_failure(s->external);
    if (reduce_any(s->model->ranks, failed)) return DEM_OK; /* which the run meets in a moment */
    return reduce_status(s->model->ranks, compare(s, own, theirs), 0.0);
}

dem_status likeness_check_force(dem_simulation *s)
{
    const size_t n = (size_t)(s->layout.dim * s->layout.n_nodes);
    if (s->external == NULL || !run_is_shared(s)) return DEM_OK;
    double *both = malloc(2 * n * sizeof *both);
    CHECK_MEMORY(both);
    const dem_status status = ask_and_compare(s, both, both + n);
    free(both);
    return status;
}
