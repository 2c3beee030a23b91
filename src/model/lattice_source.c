/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the arrays of a model's lattice are is known to models, so that this is not beside lattice/lattice_source.h. */
#include "lattice/lattice_source.h"

#include <stdlib.h>

#include "base/status.h"
#include "lattice/lattice_arrays.h"
#include "model/model.h"

lattice_source dem_private_lattice_source(const dem_model *model)
{
    return (lattice_source){.lattice = &model->lattice, .whole = model->part != NULL ? model : NULL};
}

/* An array of a source. */
typedef struct view {
    int number; /* in lattice_arrays */
    size_t size;
    dem_index n;
    const void *items; /* NULL: ranks have them, or nobody */
    bool is_away;      /* ranks have them */
} view;

static view view_of(const lattice_source *from, size_t member)
{
    int k = 0;
    while (lattice_arrays[k].offset != member) k++;
    const lattice_array *a = &lattice_arrays[k];
    const dem_model *whole = from->whole;
    return (view){k, a->size, lattice_count(from->lattice, a->of), lattice_array_of(from->lattice, a),
                  whole != NULL && lattice_array_of(&whole->part->lattice, a) != NULL};
}

bool dem_private_lattice_has(const lattice_source *from, size_t member)
{
    const view v = view_of(from, member);
    return v.is_away || v.items != NULL;
}

dem_status dem_private_lattice_visit(const lattice_source *from, size_t member, rows_taker *take, void *context)
{
    const view v = view_of(from, member);
    if (v.is_away) return from->whole->ask_array(from->whole, v.number, take, context);
    return v.items != NULL ? rows_hand_over(v.items, v.size, v.n, take, context) : DEM_OK;
}

dem_status dem_private_lattice_open(source_array *out, const lattice_source *from, size_t member)
{
    const view v = view_of(from, member);
    *out = (source_array){.items = v.items};
    if (!v.is_away) return DEM_OK;
    out->gathered = malloc((size_t)v.n * v.size + 1);
    CHECK_MEMORY(out->gathered);
    out->items = out->gathered;
    rows_copy all = {v.size, out->gathered};
    return dem_private_lattice_visit(from, member, rows_taker_copy, &all);
}

void dem_private_lattice_close(source_array *a)
{
    free(a->gathered);
    *a = (source_array){0};
}

dem_status dem_private_lattice_pick(const lattice_source *from, size_t member, const dem_index *list, dem_index n,
                                    void *out)
{
    rows_pick listed = {view_of(from, member).size, list, n, out};
    return dem_private_lattice_visit(from, member, rows_taker_pick, &listed);
}
