/* SPDX-License-Identifier: BSD-3-Clause */
/* A slab of the lattice of a file. Springs and triangles are looked at piece by piece, for those at own nodes, whose
 * other nodes are the rim; then the rows of what the slab has are read. Who reads several slabs keeps which nodes the
 * pieces have, and looks through all of them but once. Numbers of springs and triangles follow from
 * their order only where that is the order of their lowest nodes (domain/slab_rows.h): a model of slabs would have
 * others than one of the whole, and other bits. */
#include "output/slab_file.h"

#include "base/grow.h"
#include "base/sorted.h"
#include "base/status.h"
#include "lattice/lattice.h"
#include "lattice/mesh_edges.h"
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
    numbers around;                /* corners of the triangles at the rim, three each */
    dem_index *node_ranges;        /* [1 + 2 pieces] how many numbers follow, the nodes of each piece: see range_of() */
    bool are_known;                /* node_ranges have been found */
} draft;

/* What is asked for. */
typedef struct asked {
    dem_index begin, end; /* own nodes */
    bool rim_boundary;    /* is wanted */
} asked;

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

/* ---- which nodes the pieces of a file have ---- */

static dem_index count_pieces(const lattice_datasets *f, int a)
{
    hdf5_untrusted_rows piece = {0};
    dem_index n = 0;
    while (f->present[a] && lattice_datasets_next(f, a, &piece)) n++;
    return n;
}

/* Of a piece of springs, or of triangles, which come behind: the lowest node of its first row, than which no node of
 * it, and of pieces behind it, is lower, and its highest node. */
static dem_index *range_of(const draft *d, dem_index piece)
{
    return d->node_ranges + 1 + 2 * piece;
}

/* What an earlier look has left, if it is of such a file. */
static dem_status open_node_ranges(draft *d)
{
    const dem_index n = count_pieces(&d->file, LATTICE_ENDS) + count_pieces(&d->file, LATTICE_CORNERS);
    d->are_known = d->node_ranges != NULL && d->node_ranges[0] == 2 * n;
    if (d->are_known) return DEM_OK;
    free(d->node_ranges);
    d->node_ranges = lattice_zeros(1 + 2 * n, sizeof *d->node_ranges);
    CHECK_MEMORY(d->node_ranges);
    d->node_ranges[0] = 2 * n;
    return DEM_OK;
}

/* ---- springs and triangles at some nodes ---- */

/* Those of a file that come one after the other. */
typedef struct scan scan;
struct scan {
    lattice_items of;
    int dataset, arity;
    const char *what;
    dem_status (*look)(draft *d, const scan *s, dem_index k, const dem_index *corner); /* at number k */
    dem_index begin, end;                                                              /* nodes that are looked for */
    dem_index lowest; /* node of the one before; -1: there is none */
    dem_index piece;  /* that is looked at, see range_of() */
};

/* Takes number k if one of its nodes is own. */
static dem_status take(draft *d, const scan *s, dem_index k, const dem_index *corner)
{
    bool has_own = false;
    for (int c = 0; c < s->arity; c++) has_own = has_own || is_own(d, corner[c]);
    if (has_own) TRY(add(&d->found[s->of], k));
    for (int c = 0; has_own && c < s->arity; c++) {
        TRY(add(&d->corner[s->of], corner[c]));
        if (!is_own(d, corner[c])) TRY(add(&d->rim, corner[c]));
    }
    return DEM_OK;
}

/* Looks at number k, which is not to have a lower node than those before it. */
static dem_status look_at(draft *d, scan *s, dem_index k, const dem_index *corner)
{
    dem_index *range = range_of(d, s->piece), lowest = corner[0];
    for (int c = 0; c < s->arity; c++) {
        lowest = corner[c] < lowest ? corner[c] : lowest;
        if (!d->are_known && corner[c] > range[1]) range[1] = corner[c];
    }
    CHECK(lowest >= s->lowest, DEM_ERROR_MODEL,
          "%s: %s: %s %lld has the lowest node %lld, the one before it %lld: slabs need them in the order of their "
          "lowest nodes",
          d->file.file.path, lattice_dataset_list[s->dataset].name, s->what, (long long)k, (long long)lowest,
          (long long)s->lowest);
    s->lowest = lowest;
    return s->look(d, s, k, corner);
}

