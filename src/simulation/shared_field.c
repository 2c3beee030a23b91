/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/shared_field.h"

#include <stdlib.h>

#include "base/status.h"
#include "domain/gather.h"
#include "simulation/private.h"

static dem_status fill_stress(const dem_simulation *s, void *out)
{
    return dem_simulation_stress(s, out);
}

static dem_status fill_strains(const dem_simulation *s, void *out)
{
    return dem_simulation_strains(s, out);
}

static dem_status fill_forces(const dem_simulation *s, void *out)
{
    return dem_simulation_forces(s, out);
}

static dem_status fill_broken_triangles(const dem_simulation *s, void *out)
{
    return dem_simulation_broken(s, out, NULL);
}

static dem_status fill_broken_springs(const dem_simulation *s, void *out)
{
    return dem_simulation_broken(s, NULL, out);
}

static dem_status fill_triangle_damage(const dem_simulation *s, void *out)
{
    return dem_simulation_damage(s, out, NULL);
}

static dem_status fill_node_damage(const dem_simulation *s, void *out)
{
    return dem_simulation_damage(s, NULL, out);
}

/* What a field has a row of: by how many nodes such an item has. */
enum { NODES = 1, SPRINGS = 2, TRIANGLES = 3 };

static const struct field {
    int of;
    size_t size; /* bytes of a row */
    dem_status (*fill)(const dem_simulation *s, void *out);
} fields[] = {
    [SHARED_FIELD_STRESS] = {NODES, 3 * sizeof(double), fill_stress},
    [SHARED_FIELD_STRAINS] = {SPRINGS, sizeof(double), fill_strains},
    [SHARED_FIELD_FORCES] = {SPRINGS, sizeof(double), fill_forces},
    [SHARED_FIELD_BROKEN_TRIANGLES] = {TRIANGLES, 1, fill_broken_triangles},
    [SHARED_FIELD_BROKEN_SPRINGS] = {SPRINGS, 1, fill_broken_springs},
    [SHARED_FIELD_TRIANGLE_DAMAGE] = {TRIANGLES, sizeof(double), fill_triangle_damage},
    [SHARED_FIELD_NODE_DAMAGE] = {NODES, sizeof(double), fill_node_damage},
};

/* What is here of the field. */
typedef struct part_of_field {
    gather_items items;
    unsigned char *owns; /* [n] of springs or triangles */
    void *rows;          /* [n] */
} part_of_field;

static dem_status mark_owned(part_of_field *p, const domain *d, const dem_index *nodes, int n)
{
    p->owns = malloc((size_t)p->items.n + 1);
    CHECK_MEMORY(p->owns);
    for (dem_index k = 0; k < p->items.n; k++) p->owns[k] = domain_owns_element(d, nodes + n * k, n);
    p->items.is_own = p->owns;
    return DEM_OK;
}

static dem_status list_items(part_of_field *p, const dem_model *m, int of)
{
    const dem_lattice *l = &m->lattice;
    const domain *d = m->domain;
    const gather_items items[] = {
        [NODES] = gather_nodes(d),
        [SPRINGS] = {.n = l->n_springs, .n_whole = d->n_springs, .number = d->spring},
        [TRIANGLES] = {.n = l->n_triangles, .n_whole = d->n_triangles, .number = d->triangle},
    };
    p->items = items[of];
    return of == NODES ? DEM_OK : mark_owned(p, d, of == SPRINGS ? l->ends : l->triangles, of);
}

static dem_status begin(part_of_field *p, const dem_model *m, const struct field *f)
{
    TRY(list_items(p, m, f->of));
    p->rows = malloc((size_t)p->items.n * f->size + 1);
    CHECK_MEMORY(p->rows);
    return DEM_OK;
}

dem_status shared_field_gather(const dem_simulation *part, shared_field_kind field, void *out)
{
    const ranks *r = part->model->ranks;
    const struct field *f = &fields[field];
    part_of_field p = {0};
    dem_status status = reduce_status(r, begin(&p, part->model, f), 0.0);
    if (status == DEM_OK) status = reduce_status(r, f->fill(part, p.rows), 0.0);
    if (status == DEM_OK) status = gather_rows(r, &p.items, f->size, p.rows, out);
    free(p.owns);
    free(p.rows);
    return status;
}
