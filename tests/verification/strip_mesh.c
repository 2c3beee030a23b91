/* SPDX-License-Identifier: BSD-3-Clause */
#include "strip_mesh.h"

#include <stdlib.h>
#include <string.h>

#include "clamped_strip.h"
#include "unstructured.h"

static const double spacing = CLAMPED_STRIP_SPACING;

/* The outline is turned the other way, filled with a lattice, and turned back with it. */
dem_lattice strip_mesh_make(double width, double height, const strip_mesh *m)
{
    const double turn = m->angle / 180.0 * M_PI, straight[2] = {0.0, 0.0};
    const dem_outline strip = SIZED(dem_outline, .angle = -turn, .size = {width * spacing, height * spacing});
    const dem_shape s = SIZED(dem_shape, .outline = &strip, .spacing = spacing, .edge = DEM_EDGE_SMOOTH);
    dem_lattice l = dem_lattice_empty();
    dem_shape_report out = {.struct_size = sizeof out};
    assert_ok(dem_shape_lattice(&l, &s, &out));
    assert_int_equal(out.n_off, 0);
    dem_lattice_move(&l, turn, straight);
    if (m->jitter > 0.0) assert_ok(dem_lattice_jitter(&l, m->jitter * spacing, m->seed));
    if (!m->rows) unstructured_make(&l, spacing, m->seed);
    return l;
}

/* Cells of which a corner is outside of the box from 0 to `size` go. */
static void cut_cells(dem_lattice *l, const double size[2])
{
    bool *keep = calloc((size_t)l->n_nodes, sizeof *keep);
    dem_index n = 0;
    assert_non_null(keep);
    for (dem_index k = 0; k < l->n_triangles / 2; k++) {
        dem_index *cell = &l->triangles[6 * k];
        bool inside = true;
        for (int c = 0; c < 12; c++) {
            const double x = l->x[2 * cell[c / 2] + c % 2];
            inside = inside && x > -0.01 * spacing && x < size[c % 2] + 0.01 * spacing;
        }
        for (int c = 0; c < 6 && inside; c++) keep[cell[c]] = true;
        if (inside) memmove(&l->triangles[6 * n++], cell, 6 * sizeof *cell);
    }
    l->n_triangles = 2 * n;
    assert_ok(dem_lattice_select(l, keep));
    free(keep);
}

dem_lattice strip_mesh_squares(double width, double height, bool turned)
{
    const double row = sqrt(0.5) * spacing, reach = ceil(width + height) * spacing;
    const double size[2] = {2.0 * floor(0.5 * width * spacing / row) * row,
                            2.0 * floor(0.5 * height * spacing / row) * row};
    dem_lattice l = dem_lattice_empty();
    if (!turned) {
        assert_ok(dem_lattice_squares(&l, width * spacing, height * spacing, spacing));
        return l;
    }
    assert_ok(dem_lattice_squares(&l, 2.0 * reach, 2.0 * reach, spacing));
    dem_lattice_move(&l, 0.0, (const double[2]){0.0, -reach});
    dem_lattice_move(&l, 0.25 * M_PI, (const double[2]){0.5 * size[0], 0.5 * size[1]});
    cut_cells(&l, size);
    return l;
}
