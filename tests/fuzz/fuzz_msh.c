/* SPDX-License-Identifier: BSD-3-Clause */
/* Any bytes may come as a mesh. One that is accepted is a triangulation: its triangles are counter-clockwise and on
 * nodes that there are, and every node has one. */
#include "shape/msh.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int is_left(const dem_lattice *lattice, const dem_index *node)
{
    const double *a = lattice->x + 2 * node[0], *b = lattice->x + 2 * node[1], *c = lattice->x + 2 * node[2];
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0;
}

static void check(const dem_lattice *lattice)
{
    unsigned char *used = calloc((size_t)lattice->n_nodes + 1, 1);
    if (used == NULL || lattice->n_triangles < 1 || lattice->n_springs != 0) abort();
    for (dem_index k = 0; k < 3 * lattice->n_triangles; k++) {
        const dem_index node = lattice->triangles[k];
        if (node < 0 || node >= lattice->n_nodes) abort();
        used[node] = 1;
    }
    for (dem_index i = 0; i < lattice->n_nodes; i++)
        if (!used[i]) abort();
    for (dem_index t = 0; t < lattice->n_triangles; t++)
        if (!is_left(lattice, lattice->triangles + 3 * t)) abort();
    free(used);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dem_lattice lattice = dem_lattice_empty();
    char fault[MSH_FAULT] = "";
    if (msh_parse(&lattice, fault, (const char *)data, size) == DEM_OK)
        check(&lattice);
    else if (lattice.x != NULL || strchr(fault, ':') == NULL)
        abort();
    dem_lattice_free(&lattice);
    return 0;
}
