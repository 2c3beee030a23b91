/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/shared_field.h"

#include <stdlib.h>

#include "base/motion_source.h"
#include "base/status.h"
#include "domain/gather.h"
#include "simulation/private.h"

static dem_status fill_positions(const dem_simulation *s, void *out)
{
    return dem_private_positions(s, out);
}

static dem_status fill_velocities(const dem_simulation *s, void *out)
{
    return dem_private_velocities(s, out);
}

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

/* What a field has a row of. */
enum of { NODES, SPRINGS };

static const struct field {
    enum of of;
    size_t size; /* bytes of a row */
    dem_status (*fill)(const dem_simulation *s, void *out);
} fields[] = {
    [SHARED_FIELD_POSITIONS] = {NODES, 2 * sizeof(double), fill_positions},
    [SHARED_FIELD_VELOCITIES] = {NODES, 2 * sizeof(double), fill_velocities},
    [SHARED_FIELD_STRESS] = {NODES, 3 * sizeof(double), fill_stress},
    [SHARED_FIELD_STRAINS] = {SPRINGS, sizeof(double), fill_strains},
    [SHARED_FIELD_FORCES] = {SPRINGS, sizeof(double), fill_forces},
};

static gather_items items_of(const dem_model *m, enum of of)
{
    return of == NODES ? gather_nodes(m->domain) : gather_springs(m->domain, &m->lattice);
}

static dem_status allocate(void **rows, size_t size)
{
    *rows = malloc(size + 1);
    CHECK_MEMORY(*rows);
    return DEM_OK;
}

dem_status shared_field_gather(const dem_simulation *part, shared_field_kind field, void *out)
{
    const ranks *r = part->model->ranks;
    const struct field *f = &fields[field];
    const gather_items items = items_of(part->model, f->of);
    void *rows;
    dem_status status = reduce_status(r, allocate(&rows, (size_t)items.n * f->size), 0.0);
    if (status == DEM_OK) status = reduce_status(r, f->fill(part, rows), 0.0);
    if (status == DEM_OK) status = gather_rows(r, &items, f->size, rows, out);
    free(rows);
    return status;
}
