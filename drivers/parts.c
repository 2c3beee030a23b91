/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts sorted by body and size: the first of each body is its main one. */
#include "parts.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct part {
    int32_t body;
    dem_index number, n_nodes, node; /* node: its lowest */
} part;

static int by_body_and_size(const void *a, const void *b)
{
    const part *p = a, *q = b;
    if (p->body != q->body) return p->body < q->body ? -1 : 1;
    if (p->n_nodes != q->n_nodes) return p->n_nodes > q->n_nodes ? -1 : 1;
    return p->number < q->number ? -1 : 1;
}

static void fill(part *list, dem_index n, const dem_lattice *lattice, const dem_index *part_of)
{
    for (dem_index p = 0; p < n; p++) list[p].number = p;
    for (dem_index i = 0; i < lattice->n_nodes; i++) {
        part *p = &list[part_of[i]];
        if (p->n_nodes++ > 0) continue;
        p->node = i;
        p->body = lattice->body != NULL ? lattice->body[i] : 0;
    }
    qsort(list, (size_t)n, sizeof *list, by_body_and_size);
}

static void tell(parts_loose *loose, const part *p)
{
    if (loose->n == 0) loose->node = p->node;
    if (loose->n < PARTS_LISTED) loose->n_nodes[loose->n] = p->n_nodes;
    loose->n++;
}

static dem_status sort_out(parts_loose *loose, unsigned char *kept, const dem_lattice *lattice, dem_index n,
                           const dem_index *part_of)
{
    part *list = calloc((size_t)n + 1, sizeof *list);
    unsigned char *is_main = calloc((size_t)n + 1, sizeof *is_main); /* by part number */
    const dem_status status = list != NULL && is_main != NULL ? DEM_OK : DEM_ERROR_MEMORY;
    if (status == DEM_OK) fill(list, n, lattice, part_of);
    for (dem_index p = 0; status == DEM_OK && p < n; p++) {
        const bool first = p == 0 || list[p].body != list[p - 1].body;
        is_main[list[p].number] = first;
        if (!first) tell(loose, &list[p]);
    }
    for (dem_index i = 0; status == DEM_OK && i < lattice->n_nodes; i++) kept[i] = is_main[part_of[i]];
    free(list);
    free(is_main);
    return status;
}

dem_status parts_find(parts_loose *loose, unsigned char *kept, const dem_lattice *lattice)
{
    dem_index n, *part_of = calloc((size_t)lattice->n_nodes + 1, sizeof *part_of);
    *loose = (parts_loose){0};
    if (part_of == NULL) return DEM_ERROR_MEMORY;
    dem_status status = dem_lattice_parts(lattice, &n, part_of);
    if (status == DEM_OK) status = sort_out(loose, kept, lattice, n, part_of);
    free(part_of);
    return status;
}
