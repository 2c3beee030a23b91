/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/shared_breaks.h"

#include <stdlib.h>

#include "base/status.h"
#include "model/breakable_nodes.h"

/* ---- checkpoints ---- */

/* Bytes that a checkpoint has of the elements of one kind. */
typedef struct flags {
    const char *name;
    dem_index n, n_whole;    /* elements of the part and of the whole */
    const dem_index *number; /* [n] in the whole */
    int arity;
    const dem_index *nodes; /* [n][arity] */
} flags;

enum { N_ENTRIES = 3 };

static void list_entries(const dem_model *m, flags out[N_ENTRIES])
{
    const dem_lattice *l = &m->lattice;
    const domain *d = m->domain;
    const flags of_triangles = {SHARED_BREAKS_TRIANGLES, l->n_triangles, d->n_triangles, d->triangle, 3, l->triangles};
    out[0] = out[1] = of_triangles;
    out[1].name = SHARED_BREAKS_LEVELS;
    out[2] = (flags){SHARED_BREAKS_SPRINGS, l->n_springs, d->n_springs, d->spring, 2, l->ends};
}

static dem_status expand(const flags *f, dem_checkpoint *checkpoint)
{
    size_t size;
    const unsigned char *own = dem_checkpoint_find(checkpoint, f->name, &size);
    if (own == NULL) return DEM_OK;
    unsigned char *whole = calloc((size_t)f->n_whole + 1, 1);
    CHECK(whole != NULL, DEM_ERROR_MEMORY, "out of memory for a checkpoint");
    for (dem_index k = 0; k < f->n; k++) whole[f->number[k]] = own[k];
    const dem_status status = dem_checkpoint_put(checkpoint, f->name, whole, (size_t)f->n_whole);
    free(whole);
    return status;
}

dem_status shared_breaks_expand(const dem_simulation *s, dem_checkpoint *checkpoint)
{
    flags entries[N_ENTRIES];
    list_entries(s->model, entries);
    for (int k = 0; k < N_ENTRIES; k++) TRY(expand(&entries[k], checkpoint));
    return DEM_OK;
}

/* How many of the flags are set. */
static dem_index count(const unsigned char *flag, dem_index n)
{
    dem_index set = 0;
    for (dem_index k = 0; k < n; k++) set += flag[k] != 0;
    return set;
}

static bool has_all(const flags *f, dem_index k, const unsigned char *breakable)
{
    for (int c = 0; c < f->arity; c++)
        if (!breakable[f->nodes[f->arity * k + c]]) return false;
    return true;
}

/* All flags that are set must be of elements that all ranks have, and whose springs may break: those of which all nodes
 * are in what may break. */
static dem_status check(const flags *f, const unsigned char *whole, const unsigned char *own,
                        const unsigned char *breakable)
{
    dem_index known = 0;
    for (dem_index k = 0; k < f->n; k++) known += own[k] != 0 && has_all(f, k, breakable);
    const dem_index all = count(whole, f->n_whole);
    CHECK(known == all, DEM_ERROR_MODEL,
          "in the checkpoint %lld of the %s are not of what may break by itself: ranks cannot share what a program "
          "breaks yet",
          (long long)(all - known), f->name);
    return DEM_OK;
}

static dem_status cut(const flags *f, const unsigned char *breakable, dem_checkpoint *checkpoint)
{
    size_t size;
    const unsigned char *whole = dem_checkpoint_find(checkpoint, f->name, &size);
    if (whole == NULL) return DEM_OK;
    CHECK(size == (size_t)f->n_whole, DEM_ERROR_IO, "the checkpoint has %zu bytes of %s, %lld are expected", size,
          f->name, (long long)f->n_whole);
    unsigned char *own = malloc((size_t)f->n + 1);
    CHECK(own != NULL, DEM_ERROR_MEMORY, "out of memory for a checkpoint");
    for (dem_index k = 0; k < f->n; k++) own[k] = whole[f->number[k]];
    dem_status status = check(f, whole, own, breakable);
    if (status == DEM_OK) status = dem_checkpoint_put(checkpoint, f->name, own, (size_t)f->n);
    free(own);
    return status;
}

dem_status shared_breaks_cut(const dem_simulation *s, dem_checkpoint *checkpoint)
{
    flags entries[N_ENTRIES];
    list_entries(s->model, entries);
    unsigned char *breakable = malloc((size_t)s->model->lattice.n_nodes + 1);
    CHECK(breakable != NULL, DEM_ERROR_MEMORY, "out of memory for a checkpoint");
    dem_status status = DEM_OK;
    breakable_nodes_mark(&s->model->lattice, breakable);
    for (int k = 0; k < N_ENTRIES && status == DEM_OK; k++) status = cut(&entries[k], breakable, checkpoint);
    free(breakable);
    return status;
}

/* ---- runs that rank 0 leads ---- */

dem_status shared_breaks_show(dem_simulation *whole, const dem_simulation *part)
{
    if (part->forces.elements == NULL || part->elements.integrity == NULL)
        return DEM_OK; /* all has been whole so far */
    TRY(element_state_prepare(&whole->elements));
    element_state_follow_part(&whole->elements, &part->elements, part->model->domain);
    return DEM_OK;
}
