/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids of which triangles break, and the same ones cut before they are assembled: what is left of the first has to be
 * like the second. */
#ifndef DEM_TEST_CUT_SOLIDS_H
#define DEM_TEST_CUT_SOLIDS_H

#include <stdlib.h>

#include "unit/solids.h"

/* Triangles of all shapes, of two materials side by side; or square cells. */
enum { COUPLED, CELLS, N_KINDS };

static inline dem_lattice mesh_of(int kind)
{
    dem_lattice lattice = dem_lattice_empty();
    if (kind == CELLS) {
        assert_ok(dem_lattice_squares(&lattice, 0.1, 0.08, 0.01));
    } else {
        assert_ok(dem_lattice_rectangle(&lattice, 0.1, 0.08, 0.01));
        assert_ok(dem_lattice_jitter(&lattice, 0.25 * 0.01, 3));
    }
    return lattice;
}

/* The material of a triangle is that of its place, so that it is the same in the solid that is cut. */
static inline void assemble(dem_lattice *lattice, int kind)
{
    dem_material materials[2] = {rubber, rubber};
    CLEANUP(free_memory) dem_index *of = calloc((size_t)lattice->n_triangles, sizeof *of);
    assert_non_null(of);
    for (dem_index k = 0; k < lattice->n_triangles; k++)
        of[k] = lattice->x[2 * lattice->triangles[3 * (kind == CELLS ? k / 2 * 2 : k)]] > 0.0;
    materials[1].youngs_modulus = 3e7;
    for (int k = 0; k < 2; k++) materials[k].poissons_ratio = 0.2; /* brings the area term */
    for (int k = 0; k < 2; k++) materials[k].springs = kind == CELLS ? DEM_SPRINGS_INDEPENDENT : DEM_SPRINGS_COUPLED;
    assert_ok(dem_lattice_assemble_mixed(lattice, materials, 2, of, kind == CELLS ? 0.5 : 0.0));
}

static inline dem_lattice solid_of(int kind)
{
    dem_lattice lattice = mesh_of(kind);
    assemble(&lattice, kind);
    return lattice;
}

/* Two thirds of the triangles, or of the cells, break. */
static inline bool breaks(int kind, dem_index triangle)
{
    const dem_index unit = kind == CELLS ? triangle / 2 : triangle;
    return (unit * unit * 7 + unit) % 11 < 7;
}

/* The same solid, cut before it is assembled. */
static inline dem_lattice cut_solid(int kind)
{
    dem_lattice lattice = mesh_of(kind);
    CLEANUP(free_memory) bool *keep = calloc((size_t)lattice.n_triangles, sizeof *keep);
    assert_non_null(keep);
    for (dem_index k = 0; k < lattice.n_triangles; k++) keep[k] = !breaks(kind, k);
    assert_ok(dem_lattice_trim(&lattice, keep));
    assemble(&lattice, kind);
    return lattice;
}

/* The node at the same place. */
static inline dem_index same_node(const dem_lattice *l, const double *x)
{
    for (dem_index i = 0; i < l->n_nodes; i++)
        if (l->x[2 * i] == x[0] && l->x[2 * i + 1] == x[1]) return i;
    return -1;
}

#endif
