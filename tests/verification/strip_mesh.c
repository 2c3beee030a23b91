/* SPDX-License-Identifier: BSD-3-Clause */
#include "strip_mesh.h"

#include "body/shape.h"
#include "body/smoothing.h"
#include "clamped_strip.h"
#include "unstructured.h"

static const double spacing = CLAMPED_STRIP_SPACING;

/* The outline is turned the other way, filled with a lattice, and turned back with it. */
dem_lattice strip_mesh_make(double width, double height, const strip_mesh *m)
{
    const double turn = m->angle / 180.0 * M_PI, straight[2] = {0.0, 0.0};
    shape s = {.outline = {.kind = OUTLINE_RECTANGLE, .size = {width * spacing, height * spacing}},
               .spacing = spacing,
               .smooth = true};
    dem_lattice l = dem_lattice_empty();
    smoothing out;
    assert_true(outline_place(&s.outline, (const double[2]){cos(turn), -sin(turn)}, straight));
    assert_ok(shape_mesh(&l, &s));
    assert_ok(smoothing_apply(&out, &l, &s));
    assert_int_equal(out.n_off, 0);
    dem_lattice_move(&l, turn, straight);
    if (m->jitter > 0.0) assert_ok(dem_lattice_jitter(&l, m->jitter * spacing, 1));
    if (!m->rows) unstructured_make(&l, spacing, 1);
    shape_free(&s);
    return l;
}
