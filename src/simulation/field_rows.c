/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulation/field_rows.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "simulation/private.h"

/* ---- what fills rows ---- */

static dem_status copy_motion(const dem_simulation *s, bool velocities, double *out)
{
    dem_state state = {.struct_size = sizeof state};
    TRY(dem_simulation_state(s, &state));
    memcpy(out, velocities ? state.v : state.x, (size_t)state_row(&s->layout, s->model->lattice.n_nodes) * sizeof *out);
    return DEM_OK;
}

static dem_status fill_positions(const dem_simulation *s, void *out)
{
    return copy_motion(s, false, out);
}

/* The rest position need not be where the motion started. */
static dem_status fill_displacements(const dem_simulation *s, void *out)
{
    const double *rest = s->model->lattice.x;
    double *row = out;
    TRY(copy_motion(s, false, row));
    for (dem_index k = 0; k < state_row(&s->layout, s->model->lattice.n_nodes); k++) row[k] -= rest[k];
    return DEM_OK;
}

static dem_status fill_velocities(const dem_simulation *s, void *out)
{
    return copy_motion(s, true, out);
}

static dem_status fill_stress(const dem_simulation *s, void *out)
{
    return dem_simulation_stress(s, out);
}

static dem_status fill_contact_forces(const dem_simulation *s, void *out)
{
    return dem_simulation_contact_forces(s, out);
}

static dem_status fill_contact_pressures(const dem_simulation *s, void *out)
{
    return dem_simulation_contact_pressures(s, out);
}

static dem_status fill_strains(const dem_simulation *s, void *out)
{
    return dem_simulation_strains(s, out);
}

static dem_status fill_forces(const dem_simulation *s, void *out)
{
    return dem_simulation_forces(s, out);
}

static dem_status fill_fragments(const dem_simulation *s, void *out)
{
    dem_index n_fragments;
    return dem_simulation_fragments(s, &n_fragments, out);
}

static dem_status fill_damage(const dem_simulation *s, void *out)
{
    return dem_simulation_damage(s, NULL, out);
}

static dem_status fill_broken_springs(const dem_simulation *s, void *out)
{
    return dem_simulation_broken(s, NULL, out);
}

static dem_status fill_broken_triangles(const dem_simulation *s, void *out)
{
    return dem_simulation_broken(s, out, NULL);
}

/* ---- fields ---- */

/* What a field has a row of. */
enum of { NODES, SPRINGS, TRIANGLES };

static const struct field {
    enum of of;
    bool is_shared;
    size_t size; /* bytes of a row */
    dem_status (*fill)(const dem_simulation *s, void *out);
} fields[] = {
    [FIELD_POSITIONS] = {NODES, true, 2 * sizeof(double), fill_positions},
    [FIELD_DISPLACEMENTS] = {NODES, true, 2 * sizeof(double), fill_displacements},
    [FIELD_VELOCITIES] = {NODES, true, 2 * sizeof(double), fill_velocities},
    [FIELD_STRESS] = {NODES, true, 3 * sizeof(double), fill_stress},
    [FIELD_CONTACT_FORCES] = {NODES, true, 2 * sizeof(double), fill_contact_forces},
    [FIELD_CONTACT_PRESSURES] = {NODES, true, sizeof(double), fill_contact_pressures},
    [FIELD_STRAINS] = {SPRINGS, true, sizeof(double), fill_strains},
    [FIELD_FORCES] = {SPRINGS, true, sizeof(double), fill_forces},
    [FIELD_FRAGMENTS] = {NODES, false, sizeof(dem_index), fill_fragments},
    [FIELD_DAMAGE] = {NODES, true, sizeof(double), fill_damage},
    [FIELD_BROKEN_SPRINGS] = {SPRINGS, true, 1, fill_broken_springs},
    [FIELD_BROKEN_TRIANGLES] = {TRIANGLES, true, 1, fill_broken_triangles},
};

size_t field_rows_size(field_kind field)
{
    return fields[field].size;
}

bool field_rows_are_shared(field_kind field)
{
    return fields[field].is_shared;
}

dem_index field_rows_count(const dem_simulation *s, field_kind field)
{
    const dem_lattice *l = &s->model->lattice;
    const dem_index count[] = {[NODES] = l->n_nodes, [SPRINGS] = l->n_springs, [TRIANGLES] = l->n_triangles};
    return count[fields[field].of];
}

gather_items field_rows_items(const dem_simulation *part, field_kind field)
{
    const dem_model *m = part->model;
    switch (fields[field].of) {
    case NODES:
        return gather_nodes(m->domain);
    case SPRINGS:
        return gather_springs(m->domain, &m->lattice);
    default:
        return gather_triangles(m->domain, &m->lattice);
    }
}

static dem_status allocate(const dem_simulation *s, field_kind field, void **out)
{
    *out = malloc((size_t)field_rows_count(s, field) * fields[field].size + 1);
    CHECK(*out != NULL, DEM_ERROR_MEMORY, "out of memory for %lld rows of a field",
          (long long)field_rows_count(s, field));
    return DEM_OK;
}

dem_status field_rows_make(const dem_simulation *s, field_kind field, void **out)
{
    const ranks *r = s->model->ranks;
    TRY(reduce_status(r, allocate(s, field, out), 0.0));
    return reduce_status(r, fields[field].fill(s, *out), 0.0);
}