static dem_status look_at_piece(draft *d, scan *s, const hdf5_untrusted_rows *piece, const dem_index *corner)
{
    const dem_index first = (dem_index)piece->first, n = (dem_index)piece->count;
    if (lattice_check_corners(s->what, s->arity, corner, first, n, d->slab.n_nodes) != DEM_OK)
        return lattice_datasets_refuse(&d->file);
    for (dem_index k = 0; k < n; k++) {
        TRY(look_at(d, s, first + k, corner + s->arity * k));
        if (!d->are_known && k == 0) range_of(d, s->piece)[0] = s->lowest;
    }
    return DEM_OK;
}

/* Whether a piece may have something at a node that is looked for. */
static bool may_have(const draft *d, const scan *s)
{
    const dem_index *range = range_of(d, s->piece);
    return !d->are_known || (range[0] < s->end && range[1] >= s->begin);
}

static dem_status look_through(draft *d, scan s)
{
    const lattice_datasets *f = &d->file;
    const lattice_dataset *set = &lattice_dataset_list[s.dataset];
    hdf5_untrusted_rows piece = {0};
    dem_status status = DEM_OK;
    if (!f->present[s.dataset]) return DEM_OK;
    dem_index *corner = lattice_datasets_room(f, s.dataset);
    CHECK_MEMORY(corner);
    for (; status == DEM_OK && lattice_datasets_next(f, s.dataset, &piece); s.piece++) {
        if (!may_have(d, &s)) continue;
        status = hdf5_untrusted_read(&f->file, set->name, set->kind, piece, corner);
        if (status == DEM_OK) status = look_at_piece(d, &s, &piece, corner);
    }
    free(corner);
    return status;
}

static scan springs_of(const draft *d)
{
    return (scan){.of = LATTICE_SPRINGS,
                  .dataset = LATTICE_ENDS,
                  .arity = 2,
                  .what = "spring",
                  .look = take,
                  .begin = d->slab.first_node,
                  .end = d->slab.first_node + d->slab.n_own,
                  .lowest = -1};
}

static scan triangles_of(const draft *d)
{
    scan s = springs_of(d);
    s.of = LATTICE_TRIANGLES;
    s.dataset = LATTICE_CORNERS;
    s.arity = 3;
    s.what = "triangle";
    s.piece = count_pieces(&d->file, LATTICE_ENDS);
    return s;
}

/* ---- the boundary ---- */

static dem_status take_at_rim(draft *d, const scan *s, dem_index k, const dem_index *corner)
{
    bool is_at_rim = false;
    (void)k;
    for (int c = 0; c < s->arity; c++) is_at_rim = is_at_rim || sorted_find(d->rim.list, d->rim.n, corner[c]) >= 0;
    for (int c = 0; is_at_rim && c < s->arity; c++) TRY(add(&d->around, corner[c]));
    return DEM_OK;
}

/* Of all triangles at nodes of the rim, whose corners are these nodes, in order.
 * \param flags  [n] room */
static dem_status mark_rim(draft *d, const dem_index *node, dem_index n, unsigned char *flags)
{
    const numbers *rim = &d->rim, *corner = &d->around;
    dem_lattice l = dem_lattice_empty();
    for (dem_index k = 0; k < corner->n; k++) corner->list[k] = sorted_find(node, n, corner->list[k]);
    l.n_nodes = n;
    l.n_triangles = corner->n / 3;
    l.triangles = corner->list;
    TRY(mesh_edges_contact_flags(flags, &l));
    for (dem_index k = 0; k < rim->n; k++) {
        const dem_index i = sorted_find(node, n, rim->list[k]);
        d->slab.rim_boundary[k] = i >= 0 && flags[i] != 0;
    }
    return DEM_OK;
}

