/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of stresses have the order of sides and triangles, so that the lattice about the domain has to have that of the
 * whole. It has the arrays that shares of springs depend on, and ends with the rows of ghosts. */
#include "model/domain_stress.h"

#include <stddef.h>
#include <stdlib.h>

#include "base/freed_memory.h"
#include "base/status.h"
#include "lattice/lattice_cut.h"

/* What there is beside a domain. */
typedef struct beside {
    const dem_model *model;       /* of the domain, borrowed */
    dem_lattice lattice;          /* nodes and triangles; corners have their numbers in the lattice about the domain, */
    dem_index *at[LATTICE_ITEMS]; /* [nodes], [triangles] as these have, ascending */
} beside;

/* ---- what is kept ---- */

static dem_status list(dem_index **out, dem_index *n_out, const dem_index *number, dem_index n)
{
    dem_index n_beside = 0;
    for (dem_index k = 0; k < n; k++) n_beside += number[k] < 0;
    *out = malloc(((size_t)n_beside + 1) * sizeof **out);
    CHECK(*out, DEM_ERROR_MEMORY, "out of memory for what is beside a domain");
    *n_out = 0;
    for (dem_index k = 0; k < n; k++)
        if (number[k] < 0) (*out)[(*n_out)++] = k;
    return DEM_OK;
}

static void end(void *self)
{
    beside *b = self;
    dem_lattice_free(&b->lattice);
    for (int of = 0; of < LATTICE_ITEMS; of++) free(b->at[of]);
    free(b);
}

static dem_status keep(beside *b, const dem_lattice *around, const dem_index *node, const dem_index *triangle)
{
    lattice_cut cut = {.n = {0}};
    TRY(list(&b->at[LATTICE_NODES], &cut.n[LATTICE_NODES], node, around->n_nodes));
    TRY(list(&b->at[LATTICE_TRIANGLES], &cut.n[LATTICE_TRIANGLES], triangle, around->n_triangles));
    for (int of = 0; of < LATTICE_ITEMS; of++) cut.numbers[of] = b->at[of];
    return lattice_cut_create(&b->lattice, around, &cut);
}

/* ---- the lattice about the domain ---- */

static bool is_asked_for(const lattice_array *a)
{
    static const size_t asked[] = {offsetof(dem_lattice, x),         offsetof(dem_lattice, flags),
                                   offsetof(dem_lattice, ends),      offsetof(dem_lattice, triangles),
                                   offsetof(dem_lattice, thickness), offsetof(dem_lattice, modulus),
                                   offsetof(dem_lattice, coupling)};
    for (size_t k = 0; k < sizeof asked / sizeof *asked; k++)
        if (asked[k] == a->offset) return true;
    return false;
}

static dem_status merge(dem_lattice *out, const lattice_array *a, const beside *b)
{
    const dem_index n_beside = lattice_count(&b->lattice, a->of), n = lattice_count(out, a->of);
    const char *own = lattice_array_of(&b->model->lattice, a), *other = lattice_array_of(&b->lattice, a);
    if (own == NULL) return DEM_OK;
    char *to = malloc((size_t)n * a->size + 1);
    CHECK(to != NULL, DEM_ERROR_MEMORY, "out of memory for the stresses of %lld nodes", (long long)out->n_nodes);
    lattice_array_put(out, a, to);
    for (dem_index k = 0, q = 0; k < n; k++) {
        const bool is_beside = q < n_beside && b->at[a->of][q] == k;
        const char *from = is_beside ? other + (size_t)q * a->size : own + (size_t)(k - q) * a->size;
        memcpy(to + (size_t)k * a->size, from, a->size);
        q += is_beside;
    }
    return DEM_OK;
}

/* Those of nodes of the domain, by their numbers there.  \param[out] place  [nodes of the domain] */
static void list_places(const beside *b, dem_index *place)
{
    const dem_index n = b->model->lattice.n_nodes, n_beside = b->lattice.n_nodes;
    for (dem_index i = 0, q = 0; i < n; i++) {
        while (q < n_beside && b->at[LATTICE_NODES][q] == i + q) q++;
        place[i] = i + q;
    }
}

