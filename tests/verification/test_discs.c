/* SPDX-License-Identifier: BSD-3-Clause */
/* Two equal discs without friction run into each other: what their outlines do to their spins. Round bodies that push
 * each other off without friction get none; a stepped rim turns them by its teeth. */
#include "support.h"

#include <stdlib.h>

#include "shape.h"
#include "smoothing.h"

static const double radius = 0.02, speed = 2.5; /* m, m/s */
static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                         .density = 1050.0, .thickness = 1.0, .springs = DEM_SPRINGS_COUPLED);

static dem_lattice make_disc(double spacing, bool smooth)
{
    const shape s = {.outline = {.kind = OUTLINE_DISC, .radius = radius}, .spacing = spacing, .smooth = smooth};
    dem_lattice l = dem_lattice_empty();
    smoothing out;
    assert_ok(shape_mesh(&l, &s));
    assert_ok(smooth ? smoothing_apply(&out, &l, &s) : shape_cut(&l, &s));
    assert_ok(dem_lattice_assemble(&l, &rubber));
    return l;
}

/* Spin of the nodes from `first` on about their centre of mass, 1/s. */
static double spin_of(const dem_lattice *l, const motion *m, dem_index first, dem_index n)
{
    double mass = 0.0, x[2] = {0.0, 0.0}, v[2] = {0.0, 0.0}, turn = 0.0, inertia = 0.0;
    for (dem_index i = first; i < first + n; i++) {
        mass += l->mass[i];
        for (int c = 0; c < 2; c++) {
            x[c] += l->mass[i] * m->x[2 * i + c];
            v[c] += l->mass[i] * m->v[2 * i + c];
        }
    }
    for (dem_index i = first; i < first + n; i++) {
        const double dx = m->x[2 * i] - x[0] / mass, dy = m->x[2 * i + 1] - x[1] / mass;
        turn += l->mass[i] * (dx * (m->v[2 * i + 1] - v[1] / mass) - dy * (m->v[2 * i] - v[0] / mass));
        inertia += l->mass[i] * (dx * dx + dy * dy);
    }
    return turn / inertia;
}

/* The larger spin of the two after an impact, offset by half a radius, whose discs are turned by angles. */
static double collide(double spacing, bool smooth, double angle)
{
    CLEANUP(dem_lattice_free) dem_lattice a = make_disc(spacing, smooth), b = make_disc(spacing, smooth);
    const double offset = 0.5 * radius, gap = sqrt(4.0 * radius * radius - offset * offset) + 0.5 * spacing;
    dem_lattice_move(&a, angle, (double[2]){-0.5 * gap, 0.5 * offset});
    dem_lattice_move(&b, 0.7 - 2.0 * angle, (double[2]){0.5 * gap, -0.5 * offset});
    const dem_index n = a.n_nodes, m = b.n_nodes;
    assert_ok(dem_lattice_append(&a, &b));
    CLEANUP(free_memory) double *v = calloc(2 * (size_t)(n + m), sizeof *v);
    assert_non_null(v);
    for (dem_index i = 0; i < n + m; i++) v[2 * i] = i < n ? speed : -speed;
    support_start(&a, NULL, v);
    dem_options options = support_options();
    options.bodies = DEM_BODIES_OTHERS;
    CLEANUP(support_close) support_run run;
    support_open(&run, &a, NULL, 0, &options);
    const motion end = support_at(&run, 6e-3);
    return fmax(fabs(spin_of(&a, &end, 0, n)), fabs(spin_of(&a, &end, n, m)));
}

/* The largest spin for three turns of the discs. */
static double largest_spin(int n, bool smooth)
{
    double largest = 0.0;
    for (int k = 0; k < 3; k++) largest = fmax(largest, collide(radius / n, smooth, 0.2 * k));
    print_message("# %s, spacing R/%d: spins of up to %.2f 1/s\n", smooth ? "smooth" : "stepped", n, largest);
    return largest;
}

/* If they stuck together they would leave with 21 1/s. Found are 1.65, 0.24 and 0.12 1/s at R/8, R/16 and R/32 with
 * smooth rims, 81 and 74 1/s with stepped ones at R/8 and R/16. */
TEST(smooth_discs_get_next_to_no_spin)
{
    assert_true(largest_spin(8, true) < 2.5);
    assert_true(largest_spin(16, true) < 0.5);
    assert_true(largest_spin(8, false) > 20.0);
}
