/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts sorted by body and size: the first of each body is its main one. */
#include "parts.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct part {
    int32_t body;
    dem_index number, size, node; /* node: its lowest */
} part;

/* What parts consist of: nodes, or triangles. */
typedef struct members {
    const dem_lattice *lattice;
    dem_index n;
    dem_index *part; /* [n] */
    bool triangles;
} members;

static dem_index lowest_node(const members *m, dem_index i)
{
    if (!m->triangles) return i;
    const dem_index *corner = m->lattice->triangles + 3 * i;
    const dem_index lower = corner[0] < corner[1] ? corner[0] : corner[1];
    return lower < corner[2] ? lower : corner[2];
}

static int by_body_and_size(const void *a, const void *b)
{
    const part *p = a, *q = b;
    if (p->body != q->body) return p->body < q->body ? -1 : 1;
    if (p->size != q->size) return p->size > q->size ? -1 : 1;
    return p->number < q->number ? -1 : 1;
}

static void fill(part *list, dem_index n, const members *m)
{
    const int32_t *body = m->lattice->body;
    for (dem_index p = 0; p < n; p++) list[p].number = p;
    for (dem_index i = 0; i < m->n; i++) {
        part *p = &list[m->part[i]];
        const dem_index node = lowest_node(m, i);
        if (p->size++ == 0 || node < p->node) p->node = node;
        p->body = body != NULL ? body[node] : 0;
    }
    qsort(list, (size_t)n, sizeof *list, by_body_and_size);
}

static void append(parts_loose *loose, const part *p, const double *x)
{
    const dem_index k = loose->n++;
    if (k >= PARTS_LISTED) return;
    loose->size[k] = p->size;
    for (int c = 0; c < 2; c++) loose->x[k][c] = x[2 * p->node + c];
}

static dem_status sort_out(parts_loose *loose, bool *kept, const members *m, dem_index n)
{
    part *list = calloc((size_t)n + 1, sizeof *list);
    unsigned char *is_main = calloc((size_t)n + 1, sizeof *is_main); /* by part number */
    const dem_status status = list != NULL && is_main != NULL ? DEM_OK : DEM_ERROR_MEMORY;
    if (status == DEM_OK) fill(list, n, m);
    for (dem_index p = 0; status == DEM_OK && p < n; p++) {
        const bool first = p == 0 || list[p].body != list[p - 1].body;
        is_main[list[p].number] = first;
        if (!first) append(loose, &list[p], m->lattice->x);
    }
    for (dem_index i = 0; status == DEM_OK && i < m->n; i++) kept[i] = is_main[m->part[i]];
    free(list);
    free(is_main);
    return status;
}

dem_status parts_find(parts_loose *loose, bool *kept, const dem_lattice *lattice)
{
    const bool triangles = lattice->n_springs == 0 && lattice->n_triangles > 0;
    members m = {.lattice = lattice, .n = triangles ? lattice->n_triangles : lattice->n_nodes, .triangles = triangles};
    dem_index n;
    *loose = (parts_loose){0};
    m.part = calloc((size_t)m.n + 1, sizeof *m.part);
    if (m.part == NULL) return DEM_ERROR_MEMORY;
    dem_status status = triangles ? dem_lattice_pieces(lattice, &n, m.part) : dem_lattice_parts(lattice, &n, m.part);
    if (status == DEM_OK) status = sort_out(loose, kept, &m, n);
    free(m.part);
    return status;
}

void parts_print(char *text, const parts_loose *loose, const char *what)
{
    size_t n = 0;
    text[0] = '\0';
    for (dem_index k = 0; k < loose->n && k < PARTS_LISTED; k++) {
        n += (size_t)snprintf(text + n, PARTS_LIST - n, "%s%lld", k == 0 ? "" : ", ", (long long)loose->size[k]);
        if (k == 0) n += (size_t)snprintf(text + n, PARTS_LIST - n, " %s%s", what, loose->size[k] == 1 ? "" : "s");
        n += (size_t)snprintf(text + n, PARTS_LIST - n, " at (%g, %g)", loose->x[k][0], loose->x[k][1]);
    }
    if (loose->n > PARTS_LISTED) (void)snprintf(text + n, PARTS_LIST - n, ", ...");
}

dem_status parts_find_hinges(parts_hinges *hinges, const dem_lattice *lattice)
{
    dem_index *rims = calloc((size_t)lattice->n_nodes + 1, sizeof *rims);
    *hinges = (parts_hinges){0};
    if (rims == NULL) return DEM_ERROR_MEMORY;
    const dem_status status = dem_lattice_rims(lattice, rims);
    for (dem_index i = lattice->n_nodes; status == DEM_OK && i-- > 0;) {
        if (rims[i] <= 2) continue;
        hinges->n++;
        for (int c = 0; c < 2; c++) hinges->x[c] = lattice->x[2 * i + c];
    }
    free(rims);
    return status;
}
