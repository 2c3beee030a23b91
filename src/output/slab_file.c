/* SPDX-License-Identifier: BSD-3-Clause */
/* A slab of the lattice of a file. Springs and triangles are looked at piece by piece, for those at own nodes, whose
 * other nodes are the rim; then the rows of what the slab has are read. Numbers of springs and triangles follow from
 * their order only where that is the order of their lowest nodes (domain/slab_rows.h): a model of slabs would have
 * others than one of the whole, and other bits. */
#include "base/grow.h"
#include "base/sorted.h"
#include "base/status.h"
#include "lattice/lattice.h"
#include "lattice/slab.h"
#include "output/lattice_datasets.h"

#include <dem/trajectory.h>

#include <stdlib.h>
#include <string.h>

/* A list in the making. */
typedef struct numbers {
    dem_index n, capacity;
    dem_index *list; /* [n] */
} numbers;

typedef struct draft {
    lattice_datasets file;
    dem_slab slab;
    numbers rim;                   /* nodes next to own ones, some more than once, until they are in order */
    numbers found[LATTICE_ITEMS];  /* what the slab has: numbers of nodes, springs and triangles, ascending */
    numbers corner[LATTICE_ITEMS]; /* nodes of its springs and triangles, in the whole */
} draft;

static dem_status add(numbers *to, dem_index number)
{
    CHECK(grow_array((void **)&to->list, &to->capacity, to->n + 1, sizeof *to->list), DEM_ERROR_MEMORY,
          "out of memory for a list of %lld numbers", (long long)to->n + 1);
    to->list[to->n++] = number;
    return DEM_OK;
}

static bool is_own(const draft *d, dem_index number)
{
    return number >= d->slab.first_node && number < d->slab.first_node + d->slab.n_own;
}

/* ---- springs and triangles at own nodes ---- */

/* Those of a file that come one after the other. */
typedef struct scan {
    lattice_items of;
    int dataset, arity;
    const char *what;
    dem_index lowest; /* node of the one before; -1: there is none */
} scan;

/* Checks the order of number k, and takes it if one of its nodes is own. */
static dem_status take(draft *d, scan *s, dem_index k, const dem_index *corner)
{
    dem_index lowest = corner[0];
    bool has_own = false;
    for (int c = 0; c < s->arity; c++) {
        lowest = corner[c] < lowest ? corner[c] : lowest;
        has_own = has_own || is_own(d, corner[c]);
    }
    CHECK(lowest >= s->lowest, DEM_ERROR_MODEL,
          "%s: %s: %s %lld has the lowest node %lld, the one before it %lld: slabs need them in the order of their "
          "lowest nodes",
          d->file.file.path, lattice_dataset_list[s->dataset].name, s->what, (long long)k, (long long)lowest,
          (long long)s->lowest);
    s->lowest = lowest;
    if (has_own) TRY(add(&d->found[s->of], k));
    for (int c = 0; has_own && c < s->arity; c++) {
        TRY(add(&d->corner[s->of], corner[c]));
        if (!is_own(d, corner[c])) TRY(add(&d->rim, corner[c]));
    }
    return DEM_OK;
}

static dem_status take_piece(draft *d, scan *s, const hdf5_untrusted_rows *piece, const dem_index *corner)
{
    const dem_index first = (dem_index)piece->first, n = (dem_index)piece->count;
    if (lattice_check_corners(s->what, s->arity, corner, first, n, d->slab.n_nodes) != DEM_OK)
        return lattice_datasets_refuse(&d->file);
    for (dem_index k = 0; k < n; k++) TRY(take(d, s, first + k, corner + s->arity * k));
    return DEM_OK;
}

/* Of all that the file has. */
static dem_status look_through(draft *d, scan s)
{
    const lattice_datasets *f = &d->file;
    const lattice_dataset *set = &lattice_dataset_list[s.dataset];
    hdf5_untrusted_rows piece = {0};
    dem_status status = DEM_OK;
    if (!f->present[s.dataset]) return DEM_OK;
    dem_index *corner = lattice_datasets_room(f, s.dataset);
    CHECK_MEMORY(corner);
    while (status == DEM_OK && lattice_datasets_next(f, s.dataset, &piece)) {
        status = hdf5_untrusted_read(&f->file, set->name, set->kind, piece, corner);
        if (status == DEM_OK) status = take_piece(d, &s, &piece, corner);
    }
    free(corner);
    return status;
}

/* ---- nodes ---- */

