/* SPDX-License-Identifier: BSD-3-Clause */
/* A lattice and its owners for the tests of domains. */
#ifndef DEM_TEST_SHARED_LATTICE_H
#define DEM_TEST_SHARED_LATTICE_H

#include "verification/support.h"

#include "domain/partition.h"

/** A disc of jittered triangles with the elastic constants of rubber. */
static inline dem_lattice shared_disc(void)
{
    const dem_material solid = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 0.3, .density = 1050.0,
                                     .thickness = 1.0, .guard = 0.02);
    dem_lattice l = dem_lattice_empty();
    assert_ok(dem_lattice_disc(&l, 0.04, 5e-3));
    assert_ok(dem_lattice_jitter(&l, 1e-3, 7));
    assert_ok(dem_lattice_assemble(&l, &solid));
    return l;
}

/** Its nodes bisected among n ranks, to be freed. */
static inline int32_t *shared_owners(const dem_lattice *l, int n)
{
    int32_t *owner = malloc((size_t)l->n_nodes * sizeof *owner);
    assert_ok(partition_bisect(l, n, owner));
    return owner;
}

#endif
