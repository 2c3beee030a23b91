/* SPDX-License-Identifier: BSD-3-Clause */
/* The pieces that springs join which are not broken, and numbers of the whole of them. */
#include "model/fragments.h"

#include <stddef.h>
#include <stdlib.h>

#include "base/exact_sum.h"
#include "base/status.h"
#include "base/union_find.h"
#include "elastic/springs.h"
#include "model/crack_energy.h"

/* ---- which nodes belong together ---- */

/* Roots are the lowest nodes of fragments. In the last pass those of lower nodes are known already, and no node points
 * above itself. */
dem_index fragments_find(const dem_lattice *lattice, const double *integrity, dem_index *fragment)
{
    dem_index n_fragments = 0;
    union_find_start(fragment, lattice->n_nodes);
    for (dem_index k = 0; k < lattice->n_springs; k++)
        if (integrity == NULL || integrity[k] != 0.0)
            union_find_unite(fragment, lattice->ends[2 * k], lattice->ends[2 * k + 1]);
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        n_fragments += fragment[i] == i;
        fragment[i] = fragment[fragment[i]];
    }
    return n_fragments;
}

dem_index fragments_unite(dem_index *parent, dem_index *lowest, dem_index i, dem_index j)
{
    const dem_index a = union_find_root(parent, i), b = union_find_root(parent, j);
    if (a == b) return -1;
    const dem_index stays = lowest[a] < lowest[b] ? lowest[a] : lowest[b], goes = lowest[a] + lowest[b] - stays;
    union_find_unite(parent, a, b);
    lowest[a < b ? a : b] = stays;
    return goes;
}

/* Nodes outside of a domain join some of it for good. */
void fragments_begin(const dem_lattice *lattice, const domain *d, const double *integrity, dem_index *parent,
                     dem_index *lowest)
{
    const bool is_joined = d != NULL && d->joined != NULL;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        parent[i] = is_joined ? d->joined_to[i] : i;
        lowest[i] = is_joined ? d->joined[i] : domain_number(d, i);
    }
    for (dem_index k = 0; k < lattice->n_springs; k++)
        if (integrity == NULL || integrity[k] != 0.0)
            (void)fragments_unite(parent, lowest, lattice->ends[2 * k], lattice->ends[2 * k + 1]);
}

/* ---- how much is broken, and into what ---- */

/* [n_nodes] each. */
typedef struct fragment_room {
    dem_index *sorted, *next; /* nodes fragment by fragment, and behind the last of each, at its lowest node */
    double *mass;             /* of fragments, at their lowest nodes */
} fragment_room;