/* Of n nodes each part has n/n_parts, and the first ones have one more. */
static dem_status place(draft *d, dem_index part, dem_index n_parts)
{
    const dem_index n = d->file.n[LATTICE_NODES], each = n / n_parts, more = n % n_parts;
    CHECK(n_parts <= n, DEM_ERROR_MODEL, "%s: %lld nodes cannot be %lld slabs", d->file.file.path, (long long)n,
          (long long)n_parts);
    d->slab.n_nodes = n;
    d->slab.n_triangles = d->file.n[LATTICE_TRIANGLES];
    d->slab.first_node = part * each + (part < more ? part : more);
    d->slab.n_own = each + (part < more ? 1 : 0);
    return DEM_OK;
}

/* Behind what is found of springs and triangles. */
static dem_status list_nodes(draft *d)
{
    dem_slab *s = &d->slab;
    numbers *rim = &d->rim, *all = &d->found[LATTICE_NODES];
    rim->n = sorted_make(rim->list, rim->n);
    s->first_own = sorted_first(rim->list, rim->n, s->first_node);
    for (dem_index k = 0; k < s->first_own; k++) TRY(add(all, rim->list[k]));
    for (dem_index k = 0; k < s->n_own; k++) TRY(add(all, s->first_node + k));
    for (dem_index k = s->first_own; k < rim->n; k++) TRY(add(all, rim->list[k]));
    return DEM_OK;
}

/* ---- a slab ---- */

/* Hands a list over, without what it has grown by in vain. */
static dem_status give(numbers *from, void **to)
{
    *to = realloc(from->list, ((size_t)from->n + 1) * sizeof *from->list);
    CHECK_MEMORY(*to);
    from->list = NULL;
    return DEM_OK;
}

/* Nodes get the numbers of the slab. */
static dem_status finish_corners(draft *d, const scan *s)
{
    const numbers *nodes = &d->found[LATTICE_NODES];
    numbers *corner = &d->corner[s->of];
    for (dem_index k = 0; k < corner->n; k++) corner->list[k] = sorted_find(nodes->list, nodes->n, corner->list[k]);
    return d->file.present[s->dataset] ? give(corner, &d->file.data[s->dataset]) : DEM_OK;
}

/* Their numbers may have gaps. */
static dem_index first_of(const numbers *triangles)
{
    const dem_index n = triangles->n;
    return n > 0 && triangles->list[n - 1] - triangles->list[0] == n - 1 ? triangles->list[0] : -1;
}

static dem_status read_rows(draft *d)
{
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        d->file.n[of] = d->found[of].n;
        d->file.taken[of] = d->found[of].list;
    }
    TRY(lattice_datasets_read(&d->file));
    lattice_datasets_give(&d->file, &d->slab.lattice);
    d->slab.first_triangle = first_of(&d->found[LATTICE_TRIANGLES]);
    TRY(give(&d->rim, (void **)&d->slab.rim));
    return lattice_datasets_flags(&d->file, &d->slab.lattice);
}

static dem_status read_slab(draft *d, dem_index part, dem_index n_parts)
{
    const scan springs = {LATTICE_SPRINGS, LATTICE_ENDS, 2, "spring", -1};
    const scan triangles = {LATTICE_TRIANGLES, LATTICE_CORNERS, 3, "triangle", -1};
    TRY(place(d, part, n_parts));
    TRY(look_through(d, springs));
    TRY(look_through(d, triangles));
    TRY(list_nodes(d));
    TRY(finish_corners(d, &springs));
    TRY(finish_corners(d, &triangles));
    return read_rows(d);
}

/* ---- public ---- */

static void close_draft(draft *d)
{
    dem_slab_free(&d->slab);
    lattice_datasets_free(&d->file);
    free(d->rim.list);
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        free(d->found[of].list);
        free(d->corner[of].list);
    }
}

dem_status dem_slab_read(dem_slab *out, const char *path, dem_index part, dem_index n_parts)
{
    draft d = {.slab = dem_slab_empty()};
    TRY(slab_check_out(out, part, n_parts));
    CHECK(path != NULL, DEM_ERROR_ARGUMENT, "dem_slab_read: path is NULL");
    TRY(lattice_datasets_open(&d.file, path));
    const dem_status status = hdf5_close(&d.file.file, read_slab(&d, part, n_parts));
    if (status == DEM_OK) {
        slab_give(out, &d.slab);
        d.slab = dem_slab_empty();
    }
    close_draft(&d);
    return status;
}
