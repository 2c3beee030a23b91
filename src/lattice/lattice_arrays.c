/* SPDX-License-Identifier: BSD-3-Clause */
#include "lattice/lattice_arrays.h"

#include <stddef.h>
#include <string.h>

#include "base/random.h"

/* An array whose items are `n` numbers. */
#define OF(kind, member, n)                                                                                            \
    {                                                                                                                  \
        offsetof(dem_lattice, member), kind, (n) * sizeof *((dem_lattice *)NULL)->member                               \
    }

const lattice_array lattice_arrays[LATTICE_ARRAYS] = {
    OF(LATTICE_NODES, x, 2),
    OF(LATTICE_NODES, mass, 1),
    OF(LATTICE_NODES, flags, 1),
    OF(LATTICE_NODES, body, 1),
    OF(LATTICE_NODES, position, 2),
    OF(LATTICE_NODES, velocity, 2),
    OF(LATTICE_SPRINGS, ends, 2),
    OF(LATTICE_SPRINGS, rest_length, 1),
    OF(LATTICE_SPRINGS, stiffness, 1),
    OF(LATTICE_SPRINGS, viscosity, 1),
    OF(LATTICE_SPRINGS, critical_stretch, 1),
    OF(LATTICE_TRIANGLES, triangles, 3),
    OF(LATTICE_TRIANGLES, guard, 1),
    OF(LATTICE_TRIANGLES, area_stiffness, 1),
    OF(LATTICE_TRIANGLES, thickness, 1),
    OF(LATTICE_TRIANGLES, modulus, 1),
    OF(LATTICE_TRIANGLES, coupling, 3),
    OF(LATTICE_TRIANGLES, strength, 1),
    OF(LATTICE_TRIANGLES, softening, 1),
    OF(LATTICE_TRIANGLES, compressive_strength, 1),
    OF(LATTICE_TRIANGLES, confinement, 1),
    OF(LATTICE_TRIANGLES, own_stress, 1),
};

void *lattice_array_of(const dem_lattice *lattice, const lattice_array *array)
{
    void *items = NULL;
    if (array->offset + sizeof items <= lattice->struct_size)
        memcpy(&items, (const char *)lattice + array->offset, sizeof items);
    return items;
}

void lattice_array_put(dem_lattice *lattice, const lattice_array *array, void *items)
{
    memcpy((char *)lattice + array->offset, &items, sizeof items);
}

bool lattice_array_is_corners(const lattice_array *array)
{
    return array->offset == offsetof(dem_lattice, ends) || array->offset == offsetof(dem_lattice, triangles);
}

dem_index lattice_count(const dem_lattice *lattice, lattice_items of)
{
    if (of == LATTICE_NODES) return lattice->n_nodes;
    return of == LATTICE_SPRINGS ? lattice->n_springs : lattice->n_triangles;
}

uint64_t lattice_arrays_hash_counts(const dem_lattice *l)
{
    const uint64_t n = (uint64_t)l->n_nodes, s = (uint64_t)l->n_springs, t = (uint64_t)l->n_triangles;
    return random_mix(n) ^ random_mix(s + 1) ^ random_mix(t + 2);
}

uint64_t lattice_arrays_hash_next(uint64_t hash, int k, const void *items, dem_index n)
{
    return random_hash(hash, items, (size_t)n * lattice_arrays[k].size);
}

uint64_t lattice_arrays_hash(const dem_lattice *l)
{
    uint64_t hash = lattice_arrays_hash_counts(l);
    for (int k = 0; k < LATTICE_ARRAYS; k++) {
        const lattice_array *a = &lattice_arrays[k];
        hash = lattice_arrays_hash_next(hash, k, lattice_array_of(l, a), lattice_count(l, a->of));
    }
    return hash;
}
