/* SPDX-License-Identifier: BSD-3-Clause */
/* All ranks have the same arrays. What a model fills in where its lattice has none is filled in the whole, too. */
#include "model/whole_of_parts.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/reduce.h"
#include "base/status.h"
#include "domain/gather.h"
#include "lattice/lattice_arrays.h"
#include "obstacle/obstacle_set.h"

/* ---- the model ---- */

/* A side belongs to its lower node. */
static dem_index count_own_edges(const dem_model *part)
{
    dem_index n = 0;
    for (dem_index k = 0; k < part->surface.n_edges; k++)
        n += domain_owns(part->domain, domain_lowest(part->surface.ends + 2 * k, 2));
    return n;
}

static void take_counts(dem_model *m, const dem_model *part)
{
    const domain *d = part->domain;
    m->lattice = dem_lattice_empty();
    m->lattice.dim = part->lattice.dim;
    m->lattice.n_nodes = d->n_whole;
    m->lattice.n_springs = d->n_springs;
    m->lattice.n_triangles = d->n_triangles;
    m->surface.n_nodes = d->n_surface_nodes;
    m->edges_are_springs = part->edges_are_springs;
    m->n_bodies = part->n_bodies;
    m->spacing = part->spacing;
    m->omega_max = part->omega_max;
    m->mass = part->mass;
}

static dem_status make(dem_model **out, const dem_model *part)
{
    dem_model *m = calloc(1, sizeof *m);
    CHECK_MEMORY(m);
    m->ranks = &ranks_alone;
    take_counts(m, part);
    const dem_status status = obstacles_compile(&m->obstacles, part->obstacles.list, part->obstacles.n);
    if (status == DEM_OK)
        *out = m;
    else
        dem_model_destroy(m);
    return status;
}

dem_status whole_of_parts_create(dem_model **out, dem_model *part, model_array_asker *ask)
{
    const ranks *r = part->ranks;
    const dem_index n_edges = reduce_count(r, count_own_edges(part));
    TRY(reduce_status(r, r->rank == 0 ? make(out, part) : DEM_OK, 0.0));
    if (r->rank > 0) return DEM_OK;
    (*out)->surface.n_edges = n_edges;
    (*out)->part = part;
    (*out)->ask_array = ask;
    return DEM_OK;
}

/* ---- its arrays ---- */

static gather_items items_of(const dem_model *part, lattice_items of)
{
    if (of == LATTICE_NODES) return gather_nodes(part->domain);
    return of == LATTICE_SPRINGS ? gather_springs(part->domain, &part->lattice)
                                 : gather_triangles(part->domain, &part->lattice);
}

/* By the numbers of the whole.  \return NULL without memory */
static dem_index *number_corners(const dem_model *part, const dem_index *corner, size_t n)
{
    dem_index *number = malloc((n + 1) * sizeof *number);
    for (size_t k = 0; k < n && number != NULL; k++) number[k] = part->domain->number[corner[k]];
    return number;
}

static dem_status visit_corners(const dem_model *part, const lattice_array *a, const gather_items *items,
                                rows_taker *take, void *context)
{
    const dem_index *corner = lattice_array_of(&part->lattice, a);
    dem_index *number = number_corners(part, corner, (size_t)(items->n * items->n_corners));
    dem_status status = number == NULL ? status_fail(DEM_ERROR_MEMORY, "out of memory for what ranks have") : DEM_OK;
    status = reduce_status(part->ranks, status, 0.0);
    if (status == DEM_OK) status = gather_chunks(part->ranks, items, a->size, number, take, context);
    free(number);
    return status;
}

dem_status whole_of_parts_visit(const dem_model *part, int array, rows_taker *take, void *context)
{
    const lattice_array *a = &lattice_arrays[array];
    const gather_items items = items_of(part, a->of);
    if (lattice_array_is_corners(a)) return visit_corners(part, a, &items, take, context);
    return gather_chunks(part->ranks, &items, a->size, lattice_array_of(&part->lattice, a), take, context);
}

/* ---- the same again ---- */

/* A sum over own rows depends on nobody's share. So few of its bits that those of all ranks can be added. */
static const uint64_t bits_of_sum = ((uint64_t)1 << 40) - 1;

static uint64_t hash_rows(const gather_items *items, uint64_t hash, size_t size, const void *rows)
{
    uint64_t sum = 0;
    for (dem_index i = 0; i < items->n; i++) {
        if (!gather_owns(items, i)) continue;
        const uint64_t of_row = random_mix(hash + random_stride * (uint64_t)(gather_number(items, i) + 1));
        sum += random_hash(of_row, (const char *)rows + (size_t)i * size, size);
    }
    return sum;
}

static dem_status hash_array(const dem_model *part, int array, uint64_t *sum)
{
    const lattice_array *a = &lattice_arrays[array];
    const gather_items items = items_of(part, a->of);
    const void *rows = lattice_array_of(&part->lattice, a);
    const uint64_t hash = random_mix((uint64_t)array);
    dem_index *number = NULL;
    if (rows == NULL) return DEM_OK;
    if (lattice_array_is_corners(a)) {
        rows = number = number_corners(part, rows, (size_t)(items.n * items.n_corners));
        CHECK_MEMORY(number);
    }
    *sum += hash_rows(&items, hash, a->size, rows);
    free(number);
    return DEM_OK;
}

dem_status whole_of_parts_hash(const dem_model *part, dem_index *out)
{
    uint64_t sum = 0;
    dem_status status = DEM_OK;
    for (int k = 0; k < LATTICE_ARRAYS && status == DEM_OK; k++) status = hash_array(part, k, &sum);
    TRY(reduce_status(part->ranks, status, 0.0));
    const dem_index all = reduce_count(part->ranks, (dem_index)(sum & bits_of_sum));
    *out = (dem_index)((uint64_t)all & bits_of_sum);
    return DEM_OK;
}