/* Behind the list of the rim, and what is found of node_ranges. */
static dem_status find_rim_boundary(draft *d)
{
    const numbers *rim = &d->rim;
    scan s = triangles_of(d);
    s.look = take_at_rim;
    s.begin = rim->n > 0 ? rim->list[0] : 0;
    s.end = rim->n > 0 ? rim->list[rim->n - 1] + 1 : 0;
    TRY(look_through(d, s));
    const dem_index n = d->around.n;
    dem_index *node = lattice_zeros(n, sizeof *node);
    unsigned char *flags = lattice_zeros(n, 1);
    d->slab.rim_boundary = lattice_zeros(rim->n, 1);
    dem_status status = node != NULL && flags != NULL && d->slab.rim_boundary != NULL
                            ? DEM_OK
                            : status_fail(DEM_ERROR_MEMORY, "out of memory for %lld nodes", (long long)n);
    if (status == DEM_OK && n > 0) memcpy(node, d->around.list, (size_t)n * sizeof *node);
    if (status == DEM_OK) status = mark_rim(d, node, sorted_make(node, n), flags);
    free(node);
    free(flags);
    return status;
}

/* ---- nodes ---- */

static dem_status place(draft *d, const asked *a)
{
    const dem_index n = d->file.n[LATTICE_NODES];
    CHECK(a->begin >= 0 && a->begin <= a->end && a->end <= n, DEM_ERROR_MODEL,
          "%s: has no nodes from %lld to %lld: there are %lld", d->file.file.path, (long long)a->begin,
          (long long)a->end - 1, (long long)n);
    d->slab.n_nodes = n;
    d->slab.n_triangles = d->file.n[LATTICE_TRIANGLES];
    d->slab.first_node = a->begin;
    d->slab.n_own = a->end - a->begin;
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

static dem_status read_slab(draft *d, const asked *a)
{
    TRY(place(d, a));
    TRY(open_node_ranges(d));
    const scan springs = springs_of(d), triangles = triangles_of(d);
    TRY(look_through(d, springs));
    TRY(look_through(d, triangles));
    d->are_known = true;
    if (d->slab.n_own == 0) return DEM_OK;
    TRY(list_nodes(d));
    if (a->rim_boundary) TRY(find_rim_boundary(d));
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
    free(d->around.list);
    for (int of = 0; of < LATTICE_ITEMS; of++) {
        free(d->found[of].list);
        free(d->corner[of].list);
    }
    if (!d->are_known) {
        free(d->node_ranges);
        d->node_ranges = NULL;
    }
}

/* \param d  with the file, open, and what is known of node_ranges: what is then stays there */
static dem_status read_open(draft *d, dem_slab *out, const asked *a)
{
    const dem_status status = hdf5_close(&d->file.file, read_slab(d, a));
    if (status == DEM_OK) {
        slab_give(out, &d->slab);
        d->slab = dem_slab_empty();
    }
    close_draft(d);
    return status;
}

/* Of n nodes each part has n/n_parts, and the first ones have one more. */
static asked part_of(dem_index n, dem_index part, dem_index n_parts)
{
    const dem_index each = n / n_parts, more = n % n_parts, begin = part * each + (part < more ? part : more);
    return (asked){.begin = begin, .end = begin + each + (part < more ? 1 : 0)};
}

static dem_status check_parts(const draft *d, dem_index n_parts)
{
    CHECK(n_parts <= d->file.n[LATTICE_NODES], DEM_ERROR_MODEL, "%s: %lld nodes cannot be %lld slabs",
          d->file.file.path, (long long)d->file.n[LATTICE_NODES], (long long)n_parts);
    return DEM_OK;
}

dem_status dem_slab_read(dem_slab *out, const char *path, dem_index part, dem_index n_parts)
{
    draft d = {.slab = dem_slab_empty()};
    TRY(slab_check_out(out, part, n_parts));
    CHECK(path != NULL, DEM_ERROR_ARGUMENT, "dem_slab_read: path is NULL");
    TRY(lattice_datasets_open(&d.file, path));
    if (check_parts(&d, n_parts) != DEM_OK) return hdf5_close(&d.file.file, DEM_ERROR_MODEL);
    const asked a = part_of(d.file.n[LATTICE_NODES], part, n_parts);
    const dem_status status = read_open(&d, out, &a);
    free(d.node_ranges);
    return status;
}

dem_status dem_private_slab_of_file(dem_slab *out, const char *path, dem_index **node_ranges, dem_index begin,
                                    dem_index end)
{
    draft d = {.slab = dem_slab_empty(), .node_ranges = *node_ranges};
    TRY(slab_check_out(out, 0, 1));
    TRY(lattice_datasets_open(&d.file, path));
    const dem_status status = read_open(&d, out, &(asked){begin, end, true});
    *node_ranges = d.node_ranges;
    return status;
}
