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

static dem_status are_one(const lattice_source *from, bool *one)
{
    const dem_index n = from->lattice->n_nodes;
    dem_index *fragment = malloc((size_t)n * sizeof *fragment);
    CHECK_MEMORY(fragment);
    union_find_start(fragment, n);
    const dem_status status = dem_private_lattice_visit(from, offsetof(dem_lattice, ends), unite, fragment);
    *one = true;
    for (dem_index i = 1; i < n; i++) *one = *one && fragment[i] != i;
    free(fragment);
    return status;
}

static dem_status measure_several(const lattice_source *from, dem_fracture *out)
{
    dem_lattice l = *from->lattice;
    source_array ends, mass = {0};
    dem_status status = dem_private_lattice_open(&ends, from, offsetof(dem_lattice, ends));
    if (status == DEM_OK) status = dem_private_lattice_open(&mass, from, offsetof(dem_lattice, mass));
    l.ends = (dem_index *)(uintptr_t)ends.items;
    l.mass = (double *)(uintptr_t)mass.items;
    if (status == DEM_OK) status = fragments_measure(&l, NULL, out);
    dem_private_lattice_close(&ends);
    dem_private_lattice_close(&mass);
    return status;
}

dem_status fragments_measure_source(const lattice_source *from, double mass, dem_fracture *out)
{
    bool one = false;
    TRY(are_one(from, &one));
    if (!one) return measure_several(from, out);
    *out = (dem_fracture){.struct_size = sizeof *out, .fragments = 1, .largest = 1.0, .median = mass};
    out->debris = from->lattice->n_nodes == 1 ? 1.0 : 0.0;
    return DEM_OK;
}
