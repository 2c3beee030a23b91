/* SPDX-License-Identifier: BSD-3-Clause */
#include "clamped_strip.h"

#include <stdlib.h>

dem_material clamped_strip_material(bool by_stretch, double nu)
{
    return (dem_material){.struct_size = sizeof(dem_material),
                          .youngs_modulus = CLAMPED_STRIP_MODULUS,
                          .poissons_ratio = nu,
                          .density = CLAMPED_STRIP_DENSITY,
                          .thickness = 1.0,
                          .springs = DEM_SPRINGS_COUPLED,
                          .strength = by_stretch ? 0.0 : CLAMPED_STRIP_MODULUS * CLAMPED_STRIP_LIMIT,
                          .critical_stretch = by_stretch ? CLAMPED_STRIP_LIMIT : 0.0};
}

/* The crack is in the middle of a row of triangles, those along the rows of nodes, if there are any. */
clamped_strip clamped_strip_of(const dem_lattice *l)
{
    const double row = 0.5 * sqrt(3.0) * CLAMPED_STRIP_SPACING;
    clamped_strip s = {.begin = l->x[0], .end = l->x[0], .bottom = support_bottom(l)};
    s.height = support_top(l) - s.bottom;
    s.middle = s.bottom + (floor(0.5 * round(s.height / row)) + 0.5) * row;
    for (int side = 0; side < 2; side++) {
        s.sides[side] = calloc((size_t)l->n_nodes, sizeof *s.sides[side]);
        assert_non_null(s.sides[side]);
    }
    for (dem_index i = 0; i < l->n_nodes; i++) {
        const double *x = &l->x[2 * i], above = x[1] - s.bottom;
        s.begin = fmin(s.begin, x[0]);
        s.end = fmax(s.end, x[0]);
        if (above < 0.1 * CLAMPED_STRIP_SPACING) s.sides[0][s.n_sides[0]++] = i;
        if (s.height - above < 0.1 * CLAMPED_STRIP_SPACING) s.sides[1][s.n_sides[1]++] = i;
    }
    return s;
}

void clamped_strip_free(clamped_strip *s)
{
    for (int side = 0; side < 2; side++) free(s->sides[side]);
}

double clamped_strip_unit(const clamped_strip *s, double nu)
{
    return 2.0 * (1.0 - nu * nu) * CLAMPED_STRIP_LIMIT * CLAMPED_STRIP_LIMIT * CLAMPED_STRIP_SPACING / s->height;
}

void clamped_strip_stretch(const clamped_strip *s, dem_lattice *l, double parted)
{
    double *position = calloc((size_t)(2 * l->n_nodes), sizeof *position);
    assert_non_null(position);
    for (dem_index i = 0; i < l->n_nodes; i++) {
        position[2 * i] = l->x[2 * i];
        position[2 * i + 1] = l->x[2 * i + 1] + parted * ((l->x[2 * i + 1] - s->bottom) / s->height - 0.5);
    }
    support_start(l, position, NULL);
    free(position);
}

double clamped_strip_long_step(const dem_lattice *l)
{
    dem_model *model;
    assert_ok(dem_model_create(&model, l, NULL, 0));
    const double step = 1.0 / dem_model_omega_max(model);
    dem_model_destroy(model);
    return step;
}

double clamped_strip_centre(const dem_lattice *l, dem_index triangle, int axis)
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += l->x[2 * l->triangles[3 * triangle + c] + axis] / 3.0;
    return sum;
}

static bool is_near_edge(const clamped_strip *s, double x, double y)
{
    const double inside = fmin(0.5 * s->height - fabs(y - s->bottom - 0.5 * s->height), s->end - x);
    return inside < 4.0 * CLAMPED_STRIP_SPACING;
}

void clamped_strip_strengthen(const clamped_strip *s, dem_lattice *l)
{
    for (dem_index t = 0; l->strength != NULL && t < l->n_triangles; t++)
        if (is_near_edge(s, clamped_strip_centre(l, t, 0), clamped_strip_centre(l, t, 1))) l->strength[t] *= 1e3;
    for (dem_index k = 0; l->critical_stretch != NULL && k < l->n_springs; k++) {
        const double *x = &l->x[2 * l->ends[2 * k]];
        if (is_near_edge(s, x[0], x[1])) l->critical_stretch[k] *= 1e3;
    }
}

void clamped_strip_hold(const clamped_strip *s, double speed, dem_boundary *pull)
{
    for (int side = 0; side < 2; side++)
        pull[side] = (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_VELOCITY,
                                         .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .nodes = s->sides[side],
                                         .n_nodes = s->n_sides[side], .value = {0.0, (side ? 0.5 : -0.5) * speed});
}

bool clamped_strip_crosses(const clamped_strip *s, const dem_lattice *l, dem_index triangle)
{
    int above = 0;
    for (int c = 0; c < 3; c++) above += l->x[2 * l->triangles[3 * triangle + c] + 1] > s->middle;
    return above == 1 || above == 2;
}

dem_index clamped_strip_cut(const clamped_strip *s, dem_simulation *simulation, const dem_lattice *l, double from,
                            double to)
{
    dem_index *list = calloc((size_t)l->n_triangles, sizeof *list), n = 0;
    assert_non_null(list);
    for (dem_index t = 0; t < l->n_triangles; t++)
        if (clamped_strip_crosses(s, l, t) && clamped_strip_centre(l, t, 0) > from &&
            clamped_strip_centre(l, t, 0) < to)
            list[n++] = t;
    assert_ok(dem_simulation_break(simulation, list, n, NULL, 0));
    free(list);
    return n;
}