static int compare(const void *a, const void *b)
{
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

/* From the masses of fragments, each at its lowest node, and 0 at the others. They are sorted, so that what is added up
 * until the median has the same bits however nodes are numbered. */
static void weigh(dem_fracture *out, double *mass, dem_index n, double debris)
{
    exact_sum sum = {0};
    double part = 0.0;
    qsort(mass, (size_t)n, sizeof *mass, compare);
    exact_sum_add_array(&sum, mass, n);
    const double all = exact_sum_value(&sum);
    for (dem_index k = 0; k < n && part < 0.5 * all; k++) {
        part += mass[k];
        out->median = mass[k];
    }
    out->largest = all > 0.0 ? mass[n - 1] / all : 0.0;
    out->debris = all > 0.0 ? debris / all : 0.0;
}

/* A counting sort; `next` is 0 before. */
static void sort_nodes(dem_index *sorted, dem_index *next, const dem_index *fragment, dem_index n)
{
    dem_index end = 0;
    for (dem_index i = 0; i < n; i++) next[fragment[i]]++;
    for (dem_index i = 0; i < n; i++) {
        const dem_index count = next[i];
        next[i] = end;
        end += count;
    }
    for (dem_index i = 0; i < n; i++) sorted[next[fragment[i]]++] = i;
}

/* One exact sum at a time, as there may be as many fragments as nodes. All room is 0. */
static void measure(dem_fracture *out, const dem_lattice *l, const dem_index *fragment, fragment_room *room)
{
    exact_sum debris = {0}, sum = {0};
    sort_nodes(room->sorted, room->next, fragment, l->n_nodes);
    for (dem_index first = 0, p = 0; p < l->n_nodes; first = p) {
        const dem_index lowest = room->sorted[first];
        exact_sum_clear(&sum);
        while (p < room->next[lowest]) exact_sum_add(&sum, l->mass[room->sorted[p++]]);
        room->mass[lowest] = exact_sum_value(&sum);
        if (p - first == 1) exact_sum_add(&debris, room->mass[lowest]);
    }
    weigh(out, room->mass, l->n_nodes, exact_sum_value(&debris));
}

static void count(dem_fracture *out, const dem_lattice *l, const element_state *elements)
{
    exact_sum length = {0};
    for (dem_index k = 0; k < l->n_springs; k++) out->springs += springs_is_broken(element_state_springs(elements), k);
    for (dem_index k = 0; elements != NULL && k < l->n_triangles; k++) {
        if (!elements->triangle[k]) continue;
        out->triangles++;
        exact_sum_add(&length, crack_length(l, k));
    }
    out->crack_length = exact_sum_value(&length);
}

dem_status fragments_measure(const dem_lattice *l, const element_state *elements, dem_fracture *out)
{
    const size_t n = (size_t)l->n_nodes;
    dem_index *fragment = calloc(n, sizeof *fragment);
    fragment_room room = {calloc(n, sizeof *room.sorted), calloc(n, sizeof *room.next), calloc(n, sizeof *room.mass)};
    dem_fracture own = {.struct_size = sizeof own};
    const bool good = fragment != NULL && room.sorted != NULL && room.next != NULL && room.mass != NULL;
    if (good) {
        own.fragments = fragments_find(l, element_state_springs(elements).pushed, fragment);
        measure(&own, l, fragment, &room);
        count(&own, l, elements);
        *out = own;
    }
    free(fragment);
    free(room.sorted);
    free(room.next);
    free(room.mass);
    CHECK(good, DEM_ERROR_MEMORY, "out of memory for the fragments of %zu nodes", n);
    return DEM_OK;
}

/* ---- of what ranks have ---- */

static dem_status unite(void *fragment, dem_index first, dem_index n, const void *items)
{
    const dem_index *ends = items;
    (void)first;
    for (dem_index k = 0; k < n; k++) union_find_unite(fragment, ends[2 * k], ends[2 * k + 1]);
    return DEM_OK;
}

/* Numbers fragments from 0 on instead of naming them by their lowest nodes, which come first.  \return how many */
static dem_index number_fragments(dem_index *fragment, dem_index n)
{
    dem_index n_fragments = 0;
    for (dem_index i = 0; i < n; i++) fragment[i] = fragment[i] == i ? n_fragments++ : fragment[fragment[i]];
    return n_fragments;
}

/* [fragments] each. */
typedef struct weighing {
    const dem_index *fragment; /* [n_nodes] number of the fragment of each */
    exact_sum *sum;
    dem_index *n;
} weighing;

static dem_status add_masses(void *context, dem_index first, dem_index n, const void *items)
{
    const weighing *w = context;
    const double *mass = items;
    for (dem_index i = 0; i < n; i++) {
        exact_sum_add(&w->sum[w->fragment[first + i]], mass[i]);
        w->n[w->fragment[first + i]]++;
    }
    return DEM_OK;
}

static void weigh_numbered(dem_fracture *out, const weighing *w, double *mass)
{
    exact_sum debris = {0};
    for (dem_index k = 0; k < out->fragments; k++) {
        mass[k] = exact_sum_value(&w->sum[k]);
        if (w->n[k] == 1) exact_sum_add(&debris, mass[k]);
    }
    weigh(out, mass, out->fragments, exact_sum_value(&debris));
}

static dem_status measure_numbered(const lattice_source *from, const dem_index *fragment, dem_fracture *out)
{
    const size_t n = (size_t)out->fragments;
    weighing w = {fragment, calloc(n, sizeof *w.sum), calloc(n, sizeof *w.n)};
    double *mass = calloc(n, sizeof *mass);
    const bool good = w.sum != NULL && w.n != NULL && mass != NULL;
    dem_status status = good ? DEM_OK : status_fail(DEM_ERROR_MEMORY, "out of memory for %zu fragments", n);
    if (good) status = dem_private_lattice_visit(from, offsetof(dem_lattice, mass), add_masses, &w);
    if (status == DEM_OK) weigh_numbered(out, &w, mass);
    free(w.sum);
    free(w.n);
    free(mass);
    return status;
}

dem_status fragments_measure_source(const lattice_source *from, dem_fracture *out)
{
    const dem_index n = from->lattice->n_nodes;
    dem_fracture own = {.struct_size = sizeof own};
    dem_index *fragment = malloc((size_t)n * sizeof *fragment);
    CHECK_MEMORY(fragment);
    union_find_start(fragment, n);
    dem_status status = dem_private_lattice_visit(from, offsetof(dem_lattice, ends), unite, fragment);
    if (status == DEM_OK) own.fragments = number_fragments(fragment, n);
    if (status == DEM_OK) status = measure_numbered(from, fragment, &own);
    free(fragment);
    if (status == DEM_OK) *out = own;
    return status;
}