static void renumber(dem_lattice *around, const beside *b, const dem_index *place)
{
    const dem_index n_beside = b->lattice.n_triangles;
    for (dem_index k = 0; k < 2 * around->n_springs; k++) around->ends[k] = place[around->ends[k]];
    for (dem_index k = 0, q = 0; k < around->n_triangles; k++) {
        const bool is_beside = q < n_beside && b->at[LATTICE_TRIANGLES][q] == k;
        for (int c = 0; c < 3 && !is_beside; c++) around->triangles[3 * k + c] = place[around->triangles[3 * k + c]];
        q += is_beside;
    }
}

static dem_status put_together(dem_lattice *around, const beside *b, const dem_index *place)
{
    const dem_lattice *own = &b->model->lattice;
    *around = dem_lattice_empty();
    around->n_nodes = own->n_nodes + b->lattice.n_nodes;
    around->n_springs = own->n_springs;
    around->n_triangles = own->n_triangles + b->lattice.n_triangles;
    for (int k = 0; k < LATTICE_ARRAYS; k++)
        if (is_asked_for(&lattice_arrays[k])) TRY(merge(around, &lattice_arrays[k], b));
    renumber(around, b, place);
    return DEM_OK;
}

/* ---- rows ---- */

/* The rows of nodes that are integrated, of which common ones may decide what breaks; those of ghosts are empty. */
static dem_status take_rows(stress_rows *to, stress_rows *from, const domain *d, const dem_index *place)
{
    dem_index n = 0;
    to->volume = malloc(((size_t)d->n_nodes + 1) * sizeof *to->volume);
    to->row = calloc((size_t)d->n_nodes + 1, sizeof *to->row);
    CHECK(to->volume && to->row, DEM_ERROR_MEMORY, "out of memory for the stresses of %lld nodes",
          (long long)d->n_nodes);
    for (dem_index i = 0; i < d->n_nodes; i++) {
        to->volume[i] = from->volume[place[i]];
        for (dem_index p = from->row[place[i]]; !d->is_ghost[i] && p < from->row[place[i] + 1]; p++) {
            from->spring[n] = from->spring[p];
            from->share[n++] = from->share[p];
        }
        to->row[i + 1] = (int32_t)n;
    }
    to->spring = from->spring;
    to->share = from->share;
    from->spring = NULL;
    from->share = NULL;
    return DEM_OK;
}

/* Springs about the domain are those of the domain. */
static dem_status make_about(stress_rows *to, dem_lattice *around, const beside *b, const dem_index *place)
{
    const dem_model *m = b->model;
    stress_map map = {0};
    springs all = {0};
    dem_status status = springs_compile(&all, around);
    if (status == DEM_OK) status = stress_compile(&map, around, &all, &m->couplings);
    if (status == DEM_OK) status = stress_prepare(&map);
    if (status == DEM_OK) status = take_rows(to, map.rows, m->domain, place);
    stress_free(&map);
    springs_free(&all);
    return status;
}

static dem_status make(void *self, stress_rows *rows)
{
    const beside *b = self;
    dem_lattice around = dem_lattice_empty();
    dem_index *place = malloc(((size_t)b->model->lattice.n_nodes + 1) * sizeof *place);
    CHECK_MEMORY(place);
    list_places(b, place);
    dem_status status = put_together(&around, b, place);
    if (status == DEM_OK) status = make_about(rows, &around, b, place);
    dem_lattice_free(&around);
    free(place);
    freed_memory_return(b->model->lattice.n_nodes);
    return status;
}

/* ---- public ---- */

dem_status domain_stress_create(const domain_cut *c, const dem_index *node, const dem_index *triangle)
{
    beside *b = calloc(1, sizeof *b);
    CHECK_MEMORY(b);
    *b = (beside){.model = c->model, .lattice = dem_lattice_empty()};
    dem_status status = keep(b, &c->around, node, triangle);
    if (status == DEM_OK)
        status = stress_create(&c->model->stress, &(stress_maker){b, make, end}, &c->model->couplings);
    if (status != DEM_OK) end(b);
    return status;
}
