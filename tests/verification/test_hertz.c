/* SPDX-License-Identifier: BSD-3-Clause */
/* Two equal smooth discs of radius R pressed together, slowly, by a body force: Hertz's contact of cylinders. In plane
 * stress the force F over the thickness h makes the half-width b = sqrt(4 F R/(pi E h)) and the pressure
 * p = p0 sqrt(1 - y^2/b^2) with p0 = 2 F/(pi b h), whose mean square distance from the middle is b^2/4. `long` as
 * argument: with 32 rings instead of 20, and also with nodes that face each other. */
#include <stdlib.h>

#include "ask.h"
#include "elastic_bodies.h"
#include "simulation/private.h"
#include "support.h"
#include "unit/surface_contact/evaluated.h"

enum { MOST_NODES = 64 };

static int rings = 20, n_turns = 1;
static double tolerance = 0.05;                                 /* of the pressure */
static const double radius = 0.02, modulus = 1e7, share = 0.08; /* m, Pa, p0/E */
static const dem_material rubber = SIZED(dem_material, .youngs_modulus = 1e7, .poissons_ratio = 1.0 / 3.0,
                                         .density = 1050.0, .thickness = 1.0, .springs = DEM_SPRINGS_COUPLED);

/* A disc about a place, turned by a part of one of its edges. */
static dem_lattice make_disc(double place, double turn)
{
    dem_lattice l = dem_lattice_empty();
    elastic_bodies_rings(&l, rings);
    for (dem_index k = 0; k < 2 * l.n_nodes; k++) l.x[k] *= radius / rings;
    assert_ok(dem_lattice_assemble(&l, &rubber));
    dem_lattice_move(&l, turn * 2.0 * M_PI / (6 * rings), (const double[2]){place, 0.0});
    return l;
}

/* A body force that pushes body 0 or 1 of two equal ones along x, from a ramp of 4 ms on. */
static dem_boundary pushing(const dem_lattice *pair, int body, double force)
{
    const dem_index n = pair->n_nodes / 2;
    double *parts = malloc((size_t)n * sizeof *parts), mass = 0.0;
    dem_index *nodes = malloc((size_t)n * sizeof *nodes);
    assert_true(parts != NULL && nodes != NULL);
    for (dem_index i = 0; i < n; i++) mass += pair->mass[i];
    for (dem_index i = 0; i < n; i++) {
        nodes[i] = body * n + i;
        parts[i] = pair->mass[nodes[i]] / mass;
    }
    return (dem_boundary)SIZED(dem_boundary, .kind = DEM_BOUNDARY_FORCE,
                               .components = DEM_COMPONENT_X | DEM_COMPONENT_Y, .n_nodes = n, .nodes = nodes,
                               .share = parts, .value = {force, 0.0}, .ramp = 4e-3);
}

static void free_pushing(dem_boundary *b)
{
    free((void *)b->nodes);
    free((void *)b->share);
}

/* A node of the left disc on which the right one acts. */
typedef struct pressed {
    double y, force;
} pressed;

static int compare(const void *a, const void *b)
{
    const double left = ((const pressed *)a)->y, right = ((const pressed *)b)->y;
    return (left > right) - (left < right);
}

/* Those of the first n nodes, by y. */
static int find_pressed(const surface_contact *c, const double *x, dem_index n, pressed *list)
{
    int n_pressed = 0;
    for (dem_index i = 0; i < n; i++) {
        const double force = evaluated_force(c, i).x;
        if (force >= 0.0) continue;
        assert_true(n_pressed < MOST_NODES);
        list[n_pressed++] = (pressed){x[2 * i + 1], -force};
    }
    qsort(list, (size_t)n_pressed, sizeof *list, compare);
    return n_pressed;
}

/* What is found of Hertz's contact. */
typedef struct contact {
    double force, width, pressure; /* b by the moment, p0 by the pressures */
} contact;

/* p^2 = p0^2 - (p0/b)^2 y^2 is a line over y^2. It is fitted to the nodes inside; the pressure at a node is its force
 * over half of the way between its neighbours, as they are pressed. */
static contact measure(const pressed *list, int n, double middle, double half)
{
    contact c = {0.0, 0.0, 0.0};
    double sums[2] = {0.0, 0.0}, products[2] = {0.0, 0.0};
    int n_inside = 0;
    for (int k = 0; k < n; k++) {
        const double y2 = (list[k].y - middle) * (list[k].y - middle);
        c.force += list[k].force;
        c.width += list[k].force * y2;
        if (k == 0 || k == n - 1 || y2 > 0.81 * half * half) continue;
        const double p = list[k].force / (0.5 * (list[k + 1].y - list[k - 1].y));
        n_inside++;
        sums[0] += y2;
        sums[1] += p * p;
        products[0] += y2 * y2;
        products[1] += y2 * p * p;
    }
    const double slope = (n_inside * products[1] - sums[0] * sums[1]) / (n_inside * products[0] - sums[0] * sums[0]);
    c.width = 2.0 * sqrt(c.width / c.force);
    c.pressure = sqrt((sums[1] - slope * sums[0]) / n_inside);
    return c;
}

static contact press(double turn, double force, double half)
{
    const double gap = 0.1 * radius / rings;
    CLEANUP(support_close) support_run run;
    CLEANUP(dem_lattice_free) dem_lattice pair = make_disc(-radius - gap, 0.0), right = make_disc(radius + gap, turn);
    assert_ok(dem_lattice_append(&pair, &right));
    CLEANUP(free_pushing) dem_boundary push = pushing(&pair, 0, force), back = pushing(&pair, 1, -force);
    const dem_boundary both[2] = {push, back};
    dem_options o = support_options();
    pressed list[MOST_NODES];
    o.gravity[1] = 0.0;
    o.bodies = DEM_BODIES_OTHERS;
    o.method = DEM_METHOD_VERLET;
    o.fixed_step = 3e-5 / rings;
    o.mass_damping = 4000.0;
    o.n_boundaries = 2;
    o.boundaries = both;
    support_open(&run, &pair, NULL, 0, &o);
    const motion end = support_at(&run, 8e-3);
    const int n = find_pressed(run.simulation->surfaces, end.x, pair.n_nodes / 2, list);
    const dem_body_motion left = ask_body(run.simulation, 0);
    return measure(list, n, left.centre[1], half);
}

/* Hertz knows small strains; here the pressure is 0.08 E, and surfaces push before they touch. Found are half-widths
 * off by 0.07 and 0.2 percent with 20 and 32 rings, where half a spacing is 16 and 10 percent, and pressures 3.3 and
 * 1.2 percent too high. The force is that of bodies at rest: after 8 ms it is off by 5e-5. */
TEST(discs_pressed_together_are_flat_as_hertz_says)
{
    const double half = 2.0 * share * radius, force = 0.5 * M_PI * half * share * modulus;
    for (int k = 0; k < n_turns; k++) {
        const contact c = press(0.5 - 0.5 * k, force, half);
        print_message(
            "# %d rings, turned by %g edges: force %.1e off, half-width %.4f mm of %.4f, pressure %.4f of p0\n", rings,
            0.5 - 0.5 * k, c.force / force - 1.0, 1e3 * c.width, 1e3 * half, c.pressure / (share * modulus));
        assert_close(c.force, force, 1e-3 * force);
        assert_close(c.width, half, 0.01 * half);
        assert_close(c.pressure, share * modulus, tolerance * share * modulus);
    }
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "long") == 0) {
        rings = 32;
        n_turns = 2;
        tolerance = 0.03;
    }
    return test_run();
}
